//! The observer that finds the profile of a program: passes by calling context, and where it is asked for, each call by itself.

use super::contexts::Contexts;
use super::extremes::CallMeter;
use super::{Observer, Profile, ProfileLevel, UnitCount};
use crate::code::Code;
use crate::code::tally::Tally;
use crate::semantics::Motion;

/// An observer that measures calls.
#[derive(Clone, Debug)]
pub struct Profiler {
    /// Passes by calling context.
    pub contexts: Contexts,
    /// Meter of each call, where extremes are asked for.
    pub meter: Option<Box<CallMeter>>,
}

impl Observer for Profiler {
    const IS_ACTIVE: bool = true;

    fn new(code: &Code, level: ProfileLevel) -> Profiler {
        let meter = (level == ProfileLevel::Extremes).then(|| Box::new(CallMeter::new(code)));
        Profiler { contexts: Contexts::new(code, level), meter }
    }

    fn begin(&mut self, pc: u32) {
        self.contexts.begin(pc);
        if let Some(meter) = &mut self.meter {
            meter.begin(pc);
        }
    }

    #[inline]
    fn step(&mut self, pc: u32, exit: usize, units: UnitCount, next: u32, motion: Motion) {
        self.contexts.pass(pc, exit, units);
        self.contexts.go(pc, next, motion);
        if let Some(meter) = &mut self.meter {
            meter.pass(exit, units.units);
            meter.go(pc, next, motion);
        }
    }

    fn end(&mut self) {
        self.contexts.end();
        if let Some(meter) = &mut self.meter {
            meter.end();
        }
    }

    fn profiler(&mut self) -> Option<&mut Profiler> {
        Some(self)
    }

    fn into_profile(mut self, code: &Code, tally: &Tally) -> Option<Profile> {
        self.end();
        let mut profile = Profile::exclusive(code, tally);
        self.contexts.fold(code, &mut profile);
        profile.clocks = self.contexts.fold_clocks(code);
        if let Some(meter) = &self.meter {
            for (region, extremes) in profile.regions.iter_mut().zip(meter.found()) {
                region.extremes = *extremes;
            }
        }
        Some(profile)
    }
}
