//! The symbol map: every name with its value and place, every function and region with its words.

use std::fmt::Write;
use std::sync::Arc;

use isa::program::Line;
use messages::Source;

use crate::Assembled;
use crate::assembler::Assembler;
use crate::symbol::SymbolValue;

/// The kind of thing that a name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum NameKind {
    /// A word address in the code.
    Code,
    /// An octet address in the buffer.
    Buffer,
    /// A number.
    Constant,
}

/// A name of a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MapEntry {
    /// The name.
    pub name: String,
    /// The kind of thing.
    pub kind: NameKind,
    /// The value: an address or a number.
    pub value: i64,
    /// Place of the definition; `None` for names from outside.
    pub place: Option<Line>,
}

/// The map as text: code by address, buffer by address, constants by name, then functions and regions.
pub fn symbol_map(assembled: &Assembled) -> String {
    let program = &assembled.program;
    let mut entries: Vec<&MapEntry> = assembled.symbols.iter().collect();
    // By address; constants have none and go by name.
    entries.sort_by_key(|entry| {
        let address = if entry.kind == NameKind::Constant { 0 } else { entry.value };
        (entry.kind, address, &entry.name)
    });
    let width = entries.iter().map(|entry| entry.name.chars().count()).max().unwrap_or(0);
    let mut text = String::new();
    let titles = [
        (NameKind::Code, "Code, in words"),
        (NameKind::Buffer, "Buffer, in octets"),
        (NameKind::Constant, "Constants"),
    ];
    for (kind, title) in titles {
        let mut chosen = entries.iter().filter(|entry| entry.kind == kind).peekable();
        if chosen.peek().is_none() {
            continue;
        }
        let _ = writeln!(text, "{title}");
        for entry in chosen {
            let value = match kind {
                NameKind::Constant => format!("{:>20}", entry.value),
                _ => format!("{:>20}", format!("{:06x}", entry.value)),
            };
            let place = entry.place.and_then(|line| Some((program.sources.get(line.source as usize)?, line.line)));
            let place = place.map_or("given from outside".into(), |(source, line)| format!("{}:{line}", source.name));
            let _ = writeln!(text, "{value}  {:<width$}  {place}", entry.name);
        }
        text.push('\n');
    }
    if !program.regions.is_empty() {
        let _ = writeln!(text, "Functions and regions, in words");
    }
    for (index, region) in program.regions.iter().enumerate() {
        // Show what is inside what by indentation.
        let mut depth = 0;
        let mut parent = region.parent;
        while let Some(outer) = parent {
            depth += 1;
            parent = program.regions.get(outer as usize).and_then(|region| region.parent);
        }
        let own = program.region_of.iter().filter(|&&of| of == Some(index as u16)).count();
        let first = program.region_of.iter().position(|&of| of == Some(index as u16)).unwrap_or(0);
        let what = if region.is_function { "function" } else { "region" };
        let _ = writeln!(
            text,
            "{:>20}  {}{} ({what}, {own} words of its own)",
            format!("{first:06x}"),
            "  ".repeat(depth),
            region.name
        );
    }
    text.trim_end().to_string() + "\n"
}

impl Assembler<'_> {
    /// The names of the program, for people: those that belong to one expansion or are numbers are left out.
    pub(crate) fn map(&self) -> Vec<MapEntry> {
        let starts = |source: &Arc<Source>| -> Vec<usize> {
            [0].into_iter().chain(source.text.match_indices('\n').map(|(at, _)| at + 1)).collect()
        };
        let starts: Vec<Vec<usize>> = self.program.sources.iter().map(starts).collect();
        let mut entries = Vec::new();
        for (_, text, symbol) in self.names.symbols() {
            let (kind, value) = match symbol.value {
                SymbolValue::Code(value) => (NameKind::Code, value),
                SymbolValue::Buffer(value) => (NameKind::Buffer, value),
                SymbolValue::Constant(value) | SymbolValue::Variable(value, _) => (NameKind::Constant, value),
                SymbolValue::Pending(_) | SymbolValue::Broken => continue,
            };
            if !text.contains(['$', '#']) {
                let place = symbol.at.map(|at| {
                    let line = starts[at.source as usize].partition_point(|&start| start <= at.start as usize);
                    Line { source: at.source, line: line as u32 }
                });
                entries.push(MapEntry { name: text.to_string(), kind, value, place });
            }
        }
        entries
    }
}
