//! Clocks, transfers and octets of a program by call path and word, and of its functions and regions. Computing follows from what was executed
//! in each calling context; waits are those of the transfers that an instruction asked for.

use std::collections::BTreeMap;
use std::ops::AddAssign;

use super::regions::RegionNesting;
use crate::code::Code;
use crate::code::quantity::{Clocks, Octets};

/// Regions that are open around a call, the outermost first; one that is entered again inside itself stands there once.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CallPath {
    /// Numbers of the regions.
    pub regions: Box<[u16]>,
    /// The call is too deep, or one of too many: what it executes counts for none of its own regions but their exclusive parts.
    pub is_deep: bool,
}

/// Work of a part of a program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WorkClocks {
    /// Clocks of computing.
    pub busy: Clocks,
    /// Clocks from requests to the ends of their transfers.
    pub waiting: Clocks,
    /// Transfers and messages asked for.
    pub transfers: u64,
    /// Octets of those.
    pub octets: Octets,
}

impl AddAssign for WorkClocks {
    fn add_assign(&mut self, more: WorkClocks) {
        self.busy += more.busy;
        self.waiting += more.waiting;
        self.transfers += more.transfers;
        self.octets += more.octets;
    }
}

/// Work of a place, with its waits by kind of data.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PlaceUse {
    /// All of it.
    pub work: WorkClocks,
    /// Clocks of waiting by kind of data, as far as there were any.
    pub waiting_kinds: Vec<u64>,
}

impl PlaceUse {
    /// Adds other work.
    pub fn add(&mut self, more: &PlaceUse) {
        self.work += more.work;
        if self.waiting_kinds.len() < more.waiting_kinds.len() {
            self.waiting_kinds.resize(more.waiting_kinds.len(), 0);
        }
        self.waiting_kinds.iter_mut().zip(&more.waiting_kinds).for_each(|(sum, more)| *sum += more);
    }
}

/// Work of a function or region.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RegionClocks {
    /// Work of its own instructions.
    pub exclusive: WorkClocks,
    /// Work between entering and leaving it, all that was called included, and what it has jumped to in other functions; of nested calls of itself only
    /// the outermost counts.
    pub inclusive: WorkClocks,
}

/// Work of all functions and regions of a program.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ProgramClocks {
    /// In the order of the program's regions.
    pub regions: Vec<RegionClocks>,
    /// Work in no region. With the exclusive work of all regions it adds up to all of the program's.
    pub outside: WorkClocks,
}

impl ProgramClocks {
    /// None yet.
    pub(super) fn new(regions: usize) -> ProgramClocks {
        ProgramClocks { regions: vec![RegionClocks::default(); regions], outside: WorkClocks::default() }
    }

    /// Adds work that was done on a call path in the innermost of some regions.
    pub(super) fn add(&mut self, path: &CallPath, around: &[u16], work: WorkClocks) {
        match around.last() {
            Some(&own) => self.regions[usize::from(own)].exclusive += work,
            None => self.outside += work,
        }
        let own = if path.is_deep { &[][..] } else { around };
        let own = own.iter().filter(|region| !path.regions.contains(region));
        for &region in path.regions.iter().chain(own) {
            self.regions[usize::from(region)].inclusive += work;
        }
    }

    /// Adds inclusive work by region.
    pub(super) fn add_crowded(&mut self, crowded: &[WorkClocks]) {
        for (region, &work) in self.regions.iter_mut().zip(crowded) {
            region.inclusive += work;
        }
    }

    /// All work.
    pub fn total(&self) -> WorkClocks {
        self.regions.iter().fold(self.outside, |mut total, region| {
            total += region.exclusive;
            total
        })
    }
}

/// Work of a program by call path and word.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClockProfile {
    nesting: RegionNesting,
    /// In the order of paths, then of words.
    pub places: BTreeMap<(CallPath, u32), PlaceUse>,
    /// By region: inclusive work of calls that are too many to be told apart.
    crowded: Vec<WorkClocks>,
}

impl ClockProfile {
    /// No work of a program.
    pub(super) fn new(code: &Code) -> ClockProfile {
        ClockProfile { nesting: RegionNesting::new(code), places: BTreeMap::new(), crowded: Vec::new() }
    }

    /// Adds clocks of computing.
    pub(super) fn add_busy(&mut self, path: &CallPath, word: u32, busy: u64) {
        if busy != 0 {
            self.place(path, word).work.busy += Clocks(busy);
        }
    }

    /// Adds inclusive work of calls that are too many to be told apart.
    pub(super) fn add_crowded(&mut self, crowded: &[WorkClocks]) {
        if self.crowded.len() < crowded.len() {
            self.crowded.resize(crowded.len(), WorkClocks::default());
        }
        self.crowded.iter_mut().zip(crowded).for_each(|(sum, &more)| *sum += more);
    }

    fn place(&mut self, path: &CallPath, word: u32) -> &mut PlaceUse {
        self.places.entry((path.clone(), word)).or_default()
    }

    /// Adds transfers of a site, and waits for them.
    pub(super) fn add_site(&mut self, path: &CallPath, word: u32, kind: u32, found: WorkClocks) {
        let place = self.place(path, word);
        place.work += found;
        if found.waiting != Clocks(0) {
            let kind = kind as usize;
            if place.waiting_kinds.len() <= kind {
                place.waiting_kinds.resize(kind + 1, 0);
            }
            place.waiting_kinds[kind] += found.waiting.0;
        }
    }

    /// Adds the profile of other runs of the same program.
    pub(super) fn merge(&mut self, other: &ClockProfile) {
        for ((path, word), more) in &other.places {
            self.place(path, *word).add(more);
        }
        self.add_crowded(&other.crowded);
    }

    /// Work of the functions and regions.
    pub fn regions(&self) -> ProgramClocks {
        let mut found = ProgramClocks::new(self.nesting.count());
        for ((path, word), place) in &self.places {
            found.add(path, self.nesting.around(*word), place.work);
        }
        found.add_crowded(&self.crowded);
        found
    }

    /// Own work of each region, and of what lies in none.
    pub fn innermost(&self) -> BTreeMap<Option<u16>, PlaceUse> {
        let mut found: BTreeMap<Option<u16>, PlaceUse> = BTreeMap::new();
        for ((_, word), place) in &self.places {
            found.entry(self.nesting.innermost(*word)).or_default().add(place);
        }
        found
    }

    /// Work of each word.
    pub fn words(&self) -> BTreeMap<u32, PlaceUse> {
        let mut words: BTreeMap<u32, PlaceUse> = BTreeMap::new();
        self.places.iter().for_each(|((_, word), place)| words.entry(*word).or_default().add(place));
        words
    }

    /// Work by stack of regions, the outermost first; that of instructions in no region has an empty one.
    pub fn stacks(&self) -> BTreeMap<Vec<u16>, PlaceUse> {
        let mut stacks: BTreeMap<Vec<u16>, PlaceUse> = BTreeMap::new();
        for ((path, word), place) in &self.places {
            let stack = path.regions.iter().chain(self.nesting.around(*word)).copied().collect();
            stacks.entry(stack).or_default().add(place);
        }
        stacks
    }
}
