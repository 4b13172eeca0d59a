//! Profiles from calling contexts: totals and clocks of functions and regions, added up once a run is over.

use isa::Counts;

use super::{CROWDED, Contexts, has_bit};
use crate::code::Code;
use crate::code::quantity::Clocks;
use crate::profile::Profile;
use crate::profile::clocks::{ClockProfile, WorkClocks};

impl Contexts {
    /// Puts calls and inclusive totals into a profile.
    pub fn fold(&self, code: &Code, profile: &mut Profile) {
        for (region, (found, &calls)) in (0..).zip(profile.regions.iter_mut().zip(&self.entered)) {
            found.calls = calls;
            found.inclusive = self.crowded.get(region).map_or(Counts::ZERO, |crowded| crowded.0);
        }
        for context in &self.contexts {
            let mut of_callers = Counts::ZERO;
            for (exit, passes) in context.passes.iter().enumerate().filter(|(_, passes)| passes.count != 0) {
                let (cost, each) = self.costs[exit];
                let counts = cost.times(passes.count) + each.times(passes.units);
                of_callers += counts;
                let own = if context.path.is_deep { &[][..] } else { self.regions.around(code.passes()[exit].word) };
                for &region in own.iter().filter(|&&region| !has_bit(&context.open, region)) {
                    profile.regions[usize::from(region)].inclusive += counts;
                }
            }
            for region in (0..self.regions.count() as u16).filter(|&region| has_bit(&context.open, region)) {
                profile.regions[usize::from(region)].inclusive += of_callers;
            }
        }
    }

    /// Clocks of computing of each word in each context, where they are measured.
    pub fn fold_clocks(&self, code: &Code) -> Option<ClockProfile> {
        self.cells.as_ref()?;
        let mut profile = ClockProfile::new(code);
        let crowded = std::iter::once((&self.contexts[CROWDED as usize].path, &self.crowded_passes));
        let others = self.contexts.iter().map(|context| (&context.path, &context.passes));
        for (path, passes) in others.chain(crowded) {
            for (exit, passes) in passes.iter().enumerate() {
                let busy = passes.count * u64::from(self.clocks[exit]) + passes.unit_clocks;
                profile.add_busy(path, code.passes()[exit].word, busy);
            }
        }
        profile.add_crowded(&self.crowded_work());
        Some(profile)
    }

    /// By region: inclusive work in crowded contexts, as far as it was computing.
    pub fn crowded_work(&self) -> Vec<WorkClocks> {
        let work = |&(_, clocks): &(Counts, u64)| WorkClocks { busy: Clocks(clocks), ..WorkClocks::default() };
        self.crowded.iter().map(work).collect()
    }
}
