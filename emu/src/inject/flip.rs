//! Flips of bits: in which structure, at which moment, which bits of which word. How one is drawn is said here, what comes of it is not.

use random::SplitMix64;

use crate::machine::FaultKind;

/// Places of the bits of one flip in their word.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FlipPattern {
    /// One beside the other, as one particle upsets neighbouring cells.
    #[default]
    Adjacent,
    /// Anywhere in the word.
    Scattered,
}

impl FlipPattern {
    /// All of them.
    pub const ALL: [FlipPattern; 2] = [FlipPattern::Adjacent, FlipPattern::Scattered];

    /// Name in options and results.
    pub const fn name(self) -> &'static str {
        match self {
            FlipPattern::Adjacent => "adjacent",
            FlipPattern::Scattered => "scattered",
        }
    }
}

/// Number and places of the bits that flip together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FlipShape {
    /// Bits, 1 to 32.
    pub bits: u32,
    /// Places of the bits.
    pub pattern: FlipPattern,
}

impl FlipShape {
    /// One bit.
    pub const SINGLE: FlipShape = FlipShape { bits: 1, pattern: FlipPattern::Adjacent };

    /// The bits of a word that flip, drawn evenly: of adjacent ones the place of the lowest.
    pub fn mask(self, series: &mut SplitMix64) -> u32 {
        let bits = self.bits.clamp(1, u32::BITS);
        match self.pattern {
            FlipPattern::Adjacent => {
                let run = (1u64 << bits) - 1;
                (run << series.below(u64::from(u32::BITS - bits) + 1)) as u32
            }
            FlipPattern::Scattered => {
                let mut mask = 0u32;
                while mask.count_ones() < bits {
                    mask |= 1 << series.below(u32::BITS.into());
                }
                mask
            }
        }
    }
}

/// A flip: a work item, a moment in it, and bits of a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BitFlip {
    /// Structure in which the bits are.
    pub target: FaultKind,
    /// Number of the work item, from 0 in the order in which they are handed out.
    pub item: u32,
    /// Instructions of the work item before it, steps of bodies counted; on the bus the words that its transfers moved before the flipped one;
    /// a clock of the machine, where that decides.
    pub moment: u64,
    /// Number of the word in its structure; of a result, a number that is reduced to the words of the result; of a stuck arbiter or a core
    /// that stopped, the master's; of two grants at once, a number from which the other transfer follows.
    pub word: u32,
    /// Bits that flip; none where that is not what goes wrong.
    pub mask: u32,
}

/// Scalars but `s0`, which is no storage.
const SCALAR_WORDS: u32 = 31;

/// Components of vectors.
const VECTOR_WORDS: u32 = 3 * 32;

/// Halves of wide accumulators.
const WIDE_WORDS: u32 = 2 * 8;

/// Words of all registers that programs can name.
pub const REGISTER_WORDS: u32 = SCALAR_WORDS + VECTOR_WORDS + WIDE_WORDS;

/// A word of a register file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RegisterWord {
    /// Letter of the file: `s`, `v` or `w`.
    pub file: char,
    /// Number of the register.
    pub number: u8,
    /// Component of a vector; half of a wide accumulator, 1 for the upper one; 0 of a scalar.
    pub part: u8,
}

impl RegisterWord {
    /// The word of a number below [`REGISTER_WORDS`]: scalars from `s1` on, vectors by component, wide accumulators by half.
    pub fn numbered(word: u32) -> RegisterWord {
        let (file, number, part) = match word {
            scalar if scalar < SCALAR_WORDS => ('s', scalar + 1, 0),
            vector if vector < SCALAR_WORDS + VECTOR_WORDS => {
                ('v', (vector - SCALAR_WORDS) / 3, (vector - SCALAR_WORDS) % 3)
            }
            wide => ('w', (wide - SCALAR_WORDS - VECTOR_WORDS) / 2, (wide - SCALAR_WORDS - VECTOR_WORDS) % 2),
        };
        RegisterWord { file, number: number as u8, part: part as u8 }
    }

    /// Bits below the word in its register's number: 32 in the upper half of a wide accumulator.
    pub const fn bits_below(self) -> u32 {
        if self.file == 'w' { 32 * self.part as u32 } else { 0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_registers_are_counted_through() {
        let at = |word| {
            let RegisterWord { file, number, part } = RegisterWord::numbered(word);
            (file, number, part)
        };
        assert_eq!([at(0), at(30)], [('s', 1, 0), ('s', 31, 0)]);
        assert_eq!([at(31), at(33), at(126)], [('v', 0, 0), ('v', 0, 2), ('v', 31, 2)]);
        assert_eq!([at(127), at(128), at(REGISTER_WORDS - 1)], [('w', 0, 0), ('w', 0, 1), ('w', 7, 1)]);
    }

    #[test]
    fn masks_have_their_bits_and_reach_every_place() {
        let mut series = SplitMix64::new(1);
        for pattern in FlipPattern::ALL {
            for bits in [1, 2, 3, 31, 32] {
                let mut seen = 0;
                for _ in 0..2_000 {
                    let mask = FlipShape { bits, pattern }.mask(&mut series);
                    assert_eq!(mask.count_ones(), bits);
                    if pattern == FlipPattern::Adjacent {
                        assert_eq!(u64::from(mask >> mask.trailing_zeros()), (1u64 << bits) - 1);
                    }
                    seen |= mask;
                }
                assert_eq!(seen, u32::MAX, "{pattern:?} {bits}");
            }
        }
    }
}
