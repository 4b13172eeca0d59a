//! Names and formats of registers, which a program keeps for those who look at it while it runs: where a name of `.reg` begins and ends,
//! and what `.holds` says. Nothing here makes a word.

use std::collections::HashMap;
use std::rc::Rc;

use isa::naming::{HeldFormat, NamedRegister};

use crate::assembler::Assembler;
use crate::cursor::Cursor;
use crate::explain;
use crate::message::{Among, Parsed, Problem};
use crate::operand::Register;
use crate::symbol::Name;

/// End of a range of words that is not closed yet.
pub(crate) const OPEN: u32 = u32::MAX;

/// A name that `.reg` gave, with the words where it is known.
#[derive(Clone, Debug)]
pub(crate) struct AliasSpan {
    pub name: Rc<str>,
    pub register: Register,
    pub words: std::ops::Range<u32>,
}

/// Last word of `.holds` on a register in a scope.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OpenHolding {
    format: Option<Name>,
    from: u32,
}

impl Assembler<'_> {
    fn here(&self) -> u32 {
        self.program.words.len() as u32
    }

    /// Notes that a name stands for a register from here on, and yields its number among all such notes.
    pub(crate) fn begin_alias(&mut self, name: &str, register: Register) -> usize {
        let here = self.here();
        self.alias_spans.push(AliasSpan { name: name.into(), register, words: here..OPEN });
        self.alias_spans.len() - 1
    }

    /// Notes that a name stands for nothing from here on.
    pub(crate) fn end_alias(&mut self, number: usize) {
        self.alias_spans[number].words.end = self.here();
    }

    /// Opens a scope of names and formats.
    pub(crate) fn open_scope(&mut self) {
        self.aliases.push(HashMap::new());
        self.holdings.push(HashMap::new());
    }

    /// Closes the innermost scope.
    pub(crate) fn close_scope(&mut self) {
        let mut ended: Vec<usize> = self.aliases.pop().into_iter().flatten().map(|(_, alias)| alias.number).collect();
        ended.sort_unstable();
        ended.into_iter().for_each(|number| self.end_alias(number));
        let mut held: Vec<(Register, OpenHolding)> = self.holdings.pop().into_iter().flatten().collect();
        held.sort_unstable_by_key(|(register, _)| *register);
        held.into_iter().for_each(|(register, holding)| self.keep(register, holding));
    }

    /// Puts what was said of a register up to here into the program.
    fn keep(&mut self, register: Register, holding: OpenHolding) {
        let words = holding.from..self.here();
        if !words.is_empty() {
            let format = holding.format.map(|name| self.names.text(name).to_string());
            self.program.holds.push(HeldFormat { register, format, words });
        }
    }

    /// `.holds register, format`, or without a format that nothing is said any more.
    pub(crate) fn hold(&mut self, cursor: &mut Cursor) -> Parsed<()> {
        let (register_text, register_at) = cursor.name("a register")?;
        let Some(register) = self.register(register_text, register_at)? else {
            let message = format!("`{register_text}` is not a register");
            return Err(Problem::new(explain::REGISTER, message, register_at, "expected a register")
                .suggest(register_text, Among::Registers));
        };
        let mut format = None;
        if !cursor.is_at_end() {
            cursor.expect(",")?;
            let (text, at) = cursor.name("the name of a format")?;
            cursor.end()?;
            let name = self.names.intern(text);
            if self.names.format(name).is_none() {
                // A file that is missing may have had it.
                if self.is_incomplete {
                    return Ok(());
                }
                let message = format!("`{text}` is not a format");
                return Err(Problem::new(explain::FORMAT, message, at, "no such format")
                    .suggest(text, Among::Formats)
                    .hint("formats come from `.format name, bits`"));
            }
            format = Some(name);
        }
        self.held = Some((register, format));
        let holding = OpenHolding { format, from: self.here() };
        let scope = self.holdings.last_mut().expect("the outermost scope is never closed");
        if let Some(before) = scope.insert(register, holding) {
            self.keep(register, before);
        }
        Ok(())
    }

    /// The note of a `.holds` in a listing: `s2: pos, 16`.
    pub(crate) fn held_note(&self, (file, number): Register, format: Option<Name>) -> String {
        match format {
            Some(name) => {
                let bits = self.names.format(name).unwrap_or(0);
                format!("{file}{number}: {}, {bits}", self.names.text(name))
            }
            None => format!("{file}{number}: no format"),
        }
    }

    /// Closes all scopes and puts names, formats and structures into the program.
    pub(crate) fn finish_naming(&mut self) {
        while !self.aliases.is_empty() {
            self.close_scope();
        }
        let spans = std::mem::take(&mut self.alias_spans);
        self.report_meetings(&spans);
        let kept = spans.into_iter().filter(|span| !span.words.is_empty() && !span.name.contains('$'));
        self.program.register_names = kept
            .map(|span| NamedRegister { name: span.name.to_string(), register: span.register, words: span.words })
            .collect();
        let formats = self.names.formats().map(|text| (text.to_owned(), text));
        let bits = formats.filter_map(|(owned, text)| Some((owned, self.names.format_named(text)?)));
        self.program.formats = bits.collect();
    }
}
