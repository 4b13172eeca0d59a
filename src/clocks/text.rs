//! Clocks of functions and of source lines as tables.

use super::lines::LineClocks;
use crate::numeral::{percent, short};
use crate::result::{ByKind, FunctionClocks, RegionCounts, Render};
use crate::table::{row, table};

/// Lines that the table of lines has, those with the most clocks.
const LINES_SHOWN: usize = 16;

/// Letters of an instruction in the table of lines.
const CODE_SHOWN: usize = 17;

/// Clocks of functions: first those of the cores, then those of the main processor; nothing where they were not measured.
pub fn functions(result: &Render) -> String {
    let cores = function_table([&result.functions[..], &result.regions]);
    let main = function_table([&result.main.functions[..], result.main.regions.as_deref().unwrap_or_default()]);
    if cores.is_empty() {
        return String::new();
    }
    format!(
        "Clocks by function: computing, and waiting for its own transfers; incl. with all that it calls\n\
         {cores}\nMain processor\n{main}"
    )
}

/// Functions, and the regions in them, that took clocks, those with the most own ones first.
fn function_table([functions, regions]: [&[RegionCounts]; 2]) -> String {
    let clocked = |row: &RegionCounts| Some((row.exclusive.clocks?, row.inclusive.clocks?));
    let all = functions.iter().map(|row| (row, "")).chain(regions.iter().map(|row| (row, "  ")));
    let mut found: Vec<(&RegionCounts, &str, FunctionClocks, FunctionClocks)> = all
        .filter_map(|(row, prefix)| clocked(row).map(|(own, inclusive)| (row, prefix, own, inclusive)))
        .filter(|(.., inclusive)| inclusive.all() != 0)
        .collect();
    if found.is_empty() {
        return String::new();
    }
    let all: u64 = found.iter().map(|(_, _, own, _)| own.all()).sum();
    found.sort_by_key(|(_, _, own, _)| std::cmp::Reverse(own.all()));
    let head = ["function", "own", "of all", "busy", "waiting", "waits for", "transfers", "incl.", "incl. waiting"];
    let rows = found.into_iter().map(|(region, prefix, own, inclusive)| {
        vec![
            format!("{prefix}{}", region.name),
            short(own.all()),
            percent(own.all(), all),
            short(own.busy),
            short(own.waiting),
            region.waiting_kinds.as_ref().map_or(String::new(), most_waited),
            short(own.transfers),
            short(inclusive.all()),
            short(inclusive.waiting),
        ]
    });
    table(std::iter::once(row(head)).chain(rows))
}

/// The kind of data that was waited for longest; empty for none.
fn most_waited(kinds: &ByKind) -> String {
    // Of equal ones the first, as they stand in memory.
    let longest = kinds.0.iter().rev().max_by_key(|(_, waiting)| *waiting);
    longest.map_or(String::new(), |(kind, _)| kind.clone())
}

/// The instruction of a line, without its comment and as far as there is room.
fn code(text: &str) -> String {
    let words: Vec<&str> = text.split(';').next().unwrap_or_default().split_whitespace().collect();
    let words = words.join(" ");
    match words.chars().count() {
        length if length > CODE_SHOWN => words.chars().take(CODE_SHOWN - 2).collect::<String>() + "..",
        _ => words,
    }
}

/// The source lines that took the most clocks.
pub fn line_table(lines: &[LineClocks]) -> String {
    let clocks = |line: &LineClocks| line.busy + line.waiting;
    let all: u64 = lines.iter().map(clocks).sum();
    let mut found: Vec<&LineClocks> = lines.iter().filter(|line| clocks(line) != 0).collect();
    found.sort_by_key(|line| std::cmp::Reverse(clocks(line)));
    let head = ["line", "clocks", "of all", "waiting", "waits for", "instruction"];
    let rows = found.into_iter().take(LINES_SHOWN).map(|line| {
        vec![
            line.place.clone(),
            short(clocks(line)),
            percent(clocks(line), all),
            short(line.waiting),
            most_waited(&line.waiting_kinds),
            code(&line.text),
        ]
    });
    format!("Lines with the most clocks\n{}", table(std::iter::once(row(head)).chain(rows)))
}
