//! Shares of injections with their intervals.

use schemars::JsonSchema;
use serde::Serialize;

/// Standard deviations on either side of the mean that hold 95 % of a normal distribution.
const DEVIATIONS: f64 = 1.959_963_984_540_054;

/// A share, with the interval in which it lies with a confidence of 95 % (Wilson, 1927).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct ShareInterval {
    /// The share, in [0, 1]; 0 of nothing.
    pub share: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
}

impl ShareInterval {
    /// Share of `part` in `whole`.
    ///
    /// 0 of 10 is 0 with an upper end of 0.278: such a series says little.
    pub fn of(part: u64, whole: u64) -> ShareInterval {
        if whole == 0 {
            return ShareInterval { share: 0.0, low: 0.0, high: 1.0 };
        }
        let (n, share) = (whole as f64, part as f64 / whole as f64);
        let square = DEVIATIONS * DEVIATIONS;
        let middle = (share + square / (2.0 * n)) / (1.0 + square / n);
        let half = DEVIATIONS / (1.0 + square / n) * (share * (1.0 - share) / n + square / (4.0 * n * n)).sqrt();
        // The ends of nothing and of all are exact, whatever rounding does.
        let low = if part == 0 { 0.0 } else { middle - half };
        let high = if part == whole { 1.0 } else { middle + half };
        ShareInterval { share, low, high }
    }

    /// Share of `part` in `whole`, where it may be anything from `fewest` to `most`.
    pub fn between(fewest: u64, part: u64, most: u64, whole: u64) -> ShareInterval {
        let (low, high) = (ShareInterval::of(fewest, whole).low, ShareInterval::of(most, whole).high);
        ShareInterval { low, high, ..ShareInterval::of(part, whole) }
    }
}

/// Counts of injections of a group.
#[derive(Clone, Copy, Default)]
pub(super) struct GroupCount {
    /// All of them.
    pub injections: u64,
    /// Harmful ones.
    pub harmful: u64,
    /// Harmful ones that leave no picture within 1/255.
    pub beyond: u64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_those_of_the_book() {
        // Newcombe (1998), table I, method 3: 81/263, 15/148, 0/20, 29/29.
        for (part, whole, low, high) in
            [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0.0, 0.1611), (29, 29, 0.8830, 1.0)]
        {
            let found = ShareInterval::of(part, whole);
            assert!((found.low - low).abs() < 5e-5 && (found.high - high).abs() < 5e-5, "{part}/{whole}: {found:?}");
        }
        let widest = ShareInterval::of(5_000, 10_000);
        assert!(widest.high - widest.share < 0.01, "10,000 injections are within 1 %");
        assert_eq!(ShareInterval::of(0, 0), ShareInterval { share: 0.0, low: 0.0, high: 1.0 });
    }
}
