//! The listing of a program: addresses and words beside their source lines, then data and symbols.

use std::fmt::Write;

use isa::Program;
use isa::program::Line;

use crate::table::count;

/// The listing. Addresses of words are in words, those of data in octets; both hexadecimal.
pub fn text(program: &Program) -> String {
    let mut text = String::new();
    let sources: Vec<Vec<&str>> = program.sources.iter().map(|source| source.text.lines().collect()).collect();
    let mut before: Option<Line> = None;
    for (pc, word) in program.words.iter().enumerate() {
        let line = program.lines.get(pc).copied();
        if let Some(line) = line.filter(|line| before.map(|line| line.source) != Some(line.source)) {
            let name = program.sources.get(line.source as usize).map_or("?", |source| source.name.as_str());
            let _ = writeln!(text, "{:>26}{name}", "");
        }
        let shown = match line {
            // Several words of one line, as pseudo-instructions make them, show it once.
            Some(line) if before != Some(line) => {
                let source = sources.get(line.source as usize).and_then(|lines| lines.get(line.line as usize - 1));
                format!("{:>6}  {}", line.line, source.copied().unwrap_or_default().trim_end())
            }
            _ => String::new(),
        };
        let mark = if pc == program.entry as usize && program.entry != 0 { '>' } else { ' ' };
        let _ = writeln!(text, "{}", format!("{mark}{pc:05x}  {word:08x}  {shown}").trim_end());
        before = line;
    }
    if !program.buffer.is_empty() {
        let _ = writeln!(text, "\ndata, {}", count(program.buffer.len() as u64, "octet", "octets"));
        text += &octets(&program.buffer, 0);
    }
    if !program.symbols.is_empty() {
        let _ = writeln!(text, "\nsymbols");
        for (name, value) in &program.symbols {
            let _ = writeln!(text, "{value:>12}  {:>10}  {name}", format!("{:#x}", value));
        }
    }
    text
}

/// Octets, sixteen a line, with their addresses.
pub fn octets(octets: &[u8], address: u32) -> String {
    let mut text = String::new();
    for (number, row) in octets.chunks(16).enumerate() {
        let digits: Vec<String> = row.chunks(4).map(crate::result::hexadecimal).collect();
        let _ = writeln!(text, " {:08x}  {}", u64::from(address) + 16 * number as u64, digits.join(" "));
    }
    text
}
