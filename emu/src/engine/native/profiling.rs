//! Facts about the functions and regions of a plan that profiling in generated code needs.

use super::classes::Classes;
use crate::engine::plan::{Plan, Step};
use crate::profile::{FunctionChange, ProfileLevel, RegionNesting};

/// Functions and regions of a plan.
#[derive(Clone, Debug)]
pub(super) struct Profiling {
    regions: RegionNesting,
    /// By place: a slot of the same regions.
    slots: Vec<u32>,
    /// Costs by class, where each call is measured.
    pub classes: Option<Classes>,
    /// Clocks are measured.
    pub has_clocks: bool,
}

impl Profiling {
    /// Functions and regions of a plan; `None` where no profile is asked for.
    pub fn new(plan: &Plan, level: ProfileLevel) -> Option<Profiling> {
        let slots = plan.steps().iter().scan(0, |before, step| {
            // A hop is part of what stands before it.
            *before = if step.row == Step::HOP { *before } else { step.slot };
            Some(*before)
        });
        let classes = (level == ProfileLevel::Extremes).then(|| Classes::new(plan));
        (level != ProfileLevel::None).then(|| Profiling {
            regions: RegionNesting::new(plan.code),
            slots: slots.collect(),
            classes,
            has_clocks: level == ProfileLevel::Clocks,
        })
    }

    /// Number of regions.
    pub fn regions(&self) -> usize {
        self.regions.count()
    }

    /// Number of the callees' context among those of the caller's context: see [`crate::profile::Contexts::known_callee`].
    pub fn caller(&self, place: u32) -> usize {
        self.regions.innermost(self.slots[place as usize]).map_or(0, |region| usize::from(region) + 1)
    }

    /// Slot of a place, of a hop the one of what stands before it.
    pub fn slot(&self, place: u32) -> u32 {
        self.slots[place as usize]
    }

    /// Change of the function where control goes from one place to another one without a call or a return.
    pub fn change(&self, from: u32, to: u32) -> Option<FunctionChange> {
        self.regions.change(self.slot(from), self.slot(to))
    }

    /// Regions around a place.
    pub fn around(&self, place: u32) -> &[u16] {
        self.regions.around(self.slots[place as usize])
    }

    /// Regions that are entered from one place to another one.
    pub fn entered(&self, from: u32, to: u32) -> &[u16] {
        self.regions.entered(self.slots[from as usize], self.slots[to as usize])
    }

    /// Two places belong to different regions, and who measures each call or clocks wants to know when control goes from one to the other.
    pub fn is_border(&self, from: u32, to: u32) -> bool {
        let region = |place: u32| self.regions.innermost(self.slots[place as usize]);
        (self.classes.is_some() || self.has_clocks) && region(from) != region(to)
    }

    /// Something has to be done where control goes from one place to another one.
    pub fn ends_block(&self, from: u32, to: u32) -> bool {
        self.is_border(from, to) || self.change(from, to).is_some()
    }
}
