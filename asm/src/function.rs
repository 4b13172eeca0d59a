//! The functions of expressions, as data for readers and manuals, and their arithmetic.

use crate::explain;
use crate::operator::{Checked, OVERFLOW};

/// A function of one or two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ExpressionFunction {
    Min,
    Max,
    Abs,
    Bits,
    Low,
    High,
}

/// The arguments of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Parameters {
    /// So many numbers.
    Numbers(ExpressionFunction, usize),
    /// A structure or a field.
    Size,
    /// A field.
    Field,
    /// Any name.
    Defined,
}

/// A function.
#[derive(Clone, Copy, Debug)]
pub struct Described {
    /// The function's name, which nothing else may have.
    pub name: &'static str,
    /// The call as it is written.
    pub usage: &'static str,
    /// The function's value, in a sentence.
    pub doc: &'static str,
    pub(crate) argument: Parameters,
}

macro_rules! functions {
    ($($name:literal $usage:literal $argument:expr, $doc:literal;)*) => {
        /// Every function, in the order of the manual.
        pub const FUNCTIONS: &[Described] =
            &[$(Described { name: $name, usage: $usage, doc: $doc, argument: $argument }),*];
    };
}

functions! {
    "sizeof" "sizeof(structure)" Parameters::Size, "Octets of a structure, or of a field and all its elements.";
    "offsetof" "offsetof(structure.field)" Parameters::Field, "Octets before a field: the same as `structure.field`.";
    "defined" "defined(name)" Parameters::Defined, "1 when the name is defined above, else 0.";
    "min" "min(a, b)" Parameters::Numbers(ExpressionFunction::Min, 2), "The smaller number.";
    "max" "max(a, b)" Parameters::Numbers(ExpressionFunction::Max, 2), "The larger number.";
    "abs" "abs(a)" Parameters::Numbers(ExpressionFunction::Abs, 1), "The absolute value.";
    "bits" "bits(a)" Parameters::Numbers(ExpressionFunction::Bits, 1), "The number of bits that `a` needs, which is not negative; 0 for 0.";
    "low" "low(a)" Parameters::Numbers(ExpressionFunction::Low, 1), "The low 16 bits of a number of 32 bits, with their sign: what `movi` takes.";
    "high" "high(a)" Parameters::Numbers(ExpressionFunction::High, 1), "The high 16 bits of a number of 32 bits, without sign: what `movhi` takes.";
}

/// The text is a function's name.
pub(crate) fn is_function(text: &str) -> bool {
    FUNCTIONS.iter().any(|function| function.name == text)
}

impl ExpressionFunction {
    /// The function's value; `b` is 0 where it takes one number.
    pub fn apply(self, a: i64, b: i64) -> Checked {
        let word = |half: i64| {
            let fits = (-(1 << 31)..1 << 32).contains(&a);
            if fits { Ok(half) } else { Err((explain::RANGE, "the number does not fit 32 bits")) }
        };
        match self {
            ExpressionFunction::Min => Ok(a.min(b)),
            ExpressionFunction::Max => Ok(a.max(b)),
            ExpressionFunction::Abs => a.checked_abs().ok_or(OVERFLOW),
            ExpressionFunction::Bits if a < 0 => Err((explain::RANGE, "`bits` takes a number that is not negative")),
            ExpressionFunction::Bits => Ok(i64::from(64 - a.leading_zeros())),
            ExpressionFunction::Low => word(i64::from(a as i16)),
            ExpressionFunction::High => word(a >> 16 & 0xffff),
        }
    }
}
