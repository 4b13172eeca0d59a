//! What a group of work items counts: passes by block and by exit, and what each lane took so far.

use super::lanes::{LANES, Mask};
use super::plan::Plan;
use super::toll::Toll;
use crate::tally::Tally;

/// What one lane took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Total {
    /// Instructions.
    pub steps: u64,
    /// Clocks.
    pub clocks: u64,
    /// Elementary operations.
    pub elementary: u64,
}

/// Passes of a group, and the totals of its lanes.
#[derive(Clone, Debug)]
pub struct Meter {
    /// Lanes that began a block, by its first word.
    blocks: Vec<u64>,
    /// Passes and units, by exit; of words with one exit only the units.
    exits: Vec<(u64, u64)>,
    kept_blocks: Vec<u64>,
    kept_exits: Vec<(u64, u64)>,
    tolls: [u64; LANES],
    totals: [Total; LANES],
    /// Of what half a field of a toll holds, no lane has a larger share: see [`Toll::share`].
    filled: u32,
}

impl Meter {
    /// Nothing yet, for a program.
    pub fn new(plan: &Plan) -> Meter {
        Meter {
            blocks: vec![0; plan.slots().len()],
            exits: vec![(0, 0); plan.code.costs().len()],
            kept_blocks: vec![0; plan.slots().len()],
            kept_exits: vec![(0, 0); plan.code.costs().len()],
            tolls: [0; LANES],
            totals: [Total::default(); LANES],
            filled: 0,
        }
    }

    /// Forgets the passes of the group and the totals of its lanes; what was kept stays.
    pub fn reset(&mut self) {
        self.blocks.fill(0);
        self.exits.fill((0, 0));
        self.tolls = [0; LANES];
        self.totals = [Total::default(); LANES];
        self.filled = 0;
    }

    /// Some lanes begin a block of a toll, with the share that it takes at most.
    #[inline(always)]
    pub fn begin(&mut self, pc: u32, mask: Mask, toll: Toll, most: u32) {
        if self.filled + most >= Toll::WHOLE {
            self.empty();
        }
        self.filled += most;
        self.blocks[pc as usize] += u64::from(mask.count_ones());
        self.add(mask, toll);
    }

    #[inline(always)]
    fn add(&mut self, mask: Mask, toll: Toll) {
        for (lane, sum) in self.tolls.iter_mut().enumerate() {
            *sum += if mask & 1 << lane != 0 { toll.0 } else { 0 };
        }
    }

    /// Some lanes take an exit of a word that has several.
    #[inline(always)]
    pub fn pass(&mut self, plan: &Plan, exit: usize, mask: Mask) {
        self.exits[exit].0 += u64::from(mask.count_ones());
        let extra = plan.extra(exit);
        if extra.0 != 0 {
            self.add(mask, extra);
        }
    }

    /// A lane's pass through an exit of the word at `pc` has units.
    #[inline]
    pub fn add_units(&mut self, plan: &Plan, pc: u32, exit: usize, lane: usize, units: u32) {
        let first = plan.slots()[pc as usize].first_exit as usize;
        self.exits[first + exit].1 += u64::from(units);
        if units != 0 && plan.code.costs()[first + exit].has_busy_units {
            let (clocks, elementary) = plan.code.unit_cost(first + exit, units);
            self.totals[lane].clocks += clocks.0;
            self.totals[lane].elementary += elementary;
        }
    }

    /// Empties the tolls into the totals.
    #[cold]
    fn empty(&mut self) {
        for lane in 0..LANES {
            self.totals[lane] = self.total(lane);
        }
        self.tolls = [0; LANES];
        self.filled = 0;
    }

    /// What a lane took.
    pub fn total(&self, lane: usize) -> Total {
        let (toll, total) = (Toll(self.tolls[lane]), self.totals[lane]);
        Total {
            steps: total.steps + toll.steps(),
            clocks: total.clocks + toll.clocks(),
            elementary: total.elementary + toll.elementary(),
        }
    }

    /// Clocks of a lane before the rest of its block, of which the toll is given.
    #[inline(always)]
    pub fn clocks_before(&self, lane: usize, rest: Toll) -> u64 {
        self.totals[lane].clocks + Toll(self.tolls[lane] - rest.0).clocks()
    }

    /// Keeps the passes of the group, which has come to its end, for [`Meter::fold`].
    pub fn keep(&mut self) {
        for (kept, count) in self.kept_blocks.iter_mut().zip(&self.blocks) {
            *kept += count;
        }
        for (kept, (count, units)) in self.kept_exits.iter_mut().zip(&self.exits) {
            kept.0 += count;
            kept.1 += units;
        }
    }

    /// Adds the passes that were kept to a tally of the same program, and forgets them.
    pub fn fold(&mut self, plan: &Plan, tally: &mut Tally) {
        let passes = tally.passes_mut();
        for (pc, count) in self.kept_blocks.iter_mut().enumerate().filter(|(_, count)| **count != 0) {
            let place = plan.place(pc as u32).expect("blocks begin in the program");
            for at in pc as u32..place.end {
                if plan.code.row(at).is_some_and(|row| row.exits.len() == 1) {
                    passes[plan.slots()[at as usize].first_exit as usize].count += *count;
                }
            }
            *count = 0;
        }
        for (pass, kept) in passes.iter_mut().zip(&mut self.kept_exits) {
            let (count, units) = std::mem::take(kept);
            pass.count += count;
            pass.units += units;
        }
    }
}
