//! Variants that are worth their cost: those that no other one beats in cost and error both, on each scene and on all scenes together.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Serialize;

use super::{CostAxis, ErrorAxis, MeasuredVariant};

/// Scenes that a front goes over.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum OverScenes {
    /// Each scene has a front of its own.
    #[default]
    Each,
    /// One front of the means of all scenes.
    Mean,
    /// One front of the worst of all scenes.
    Worst,
}

/// Mean and worst of several figures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct MeanAndWorst {
    /// The mean.
    pub mean: f64,
    /// The worst.
    pub worst: f64,
}

impl MeanAndWorst {
    /// Of figures of which more is worse; 0 without any.
    pub fn of(figures: &[f64]) -> MeanAndWorst {
        let mean = figures.iter().sum::<f64>() / figures.len().max(1) as f64;
        MeanAndWorst { mean, worst: figures.iter().copied().reduce(f64::max).unwrap_or(0.0) }
    }
}

/// A variant over all scenes that it fits, where these are all that were asked for.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct OverallVariant {
    /// Number of the variant among all that were asked for.
    #[serde(skip)]
    pub number: usize,
    /// The variant in words.
    pub variant: String,
    /// Cost by the chosen axis.
    pub cost: MeanAndWorst,
    /// Pixels off by 1/255 or more: the mean of the scenes, and the worst picture of any.
    pub off: MeanAndWorst,
    /// Error by the chosen axis; the mean of ratios is that of the mean squares.
    pub error: MeanAndWorst,
    /// A variant that is no worse in mean cost and mean error and better in one of them; null for one on the front of means.
    pub mean_dominated_by: Option<String>,
    /// A variant that is no worse in the worst cost and the worst error and better in one of them; null for one on the front of the worst.
    pub worst_dominated_by: Option<String>,
}

/// For each pair of cost and badness the number of one on the front that beats it: neither is larger, and one is smaller; `None` for those on the front.
pub fn dominated(pairs: &[(f64, f64)]) -> Vec<Option<usize>> {
    let beats = |other: usize, here: usize| {
        let ((other_cost, other_error), (cost, error)) = (pairs[other], pairs[here]);
        other_cost <= cost && other_error <= error && (other_cost < cost || other_error < error)
    };
    let all = 0..pairs.len();
    let is_on_front: Vec<bool> = all.clone().map(|here| !all.clone().any(|other| beats(other, here))).collect();
    // One that beats it and is on the front itself; there always is one, since beating is transitive.
    all.clone().map(|here| all.clone().find(|&other| is_on_front[other] && beats(other, here))).collect()
}

/// Says of each variant whether it is on the front of its scene, and if not, which one beats it. A cost that was not measured is the largest.
pub fn rank(measured: &mut [MeasuredVariant], cost: CostAxis, error: ErrorAxis) {
    for scene in measured.chunk_by_mut(|one, other| one.scene == other.scene) {
        let pair = |one: &MeasuredVariant| (cost.of(one).unwrap_or(f64::INFINITY), error.badness(one));
        let by = dominated(&scene.iter().map(pair).collect::<Vec<_>>());
        let names: Vec<String> = scene.iter().map(|one| one.variant.clone()).collect();
        for (one, by) in scene.iter_mut().zip(by) {
            one.is_on_front = by.is_none();
            one.dominated_by = by.map(|by| names[by].clone());
        }
    }
}

/// The variants that fit all of so many scenes, each with its mean and its worst scene.
pub fn overall(measured: &[MeasuredVariant], scenes: usize, cost: CostAxis, error: ErrorAxis) -> Vec<OverallVariant> {
    let mut by_variant: BTreeMap<usize, Vec<&MeasuredVariant>> = BTreeMap::new();
    for one in measured {
        by_variant.entry(one.number).or_default().push(one);
    }
    by_variant.retain(|_, scene| scene.len() == scenes);
    // Costs and badnesses, of which more is worse.
    let figures: Vec<(MeanAndWorst, MeanAndWorst)> = by_variant
        .values()
        .map(|scenes| {
            let costs: Vec<f64> = scenes.iter().filter_map(|one| cost.of(one)).collect();
            let errors: Vec<f64> = scenes.iter().map(|one| error.badness(one)).collect();
            (MeanAndWorst::of(&costs), MeanAndWorst { mean: error.mean(&errors), ..MeanAndWorst::of(&errors) })
        })
        .collect();
    let by = |part: fn(&MeanAndWorst) -> f64| {
        dominated(&figures.iter().map(|(cost, error)| (part(cost), part(error))).collect::<Vec<_>>())
    };
    let (by_mean, by_worst) = (by(|figure| figure.mean), by(|figure| figure.worst));
    let names: Vec<&str> = by_variant.values().map(|scenes| scenes[0].variant.as_str()).collect();
    let named = |by: Option<usize>| by.map(|by| names[by].to_owned());
    let all = by_variant.iter().zip(&figures).zip(by_mean.into_iter().zip(by_worst));
    all.map(|(((&number, scenes), (cost, badness)), (by_mean, by_worst))| OverallVariant {
        number,
        variant: scenes[0].variant.clone(),
        cost: *cost,
        off: MeanAndWorst {
            mean: MeanAndWorst::of(&scenes.iter().map(|one| one.off.mean).collect::<Vec<_>>()).mean,
            worst: scenes.iter().map(|one| one.off.worst).fold(0.0, f64::max),
        },
        error: MeanAndWorst { mean: error.figure(badness.mean), worst: error.figure(badness.worst) },
        mean_dominated_by: named(by_mean),
        worst_dominated_by: named(by_worst),
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_beaten_names_one_of_the_front() {
        let pairs = [(3.0, 1.0), (1.0, 3.0), (2.0, 3.0), (2.0, 2.0), (2.0, 2.0), (4.0, 2.5), (f64::INFINITY, 0.5)];
        assert_eq!(dominated(&pairs), [None, None, Some(1), None, None, Some(0), None]);
        assert_eq!(dominated(&[]), []);
    }

    #[test]
    fn figures_have_a_mean_and_a_worst() {
        assert_eq!(MeanAndWorst::of(&[1.0, 4.0, 1.0]), MeanAndWorst { mean: 2.0, worst: 4.0 });
        assert_eq!(MeanAndWorst::of(&[-3.0, -5.0]), MeanAndWorst { mean: -4.0, worst: -3.0 });
        // Two ratios of 60 and 40 dB: the mean of 1e-6 and 1e-4 is 5.05e-5, 42.97 dB.
        let mean = ErrorAxis::Psnr.figure(ErrorAxis::Psnr.mean(&[1e-3, 1e-2]));
        assert!((mean - 42.967).abs() < 1e-3, "{mean}");
    }
}
