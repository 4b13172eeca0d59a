//! Cost of runs: four numbers that are added up as one.

use crate::code::OutcomeCost;

/// The numbers of a [`Cost`]: where each begins, and its bits.
const STEPS: (u32, u32) = (0, 15);
const INNER: (u32, u32) = (15, 15);
pub(super) const CLOCKS: (u32, u32) = (30, 17);
const ELEMENTARY: (u32, u32) = (47, 16);
const FIELDS: [(u32, u32); 4] = [STEPS, INNER, CLOCKS, ELEMENTARY];

/// The bits which say that one of the numbers has come to half of what there is room for. No run takes half of that.
pub(super) const HALVES: u64 = half(STEPS) | half(INNER) | half(CLOCKS) | half(ELEMENTARY);

const fn half((start, bits): (u32, u32)) -> u64 {
    1 << (start + bits - 1)
}

/// Instructions, steps of bodies beside them, clocks and elementary operations in one number, so that all are added up at once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost(pub u64);

impl Cost {
    /// Half of the room for steps: what a sum of them may come to before it is looked at.
    pub const WHOLE: u32 = 1 << 14;

    /// The cost of a step through an exit that costs as much; of a number that is too large, what makes the plan be refused.
    pub(super) fn new(cost: &OutcomeCost) -> Cost {
        let fit = |number: u32, (start, bits): (u32, u32)| u64::from(number.min(1 << (bits - 1))) << start;
        Cost::step(cost.is_inner).plus(Cost(fit(cost.clocks, CLOCKS) | fit(cost.elementary, ELEMENTARY)))
    }

    /// An instruction or a step of a body, whatever else it takes.
    pub(super) fn step(is_inner: bool) -> Cost {
        Cost(1 << if is_inner { INNER.0 } else { STEPS.0 })
    }

    pub(super) fn plus(self, more: Cost) -> Cost {
        Cost(self.0 + more.0)
    }

    /// The larger one of each number.
    pub(super) fn max(self, other: Cost) -> Cost {
        Cost(FIELDS.iter().map(|&field| self.part(field).max(other.part(field)) << field.0).sum())
    }

    /// True where none of the numbers has come to a quarter of the room for it: two runs and what their exits add fit on top of a half.
    pub(super) fn is_small(self) -> bool {
        self.0 & (HALVES | HALVES >> 1) == 0
    }

    /// None of the numbers has come to half of the room for it.
    #[cfg(feature = "native")]
    pub(super) fn is_below_half(self) -> bool {
        self.0 & HALVES == 0
    }

    #[inline(always)]
    const fn part(self, (start, bits): (u32, u32)) -> u64 {
        self.0 >> start & ((1 << bits) - 1)
    }

    /// Instructions.
    #[inline(always)]
    pub const fn steps(self) -> u64 {
        self.part(STEPS)
    }

    /// Steps of bodies that go on.
    #[inline(always)]
    pub const fn inner_steps(self) -> u64 {
        self.part(INNER)
    }

    /// Clocks.
    #[inline(always)]
    pub const fn clocks(self) -> u64 {
        self.part(CLOCKS)
    }

    /// Elementary operations.
    #[inline(always)]
    pub const fn elementary(self) -> u64 {
        self.part(ELEMENTARY)
    }
}
