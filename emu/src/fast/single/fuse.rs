//! What an item took so far, and when it is to be looked at: three sums in one number of 64 bits, which are emptied before one of them is full
//! or the step limit is reached.

use crate::checked::{Seat, State};
use crate::fast::plan::{FIELD, FLAG, Plan, Toll};
use crate::independence::Origin;

/// A sum that has come so far is emptied.
const FULL: u64 = 1 << (FIELD - 1);

/// The bits which say that something is to be looked at before a run begins: a sum is full, or the run is flagged.
pub(super) const LOOK: u64 = FULL | FULL << FIELD | FULL << (2 * FIELD) | FLAG;

/// What an item took before its sums were emptied.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fuse {
    steps: u64,
    clocks: u64,
    elementary: u64,
    limit: u64,
    /// Where the sum of the steps began, so that it is full when the limit is reached, or at once while numbers of cores are followed.
    bias: u64,
    is_following: bool,
    /// What it knows of the cores.
    origin: Origin,
    /// The same at the beginning of the run that was followed last.
    before: Origin,
    /// Where that run began, and the steps up to its end.
    followed: (u32, u64),
}

impl Fuse {
    /// At the state of an item.
    pub(super) fn new(state: &State, seat: Seat, origin: Origin, is_following: bool) -> Fuse {
        let State { steps, inner_steps, clocks, elementary, pc, .. } = *state;
        let limit = seat.step_limit.saturating_sub(inner_steps);
        Fuse { steps, clocks, elementary, limit, bias: 0, is_following, origin, before: origin, followed: (pc, 0) }
    }

    /// The sums at the beginning.
    pub(super) fn begin(&mut self) -> u64 {
        let room = if self.origin.tainted != 0 { 0 } else { self.limit.saturating_sub(self.steps) };
        self.bias = FULL - FULL.min(room);
        self.bias
    }

    /// Looks at what is to be looked at before the run at a word begins. `toll` is what it takes, and the exit that led there. Yields the sums,
    /// and whether the run begins; else they are those before it.
    #[cold]
    #[inline(never)]
    pub(super) fn look(&mut self, plan: &Plan, pc: u32, sums: u64, toll: u64) -> (u64, bool) {
        let run = if pc <= plan.code.words() { plan.run_toll(pc) } else { Toll::default() };
        let sums = self.empty(sums + ((toll & !FLAG) - run.0));
        if pc > plan.code.words() || self.steps + run.steps() > self.limit {
            return (sums, false);
        }
        let end = plan.run_end(pc);
        if self.is_following && (self.origin.tainted != 0 || plan.asks(&(pc..end))) {
            (self.before, self.followed) = (self.origin, (pc, self.steps + run.steps()));
            for word in pc..end {
                self.origin.step(plan.mark(word));
            }
            return (self.begin() + run.0, true);
        }
        (sums + run.0, true)
    }

    fn empty(&mut self, sums: u64) -> u64 {
        let toll = Toll(sums);
        self.steps += toll.steps() - self.bias;
        self.clocks += toll.clocks();
        self.elementary += toll.elementary();
        self.begin()
    }

    /// What units of an exit take beside the sums.
    pub(super) fn add_units(&mut self, plan: &Plan, exit: usize, units: u32) {
        if plan.code.costs()[exit].has_busy_units {
            let (clocks, elementary) = plan.code.unit_cost(exit, units);
            self.clocks += clocks.0;
            self.elementary += elementary;
        }
    }

    /// Clocks before the rest of a run.
    #[inline(always)]
    pub(super) fn clocks_before(&self, sums: u64, rest: Toll) -> u64 {
        self.clocks + Toll(sums.wrapping_sub(rest.0)).clocks()
    }

    /// Brings the state up to date at a word; `rest` is what of the run was not executed.
    pub(super) fn settle(mut self, plan: &Plan, state: &mut State, sums: u64, pc: u32, rest: Option<Toll>) -> Origin {
        self.empty(sums);
        if let Some(rest) = rest {
            if self.followed.1 == self.steps {
                self.origin = self.before;
                for word in self.followed.0..pc {
                    self.origin.step(plan.mark(word));
                }
            }
            self.steps -= rest.steps();
            self.clocks -= rest.clocks();
            self.elementary -= rest.elementary();
        }
        (state.pc, state.steps, state.clocks, state.elementary) = (pc, self.steps, self.clocks, self.elementary);
        self.origin
    }
}
