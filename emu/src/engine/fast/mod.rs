//! One work item after the other, without a look at each instruction's count or at the clock: a program is walked in *runs*, from any word to
//! the next control row, and what a run takes is added once. Whatever is unusual is left to [`super::interpreter`], which goes on where this
//! stopped, from the same [`State`].

mod count;
#[cfg(target_arch = "x86_64")]
pub(super) mod doubles;
mod fuel;
pub(super) mod operands;
#[cfg(target_arch = "x86_64")]
mod planes;
mod rows;
mod walk;

use fuel::Fuel;
use walk::{Ended, Position, Walk};

use count::FlowCounts;

use super::host::{HostSimd, Present};
use super::plan::Plan;
use super::state::{CoreId, State};
use super::taint::Taint;
use super::{AddOctets, Demand, Engine, Refusal, Stopped, TimedLink};
use crate::code::registers::Registers;
use crate::code::tally::Tally;
use crate::profile::RunObserver;
use crate::semantics::{Computes, Watch};

/// The fast engine of one program.
#[derive(Clone, Debug)]
pub struct Fast<'a> {
    plan: Plan<'a>,
    count: FlowCounts,
    simd: Present,
}

impl<'a> Engine<'a> for Fast<'a> {
    fn new(demand: &Demand<'a>) -> Result<Fast<'a>, Refusal> {
        if demand.computes != Computes::default() {
            return Err(ARITHMETIC);
        }
        let plan = Plan::new(demand.code).ok_or(TOO_LONG)?;
        // Flags that nobody asks for would make each run with a message be looked at.
        let plan = if demand.follows_cores { plan } else { plan.regardless_of_cores() };
        Ok(Fast { count: FlowCounts::new(&plan, demand.follows_cores), plan, simd: demand.wish.simd.present() })
    }

    fn run<T: Watch, L: TimedLink, O: RunObserver>(
        &mut self,
        seat: CoreId,
        state: &mut State,
        _: &T,
        link: &mut L,
        taint: &mut Taint,
        observer: &mut O,
    ) -> Stopped {
        self.count.taint = *taint;
        let stopped = run(self.simd, &self.plan, seat, state, link, &mut self.count, observer);
        *taint = self.count.taint;
        stopped
    }

    fn fold(&mut self, tally: &mut Tally, _: AddOctets) {
        self.count.fold(&self.plan, tally);
    }
}

const ARITHMETIC: Refusal =
    "the fast engine computes in no other modes than the default ones, traps no divisions by zero and counts no losses";
const TOO_LONG: Refusal = "an instruction takes more clocks than the sums of the fast engine have room for";

/// Runs until the program halts, waits or comes to something unusual, with the features given. The results are the same with all of them.
fn run<L: TimedLink, O: RunObserver>(
    Present(simd): Present,
    plan: &Plan,
    seat: CoreId,
    state: &mut State,
    link: &mut L,
    count: &mut FlowCounts,
    observer: &mut O,
) -> Stopped {
    #[cfg(target_arch = "x86_64")]
    if simd >= HostSimd::Avx2 {
        let run = |registers: &mut Registers, first: Position, walk: &mut Walk<L, O>| {
            // SAFETY: the host has the features that the function is compiled for. `rows::baseline::run` is its safe twin.
            unsafe { rows::avx2::run::<L, O>(registers, first, walk) }
        };
        return walk::<L, O>(plan, seat, state, link, count, observer, run);
    }
    let _ = simd;
    // Hosts without vector instructions are few: one function serves all links there.
    let mut link: &mut dyn TimedLink = link;
    let run = rows::baseline::run::<&mut dyn TimedLink, O>;
    walk::<_, O>(plan, seat, state, &mut link, count, observer, run)
}

fn walk<L: TimedLink, O: RunObserver>(
    plan: &Plan,
    seat: CoreId,
    state: &mut State,
    link: &mut L,
    count: &mut FlowCounts,
    observer: &mut O,
    run: impl FnOnce(&mut Registers, Position, &mut Walk<L, O>),
) -> Stopped {
    // Rows count without a look at how much there is.
    assert_eq!((count.runs.len(), count.exits.len()), (plan.steps().len(), plan.exits()), "they are of one plan");
    let fuel = Fuel::new(state, seat, count.taint, count.is_following);
    if state.pc as usize >= plan.slots().len() {
        return Stopped::Bailout;
    }
    let from = plan.place_of(state.pc);
    let State { registers, buffer, units, .. } = &mut *state;
    let stop = Ended { stopped: Stopped::Bailout, place: from, sums: 0, is_cut: false };
    let steps = plan.steps_of(fuel.is_held()).as_ptr();
    let mut walk = Walk { plan, seat, buffer, units, link, count, observer, fuel, steps, from, stop };
    let sums = walk.fuel.begin(plan);
    let first = walk.begin(from, sums);
    run(registers, first, &mut walk);
    let Ended { stopped, place, sums, is_cut } = walk.stop;
    // A run is paid for as a whole when it begins, so what was not executed of it is given back.
    let rest = is_cut.then(|| plan.run_cost(place));
    if is_cut {
        walk.count.runs[place as usize].cut += 1;
        if O::IS_ACTIVE {
            walk.observer.walked(walk.from..place);
        }
    }
    let fuel = walk.fuel;
    count.taint = fuel.settle(plan, state, sums, place, rest);
    stopped
}
