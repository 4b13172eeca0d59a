//! Operators with two operands: C's marks and levels, checked arithmetic on 64 bits.

use crate::explain;

/// An operator with two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Binary {
    Or,
    ExclusiveOr,
    And,
    Equal,
    Different,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Left,
    Right,
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
}

impl Binary {
    /// Every operator, in the order of the manual.
    pub const ALL: [Binary; 16] = {
        use Binary::*;
        [
            Or,
            ExclusiveOr,
            And,
            Equal,
            Different,
            Less,
            LessOrEqual,
            Greater,
            GreaterOrEqual,
            Left,
            Right,
            Add,
            Subtract,
            Multiply,
            Divide,
            Remainder,
        ]
    };

    /// The operator as it is written.
    pub fn mark(self) -> &'static str {
        const MARKS: [&str; 16] =
            ["|", "^", "&", "==", "!=", "<", "<=", ">", ">=", "<<", ">>", "+", "-", "*", "/", "%"];
        MARKS[self as usize]
    }

    /// The operator that is written so.
    pub fn from_mark(mark: &str) -> Option<Binary> {
        Binary::ALL.into_iter().find(|operator| operator.mark() == mark)
    }

    /// Precedence: `||` has level 1, `&&` 2, and so on upwards.
    pub fn level(self) -> u8 {
        match self {
            Binary::Or => 3,
            Binary::ExclusiveOr => 4,
            Binary::And => 5,
            Binary::Equal | Binary::Different => 6,
            Binary::Less | Binary::LessOrEqual | Binary::Greater | Binary::GreaterOrEqual => 7,
            Binary::Left | Binary::Right => 8,
            Binary::Add | Binary::Subtract => 9,
            Binary::Multiply | Binary::Divide | Binary::Remainder => 10,
        }
    }

    /// The operator's value; division is towards zero.
    pub fn apply(self, a: i64, b: i64) -> Checked {
        let shift =
            || u32::try_from(b).ok().filter(|&count| count < 64).ok_or((explain::SHIFT, "shifts go from 0 to 63"));
        let divided = |result: Option<i64>| {
            if b == 0 { Err((explain::DIVISION, "division by zero")) } else { result.ok_or(OVERFLOW) }
        };
        match self {
            Binary::Or => Ok(a | b),
            Binary::ExclusiveOr => Ok(a ^ b),
            Binary::And => Ok(a & b),
            Binary::Equal => Ok((a == b).into()),
            Binary::Different => Ok((a != b).into()),
            Binary::Less => Ok((a < b).into()),
            Binary::LessOrEqual => Ok((a <= b).into()),
            Binary::Greater => Ok((a > b).into()),
            Binary::GreaterOrEqual => Ok((a >= b).into()),
            Binary::Left => shift().and_then(|count| {
                let shifted = a << count;
                if shifted >> count == a { Ok(shifted) } else { Err(OVERFLOW) }
            }),
            Binary::Right => shift().map(|count| a >> count),
            Binary::Add => a.checked_add(b).ok_or(OVERFLOW),
            Binary::Subtract => a.checked_sub(b).ok_or(OVERFLOW),
            Binary::Multiply => a.checked_mul(b).ok_or(OVERFLOW),
            Binary::Divide => divided(a.checked_div(b)),
            Binary::Remainder => divided(a.checked_rem(b)),
        }
    }
}

/// Result of a checked operation; the error is its code and the sentence about it.
pub(crate) type Checked = Result<i64, (&'static str, &'static str)>;

/// The error for a value that does not fit.
pub(crate) const OVERFLOW: (&str, &str) = (explain::OVERFLOW, "the result does not fit 64 bits");
