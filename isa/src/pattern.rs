//! The 32-bit word of an instruction as a bit pattern: `0` and `1` are fixed, a letter is a bit of that operand's field,
//! `-` encodes as 0 and must be 0, spaces are ignored. One parser serves built-in rows, at compile time, and extensions.

use std::fmt;

/// Most fields that a pattern may have.
pub const MAX_FIELDS: usize = 6;

/// Letters that may name an operand: written, read and written, read, immediate.
pub const LETTERS: &[u8] = b"dexyabcij";

/// Place of an operand in the word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PatternField {
    /// The operand's letter.
    pub letter: u8,
    /// Lowest bit of the field.
    pub shift: u8,
    /// Number of bits.
    pub width: u8,
}

/// A parsed pattern.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BitPattern {
    /// The fixed bits.
    pub value: u32,
    /// Mask of the fixed bits, those drawn `-` included.
    pub mask: u32,
    fields: [PatternField; MAX_FIELDS],
    count: u8,
}

/// The reason for which a pattern cannot be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PatternError {
    /// Not 32 bits but this many.
    Length(usize),
    /// A character, at this octet, that means nothing in a pattern.
    Character(usize),
    /// The field of this letter is in several pieces.
    Split(u8),
    /// More than [`MAX_FIELDS`] fields.
    TooManyFields,
}

impl fmt::Display for PatternError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PatternError::Length(bits) => write!(f, "the pattern has {bits} bits instead of 32"),
            PatternError::Character(at) => {
                write!(f, "character {} of the pattern is none of 0, 1, -, {}", at + 1, LETTERS.escape_ascii())
            }
            PatternError::Split(letter) => write!(f, "the field `{}` is in several pieces", *letter as char),
            PatternError::TooManyFields => write!(f, "the pattern has more than {MAX_FIELDS} fields"),
        }
    }
}

/// Names of the major opcodes that stay free for extensions, with their six bits.
pub const CUSTOM: [(&str, &str); 4] =
    [("custom0", "111100"), ("custom1", "111101"), ("custom2", "111110"), ("custom3", "111111")];

impl BitPattern {
    /// Reads a pattern.
    pub const fn parse(text: &str) -> Result<BitPattern, PatternError> {
        // From the top bit down. `vlt`, for example, is "010000 ddddd aaaaa bbbbb ------ 10100": value 0x4000_0014, mask 0xfc00_07ff, and the
        // fields d at 21, a at 16, b at 11, of 5 bits each.
        let text = text.as_bytes();
        let empty = PatternField { letter: 0, shift: 0, width: 0 };
        let mut pattern = BitPattern { value: 0, mask: 0, fields: [empty; MAX_FIELDS], count: 0 };
        let mut bits = 0;
        let mut at = 0;
        let mut last = 0;
        // A name in the place of the six major bits.
        if let Some(value) = custom_major(text) {
            pattern.value = value << 26;
            pattern.mask = 0x3f << 26;
            bits = 6;
            at = CUSTOM[0].0.len();
        }
        while at < text.len() {
            let c = text[at];
            at += 1;
            if c == b' ' {
                continue;
            }
            bits += 1;
            // Further ones are only counted, for the message.
            if bits > 32 {
                continue;
            }
            let shift = 32 - bits as u8;
            match c {
                // A dash is a fixed 0, so that words with another bit there stay free for later.
                b'0' | b'1' | b'-' => {
                    pattern.mask |= 1 << shift;
                    pattern.value |= ((c == b'1') as u32) << shift;
                }
                _ if is_letter(c) => {
                    // The same letter goes on: its field grows downwards.
                    if c == last {
                        let field = &mut pattern.fields[pattern.count as usize - 1];
                        field.shift = shift;
                        field.width += 1;
                    } else {
                        // A letter that comes back would be a second piece of its field.
                        if pattern.field(c).is_some() {
                            return Err(PatternError::Split(c));
                        }
                        if pattern.count as usize == MAX_FIELDS {
                            return Err(PatternError::TooManyFields);
                        }
                        pattern.fields[pattern.count as usize] = PatternField { letter: c, shift, width: 1 };
                        pattern.count += 1;
                    }
                }
                _ => return Err(PatternError::Character(at - 1)),
            }
            last = c;
        }
        if bits == 32 { Ok(pattern) } else { Err(PatternError::Length(bits)) }
    }

    /// The field of an operand.
    pub const fn field(&self, letter: u8) -> Option<PatternField> {
        let mut at = 0;
        while at < self.count as usize {
            if self.fields[at].letter == letter {
                return Some(self.fields[at]);
            }
            at += 1;
        }
        None
    }

    /// All fields, from the top bit down.
    pub fn fields(&self) -> &[PatternField] {
        &self.fields[..self.count as usize]
    }

    /// Number of fields.
    pub const fn field_count(&self) -> usize {
        self.count as usize
    }

    /// Some word matches both patterns.
    pub const fn overlaps(&self, other: &BitPattern) -> bool {
        (self.value ^ other.value) & self.mask & other.mask == 0
    }

    /// The `word` has the fixed bits of this pattern.
    pub const fn matches(&self, word: u32) -> bool {
        word & self.mask == self.value
    }

    /// The six major bits are one of the four opcodes kept for extensions.
    pub const fn is_custom(&self) -> bool {
        self.mask >> 26 == 0x3f && self.value >> 28 == 0xf
    }
}

const fn is_letter(c: u8) -> bool {
    let mut at = 0;
    while at < LETTERS.len() {
        if LETTERS[at] == c {
            return true;
        }
        at += 1;
    }
    false
}

/// The major opcode when the text starts with `custom0` to `custom3`.
const fn custom_major(text: &[u8]) -> Option<u32> {
    let name = CUSTOM[0].0.as_bytes();
    if text.len() < name.len() {
        return None;
    }
    let mut at = 0;
    while at < name.len() - 1 {
        if text[at] != name[at] {
            return None;
        }
        at += 1;
    }
    let digit = text[at];
    if digit >= b'0' && digit <= b'3' { Some(0x3c + (digit - b'0') as u32) } else { None }
}
