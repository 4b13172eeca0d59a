//! Profiles of functions and regions: observers that are told of each instruction, and the totals that come of it.

mod calls;
mod profiler;

use std::ops::Range;

use isa::Counts;

pub use calls::Near;
pub use profiler::Profiler;

use crate::code::Code;
use crate::code::tally::Tally;
use crate::semantics::Motion;

/// Someone who is told of each executed instruction.
pub trait Observer {
    /// Engines have to tell.
    const IS_ACTIVE: bool;

    /// For a program.
    fn new(code: &Code) -> Self;

    /// A run begins at a word.
    fn begin(&mut self, pc: u32);

    /// The slot at `pc` ended by pass `exit` (numbered over the whole program) with `units` units, and control goes to
    /// `next`.
    fn step(&mut self, pc: u32, exit: usize, units: u32, next: u32, motion: Motion);

    /// The run is over.
    fn end(&mut self);

    /// Profile that it found, given the passes of the same runs.
    fn into_profile(self, code: &Code, tally: &Tally) -> Option<Profile>;
}

/// An observer for engines that count several words at once, too: they call these instead of [`Observer::step`].
pub trait RunObserver: Observer {
    /// Notice that the slots at some places of the order ended, one behind the other. Passes of those with several exits, and units, are told
    /// by [`RunObserver::pass`].
    fn walked(&mut self, places: Range<u32>);

    /// A pass through an exit: of a word with several, or with units of one that `is_only`.
    fn pass(&mut self, exit: usize, is_only: bool, units: u32);

    /// True where what stands behind a place belongs elsewhere, so that [`RunObserver::go`] is to be told when control runs on.
    fn is_border(&self, place: u32) -> bool;

    /// Control goes from one slot to another; what ended before was told.
    fn go(&mut self, pc: u32, next: u32, motion: Motion);

    /// So many operations were executed: instead of [`RunObserver::walked`] and [`RunObserver::pass`], for engines that add them up themselves.
    fn add(&mut self, counts: &Counts);

    /// Adds operations of which there are few: each class below 2^31.
    fn add_near(&mut self, counts: &Near);

    /// So many of the operations that were told of last were not executed.
    fn take_back(&mut self, counts: &Counts);
}

/// Nobody.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unobserved;

impl Observer for Unobserved {
    const IS_ACTIVE: bool = false;

    fn new(_: &Code) -> Unobserved {
        Unobserved
    }

    fn begin(&mut self, _: u32) {}

    fn step(&mut self, _: u32, _: usize, _: u32, _: u32, _: Motion) {}

    fn end(&mut self) {}

    fn into_profile(self, _: &Code, _: &Tally) -> Option<Profile> {
        None
    }
}

impl RunObserver for Unobserved {
    fn walked(&mut self, _: Range<u32>) {}

    fn pass(&mut self, _: usize, _: bool, _: u32) {}

    fn is_border(&self, _: u32) -> bool {
        false
    }

    fn go(&mut self, _: u32, _: u32, _: Motion) {}

    fn add(&mut self, _: &Counts) {}

    fn add_near(&mut self, _: &Near) {}

    fn take_back(&mut self, _: &Counts) {}
}

/// Cost of one function or region.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RegionProfile {
    /// Name of the region.
    pub name: String,
    /// True for a function, entered by calls; false for a region, entered by running into it.
    pub is_function: bool,
    /// The region around it, an index into [`Profile::regions`].
    pub parent: Option<u16>,
    /// Number of times that it was entered.
    pub calls: u64,
    /// Instructions in it, inner regions and called functions left out.
    pub instructions: u64,
    /// Their operations.
    pub exclusive: Counts,
    /// Operations between entering and leaving it, all that was called included; of nested calls of itself only the
    /// outermost counts.
    pub inclusive: Counts,
    /// Least of each class in one call, nested calls of itself being calls too; zero when there was none.
    pub least: Counts,
    /// Most of each class in one call.
    pub most: Counts,
    /// Least elementary operations in one call.
    pub least_elementary: u64,
    /// Most elementary operations in one call.
    pub most_elementary: u64,
}

/// Costs of the functions and regions of a program in a run.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Profile {
    /// In the order of the program's regions.
    pub regions: Vec<RegionProfile>,
    /// Operations in no region. With the exclusive counts of all regions they add up to all operations of the run.
    pub outside: Counts,
    /// Instructions in no region.
    pub outside_instructions: u64,
}

impl Profile {
    /// The exclusive part, which the passes alone tell; nothing was entered.
    pub fn exclusive(code: &Code, tally: &Tally) -> Profile {
        let regions = code.program.regions.iter().map(|region| RegionProfile {
            name: region.name.clone(),
            is_function: region.is_function,
            parent: region.parent,
            calls: 0,
            instructions: 0,
            exclusive: Counts::ZERO,
            inclusive: Counts::ZERO,
            least: Counts::ZERO,
            most: Counts::ZERO,
            least_elementary: 0,
            most_elementary: 0,
        });
        let mut profile = Profile { regions: regions.collect(), ..Profile::default() };
        for pc in 0..code.words() {
            let word = tally.word(code, pc);
            let region = code.program.region_of.get(pc as usize).copied().flatten();
            match region.and_then(|region| profile.regions.get_mut(region as usize)) {
                Some(region) => {
                    region.instructions += word.instructions;
                    region.exclusive += word.counts;
                }
                None => {
                    profile.outside_instructions += word.instructions;
                    profile.outside += word.counts;
                }
            }
        }
        profile
    }

    /// Adds the profile of other runs of the same program.
    pub fn merge(&mut self, other: &Profile) {
        for (region, more) in self.regions.iter_mut().zip(&other.regions) {
            region.instructions += more.instructions;
            region.exclusive += more.exclusive;
            region.inclusive += more.inclusive;
            if more.calls != 0 {
                region.note_extremes(more.least, more.most, more.least_elementary, more.most_elementary);
                region.calls += more.calls;
            }
        }
        self.outside += other.outside;
        self.outside_instructions += other.outside_instructions;
    }

    /// Operations of the whole run.
    pub fn total(&self) -> Counts {
        self.regions.iter().fold(self.outside, |total, region| total + region.exclusive)
    }
}

impl RegionProfile {
    /// Widens least and most; before `calls` counts the calls that they come from.
    fn note_extremes(&mut self, least: Counts, most: Counts, least_elementary: u64, most_elementary: u64) {
        if self.calls == 0 {
            (self.least, self.most) = (least, most);
            (self.least_elementary, self.most_elementary) = (least_elementary, most_elementary);
            return;
        }
        for (at, count) in self.least.0.iter_mut().enumerate() {
            *count = least.0[at].min(*count);
        }
        for (at, count) in self.most.0.iter_mut().enumerate() {
            *count = most.0[at].max(*count);
        }
        self.least_elementary = self.least_elementary.min(least_elementary);
        self.most_elementary = self.most_elementary.max(most_elementary);
    }

    /// One call is over.
    fn note_call(&mut self, cost: Counts, is_outermost: bool) {
        let elementary = cost.elementary();
        self.note_extremes(cost, cost, elementary, elementary);
        self.calls += 1;
        if is_outermost {
            self.inclusive += cost;
        }
    }
}
