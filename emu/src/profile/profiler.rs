//! Follows calls, returns and regions while a program runs, with a stack of what is open and snapshots of the running
//! totals.

use std::ops::Range;

use isa::Counts;

use super::calls::{Calls, Entered, Near, Running};
use super::{Observer, Profile, RegionProfile, RunObserver};
use crate::code::Code;
use crate::code::layout::{Order, Stage};
use crate::code::tally::Tally;
use crate::semantics::Motion;

/// Most regions and calls that are open at once; what deeper calls cost counts for what is open already.
const DEEPEST: usize = 1 << 16;

/// Something open, with the totals when it was entered.
#[derive(Clone, Copy, Debug)]
struct Open {
    what: What,
    entered: Entered,
}

/// A call or a region.
#[derive(Clone, Copy, Debug)]
enum What {
    /// A call: the regions above it belong to the callee.
    Call {
        /// Word to which the callee returns.
        back: u32,
        /// Number of the first thing open in the caller.
        base: u32,
    },
    /// A region or function, by its number.
    Region(u16),
}

/// An observer that measures calls.
#[derive(Clone, Debug)]
pub struct Profiler {
    /// Cost of each exit of the program, and what a unit of it adds.
    costs: Vec<(Counts, Counts)>,
    /// Order of the slots.
    order: Order,
    /// Costs of all up to each place of the order together, slots with several exits left out.
    before: Vec<Counts>,
    /// The innermost region of each slot.
    region_of: Vec<Option<u16>>,
    /// Regions from the outermost to a region itself.
    chains: Vec<Vec<u16>>,
    regions: Vec<RegionProfile>,
    /// Number of open calls of each region.
    depth: Vec<u32>,
    open: Vec<Open>,
    /// Number of open calls that return to each word.
    returns_to: Vec<u32>,
    /// Calls deeper than [`DEEPEST`].
    deeper: u64,
    /// Number of the first thing open in the current call.
    base: usize,
    total: Running,
    /// Totals of the calls of each region, without those that took more than 32 bits hold.
    calls: Vec<Calls>,
}

impl Profiler {
    fn chain(&self, pc: u32) -> Option<u16> {
        self.region_of.get(pc as usize).copied().flatten()
    }

    fn close_top(&mut self) {
        let Some(Open { what, entered }) = self.open.pop() else { return };
        match what {
            What::Region(region) => {
                let at = usize::from(region);
                self.depth[at] -= 1;
                let is_outermost = self.depth[at] == 0;
                match self.total.since(&entered) {
                    Some(cost) => self.calls[at].note(&cost, is_outermost),
                    None => {
                        let cost = self.total.long_since(&entered, self.open.len());
                        self.regions[at].note_call(cost, is_outermost);
                    }
                }
            }
            What::Call { back, base } => {
                self.returns_to[back as usize] -= 1;
                self.base = base as usize;
            }
        }
    }

    fn close_to(&mut self, height: usize) {
        while self.open.len() > height {
            self.close_top();
        }
    }

    /// Leaves and enters regions of the current call so that those around a word are open.
    fn move_to(&mut self, pc: u32) {
        let base = self.base;
        let Some(chain) = self.chain(pc) else { return self.close_to(base) };
        let chain = usize::from(chain);
        let is_open = |(open, region): &(&Open, &u16)| matches!(open.what, What::Region(other) if other == **region);
        let kept = self.open[base..].iter().zip(&self.chains[chain]).take_while(is_open).count();
        self.close_to(base + kept);
        for at in kept..self.chains[chain].len() {
            if self.open.len() < DEEPEST {
                let region = self.chains[chain][at];
                self.depth[usize::from(region)] += 1;
                self.open.push(Open { what: What::Region(region), entered: self.total.enter() });
            }
        }
    }

    /// Adds operations of any number.
    #[inline]
    fn add_counts(&mut self, counts: &Counts) {
        let is_small = counts.0.iter().fold(0, |all, count| all | count) < 1 << 31;
        match is_small {
            true => self.add_near(&counts.0.map(|count| count as u32)),
            false => self.total.carry_over(self.open.iter_mut().map(|open| &mut open.entered), counts),
        }
    }

    #[inline]
    fn add_near(&mut self, counts: &Near) {
        if self.total.add(counts) {
            self.total.carry_over(self.open.iter_mut().map(|open| &mut open.entered), &Counts::ZERO);
        }
    }

    fn call(&mut self, back: u32, target: u32) {
        if self.open.len() < DEEPEST {
            let (what, entered) = (What::Call { back, base: self.base as u32 }, Entered::default());
            self.open.push(Open { what, entered });
            self.base = self.open.len();
            self.returns_to[back as usize] += 1;
            self.move_to(target);
        } else {
            self.deeper += 1;
        }
    }

