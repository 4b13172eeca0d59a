//! Waits as a histogram whose columns double in width.

use serde::Serialize;

use crate::code::quantity::Clocks;

/// Number of waits by length: column 0 holds those of 0 clocks, column n those of 2^(n-1) to 2^n - 1, the last one all
/// that are longer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct Waits(pub [u64; Waits::COLUMNS]);

impl Default for Waits {
    fn default() -> Waits {
        Waits([0; Waits::COLUMNS])
    }
}

impl Waits {
    /// Number of columns.
    pub const COLUMNS: usize = 24;

    /// Notes a wait.
    pub fn add(&mut self, wait: Clocks) {
        let column = (u64::BITS - wait.0.leading_zeros()) as usize;
        self.0[column.min(Waits::COLUMNS - 1)] += 1;
    }

    /// Notes grants without a wait.
    pub fn add_none(&mut self, count: u64) {
        self.0[0] += count;
    }

    /// Adds waits that were noted apart.
    pub fn merge(&mut self, more: &Waits) {
        self.0.iter_mut().zip(more.0).for_each(|(column, more)| *column += more);
    }

    /// Number of waits.
    pub fn total(&self) -> u64 {
        self.0.iter().sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_double() {
        let mut waits = Waits::default();
        for wait in [0, 1, 2, 3, 4, 7, 8, u64::MAX] {
            waits.add(Clocks(wait));
        }
        assert_eq!((&waits.0[..6], waits.0[Waits::COLUMNS - 1]), (&[1, 1, 2, 2, 1, 0][..], 1));
        assert_eq!(waits.total(), 8);
    }
}
