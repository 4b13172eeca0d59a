//! Bits of a format that may be left unprotected, and how sure that is.

use std::collections::BTreeMap;

use emu::inject::FaultKind;
use schemars::JsonSchema;
use serde::Serialize;

use super::row::{InjectionClass, InjectionRow};
use super::statistics::{GroupCount, ShareInterval};

/// Injections that a bit needs before it may count as one without harm.
const LEAST_HITS: u64 = 30;

/// Bits of a format that may be left unprotected.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct UnprotectedBits {
    /// Name of the structure.
    pub kind: String,
    /// Format of a number, or field of memory.
    pub format: String,
    /// Lowest bits, counted from bit 0, each of them hit 30 times at least, of which no flip left anything but a picture within 1/255.
    pub bits: u32,
    /// Injections into those bits.
    pub injections: u64,
    /// Upper end of the share of them that leaves no picture within 1/255 after all, with a confidence of 95 %.
    pub high: f64,
    /// Upper end of the share of the bit among them that was hit least, by itself.
    pub weakest_high: f64,
}

/// Bits of each format that may be left unprotected by flips of so many bits: as many of the lowest ones as were hit without harm, each of them
/// [`LEAST_HITS`] times.
///
/// Of a format whose bits 0 to 9 were hit 100 times each without harm, bit 10 never, and bit 11 100 times without harm, the lowest ten are named: of a
/// bit that was not hit nothing is known. The highest of two bits that flip together is bit 1 at least.
pub(super) fn unprotected(kinds: &[FaultKind], flipped: u32, rows: &[InjectionRow]) -> Vec<UnprotectedBits> {
    let mut formats: BTreeMap<(usize, &str), BTreeMap<u32, GroupCount>> = BTreeMap::new();
    for row in rows {
        // A part of an instruction is no number, and a protected flip says nothing of the bit.
        let is_told = !matches!(row.class, InjectionClass::Corrected | InjectionClass::Detected);
        let Some(kind) = kinds.iter().position(|kind| kind.name() == row.kind).filter(|_| is_told) else { continue };
        let (Some(format), Some(highest)) = (&row.format, row.highest_bit()) else { continue };
        let bit = formats.entry((kind, format)).or_default().entry(highest).or_default();
        bit.injections += 1;
        bit.beyond += u64::from(!row.is_within_step());
    }
    let mut found = Vec::new();
    for ((kind, format), bits) in formats {
        let first = flipped.max(1) - 1;
        let is_safe = |bit: &&GroupCount| bit.beyond == 0 && bit.injections >= LEAST_HITS;
        let safe: Vec<u64> =
            (first..).map_while(|bit| bits.get(&bit).filter(is_safe)).map(|bit| bit.injections).collect();
        let Some(&fewest) = safe.iter().min() else { continue };
        let injections = safe.iter().sum();
        found.push(UnprotectedBits {
            kind: kinds[kind].name().to_owned(),
            format: format.to_owned(),
            bits: first + safe.len() as u32,
            injections,
            high: ShareInterval::of(0, injections).high,
            weakest_high: ShareInterval::of(0, fewest).high,
        });
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inject::result::tests::row;

    #[test]
    fn lowest_bits_without_harm_are_named() {
        use InjectionClass::{Masked, Trap, WrongPixel};
        let hits = |bit: u32, count: u64, class: InjectionClass, difference: f64| {
            (0..count).map(move |number| row(number, class, bit, difference))
        };
        let named = |flipped: u32, rows: &[InjectionRow]| {
            let found = unprotected(&[FaultKind::Registers], flipped, rows);
            found.first().map(|one| (one.bits, one.injections, one.format.clone()))
        };
        let mut rows: Vec<InjectionRow> = hits(0, 40, Masked, 0.0).collect();
        rows.extend(hits(1, 30, WrongPixel, 0.001));
        rows.extend(hits(2, 100, Masked, 0.0));
        assert_eq!(named(1, &rows), Some((3, 170, "pos".to_owned())));
        let found = &unprotected(&[FaultKind::Registers], 1, &rows)[0];
        assert!(found.high < 0.03 && found.weakest_high > 0.1, "{found:?}");
        // Nothing is known of a bit that was not hit, and little of one that was hit seldom.
        rows.extend(hits(4, 100, Masked, 0.0));
        rows.extend(hits(3, 29, Masked, 0.0));
        assert_eq!(named(1, &rows), Some((3, 170, "pos".to_owned())));
        rows.extend(hits(3, 1, Masked, 0.0));
        assert_eq!(named(1, &rows), Some((5, 300, "pos".to_owned())));
        // The higher one of two bits is not bit 0.
        assert_eq!(named(2, &rows[40..]), Some((5, 260, "pos".to_owned())));
        assert_eq!(named(1, &rows[40..]), None);
        rows.extend(hits(2, 1, Trap, 0.0));
        assert_eq!(named(1, &rows), Some((2, 70, "pos".to_owned())));
    }
}
