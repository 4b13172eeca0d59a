//! Walks down the tree by all ways: what the row of a driver whose way is one of many takes on the others.

use isa::{Class, Counts, Isa};

use super::Measurement;
use crate::failure::Failure;

/// Least, mean and most of a row over all ways down its tree.
#[derive(Clone, Debug, PartialEq)]
pub struct PathRange {
    /// Least of each class.
    pub least: Counts,
    /// Mean of each class, in the order of [`Class::ALL`], each way being as likely as another.
    pub mean: Vec<f64>,
    /// Most of each class.
    pub most: Counts,
}

impl PathRange {
    /// Mean of a class.
    pub fn mean_of(&self, class: Class) -> f64 {
        self.mean[class as usize]
    }
}

/// Runs the driver with each number of levels at which its walk goes to the right; `None` for a row without other ways.
///
/// Of 16 levels there are 2^16 ways, and what one takes depends on the number of its steps to the right only: there are as many ways with r of them
/// as r can be chosen of 16, so 1 goes left everywhere, 16 go right once, 120 twice.
///
/// # Errors
/// A program that traps; ours do not.
pub fn range(measured: &Measurement, isa: &Isa) -> Result<Option<PathRange>, Failure> {
    let Measurement { row, program, memory, .. } = measured;
    let Some(spread) = &row.spread else { return Ok(None) };
    let mut range: Option<PathRange> = None;
    let (mut ways, all) = (1.0, f64::from(spread.most).exp2());
    for rights in 0..=spread.most {
        let regions = super::run(&row.to_the_right(program, rights), memory.clone(), isa)?.regions;
        let counts = super::region(row, &regions, &row.region)?.extremes.map_or(Counts::ZERO, |extremes| extremes.most);
        let range =
            range.get_or_insert_with(|| PathRange { least: counts, mean: vec![0.0; Class::ALL.len()], most: counts });
        for (at, count) in counts.0.into_iter().enumerate() {
            range.least.0[at] = range.least.0[at].min(count);
            range.most.0[at] = range.most.0[at].max(count);
            range.mean[at] += count as f64 * ways / all;
        }
        ways = ways * f64::from(spread.most - rights) / f64::from(rights + 1);
    }
    Ok(range)
}
