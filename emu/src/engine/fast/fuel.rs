//! Fuel of an item: four sums in one number of 64 bits, which are emptied before one of them is full
//! or the step limit is reached.

use crate::engine::cost::{Cost, FLAG, HALVES};
use crate::engine::plan::Plan;
use crate::engine::taint::Taint;
use crate::engine::{CoreId, State};

/// The bits which say that something is to be looked at before a run begins: a sum has come to half of its room, or the run is flagged.
pub(super) const LOOK: u64 = HALVES | FLAG;

/// Fuel of an item: what it took before its sums were emptied, and how much it may take.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fuel {
    steps: u64,
    inner_steps: u64,
    clocks: u64,
    elementary: u64,
    limit: u64,
    /// Start of the sums of the steps, so that one is full before both come to the limit.
    bias: Cost,
    is_following: bool,
    /// Taint of the item.
    taint: Taint,
    /// Taint at the beginning of the run that was followed last.
    before: Taint,
    /// Place of that run, and the steps up to its end.
    followed: (u32, u64),
}

impl Fuel {
    /// At the state of an item.
    pub(super) fn new(state: &State, seat: CoreId, taint: Taint, is_following: bool) -> Fuel {
        let State { steps, inner_steps, clocks, elementary, pc, .. } = *state;
        let (limit, bias, followed) = (seat.step_limit, Cost::default(), (pc, 0));
        Fuel { steps, inner_steps, clocks, elementary, limit, bias, is_following, taint, before: taint, followed }
    }

    /// True while a register holds the number of cores.
    pub(super) fn is_held(&self) -> bool {
        self.taint.tainted != 0
    }

    fn all_steps(&self) -> u64 {
        self.steps + self.inner_steps
    }

    /// The sums at the beginning.
    pub(super) fn begin(&mut self, plan: &Plan) -> u64 {
        const FULL: u64 = Cost::WHOLE as u64;
        // A sum starts so high that it is full when the limit is reached: with 100 steps left, at full less 100.
        let room = self.limit.saturating_sub(self.all_steps());
        // Where there are two kinds of steps, each of the two sums may come to half of what is left.
        self.bias = match plan.has_inner_steps() {
            false => Cost::of_steps(FULL - FULL.min(room), 0),
            true => Cost::of_steps(FULL - FULL.min(room / 2), FULL - FULL.min(room / 2)),
        };
        self.bias.0
    }

    /// Looks at what is to be looked at before the run at a place begins. `cost` is what it takes, and the exit that led there. Yields the
    /// sums, and whether the run begins; else they are those before it.
    #[cold]
    #[inline(never)]
    pub(super) fn look(&mut self, plan: &Plan, place: u32, sums: u64, cost: u64) -> (u64, bool) {
        // The cost has the outcome and the run; the run is taken off again, because it may not begin.
        let run = plan.run_cost(place);
        let sums = self.empty(plan, sums + ((cost & !FLAG) - run.0));
        let after = self.all_steps() + run.steps() + run.inner_steps();
        if after > self.limit {
            return (sums, false);
        }
        let end = plan.run_end(place);
        // The run's effect is taken beforehand; where the run is cut short, `settle` goes back to `before` and takes a part of it.
        if self.is_following && plan.asks(&(place..end), self.is_held()) {
            (self.before, self.followed) = (self.taint, (place, after));
            for place in place..end {
                self.taint.step(plan.effect(place));
            }
        }
        (sums + run.0, true)
    }

    fn empty(&mut self, plan: &Plan, sums: u64) -> u64 {
        let cost = Cost(sums - self.bias.0);
        self.steps += cost.steps();
        self.inner_steps += cost.inner_steps();
        self.clocks += cost.clocks();
        self.elementary += cost.elementary();
        self.begin(plan)
    }

    /// Addition of what units of a pass take beside the sums.
    pub(super) fn add_units(&mut self, plan: &Plan, pass: usize, units: u32) {
        if plan.code.costs()[pass].has_busy_units {
            let (clocks, elementary) = plan.code.unit_cost(pass, units);
            self.clocks += clocks.0;
            self.elementary += elementary;
        }
    }

    /// Clocks before the rest of a run.
    #[inline(always)]
    pub(super) fn clocks_before(&self, sums: u64, rest: Cost) -> u64 {
        self.clocks + Cost(sums.wrapping_sub(rest.0)).clocks()
    }

    /// Brings the state up to date at a place; `rest` is what of the run was not executed.
    pub(super) fn settle(mut self, plan: &Plan, state: &mut State, sums: u64, place: u32, rest: Option<Cost>) -> Taint {
        self.empty(plan, sums);
        if let Some(rest) = rest {
            // Only if the run that was cut is the one whose effect was taken last.
            if self.followed.1 == self.all_steps() {
                self.taint = self.before;
                for place in self.followed.0..place {
                    self.taint.step(plan.effect(place));
                }
            }
            self.steps -= rest.steps();
            self.inner_steps -= rest.inner_steps();
            self.clocks -= rest.clocks();
            self.elementary -= rest.elementary();
        }
        state.pc = plan.steps()[place as usize].slot;
        (state.steps, state.inner_steps) = (self.steps, self.inner_steps);
        (state.clocks, state.elementary) = (self.clocks, self.elementary);
        self.taint
    }
}
