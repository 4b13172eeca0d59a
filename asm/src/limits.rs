//! Limits of what one source may ask for. Beyond one there is an error with a place, never a long wait or a lack of memory.

/// Work that one source may ask for: the most that there is, or less where a caller assembles many sources that it has not written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SourceLimits {
    /// Words of a program.
    pub words: usize,
    /// Octets of the initial buffer.
    pub buffer: usize,
    /// Lines of all files, expansions and repetitions together.
    pub lines: usize,
    /// Octets that expansions make.
    pub expanded_octets: usize,
    /// Names that the suggestions of all messages are sought among, together.
    pub compared_names: usize,
}

impl Default for SourceLimits {
    /// The constants of this module.
    fn default() -> SourceLimits {
        SourceLimits {
            words: WORDS,
            buffer: BUFFER,
            lines: LINES,
            expanded_octets: EXPANDED_OCTETS,
            compared_names: COMPARED_NAMES,
        }
    }
}

/// Words of a program.
pub const WORDS: usize = 1 << 20;
/// Octets of the initial buffer.
pub const BUFFER: usize = 16 << 20;
/// Lines of all files, expansions and repetitions together.
pub const LINES: usize = 1_000_000;
/// Octets of one line, after substitution.
pub const LINE_OCTETS: usize = 1 << 20;
/// Octets of all lines together.
pub const TEXT_OCTETS: usize = 32 << 20;
/// Octets that expansions make: those that arguments add to lines, and all of calls and repetitions inside others.
pub const EXPANDED_OCTETS: usize = 2 << 20;
/// Octets that a line inside of two expansions counts besides those of its text.
pub const EXPANDED_LINE: usize = 32;
/// Tokens of a line with arguments that count by their octets alone.
pub const EXPANDED_TOKENS: usize = 64;
/// Octets that each token beyond those counts: a long expression takes its time by its operators.
pub const EXPANDED_TOKEN: usize = 8;
/// Parameters of a macro.
pub const PARAMETERS: usize = 256;
/// Names that the suggestions of all messages are sought among, together.
pub const COMPARED_NAMES: usize = 200_000;
/// Octets of the longest name for which a similar one is sought.
pub const COMPARED_OCTETS: usize = 100;
/// Macro calls and repetitions inside each other.
pub const EXPANSION_DEPTH: usize = 64;
/// Files that include each other.
pub const INCLUDE_DEPTH: usize = 32;
/// Parentheses inside each other.
pub const PARENTHESES: usize = 100;
/// Functions and regions of a program.
pub const REGIONS: usize = 65_535;
/// Functions and regions inside each other.
pub const REGION_DEPTH: usize = 64;
/// Files of a program.
pub const SOURCES: usize = 65_535;
/// Messages that are shown; the others are counted.
pub const MESSAGES: usize = 100;
/// Messages that are kept before the first ones in the order of the text are chosen.
pub const KEPT_MESSAGES: usize = 2_000;
/// Most digits after the point of a fixed-point literal.
pub const FRACTION_DIGITS: usize = 38;
/// Most fraction bits of a number format.
pub const FRACTION_BITS: i64 = 63;
/// Structures and their fields, in octets.
pub const STRUCTURE: i64 = 1 << 31;
