//! Words for instructions that are made up: what is left of the opcodes for extensions.

use std::fmt::Write;

use isa::Isa;
use isa::pattern::CUSTOM;

use super::pattern::{MOST_BITS, Pattern};

/// Bits that tell instructions of one major opcode apart.
const SELECTOR: u32 = 4;

/// Words that are left for extensions.
pub struct Majors {
    /// Major opcodes that are free as a whole, the last one first.
    free: Vec<&'static str>,
    /// The one that short instructions share, and how many of them there are.
    shared: Option<(&'static str, u32)>,
}

impl Majors {
    /// All that the extensions of a set of instructions leave.
    pub fn new(isa: &Isa) -> Majors {
        let is_free = |bits: &str| {
            let major = u32::from_str_radix(bits, 2).unwrap_or(0);
            isa.extensions().all(|op| isa.definition(op).pattern.value >> 26 != major)
        };
        Majors {
            free: CUSTOM.iter().rev().filter(|(_, bits)| is_free(bits)).map(|(name, _)| *name).collect(),
            shared: None,
        }
    }

    /// True where an instruction fits whose operands have so many bits.
    pub fn has_room(&self, bits: u32) -> bool {
        let shares = bits + SELECTOR <= MOST_BITS && self.shared.is_some_and(|(_, count)| count < 1 << SELECTOR);
        shares || !self.free.is_empty()
    }

    /// The row of a pattern, with words of its own.
    pub fn row(&mut self, name: &str, pattern: &Pattern) -> String {
        let bits = pattern.bits();
        let mut picture = String::new();
        // Fields stand in the order of their letters, as the table has them.
        let mut fields: Vec<(char, u8)> =
            pattern.operands.iter().map(|&(letter, kind)| (letter, kind.width().unwrap_or(0))).collect();
        fields.sort_by_key(|(letter, _)| isa::pattern::LETTERS.iter().position(|&other| other == *letter as u8));
        for (letter, width) in fields {
            let _ = write!(picture, " {}", letter.to_string().repeat(width.into()));
        }
        // Share a major opcode where the operands leave room for a selector. Of two instructions with 15 bits of operands the first has
        // `-------0000` behind them, the second `-------0001`; one with 25 bits takes an opcode of its own.
        let major = if bits + SELECTOR <= MOST_BITS {
            let (major, count) = match self.shared.take().filter(|(_, count)| *count < 1 << SELECTOR) {
                Some(shared) => shared,
                None => (self.free.pop().unwrap_or(CUSTOM[0].0), 0),
            };
            let rest = (MOST_BITS - SELECTOR - bits) as usize;
            let _ = write!(picture, " {}{count:0width$b}", "-".repeat(rest), width = SELECTOR as usize);
            self.shared = Some((major, count + 1));
            major
        } else {
            let _ = write!(picture, " {}", "-".repeat((MOST_BITS - bits) as usize));
            self.free.pop().unwrap_or(CUSTOM[0].0)
        };
        let operands: Vec<String> =
            pattern.operands.iter().map(|(letter, kind)| format!("{letter}: {}", kind.name())).collect();
        format!("{name} ({})  \"{major}{}\"  [Done(body)]", operands.join(", "), picture.trim_end())
    }
}
