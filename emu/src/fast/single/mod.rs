//! One work item after the other, without a look at each instruction's count or at the clock: a program is walked in *runs*, from any word to
//! the next control row, and what a run takes is added once. Whatever is unusual is left to [`crate::checked`], which goes on where this
//! stopped, from the same [`State`].

mod count;
#[cfg(target_arch = "x86_64")]
mod doubles;
mod driver;
mod fuse;
mod operands;
#[cfg(target_arch = "x86_64")]
mod planes;
mod rows;
mod walk;

use fuse::Fuse;
use walk::{Ended, Place, Walk};

pub use count::Count;
pub use driver::Driver;

use super::plan::Plan;
use super::{Features, Moment, Present};
use crate::checked::{Seat, State};
use crate::exec::{Link, Message, methods};
use crate::octets::Buffer;
use crate::profile::RunObserver;
use crate::registers::Registers;
use crate::trap::{Fault, Stop};

/// The machine as a work item sees it.
pub trait Wire: Link {
    /// Whether it wants to know when it is asked.
    fn keeps_time(&self) -> bool;

    /// When and where it is asked next; the time only where it is kept.
    fn note(&mut self, moment: Moment);
}

/// A link to which the time does not matter.
pub struct Timeless<'a>(pub &'a mut dyn Link);

/// Why the engine stopped. The state is that before the instruction at the program counter, but for `halt`, which has been executed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stopped {
    /// The program executed `halt`.
    Halt,
    /// The instruction at the program counter waits for the machine.
    Wait,
    /// The instruction at the program counter asked the machine for something and went wrong.
    Fault(Fault),
    /// The instruction at the program counter is for the interpreter.
    Unusual,
}

/// Runs until the program halts, waits or comes to something unusual, with the features given. The results are the same with all of them.
pub fn run<L: Wire, O: RunObserver>(
    Present(features): Present,
    plan: &Plan,
    seat: Seat,
    state: &mut State,
    link: &mut L,
    count: &mut Count,
    observer: &mut O,
) -> Stopped {
    #[cfg(target_arch = "x86_64")]
    if features >= Features::Avx2 {
        let run = |registers: &mut Registers, first: Place, walk: &mut Walk<L, O>| {
            // SAFETY: the host has the features that the function is compiled for. `rows::baseline::run` is its safe twin.
            unsafe { rows::avx2::run::<L, O>(registers, first, walk) }
        };
        return walk::<L, O>(plan, seat, state, link, count, observer, run);
    }
    let _ = features;
    // Hosts without vector instructions are few: one function serves all links there.
    let mut link: &mut dyn Wire = link;
    let run = rows::baseline::run::<&mut dyn Wire, O>;
    walk::<_, O>(plan, seat, state, &mut link, count, observer, run)
}

fn walk<L: Wire, O: RunObserver>(
    plan: &Plan,
    seat: Seat,
    state: &mut State,
    link: &mut L,
    count: &mut Count,
    observer: &mut O,
    run: impl FnOnce(&mut Registers, Place, &mut Walk<L, O>),
) -> Stopped {
    // Rows count without a look at how much there is.
    assert_eq!((count.runs.len(), count.exits.len()), (plan.steps().len(), plan.exits()), "they are of one plan");
    let fuse = Fuse::new(state, seat, count.origin, count.is_following);
    if state.pc as usize >= plan.slots().len() {
        return Stopped::Unusual;
    }
    let from = plan.place_of(state.pc);
    let State { registers, buffer, units, .. } = &mut *state;
    let stop = Ended { stopped: Stopped::Unusual, place: from, sums: 0, is_cut: false };
    let steps = plan.steps_of(fuse.is_held()).as_ptr();
    let mut walk = Walk { plan, seat, buffer, units, link, count, observer, fuse, steps, from, stop };
    let sums = walk.fuse.begin(plan);
    let first = walk.begin(from, sums);
    run(registers, first, &mut walk);
    let Ended { stopped, place, sums, is_cut } = walk.stop;
    let rest = is_cut.then(|| plan.run_toll(place));
    if is_cut {
        walk.count.runs[place as usize].cut += 1;
        if O::IS_ACTIVE {
            walk.observer.walked(walk.from..place);
        }
    }
    let fuse = walk.fuse;
    count.origin = fuse.settle(plan, state, sums, place, rest);
    stopped
}

impl Link for Timeless<'_> {
    methods! { hand_on! self => self.0; }
}

impl Wire for Timeless<'_> {
    fn keeps_time(&self) -> bool {
        false
    }

    fn note(&mut self, _: Moment) {}
}

impl Wire for &mut dyn Wire {
    fn keeps_time(&self) -> bool {
        (**self).keeps_time()
    }

    fn note(&mut self, moment: Moment) {
        (**self).note(moment);
    }
}