    /// A return ends the newest call that returns to its target, and every call inside that one.
    fn go_back(&mut self, target: u32) {
        if self.deeper != 0 {
            self.deeper -= 1;
            return;
        }
        let is_known = self.returns_to.get(target as usize).is_some_and(|&count| count != 0);
        if is_known {
            while !matches!(self.open.last(), Some(Open { what: What::Call { back, .. }, .. }) if *back == target) {
                self.close_top();
            }
            self.close_top();
        }
        self.move_to(target);
    }
}

impl Observer for Profiler {
    const IS_ACTIVE: bool = true;

    fn new(code: &Code) -> Profiler {
        let costs = (0..code.passes().len()).map(|pass| code.pass_cost(pass)).collect();
        let region = |slot: u32| code.program.region_of.get(code.word(slot) as usize).copied().flatten();
        let regions = &code.program.regions;
        let chain = |number: usize| {
            let mut chain = vec![number as u16];
            // A region is listed after the one around it; anything else would be a loop.
            while let Some(parent) = regions[usize::from(chain[chain.len() - 1])].parent
                && parent < chain[chain.len() - 1]
            {
                chain.push(parent);
            }
            chain.reverse();
            chain
        };
        let order = Order::new(code);
        let mut before = vec![Counts::ZERO];
        let mut sum = Counts::ZERO;
        for &stage in order.stages() {
            if let Stage::Slot(slot) = stage
                && code.slot_row(slot).is_some_and(|row| row.outcomes.len() == 1)
            {
                sum += code.pass_cost(code.slots()[slot as usize].first_outcome as usize).0;
            }
            before.push(sum);
        }
        Profiler {
            costs,
            order,
            before,
            region_of: (0..code.slots().len() as u32).map(region).collect(),
            chains: (0..regions.len()).map(chain).collect(),
            regions: Profile::exclusive(code, &Tally::default()).regions,
            depth: vec![0; regions.len()],
            open: Vec::new(),
            returns_to: vec![0; code.slots().len() + 1],
            deeper: 0,
            base: 0,
            total: Running::default(),
            calls: vec![Calls::default(); regions.len()],
        }
    }

    fn begin(&mut self, pc: u32) {
        self.end();
        self.move_to(pc);
    }

    #[inline]
    fn step(&mut self, pc: u32, exit: usize, units: u32, next: u32, motion: Motion) {
        let (cost, each) = self.costs[exit];
        self.add_counts(&cost);
        if units != 0 {
            self.add_counts(&each.times(units.into()));
        }
        self.go(pc, next, motion);
    }

    fn end(&mut self) {
        self.close_to(0);
        self.deeper = 0;
    }

    fn into_profile(mut self, code: &Code, tally: &Tally) -> Option<Profile> {
        self.end();
        let mut profile = Profile::exclusive(code, tally);
        for (calls, found) in self.calls.iter().zip(&mut self.regions) {
            calls.add_to(found);
        }
        for (region, found) in profile.regions.iter_mut().zip(self.regions) {
            region.calls = found.calls;
            region.inclusive = found.inclusive;
            (region.least, region.most) = (found.least, found.most);
            (region.least_elementary, region.most_elementary) = (found.least_elementary, found.most_elementary);
        }
        Some(profile)
    }
}

impl RunObserver for Profiler {
    fn walked(&mut self, places: Range<u32>) {
        let at = |place: u32| self.before[place as usize];
        let (from, to) = (at(places.start), at(places.end));
        let walked = Counts(std::array::from_fn(|at| to.0[at] - from.0[at]));
        self.add_counts(&walked);
    }

    fn pass(&mut self, exit: usize, is_only: bool, units: u32) {
        let (cost, each) = self.costs[exit];
        if !is_only {
            self.add_counts(&cost);
        }
        if units != 0 {
            self.add_counts(&each.times(units.into()));
        }
    }

    fn is_border(&self, place: u32) -> bool {
        self.chain(self.order.slot(place)) != self.chain(self.order.slot(place + 1))
    }

    fn add(&mut self, counts: &Counts) {
        self.add_counts(counts);
    }

    #[inline]
    fn add_near(&mut self, counts: &Near) {
        self.add_near(counts);
    }

    fn take_back(&mut self, counts: &Counts) {
        self.total.take_back(counts);
    }

    #[inline]
    fn go(&mut self, pc: u32, next: u32, motion: Motion) {
        match motion {
            Motion::Call => self.call(pc.wrapping_add(1), next),
            Motion::Return => self.go_back(next),
            Motion::Jump if self.deeper == 0 && self.chain(pc) != self.chain(next) => self.move_to(next),
            Motion::Jump => {}
        }
    }
}
