//! Follows calls, returns and regions while a program runs, with a stack of what is open and snapshots of the running
//! totals.

use std::ops::Range;

use isa::Counts;

use super::{Observer, Profile, RegionProfile, RunObserver};
use crate::code::Code;
use crate::code::layout::{Order, Stage};
use crate::code::tally::Tally;
use crate::semantics::Motion;

/// Most regions and calls that are open at once; what deeper calls cost counts for what is open already.
const DEEPEST: usize = 1 << 16;

/// Something open.
#[derive(Clone, Copy, Debug)]
enum Open {
    /// A call: the regions above it belong to the callee.
    Call {
        /// Word to which the callee returns.
        back: u32,
    },
    /// A region or function.
    Region {
        /// Which.
        region: u16,
        /// Totals when it was entered.
        before: Counts,
    },
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
    total: Counts,
}

impl Profiler {
    fn chain(&self, pc: u32) -> Option<u16> {
        self.region_of.get(pc as usize).copied().flatten()
    }

    fn close_top(&mut self) {
        match self.open.pop() {
            Some(Open::Region { region, before }) => {
                let at = usize::from(region);
                self.depth[at] -= 1;
                self.regions[at].note_call(self.total - before, self.depth[at] == 0);
            }
            Some(Open::Call { back }) => self.returns_to[back as usize] -= 1,
            None => {}
        }
    }

    fn close_to(&mut self, height: usize) {
        while self.open.len() > height {
            self.close_top();
        }
    }

    /// Leaves and enters regions of the current call so that those around a word are open.
    fn move_to(&mut self, pc: u32) {
        let base = self.open.iter().rposition(|open| matches!(open, Open::Call { .. })).map_or(0, |call| call + 1);
        let chain = self.chain(pc).map_or(&[][..], |region| &self.chains[usize::from(region)]);
        let is_open =
            |(open, region): &(&Open, &u16)| matches!(open, Open::Region { region: other, .. } if other == *region);
        let kept = self.open[base..].iter().zip(chain).take_while(is_open).count();
        let entered = chain[kept..].to_vec();
        self.close_to(base + kept);
        for region in entered {
            if self.open.len() < DEEPEST {
                self.depth[usize::from(region)] += 1;
                self.open.push(Open::Region { region, before: self.total });
            }
        }
    }

    fn call(&mut self, back: u32, target: u32) {
        if self.open.len() < DEEPEST {
            self.open.push(Open::Call { back });
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
            while !matches!(self.open.last(), Some(Open::Call { back }) if *back == target) {
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
            total: Counts::ZERO,
        }
    }

    fn begin(&mut self, pc: u32) {
        self.end();
        self.move_to(pc);
    }

    #[inline]
    fn step(&mut self, pc: u32, exit: usize, units: u32, next: u32, motion: Motion) {
        let (cost, each) = &self.costs[exit];
        self.total += *cost;
        if units != 0 {
            self.total += each.times(units.into());
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
        for (total, (to, from)) in self.total.0.iter_mut().zip(to.0.iter().zip(from.0)) {
            *total += to - from;
        }
    }

    fn pass(&mut self, exit: usize, is_only: bool, units: u32) {
        let (cost, each) = &self.costs[exit];
        if !is_only {
            self.total += *cost;
        }
        if units != 0 {
            self.total += each.times(units.into());
        }
    }

    fn is_border(&self, place: u32) -> bool {
        self.chain(self.order.slot(place)) != self.chain(self.order.slot(place + 1))
    }

    #[inline]
    fn add(&mut self, counts: &Counts) {
        self.total += *counts;
    }

    fn take_back(&mut self, counts: &Counts) {
        self.total = self.total - *counts;
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
