//! The machine's result beside the exact one: what the instruction brought in, what arrived, and the new shadow.

use std::sync::Arc;

use super::ledger::{FEW_GOOD_BITS, FormatGap, SettledResult};
use super::long_real::{LongReal, power};
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

/// A settled result.
pub struct Settled {
    /// The shadow of the number.
    pub number: ShadowNumber,
    /// Entry of the ledger.
    pub entry: SettledResult,
    /// Another site whose shift contradicts the declared format: a sum of products has none of its own.
    pub elsewhere: Option<(u32, FormatGap, f64)>,
}

/// The shadow of a number that was moved: it keeps the format that it has, or takes that of the register.
pub fn moved(mut number: ShadowNumber, declared: Option<i32>) -> ShadowNumber {
    number.scale = number.scale.or(declared);
    if number.scale == declared {
        number.fitted = None;
    }
    number
}

/// A number whose shift gave it other fraction bits than are declared where it is read: it is the real number in the declared format, and the line
/// of that shift has brought the difference in. Yields that line's site and the difference in raw units.
pub fn corrected(number: &mut ShadowNumber, raw: i64, declared: i32) -> Option<(u32, FormatGap, f64)> {
    let (computed, site) = (number.scale?, number.fitted?);
    let (machine, by) = (LongReal::whole(raw.into()), declared - computed);
    let brought = machine.minus(&machine.scaled(by)).to_f64();
    let (real, parts) = match &number.deviation {
        Some(deviation) => (deviation.real.scaled(by), deviation.parts.times(power(by))),
        None => (machine.scaled(by), ErrorParts::NONE),
    };
    *number = ShadowNumber { scale: Some(declared), ..ShadowNumber::default() };
    // Zero is the same number in every format.
    if real.is_zero() && machine.is_zero() {
        return None;
    }
    number.deviation = Some(Arc::new(Deviation { real, parts: parts.with(site, brought) }));
    Some((site, FormatGap { computed, declared }, brought))
}

/// Bits of a number that an error leaves.
fn good_bits(real: &LongReal, error: f64) -> f64 {
    if real.is_zero() { 0.0 } else { (f64::from(real.exponent()) - error.abs().log2()).max(0.0) }
}

/// Settles a computed result. Where its shift has to bring it into a format (`is_fitted`) and the declared one is another, the real number is the
/// one in the declared format, and the line has brought the difference in: a shift that is one too large halves the number that everybody else
/// takes the register for.
pub fn settle(term: ShadowTerm, is_fitted: bool, place: ResultPlace) -> Settled {
    let raw = LongReal::whole(place.raw.into());
    let rounded = raw.minus(&term.machine).to_f64();
    let is_saturated = rounded.abs() >= 1.0;
    // Zero is the same number in every format.
    let is_number = !term.machine.is_zero() || !term.real().is_zero();
    let gap = match (term.scale, place.declared) {
        (Some(computed), Some(declared)) if is_number && computed != declared => {
            (is_fitted || term.fitted.is_some()).then_some(FormatGap { computed, declared })
        }
        _ => None,
    };
    let shift_site = if is_fitted { Some(place.site) } else { term.fitted };
    let scale = place.declared.or(term.scale);
    // Bring the exact numbers into the declared format: by 3 bits more, a number is 8 times as many units.
    let term = match gap {
        Some(FormatGap { computed, declared }) => term.scaled(declared - computed),
        None => term,
    };
    let total = if gap.is_some() { raw.minus(&term.machine).to_f64() } else { rounded };
    // Of a sum, rounding is the line's own, and the format is that of the products.
    let (brought, inherited) = if is_fitted { (total, 0.0) } else { (rounded, total - rounded) };
    let largest = term.largest;
    let real = *term.real();
    let error = raw.minus(&real);
    let arrived = match &term.deviation {
        None => 0.0,
        Some(_) if total == 0.0 => error.to_f64(),
        Some(_) => term.machine.minus(&real).to_f64(),
    };
    // What is left of terms that were at least four times as large has lost two bits or more.
    let is_cancelled = largest.is_some_and(|largest| real.is_zero() || largest >= real.exponent() + 2);
    let bits = if is_cancelled && arrived != 0.0 { good_bits(&real, error.to_f64()) } else { f64::INFINITY };
    let entry = SettledResult {
        brought,
        arrived,
        scale,
        is_saturated,
        cancelled: (bits < FEW_GOOD_BITS).then_some(bits),
        is_doubtful: !real.is_exact() && real.good_bits() < FEW_GOOD_BITS,
        gap: gap.filter(|_| is_fitted),
    };
    let elsewhere = match (gap, shift_site) {
        (Some(gap), Some(site)) if !is_fitted => Some((site, gap, inherited)),
        _ => None,
    };
    // A format that is declared is no longer in doubt.
    let fitted = if place.declared.is_some() || scale.is_none() { None } else { shift_site };
    // A shadow beyond all ranges says nothing any more and begins anew at the machine's number, as one does that has come back to it.
    if error.is_zero() && real.is_exact() || !real.is_in_range() {
        return Settled { number: ShadowNumber { deviation: None, scale, fitted }, entry, elsewhere };
    }
    let deviation = match term.deviation {
        Some(deviation) if total == 0.0 => deviation,
        deviation => {
            let mut deviation = deviation.unwrap_or_else(|| Arc::new(Deviation { real, parts: ErrorParts::NONE }));
            // What a formula has computed belongs to nobody else yet.
            let own = Arc::make_mut(&mut deviation);
            own.parts = own.parts.with(place.site, brought);
            if let Some((site, _, inherited)) = elsewhere {
                own.parts = own.parts.with(site, inherited);
            }
            deviation
        }
    };
    Settled { number: ShadowNumber { deviation: Some(deviation), scale, fitted }, entry, elsewhere }
}
