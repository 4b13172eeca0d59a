//! The machine's result beside the exact one: what the instruction brought in, what arrived, and the new shadow.

use std::sync::Arc;

use super::ledger::{FEW_GOOD_BITS, FormatGap, SettledResult};
use super::long_real::LongReal;
use super::number::{Deviation, ShadowNumber, ShadowTerm};
use super::parts::ErrorParts;

/// Place of a result.
#[derive(Clone, Copy, Debug)]
pub struct ResultPlace {
    /// Site of the instruction.
    pub site: u32,
    /// The machine's number.
    pub raw: i64,
    /// Fraction bits that the program declares for the register behind the instruction.
    pub declared: Option<i32>,
}

/// The shadow of a number that was moved: it keeps the format that it has, or takes that of the register.
pub fn moved(mut number: ShadowNumber, declared: Option<i32>) -> ShadowNumber {
    number.scale = number.scale.or(declared);
    number
}

/// Bits of a number that an error leaves.
fn good_bits(real: &LongReal, error: f64) -> f64 {
    if real.is_zero() { 0.0 } else { (f64::from(real.exponent()) - error.abs().log2()).max(0.0) }
}

/// Settles a computed result. Where its shift has to bring it into a format (`is_fitted`) and the declared one is another, the real number is the
/// one in the declared format, and the line has brought the difference in: a shift that is one too large halves the number that everybody else
/// takes the register for.
pub fn settle(term: ShadowTerm, is_fitted: bool, place: ResultPlace) -> (ShadowNumber, SettledResult) {
    let raw = LongReal::whole(place.raw.into());
    let rounded = raw.minus(&term.machine).to_f64();
    let is_saturated = rounded.abs() >= 1.0;
    // Zero is the same number in every format.
    let is_number = !term.machine.is_zero() || !term.real().is_zero();
    let gap = match (term.scale, place.declared) {
        (Some(computed), Some(declared)) if is_fitted && is_number && computed != declared => {
            Some(FormatGap { computed, declared })
        }
        _ => None,
    };
    let scale = place.declared.or(term.scale);
    // Bring the exact numbers into the declared format: by 3 bits more, a number is 8 times as many units.
    let term = match gap {
        Some(FormatGap { computed, declared }) => term.scaled(declared - computed),
        None => term,
    };
    let brought = if gap.is_some() { raw.minus(&term.machine).to_f64() } else { rounded };
    let largest = term.largest;
    let real = *term.real();
    let error = raw.minus(&real);
    let arrived = if term.deviation.is_some() { term.machine.minus(&real).to_f64() } else { 0.0 };
    // What is left of terms that were at least four times as large has lost two bits or more.
    let is_cancelled = largest.is_some_and(|largest| real.is_zero() || largest >= real.exponent() + 2);
    let bits = good_bits(&real, error.to_f64());
    let result = SettledResult {
        brought,
        arrived,
        scale,
        is_saturated,
        cancelled: (is_cancelled && arrived != 0.0 && bits < FEW_GOOD_BITS).then_some(bits),
        is_doubtful: real.good_bits() < FEW_GOOD_BITS,
        gap,
    };
    // A shadow beyond all ranges says nothing any more and begins anew at the machine's number, as one does that has come back to it.
    if error.is_zero() && real.is_exact() || !real.is_in_range() {
        return (ShadowNumber { deviation: None, scale }, result);
    }
    let deviation = match term.deviation {
        Some(deviation) if brought == 0.0 => deviation,
        deviation => {
            let parts = deviation.map_or(ErrorParts::NONE, |deviation| deviation.parts);
            Arc::new(Deviation { real, parts: parts.with(place.site, brought) })
        }
    };
    (ShadowNumber { deviation: Some(deviation), scale }, result)
}
