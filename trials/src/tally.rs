//! Outcome of a number of trials.

use std::ops::Range;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Trials, those that went wrong, the largest error, and an example.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TrialTally {
    /// Number of trials.
    pub trials: u64,
    /// Trials that went wrong.
    pub failures: u64,
    /// The largest error of the others, in the case's unit.
    pub worst: f64,
    /// The first trial that went wrong, and how.
    pub example: Option<(u64, String)>,
}

impl TrialTally {
    /// Both together.
    pub fn plus(self, other: TrialTally) -> TrialTally {
        let example = match (self.example, other.example) {
            (Some(one), Some(other)) => Some(if one.0 <= other.0 { one } else { other }),
            (one, other) => one.or(other),
        };
        TrialTally {
            trials: self.trials + other.trials,
            failures: self.failures + other.failures,
            worst: self.worst.max(other.worst),
            example,
        }
    }
}

/// Makes trials on all host threads. A trial gives its error, or says what is wrong; it depends on nothing but its number, so the result is
/// the same on every host.
pub fn tally(trials: Range<u64>, trial: impl Fn(u64) -> Result<f64, String> + Sync) -> TrialTally {
    trials.into_par_iter().map(|number| one(number, &trial)).reduce(TrialTally::default, TrialTally::plus)
}

/// Trials one after the other, for those that use all host threads themselves and wait for them.
pub fn tally_in_turn(trials: Range<u64>, trial: impl Fn(u64) -> Result<f64, String>) -> TrialTally {
    trials.map(|number| one(number, &trial)).fold(TrialTally::default(), TrialTally::plus)
}

fn one(number: u64, trial: impl Fn(u64) -> Result<f64, String>) -> TrialTally {
    match trial(number) {
        Ok(worst) => TrialTally { trials: 1, failures: 0, worst, example: None },
        Err(text) => TrialTally { trials: 1, failures: 1, worst: 0.0, example: Some((number, text)) },
    }
}
