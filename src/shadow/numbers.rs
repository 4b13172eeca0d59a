//! A number beside its shadow, for people.

use emu::shadow::{Shadow, ShadowNumber};
use emu::stepper::Stepper;
use isa::naming::RegisterId;

use super::totals::{ShadowedNumber, SourcePrograms, error_of, good_bits};
use crate::registers::{self, RegisterContents};

/// Lines that are named of an error.
const NAMED: usize = 3;

/// Names of the components of a vector.
const COMPONENTS: [&str; 3] = ["x", "y", "z"];

/// Numbers of a register beside their shadows, by the names of its components: `s2`, or `v1.x`, `v1.y` and `v1.z`. The fraction bits are those of
/// the format that it is declared to hold, else those of the shadow.
pub fn register_numbers<'a>(
    stepper: &Stepper,
    shadow: &'a Shadow,
    register: RegisterId,
) -> Vec<(String, ShadowedNumber<'a>)> {
    let declared = stepper.code.program.format_of(register, stepper.code.word(stepper.state().pc));
    let numbers = RegisterContents::of(&stepper.state().registers, register).numbers();
    let component = |k: usize| if numbers.len() == 1 { String::new() } else { format!(".{}", COMPONENTS[k]) };
    let number = |(k, (&raw, shadow)): (usize, (&i64, Option<&'a ShadowNumber>))| {
        let scale = declared.map(|(_, bits)| bits).or(shadow.and_then(|shadow| shadow.scale));
        (registers::name(register) + &component(k), ShadowedNumber { raw, scale, shadow })
    };
    numbers.iter().zip(shadow.of(register)).enumerate().map(number).collect()
}

/// The exact number, how far the machine's is from it, and which lines brought that in: `exact 0.6, error -0.40 ulp, 31 good bits (unit.s:9 -0.40)`.
pub fn number_text(number: ShadowedNumber, programs: &SourcePrograms) -> String {
    // A register that is declared to hold a number, and that no instruction has written, is exact.
    let scale = number.scale.or(number.shadow.and_then(|shadow| shadow.scale));
    if number.shadow.is_none() && scale.is_none() {
        return "an integer, which has no shadow".into();
    }
    let real = |value: f64| match scale {
        Some(scale) => real_text(value * f64::from(-scale).exp2()),
        None => format!("{} raw", real_text(value)),
    };
    let Some(deviation) = number.shadow.and_then(|shadow| shadow.deviation.as_ref()) else {
        return format!("exact {}", real(number.raw as f64));
    };
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
pub fn ulps(number: f64) -> String {
    match number.abs() {
        0.0 => "0".into(),
        magnitude if (0.005..1e5).contains(&magnitude) => format!("{number:.2}"),
        _ => format!("{number:.1e}"),
    }
}

/// Errors of a register's components, the machine's number less the exact one, in units of its last place; NaN where a component is an integer,
/// which has no shadow, or is not there. `None` of a core without shadows.
pub fn register_errors(stepper: &Stepper, register: RegisterId) -> Option<[f64; 3]> {
    let error = |number: ShadowedNumber| match number.shadow {
        Some(shadow) => shadow.deviation.as_ref().map_or(0.0, |deviation| error_of(number.raw, deviation)),
        None if number.scale.is_some() => 0.0,
        None => f64::NAN,
    };
    let mut errors = [f64::NAN; 3];
    for (place, (_, number)) in errors.iter_mut().zip(register_numbers(stepper, stepper.shadow()?, register)) {
        *place = error(number);
    }
    Some(errors)
}
