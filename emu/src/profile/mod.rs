//! Profiles of functions and regions: observers that are told of each instruction, and the totals that come of it.

mod cells;
mod clocks;
mod contexts;
mod crowd;
mod extremes;
mod log;
mod passes;
mod profiler;
mod regions;
mod sites;

use isa::Counts;

pub use clocks::{CallPath, ClockProfile, PlaceUse, ProgramClocks, RegionClocks, WorkClocks};
pub(crate) use contexts::CROWDED;
#[cfg(feature = "native")]
pub(crate) use contexts::CallStack;
#[cfg(feature = "native")]
pub(crate) use extremes::{CallMeter, Near};
pub use log::{ClockKeys, ClockLog, LogPart, TransferMeter};
#[cfg(feature = "native")]
pub(crate) use passes::ContextPasses;
pub use profiler::Profiler;
#[cfg(feature = "native")]
pub(crate) use regions::{FunctionChange, RegionNesting};
pub use sites::{SiteAsked, SiteTable, TransferSite};

use crate::code::octets::Buffer;
use crate::code::registers::Registers;
use crate::code::tally::Tally;
use crate::code::{Code, Slot};
use crate::semantics::Motion;

/// Level of detail that is asked of a profile.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum ProfileLevel {
    /// No profile.
    #[default]
    None,
    /// Exclusive and inclusive totals, and calls.
    Totals,
    /// Totals and calls, and clocks of computing and waiting by calling context: this takes some time.
    Clocks,
    /// Exclusive and inclusive totals, and least and most of one call, for which each call is measured by itself: this takes time.
    Extremes,
}

/// Units of a pass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct UnitCount {
    /// Number of them.
    pub units: u32,
    /// Clocks that they take.
    pub clocks: u64,
}

/// Someone who is told of each executed instruction.
pub trait Observer {
    /// Engines have to tell.
    const IS_ACTIVE: bool;

    /// The interpreter shows it the values before and after each instruction.
    const SEES_VALUES: bool = false;

    /// For a program.
    fn new(code: &Code, level: ProfileLevel) -> Self;

    /// A run begins at a word.
    fn begin(&mut self, pc: u32);

    /// The instruction in the slot at `pc` is about to be tried: on these registers and this buffer.
    fn before(&mut self, _pc: u32, _slot: &Slot, _registers: &Registers, _buffer: &Buffer) {}

    /// The instruction in the slot at `pc` has been executed, and these are the registers behind it.
    fn after(&mut self, _pc: u32, _code: &Code, _registers: &Registers) {}

    /// The slot at `pc` ended by pass `exit` (numbered over the whole program) with `units` units, and control goes to
    /// `next`.
    fn step(&mut self, pc: u32, exit: usize, units: UnitCount, next: u32, motion: Motion);

    /// The run is over.
    fn end(&mut self);

    /// The profiler, for engines that count by themselves; `None` where there is none.
    fn profiler(&mut self) -> Option<&mut Profiler> {
        None
    }

    /// Profile that it found, given the passes of the same runs.
    fn into_profile(self, code: &Code, tally: &Tally) -> Option<Profile>;
}

/// Observer that looks at nothing and finds no profile.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unobserved;

impl Observer for Unobserved {
    const IS_ACTIVE: bool = false;

    fn new(_: &Code, _: ProfileLevel) -> Unobserved {
        Unobserved
    }

    fn begin(&mut self, _: u32) {}

    fn step(&mut self, _: u32, _: usize, _: UnitCount, _: u32, _: Motion) {}

    fn end(&mut self) {}

    fn into_profile(self, _: &Code, _: &Tally) -> Option<Profile> {
        None
    }
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
    /// Operations between entering and leaving it, all that was called included, and what it has jumped to in other functions; of nested calls
    /// of itself only the outermost counts.
    pub inclusive: Counts,
    /// Least and most of one call; `None` where there was none, or nobody asked.
    pub extremes: Option<Extremes>,
}

/// Least and most that one call takes, nested calls of itself being calls too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extremes {
    /// Least of each class.
    pub least: Counts,
    /// Most of each class.
    pub most: Counts,
    /// Least elementary operations.
    pub least_elementary: u64,
    /// Most elementary operations.
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
    /// Clocks by call path and word, where they were asked for.
    pub clocks: Option<ClockProfile>,
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
            extremes: None,
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
            region.calls += more.calls;
            region.extremes = match (region.extremes, more.extremes) {
                (Some(mut extremes), Some(more)) => {
                    extremes.widen(&more);
                    Some(extremes)
                }
                (extremes, more) => extremes.or(more),
            };
        }
        match (&mut self.clocks, &other.clocks) {
            (Some(clocks), Some(more)) => clocks.merge(more),
            (clocks, more) => *clocks = clocks.take().or_else(|| more.clone()),
        }
        self.outside += other.outside;
        self.outside_instructions += other.outside_instructions;
    }

    /// Operations of the whole run.
    pub fn total(&self) -> Counts {
        self.regions.iter().fold(self.outside, |total, region| total + region.exclusive)
    }
}

impl Extremes {
    /// Extremes of one call, which has this cost.
    pub(crate) fn of(cost: Counts) -> Extremes {
        let elementary = cost.elementary();
        Extremes { least: cost, most: cost, least_elementary: elementary, most_elementary: elementary }
    }

    /// Widens the extremes by those of other calls.
    pub(crate) fn widen(&mut self, other: &Extremes) {
        self.least.0.iter_mut().zip(other.least.0).for_each(|(least, other)| *least = other.min(*least));
        self.most.0.iter_mut().zip(other.most.0).for_each(|(most, other)| *most = other.max(*most));
        self.least_elementary = self.least_elementary.min(other.least_elementary);
        self.most_elementary = self.most_elementary.max(other.most_elementary);
    }
}
