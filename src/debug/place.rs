//! Places in a program as people name them: a function, `file:line`, a line, `*word`.

use std::path::Path;

use isa::Program;
use messages::did_you_mean;

use crate::arguments::numbered;

/// The words of a place, each the first of a run that belongs to it.
///
/// # Errors
/// A function, a file or a line that the program does not have.
pub fn words(program: &Program, text: &str, here: u32) -> Result<Vec<u32>, String> {
    let text = text.trim();
    // Find a word by its number, such as *17
    if let Some(word) = text.strip_prefix('*') {
        let word = numbered(word)?;
        return match u32::try_from(word).ok().filter(|&word| (word as usize) < program.words.len()) {
            Some(word) => Ok(vec![word]),
            None => Err(format!("the program has words 0 to {}, not {word}", program.words.len().saturating_sub(1))),
        };
    }
    // Find a line of the file that the core is in, such as 42
    if text.bytes().all(|digit| digit.is_ascii_digit()) && !text.is_empty() {
        let source = program.lines.get(here as usize).or(program.lines.first()).map_or(0, |line| line.source);
        return lines(program, &[source], text.parse().unwrap_or(0))
            .ok_or_else(|| format!("no instruction stands at line {text}"));
    }
    // Find a line of a file, such as walk.s:42; the last colon counts, since paths may have others
    if let Some((file, line)) = text.rsplit_once(':')
        && let Ok(number) = line.trim().parse()
    {
        let sources = sources(program, file);
        if sources.is_empty() {
            let known = program.sources.iter().map(|source| source.name.as_str());
            let hint = did_you_mean(file, known).map_or_else(String::new, |hint| format!(": {hint}"));
            return Err(format!("the program has no file `{file}`{hint}"));
        }
        return lines(program, &sources, number).ok_or_else(|| format!("no instruction stands at {text}"));
    }
    // Find a function; other symbols, such as constants, are no places
    let functions = || program.regions.iter().filter(|region| region.is_function).map(|region| region.name.as_str());
    let address = program.symbols.get(text).copied().and_then(|at| u32::try_from(at).ok());
    match (functions().any(|name| name == text), address) {
        (true, Some(address)) => Ok(vec![address]),
        _ => {
            let hint = did_you_mean(text, functions())
                .unwrap_or_else(|| "a place is a function, file:line, a line or *word".into());
            Err(format!("the program has no function `{text}`: {hint}"))
        }
    }
}

/// Sources that a path means: of the same name, or the same end of a path.
pub fn sources(program: &Program, path: &str) -> Vec<u16> {
    let wanted = Path::new(path);
    let is_it = |name: &str| {
        let own = Path::new(name);
        name == path
            || wanted.ends_with(own)
            || own.ends_with(wanted)
            || std::fs::canonicalize(own)
                .is_ok_and(|own| std::fs::canonicalize(wanted).is_ok_and(|wanted| own == wanted))
    };
    (0u16..).zip(&program.sources).filter(|(_, source)| is_it(&source.name)).map(|(number, _)| number).collect()
}

/// First words of the runs that a line made; `None` where it made none.
pub fn lines(program: &Program, sources: &[u16], line: u32) -> Option<Vec<u32>> {
    let is_it = |pc: usize| program.lines.get(pc).is_some_and(|at| at.line == line && sources.contains(&at.source));
    let firsts = (0..program.lines.len()).filter(|&pc| is_it(pc) && (pc == 0 || !is_it(pc - 1)));
    let found: Vec<u32> = firsts.map(|pc| pc as u32).collect();
    if found.is_empty() { None } else { Some(found) }
}
