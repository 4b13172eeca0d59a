//! Axes in numbers: their ends, where a number stands, and round ticks with their names.

use super::AxisKind;
use crate::numeral::grouped;

/// An axis with its ends.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisScale {
    kind: AxisKind,
    low: f64,
    high: f64,
}

/// Round numbers of a decade.
const ROUND: [f64; 3] = [1.0, 2.0, 5.0];

/// A round number that is at least as large as `least`: 1, 2 or 5 times a power of ten.
fn round_up(least: f64) -> f64 {
    let power = 10f64.powf(least.log10().floor());
    ROUND
        .iter()
        .chain(&[10.0])
        .map(|round| round * power)
        .find(|&step| step >= least * (1.0 - 1e-9))
        .unwrap_or(power * 10.0)
}

/// The largest round number that is at most `most`.
fn round_down(most: f64) -> f64 {
    let power = 10f64.powf(most.log10().floor());
    ROUND.iter().rev().map(|round| round * power).find(|&step| step <= most * (1.0 + 1e-9)).unwrap_or(power)
}

impl AxisScale {
    /// The axis for numbers, with at most `ticks` ticks where they are equally far apart; its ends are round.
    pub fn new(kind: &AxisKind, numbers: impl Iterator<Item = f64> + Clone, ticks: usize) -> AxisScale {
        let finite = numbers.filter(|number| number.is_finite());
        let (least, most) =
            (finite.clone().fold(f64::INFINITY, f64::min), finite.clone().fold(f64::NEG_INFINITY, f64::max));
        let (least, most) = if least <= most { (least, most) } else { (0.0, 1.0) };
        let (low, high) = match kind {
            AxisKind::Names(names) => (-0.5, names.len().max(1) as f64 - 0.5),
            AxisKind::Logarithmic => {
                let positive = finite.filter(|&number| number > 0.0).fold(f64::INFINITY, f64::min);
                let (least, most) = if positive.is_finite() { (positive, most) } else { (1.0, 10.0) };
                let (low, high) = (round_down(least), round_up(most));
                if low < high { (low, high) } else { (low / 2.0, high * 2.0) }
            }
            AxisKind::FromZero | AxisKind::Linear => {
                let least = if *kind == AxisKind::FromZero { least.min(0.0) } else { least };
                let most = if most > least { most } else { least + 1.0 };
                let step = round_up((most - least) / ticks.max(1) as f64);
                ((least / step).floor() * step, (most / step).ceil() * step)
            }
        };
        AxisScale { kind: kind.clone(), low, high }
    }

    /// Place of a number, 0 at the lower end and 1 at the upper one.
    pub fn place(&self, number: f64) -> f64 {
        let part = match self.kind {
            AxisKind::Logarithmic => {
                (number.max(f64::MIN_POSITIVE).log10() - self.low.log10()) / (self.high.log10() - self.low.log10())
            }
            _ => (number - self.low) / (self.high - self.low),
        };
        if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 }
    }

    /// At most about `most` ticks with their names, the smallest first.
    pub fn ticks(&self, most: usize) -> Vec<(f64, String)> {
        match &self.kind {
            AxisKind::Names(names) => (0..).zip(names).map(|(at, name)| (f64::from(at), name.clone())).collect(),
            AxisKind::Logarithmic => {
                let decades = (self.high / self.low).log10();
                let rounds: &[f64] = if decades * 3.0 <= most as f64 { &ROUND } else { &ROUND[..1] };
                let powers = self.low.log10().floor() as i32..=self.high.log10().ceil() as i32;
                let all = powers.flat_map(|power| rounds.iter().map(move |round| round * 10f64.powi(power)));
                let inside = all.filter(|&tick| tick >= self.low * (1.0 - 1e-9) && tick <= self.high * (1.0 + 1e-9));
                inside.map(|tick| (tick, name(tick, tick))).collect()
            }
            AxisKind::FromZero | AxisKind::Linear => {
                let step = round_up((self.high - self.low) / most.max(1) as f64);
                let (first, last) = ((self.low / step - 1e-9).ceil() as i64, (self.high / step + 1e-9).floor() as i64);
                (first..=last).map(|k| (k as f64 * step, name(k as f64 * step, step))).collect()
            }
        }
    }
}

/// A tick's name, with the decimals that a step takes.
fn name(tick: f64, step: f64) -> String {
    if step < 1e-6 || tick.abs() >= 1e15 {
        return format!("{tick:e}");
    }
    let decimals = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
    match (decimals, tick >= 0.0) {
        (0, true) => grouped(tick.round() as u64),
        (0, false) => format!("-{}", grouped(-tick.round() as u64)),
        _ => format!("{tick:.decimals$}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(kind: &AxisKind, numbers: &[f64], most: usize) -> Vec<String> {
        let scale = AxisScale::new(kind, numbers.iter().copied(), most);
        scale.ticks(most).into_iter().map(|(_, name)| name).collect()
    }

    #[test]
    fn ticks_are_round_and_hold_all_numbers() {
        assert_eq!(names(&AxisKind::FromZero, &[3.0, 17.0], 5), ["0", "5", "10", "15", "20"]);
        assert_eq!(names(&AxisKind::Linear, &[30.1, 30.9], 5), ["30.0", "30.2", "30.4", "30.6", "30.8", "31.0"]);
        assert_eq!(names(&AxisKind::Linear, &[-3.0, 3.0], 4), ["-4", "-2", "0", "2", "4"]);
        assert_eq!(names(&AxisKind::Logarithmic, &[300.0, 4000.0], 8), ["200", "500", "1,000", "2,000", "5,000"]);
        assert_eq!(
            names(&AxisKind::Logarithmic, &[1.0, 1e6], 8),
            ["1", "10", "100", "1,000", "10,000", "100,000", "1,000,000"]
        );
        assert_eq!(names(&AxisKind::Linear, &[], 5).len(), 6);
    }

    #[test]
    fn places_lie_between_the_ends() {
        let scale = AxisScale::new(&AxisKind::Logarithmic, [10.0, 1000.0].into_iter(), 5);
        assert_eq!([10.0, 100.0, 1000.0, 0.0, f64::NAN].map(|number| scale.place(number)), [0.0, 0.5, 1.0, 0.0, 0.0]);
    }
}
