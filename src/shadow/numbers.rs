//! A number beside its shadow, for people.

use emu::shadow::ShadowNumber;
use emu::stepper::Stepper;
use isa::naming::RegisterId;

use super::totals::{SourcePrograms, error_of, good_bits};
use crate::registers::RegisterContents;

/// Lines that are named of an error.
const NAMED: usize = 3;

/// A number of a register or of memory with its shadow.
#[derive(Clone, Copy)]
pub struct ShadowedNumber<'a> {
    /// The machine's number.
    pub raw: i64,
    /// Fraction bits of its format, where they are known.
    pub scale: Option<i32>,
    /// The shadow; `None` of an integer.
    pub shadow: Option<&'a ShadowNumber>,
}

/// The exact number, how far the machine's is from it, and which lines brought that in: `exact 0.6, error -0.40 ulp, 31 good bits (unit.s:9 -0.40)`.
pub fn number_text(number: ShadowedNumber, programs: &SourcePrograms) -> String {
    let Some(shadow) = number.shadow else { return "an integer, which has no shadow".into() };
    let scale = number.scale.or(shadow.scale);
    let real = |value: f64| match scale {
        Some(scale) => real_text(value * f64::from(-scale).exp2()),
        None => format!("{} raw", real_text(value)),
    };
    let Some(deviation) = &shadow.deviation else { return format!("exact {}", real(number.raw as f64)) };
    let (error, bits) = (error_of(number.raw, deviation), deviation.real.good_bits());
    let mut parts: Vec<(u32, f64)> = deviation.parts.iter().collect();
    parts.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    let named = parts.iter().take(NAMED).map(|&(site, amount)| format!("{} {}", programs.place(site), ulps(amount)));
    let mut text = format!(
        "exact {}, error {} ulp, {:.0} good bits ({})",
        real(deviation.real.to_f64()),
        ulps(error),
        good_bits(&deviation.real, error),
        named.collect::<Vec<_>>().join(", "),
    );
    if bits < emu::shadow::ledger::FEW_GOOD_BITS {
        text += &format!("; cancellation left the exact number itself {bits:.0} good bits");
    }
    text
}

/// A real number with all its digits; a very small or large one with a power of ten.
pub(super) fn real_text(value: f64) -> String {
    match value.abs() {
        magnitude if magnitude == 0.0 || (1e-9..1e15).contains(&magnitude) => value.to_string(),
        _ => format!("{value:e}"),
    }
}

/// Units in the last place: two digits behind the point of small numbers, powers of ten of large and very small ones.
pub(super) fn ulps(number: f64) -> String {
    match number.abs() {
        0.0 => "0".into(),
        magnitude if (0.005..1e5).contains(&magnitude) => format!("{number:.2}"),
        _ => format!("{number:.1e}"),
    }
}

/// Errors of a register's components, the machine's number less the exact one, in units of its last place; NaN where a component is an integer,
/// which has no shadow, or is not there. `None` of a core without shadows.
pub fn register_errors(stepper: &Stepper, register: RegisterId) -> Option<[f64; 3]> {
    let shadows = stepper.shadow()?.of(register);
    let numbers = RegisterContents::of(&stepper.state().registers, register).numbers();
    let mut errors = [f64::NAN; 3];
    for ((error, raw), shadow) in errors.iter_mut().zip(numbers).zip(shadows) {
        if let Some(shadow) = shadow {
            *error = shadow.deviation.as_ref().map_or(0.0, |deviation| error_of(raw, deviation));
        }
    }
    Some(errors)
}
