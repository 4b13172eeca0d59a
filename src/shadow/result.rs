//! The shadow of a run as data: the key `shadow` of results.

use schemars::JsonSchema;
use serde::Serialize;

/// Numbers at the end beside exact ones, the lines of which their errors consist, and the errors of each line and function.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ShadowResult {
    /// Numbers that were compared at the end: components of pixels, or registers and words of memory.
    pub compared: u64,
    /// Compared numbers that differ from exact arithmetic.
    pub different: u64,
    /// Largest error of them in units in the last place.
    pub largest_ulps: f64,
    /// Root of the mean square of all their errors in units in the last place.
    pub root_mean_square_ulps: f64,
    /// Lines of which the final errors consist, and those whose errors turned decisions: first those whose shifts contradict declared formats, then
    /// the one with the largest share first.
    pub where_precision_died: Vec<DiedLine>,
    /// Share of the final errors that belongs to lines too small to be followed, in [0, 1].
    pub other_share: f64,
    /// The numbers with the largest errors, the largest first.
    pub outputs: Vec<ShadowOutput>,
    /// Decisions on numbers with shadows.
    pub decisions: u64,
    /// Decisions that exact arithmetic would have taken otherwise.
    pub turned: u64,
    /// Errors by source line, in the order of the programs.
    pub lines: Vec<ShadowLine>,
    /// Errors by function.
    pub functions: Vec<ShadowFunction>,
}

/// A source line and its part of the final errors.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct DiedLine {
    /// `file:line` outside of macros, or the word where there are no sources.
    pub place: String,
    /// `file:line` within the macro that is called there; `None` where none is.
    pub macro_place: Option<String>,
    /// The function around it.
    pub function: Option<String>,
    /// Text of the line.
    pub source: String,
    /// True for a line of the main processor's program.
    pub is_main: bool,
    /// Share of the final errors, in [0, 1].
    pub share: f64,
    /// Largest part of one number's error, in units in the last place of that number.
    pub largest_ulps: f64,
    /// Numbers at the end to whose error the line belongs.
    pub outputs: u64,
    /// Decisions anywhere that were turned by an error of which the line's part is the largest.
    pub turned_by: u64,
}

/// A number at the end.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ShadowOutput {
    /// Register with its component, address in global memory, or pixel with its component.
    pub name: String,
    /// Number with which the machine ended.
    pub raw: i64,
    /// The exact number in the same units, as a double.
    pub exact: f64,
    /// Real value of the machine's number, where its format is known.
    pub real: Option<f64>,
    /// Real value of the exact number, where its format is known.
    pub exact_real: Option<f64>,
    /// Difference in units in the last place, the machine's number less the exact one.
    pub error_ulps: f64,
    /// Significant bits of the machine's number that are right.
    pub good_bits: f64,
    /// Largest parts of the difference, the largest first.
    pub parts: Vec<OutputPart>,
}

/// Part of a number's error.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct OutputPart {
    /// `file:line` that brought it in.
    pub place: String,
    /// The function around it.
    pub function: Option<String>,
    /// Part of the difference in units in the last place, with its sign.
    pub ulps: f64,
}

/// Errors of a source line.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ShadowLine {
    /// `file:line` outside of macros, or the word where there are no sources.
    pub place: String,
    /// `file:line` within the macro that is called there; `None` where none is.
    pub macro_place: Option<String>,
    /// The function around it.
    pub function: Option<String>,
    /// Text of the line.
    pub source: String,
    /// True for a line of the main processor's program.
    pub is_main: bool,
    /// Results with shadows; a vector has three.
    pub results: u64,
    /// Largest error that the line brought in, in units in the last place of the register.
    pub brought_ulps: f64,
    /// Largest error that the line brought in, as a real number, where formats are known.
    pub brought: f64,
    /// Largest error that arrived at the line, as its result has it, in units in the last place.
    pub arrived_ulps: f64,
    /// Largest error that arrived at the line, as a real number, where formats are known.
    pub arrived: f64,
    /// Results that did not fit: they are off by a unit or more.
    pub saturated: u64,
    /// Decisions on numbers with shadows.
    pub decisions: u64,
    /// Decisions that exact arithmetic would have taken otherwise.
    pub turned: u64,
    /// Decisions anywhere that were turned by an error of which the line's part is the largest.
    pub turned_by: u64,
    /// Results of which cancellation left fewer than 20 good bits.
    pub cancelled: u64,
    /// Fewest good bits of those.
    pub fewest_good_bits: Option<f64>,
    /// Results whose shadow has fewer than 20 good bits itself: cancellation took them from the exact arithmetic.
    pub doubtful: u64,
    /// A shift that contradicts the formats that the program declares.
    pub format_gap: Option<FormatGapResult>,
}

/// Fraction bits of a result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct FormatGapResult {
    /// By the formats of the operands and the instruction's shift.
    pub computed: i32,
    /// By the directive `.holds` that says what the register holds.
    pub declared: i32,
}

/// Errors of a function, its lines together.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ShadowFunction {
    /// Name of the function; `None` for what is in none.
    pub function: Option<String>,
    /// True for a function of the main processor's program.
    pub is_main: bool,
    /// Share of the final errors, in [0, 1].
    pub share: f64,
    /// Largest error that one of its lines brought in, in units in the last place.
    pub brought_ulps: f64,
    /// Largest error that one of its lines with known formats brought in, as a real number.
    pub brought: f64,
    /// Largest error that arrived at one of its lines, in units in the last place.
    pub arrived_ulps: f64,
    /// Largest error that arrived at one of its lines with known formats, as a real number.
    pub arrived: f64,
    /// Results that did not fit.
    pub saturated: u64,
    /// Decisions that exact arithmetic would have taken otherwise.
    pub turned: u64,
}
