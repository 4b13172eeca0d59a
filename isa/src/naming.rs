//! Names, formats and structures that a program gives its registers and its records in memory. Machines ignore all of it; whoever shows
//! a state to people reads it.

use std::ops::Range;

use crate::definition::Kind;
use crate::program::Line;

/// A register that programs can name: the letter of its file, `s`, `v` or `w`, and its number.
pub type RegisterId = (char, u8);

/// Another name of a register (`.reg`).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedRegister {
    /// The name.
    pub name: String,
    /// The register.
    pub register: RegisterId,
    /// The words in which the name stands for it.
    pub words: Range<u32>,
}

/// Format of the number in a register (`.holds`).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HeldFormat {
    /// The register; of a vector, each component has the format.
    pub register: RegisterId,
    /// Name of the format among [`crate::Program::formats`]; `None` where the register holds no number of a known format.
    pub format: Option<String>,
    /// The words before whose execution this holds.
    pub words: Range<u32>,
}

/// An instruction that a function computes in many steps (`.computes`): what is in the operands at the first word gives what is in the results
/// where the function returns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ComputedInstruction {
    /// The instruction; the program does not execute it.
    pub word: u32,
    /// From the word before which its operands are read to the function's end.
    pub words: Range<u32>,
    /// Line of the directive.
    pub line: Line,
}

/// A record in memory (`.struct`).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordMap {
    /// Name of the structure.
    pub name: String,
    /// Size in octets.
    pub octets: u32,
    /// Fields, in the order of their offsets.
    pub fields: Vec<FieldMap>,
}

/// A field of a record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FieldMap {
    /// Name of the field, without that of the structure.
    pub name: String,
    /// Octets from the beginning of the structure.
    pub offset: u32,
    /// Size in octets.
    pub octets: u32,
}

/// Registers that programs can name, file by file: 32 scalars, 32 vectors, 8 wide accumulators.
pub fn registers() -> impl Iterator<Item = RegisterId> {
    [(Kind::S, 32u8), (Kind::V, 32), (Kind::W, 8)].into_iter().flat_map(|(kind, count)| {
        let file = kind.register_file().expect("registers have a file");
        (0..count).map(move |number| (file, number))
    })
}

/// The innermost of what is said of a register at a word: what began last, and of that what ends first.
fn innermost<T>(said: &[T], pc: u32, of: impl Fn(&T) -> (RegisterId, &Range<u32>), register: RegisterId) -> Option<&T> {
    let here = said.iter().filter(|item| {
        let (other, words) = of(item);
        other == register && words.contains(&pc)
    });
    here.min_by_key(|item| {
        let words = of(item).1;
        (std::cmp::Reverse(words.start), words.end)
    })
}

impl crate::Program {
    /// Format and fraction bits of what a register holds before the word at `pc` is executed; `None` where nothing is said.
    pub fn format_of(&self, register: RegisterId, pc: u32) -> Option<(&str, i32)> {
        let held = innermost(&self.holds, pc, |held| (held.register, &held.words), register)?;
        self.format(held.format.as_deref()?)
    }

    /// A format by its name, with the fraction bits of its real values.
    pub fn format(&self, name: &str) -> Option<(&str, i32)> {
        let (name, bits) = self.formats.get_key_value(name)?;
        Some((name, self.shown_formats.get(name).copied().unwrap_or(*bits as i32)))
    }

    /// Name of a register at a word: of several the one that was given last.
    pub fn name_of(&self, register: RegisterId, pc: u32) -> Option<&str> {
        Some(&innermost(&self.register_names, pc, |named| (named.register, &named.words), register)?.name)
    }

    /// The register of a name at a word; anywhere else, where all that bear the name agree, the register of those.
    pub fn register_named(&self, name: &str, pc: u32) -> Option<RegisterId> {
        let named = || self.register_names.iter().filter(|named| named.name == name);
        let here = named().filter(|named| named.words.contains(&pc)).max_by_key(|named| named.words.start);
        let everywhere = || {
            let first = named().next()?;
            named().all(|named| named.register == first.register).then_some(first)
        };
        here.or_else(everywhere).map(|named| named.register)
    }

    /// The structure of a name.
    pub fn record(&self, name: &str) -> Option<&RecordMap> {
        self.records.iter().find(|record| record.name == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Program;

    #[test]
    fn the_innermost_word_on_a_register_counts() {
        let held =
            |format: Option<&str>, words| HeldFormat { register: ('s', 2), format: format.map(Into::into), words };
        let program = Program {
            formats: [("pos".to_owned(), 16), ("dir".to_owned(), 30)].into(),
            holds: vec![held(Some("dir"), 0..4), held(Some("pos"), 0..9), held(None, 6..8), held(Some("gone"), 8..9)],
            ..Program::default()
        };
        let at = |pc| program.format_of(('s', 2), pc);
        assert_eq!([at(0), at(3)], [Some(("dir", 30)); 2]);
        assert_eq!([at(4), at(5), at(6), at(8), at(9)], [Some(("pos", 16)), Some(("pos", 16)), None, None, None]);
        assert_eq!(program.format_of(('s', 3), 0), None);
        let moved = Program { shown_formats: [("pos".to_owned(), -270)].into(), ..program };
        assert_eq!((moved.format_of(('s', 2), 4), moved.format("dir")), (Some(("pos", -270)), Some(("dir", 30))));
        assert_eq!(registers().count(), 72);
    }

    #[test]
    fn a_name_counts_where_it_is_given_and_elsewhere_if_it_is_clear() {
        let named = |name: &str, number, words| NamedRegister { name: name.into(), register: ('s', number), words };
        let names = vec![named("t", 3, 0..9), named("u", 3, 4..6), named("a", 1, 0..2), named("a", 2, 2..4)];
        let program = Program { register_names: names, ..Program::default() };
        assert_eq!([3, 4, 6, 9].map(|pc| program.name_of(('s', 3), pc)), [Some("t"), Some("u"), Some("t"), None]);
        assert_eq!(program.register_named("u", 100), Some(('s', 3)));
        assert_eq!([0, 2, 4].map(|pc| program.register_named("a", pc)), [Some(('s', 1)), Some(('s', 2)), None]);
    }
}
