//! Conditions of breakpoints: comparisons of registers, of their components, of the step and the program counter with each other and with numbers,
//! joined by `&&`.

use std::cmp::Ordering;
use std::str::FromStr;

use asm::real;
use emu::stepper::Stepper;
use isa::Program;

use crate::arguments::numbered;
use crate::registers::{RegisterContents, format_of, is_real, register_of};

/// ComparedSide of a comparison as it was typed.
#[derive(Clone, Debug, PartialEq, Eq)]
enum ComparedSide {
    /// A raw number.
    Raw(i64),
    /// A real number and the format that was typed with it.
    Real(String, Option<String>),
    /// `step`.
    Step,
    /// `pc`.
    Pc,
    /// A register or a name of one, and its component.
    Register(String, usize),
}

/// One comparison: the orders for which it holds.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Compared {
    left: ComparedSide,
    right: ComparedSide,
    holds: [Ordering; 2],
    is_negated: bool,
}

/// Comparisons that have to hold together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StopCondition {
    text: String,
    all: Vec<Compared>,
}

const MARKS: [(&str, [Ordering; 2], bool); 6] = [
    ("==", [Ordering::Equal; 2], false),
    ("!=", [Ordering::Equal; 2], true),
    ("<=", [Ordering::Less, Ordering::Equal], false),
    (">=", [Ordering::Greater, Ordering::Equal], false),
    ("<", [Ordering::Less; 2], false),
    (">", [Ordering::Greater; 2], false),
];

impl FromStr for StopCondition {
    type Err = String;

    fn from_str(text: &str) -> Result<StopCondition, String> {
        let comparison = |part: &str| -> Result<Compared, String> {
            let found =
                MARKS.iter().filter_map(|(mark, holds, is_negated)| Some((part.find(mark)?, mark, holds, is_negated)));
            // The first mark in the text, and of those at one place the longest.
            let first = found.min_by_key(|(at, mark, _, _)| (*at, std::cmp::Reverse(mark.len())));
            let (at, mark, holds, is_negated) =
                first.ok_or_else(|| format!("`{}` compares nothing; write such as s1 == 5", part.trim()))?;
            let (left, right) = (side(&part[..at])?, side(&part[at + mark.len()..])?);
            Ok(Compared { left, right, holds: *holds, is_negated: *is_negated })
        };
        Ok(StopCondition {
            text: text.trim().to_owned(),
            all: text.split("&&").map(comparison).collect::<Result<_, _>>()?,
        })
    }
}

fn side(text: &str) -> Result<ComparedSide, String> {
    let text = text.trim();
    if text.is_empty() {
        return Err("one side of the comparison is missing".into());
    }
    // Read a number: 0.5, 1e-3 and 1:pos are real, 1 is raw
    if text.starts_with(|c: char| c.is_ascii_digit() || "+-".contains(c)) {
        let (number, format) = match text.split_once(':') {
            Some((number, format)) => (number, Some(format.to_owned())),
            None => (text, None),
        };
        return if format.is_some() || is_real(number) {
            Ok(ComparedSide::Real(number.into(), format))
        } else {
            numbered(text).map(ComparedSide::Raw)
        };
    }
    match text {
        "step" => return Ok(ComparedSide::Step),
        "pc" => return Ok(ComparedSide::Pc),
        _ => {}
    }
    // Read a register; one without a component is a scalar, or the first of a vector
    let (name, component) = match text.rsplit_once('.') {
        Some((name, "x")) => (name, 0),
        Some((name, "y")) => (name, 1),
        Some((name, "z")) => (name, 2),
        Some((_, other)) => return Err(format!("`{other}` is no component: x, y or z")),
        None => (text, 0),
    };
    Ok(ComparedSide::Register(name.into(), component))
}

impl StopCondition {
    /// The condition as it was typed.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Checks that all names and formats are the program's.
    ///
    /// # Errors
    /// One that is not.
    pub fn check(&self, program: &Program) -> Result<(), String> {
        for comparison in &self.all {
            for side in [&comparison.left, &comparison.right] {
                match side {
                    ComparedSide::Register(name, component) => {
                        let (file, _) = register_of(program, name, program.entry)?;
                        if file != 'v' && *component != 0 {
                            return Err(format!("`{name}` has no components"));
                        }
                    }
                    ComparedSide::Real(number, Some(format)) => {
                        real::parse(number, format_of(program, format)?.1)?;
                    }
                    ComparedSide::Real(number, None) => {
                        real::parse(number, 0)?;
                    }
                    _ => {}
                }
            }
        }
        Ok(())
    }

    /// The condition holds for a state.
    pub fn holds(&self, stepper: &Stepper) -> bool {
        self.all.iter().all(|comparison| {
            let (left, right) = (&comparison.left, &comparison.right);
            let order = match (value(left, right, stepper), value(right, left, stepper)) {
                (Some(a), Some(b)) => a.cmp(&b),
                _ => return false,
            };
            comparison.holds.contains(&order) != comparison.is_negated
        })
    }
}

/// Value of a side as a raw number; a real one takes the format of the register on the other side where it has none of its own.
fn value(side: &ComparedSide, other: &ComparedSide, stepper: &Stepper) -> Option<i64> {
    let (state, program) = (stepper.state(), stepper.code.program);
    let pc = stepper.code.word(state.pc);
    match side {
        ComparedSide::Raw(value) => Some(*value),
        ComparedSide::Step => i64::try_from(stepper.steps()).ok(),
        ComparedSide::Pc => Some(pc.into()),
        ComparedSide::Real(number, Some(format)) => real::parse(number, format_of(program, format).ok()?.1).ok(),
        ComparedSide::Real(number, None) => match other {
            ComparedSide::Register(name, _) => {
                let (_, bits) = program.format_of(register_of(program, name, pc).ok()?, pc)?;
                real::parse(number, bits).ok()
            }
            _ => None,
        },
        ComparedSide::Register(name, component) => {
            let register = register_of(program, name, pc).ok()?;
            RegisterContents::of(&state.registers, register).numbers().get(*component).copied()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions_compare_two_sides() {
        for text in ["s1 == 5", "near_t<1.5:t && s2 != 0", "v1.y >= -1", "step > 1,000", "pc == 0x10", "w0 < s1"] {
            assert!(text.parse::<StopCondition>().is_ok(), "{text}");
        }
        let small: StopCondition = "s1 > 1e-3".parse().expect("an exponent makes it real");
        assert_eq!(small.all[0].right, ComparedSide::Real("1e-3".into(), None));
        for (text, message) in [
            ("s1", "compares nothing"),
            ("s1 ==", "is missing"),
            ("v1.w == 1", "no component"),
            ("s1 == 5 && ", "compares nothing"),
            ("s1 == 0xg", ""),
        ] {
            assert!(text.parse::<StopCondition>().unwrap_err().contains(message), "{text}");
        }
    }
}
