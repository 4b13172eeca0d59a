//! A walk through a program: what rows need beside registers, and how a run follows the other.

use isa::table::Ending;

use super::count::Count;
use super::fuse::Fuse;
use super::{Stopped, Wire};
use crate::checked::Seat;
use crate::exec::{Flow, Motion};
use crate::fast::group::{Counting, Moment};
use crate::fast::plan::{FLAG, Plan, Step};
use crate::octets::Buffer;
use crate::profile::RunObserver;

/// Where a walk is: the step that comes next, a null pointer when it stops, and what the item took since the fuse was looked at.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub step: *const Step,
    pub sums: u64,
}

/// Where control goes from one run to the next, and what that and the next run take.
#[derive(Clone, Copy)]
pub(super) struct Way {
    pub pc: u32,
    pub step: *const Step,
    pub toll: u64,
}

/// How and where a walk stopped.
#[derive(Clone, Copy)]
pub(super) struct Ended {
    pub stopped: Stopped,
    pub pc: u32,
    pub sums: u64,
    /// Whether the rest of the current run is left.
    pub is_cut: bool,
}

/// All but the registers.
pub(super) struct Walk<'a, L, O> {
    pub plan: &'a Plan<'a>,
    pub seat: Seat,
    pub buffer: &'a mut Buffer,
    pub link: &'a mut L,
    pub count: &'a mut Count,
    pub observer: &'a mut O,
    pub fuse: Fuse,
    /// Where what the observer has not been told of begins.
    pub from: u32,
    pub stop: Ended,
}

impl<L: Wire, O: RunObserver> Walk<'_, L, O> {
    #[cold]
    fn stop(&mut self, stop: Ended) -> Place {
        self.stop = stop;
        Place { step: std::ptr::null(), sums: 0 }
    }

    /// Stops before a word of the current run.
    #[cold]
    #[inline(never)]
    pub fn stop_before(&mut self, stopped: Stopped, place: Place) -> Place {
        self.stop(Ended { stopped, pc: self.word(place.step), sums: place.sums, is_cut: true })
    }

    /// The word of a step.
    #[inline(always)]
    pub fn word(&self, step: *const Step) -> u32 {
        ((step as usize - self.plan.steps().as_ptr() as usize) / size_of::<Step>()) as u32
    }

    #[inline(always)]
    fn step(&self, pc: u32) -> *const Step {
        self.plan.steps().as_ptr().wrapping_add(pc as usize)
    }

    /// On to the next step of the run.
    #[inline(always)]
    pub fn go_on(&mut self, place: Place) -> Place {
        if O::IS_ACTIVE {
            let pc = self.word(place.step);
            if self.observer.is_border(pc) {
                self.observer.walked(self.from..pc + 1);
                self.observer.go(pc, pc + 1, Motion::Jump);
                self.from = pc + 1;
            }
        }
        Place { step: place.step.wrapping_add(1), sums: place.sums }
    }

    /// The way to a word to which no exit leads whose target is known.
    #[inline(always)]
    pub fn way_to<C: Counting>(&mut self, pc: u32) -> Way {
        let toll = match self.count.runs.get_mut(pc as usize) {
            Some(run) => {
                run.begun += u64::from(C::IS_ON);
                run.toll
            }
            None => FLAG,
        };
        Way { pc, step: self.step(pc), toll }
    }

    /// Begins at a word.
    pub fn begin<C: Counting>(&mut self, pc: u32, sums: u64) -> Place {
        self.from = pc;
        let way = self.way_to::<C>(pc);
        self.look::<C>(way, sums)
    }

    /// Looks at what is to be looked at before a run begins, which is counted already.
    #[cold]
    #[inline(never)]
    pub fn look<C: Counting>(&mut self, way: Way, sums: u64) -> Place {
        let Way { pc, toll, .. } = way;
        let (sums, begins) = self.fuse.look(self.plan, pc, sums, toll);
        if begins {
            return Place { step: self.step(pc), sums };
        }
        if let Some(run) = self.count.runs.get_mut(pc as usize) {
            run.cut += u64::from(C::IS_ON);
        }
        self.stop(Ended { stopped: Stopped::Unusual, pc, sums, is_cut: false })
    }

    /// Stops behind the program's end.
    #[cold]
    #[inline(never)]
    pub fn halt(&mut self, place: Place) -> Place {
        let pc = self.word(place.step);
        if O::IS_ACTIVE {
            self.observer.walked(self.from..pc + 1);
            self.observer.go(pc, pc, Motion::Jump);
        }
        self.stop(Ended { stopped: Stopped::Halt, pc, sums: place.sums, is_cut: false })
    }

    /// The way on from a control row: one that its step knows, or to any word.
    #[inline(always)]
    pub fn turn<C: Counting, E: Ending>(
        &mut self,
        has_target: bool,
        now: &Step,
        step: *const Step,
        flow: Flow,
        exit: E,
    ) -> Way {
        let number = now.exit as usize + exit.index();
        if O::IS_ACTIVE {
            if E::EXITS > 1 {
                self.observer.pass(number, false, 0);
            }
            self.observer.walked(self.from..flow.pc + 1);
            self.observer.go(flow.pc, flow.next, flow.motion);
            self.from = flow.next;
        }
        if E::EXITS > 1 && exit.index() == 0 {
            return Way { pc: flow.pc + 1, step: step.wrapping_add(1), toll: now.edges[0] };
        }
        if has_target {
            if C::IS_ON {
                self.count.take_exit(number);
            }
            return Way { pc: flow.next, step: self.step(now.target), toll: now.edges[1] };
        }
        self.way_to::<C>(flow.next)
    }

    /// Tells the link when it is asked.
    #[inline(always)]
    pub fn note(&mut self, place: Place) {
        let pc = self.word(place.step);
        let is_asked = self.link.keeps_time();
        let clocks = if is_asked { self.fuse.clocks_before(place.sums, self.plan.run_toll(pc)) } else { 0 };
        self.link.note(Moment { pc, clocks });
    }

    /// Counts what a straight row took, where that is not known beforehand, and yields the sums.
    #[inline(always)]
    pub fn pass<C: Counting, E: Ending>(&mut self, now: &Step, mut sums: u64, exit: E) -> u64 {
        let (number, units) = (now.exit as usize + exit.index(), exit.units());
        if E::EXITS > 1 {
            if C::IS_ON {
                self.count.take_exit(number);
            }
            if now.is_uneven {
                sums += self.plan.extra(number).0;
            }
            if O::IS_ACTIVE {
                self.observer.pass(number, false, 0);
            }
        }
        if C::IS_ON && units != 0 {
            self.count_units(number, units);
        }
        sums
    }

    fn count_units(&mut self, exit: usize, units: u32) {
        self.count.add_units(exit, units);
        self.fuse.add_units(self.plan, exit, units);
        if O::IS_ACTIVE {
            self.observer.pass(exit, true, units);
        }
    }
}
