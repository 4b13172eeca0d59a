//! Passes through the exits of a program in one calling context.

use super::UnitCount;

/// Passes through an exit in one context.
#[derive(Clone, Copy, Debug, Default)]
pub struct ContextPasses {
    /// Number of passes.
    pub count: u64,
    /// Their units.
    pub units: u64,
    /// Clocks of those.
    pub unit_clocks: u64,
}

impl ContextPasses {
    /// Adds passes that have so many units together.
    #[inline]
    pub fn add(&mut self, count: u64, units: UnitCount) {
        self.count += count;
        self.units += u64::from(units.units);
        self.unit_clocks += units.clocks;
    }

    /// Adds passes that were counted elsewhere.
    pub fn merge(&mut self, more: ContextPasses) {
        self.count += more.count;
        self.units += more.units;
        self.unit_clocks += more.unit_clocks;
    }
}
