//! Words of the program as text, with what their exits cost, their functions and their source lines.

use std::fmt::Write;

use super::session::Session;
use crate::trace::instruction;

/// Lines of a disassembly: `>` marks the next instruction.
pub fn text(session: &Session, from: u32, count: u32) -> String {
    let (code, program) = (&session.stepper().code, &session.target.program);
    let mut text = String::new();
    let mut function = None;
    for pc in from..from.saturating_add(count).min(program.words.len() as u32) {
        let here = program.function(pc);
        if here != function {
            let _ = writeln!(text, "{}:", here.unwrap_or("(no function)"));
            function = here;
        }
        let costs = code.row(pc).map_or_else(String::new, |row| {
            let outcomes: Vec<String> = row.outcomes.iter().map(|outcome| outcome.text()).collect();
            outcomes.join(", ")
        });
        let mark = if pc == session.pc() && session.stepper().end().is_none() { '>' } else { ' ' };
        let (written, place) = (instruction::text(code, pc), program.place(pc).unwrap_or_default());
        let _ =
            writeln!(text, "{mark} {pc:06x}  {:08x}  {written:<34} {costs:<28} {place}", program.words[pc as usize]);
    }
    text
}

/// The source line of a word, without its end.
pub fn source_line(session: &Session, pc: u32) -> Option<String> {
    let program = &session.target.program;
    program.line_text(*program.lines.get(pc as usize)?).map(|text| text.trim_end().to_owned())
}

/// Source lines around a word: `>` marks its own.
pub fn listing(session: &Session, pc: u32, around: u32) -> String {
    let program = &session.target.program;
    let Some(line) = program.lines.get(pc as usize) else { return String::new() };
    let Some(source) = program.sources.get(usize::from(line.source)) else { return String::new() };
    let (first, last) = (line.line.saturating_sub(around).max(1), line.line.saturating_add(around));
    let mut text = format!("{}\n", source.name);
    for (number, shown) in (1u32..).zip(source.text.lines()).skip(first as usize - 1) {
        if number > last {
            break;
        }
        let mark = if number == line.line { '>' } else { ' ' };
        let _ = writeln!(text, "{mark} {number:>5}  {}", shown.trim_end());
    }
    text
}
