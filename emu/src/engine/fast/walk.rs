//! A walk through a program: what rows need beside registers, and how a run follows the other.

use isa::table::AnyOutcome;

use super::count::FlowCounts;
use super::fuel::Fuel;
use crate::code::octets::Buffer;
use crate::code::registers::Registers;
use crate::code::trap::{Fault, Stop};
use crate::engine::CoreId;
use crate::engine::RequestTime;
use crate::engine::cost::FLAG;
use crate::engine::plan::{Plan, Step};
use crate::engine::{Stopped, TimedLink};
use crate::extension::{Numbers, Units};
use crate::profile::RunObserver;
use crate::semantics::{Flow, Motion};

/// Position of a walk: the step that comes next, a null pointer when it stops, and what the item took since the fuel was looked at.
#[derive(Clone, Copy)]
pub(super) struct Position {
    pub step: *const Step,
    pub sums: u64,
}

/// Turn from one run to the next, and what that and the next run take.
#[derive(Clone, Copy)]
pub(super) struct Turn {
    pub step: *const Step,
    pub cost: u64,
}

/// End of a walk.
#[derive(Clone, Copy)]
pub(super) struct Ended {
    pub stopped: Stopped,
    pub place: u32,
    pub sums: u64,
    /// The rest of the current run is left.
    pub is_cut: bool,
}

/// All but the registers.
pub(super) struct Walk<'a, L, O> {
    pub plan: &'a Plan<'a>,
    pub seat: CoreId,
    pub buffer: &'a mut Buffer,
    pub units: &'a mut Units,
    pub link: &'a mut L,
    pub count: &'a mut FlowCounts,
    pub observer: &'a mut O,
    pub fuel: Fuel,
    /// The plan's steps for what the fuel knows of the cores.
    pub steps: *const Step,
    /// The place from which on the observer was told of nothing.
    pub from: u32,
    pub stop: Ended,
}

impl<L: TimedLink, O: RunObserver> Walk<'_, L, O> {
    #[cold]
    fn stop(&mut self, stop: Ended) -> Position {
        self.stop = stop;
        Position { step: std::ptr::null(), sums: 0 }
    }

    /// Stops before a step of the current run.
    #[cold]
    #[inline(never)]
    pub fn stop_before(&mut self, stopped: Stopped, at: Position) -> Position {
        self.stop(Ended { stopped, place: self.place(at.step), sums: at.sums, is_cut: true })
    }

    /// The place of a step in the plan.
    #[inline(always)]
    pub fn place(&self, step: *const Step) -> u32 {
        let place = ((step as usize).wrapping_sub(self.steps as usize) / size_of::<Step>()) as u32;
        debug_assert!(place <= self.plan.end() + 1, "a step of these, and not of the other ones");
        place
    }

    #[inline(always)]
    fn step(&self, place: u32) -> *const Step {
        self.steps.wrapping_add(place as usize)
    }

    /// Tells the observer of everything up to a step, after which control goes to another one.
    fn tell(&mut self, last: u32, next: u32, motion: Motion) {
        self.observer.walked(self.from..last + 1);
        let slot = |place: u32| self.plan.steps()[place as usize].slot;
        self.observer.go(slot(last), slot(next), motion);
        self.from = next;
    }

    /// On to the next step of the run.
    #[inline(always)]
    pub fn go_on(&mut self, at: Position) -> Position {
        if O::IS_ACTIVE {
            let place = self.place(at.step);
            if self.observer.is_border(place) {
                self.tell(place, place + 1, Motion::Jump);
            }
        }
        Position { step: at.step.wrapping_add(1), sums: at.sums }
    }

    /// The way to a place to which no exit leads whose target is known.
    #[inline(always)]
    pub fn way_to(&mut self, place: u32) -> Turn {
        let step = self.step(place);
        let cost = match self.count.runs.get_mut(place as usize) {
            Some(run) => {
                run.begun += 1;
                // SAFETY: there is a step for each of the counts, which `super::walk` has compared. The safe twin is `Plan::steps`.
                unsafe { (*step).cost }
            }
            None => FLAG,
        };
        Turn { step, cost }
    }

    /// Begins at a place.
    pub fn begin(&mut self, place: u32, sums: u64) -> Position {
        self.from = place;
        let way = self.way_to(place);
        self.look(way.step, way.cost, sums)
    }

    /// Looks at what is to be looked at before a run begins, which is counted already.
    #[cold]
    #[inline(never)]
    pub fn look(&mut self, step: *const Step, cost: u64, sums: u64) -> Position {
        let place = self.place(step);
        // The look may change what is known of the cores, and with it the steps that are walked on.
        let (sums, begins) = self.fuel.look(self.plan, place, sums, cost);
        self.steps = self.plan.steps_of(self.fuel.is_held()).as_ptr();
        if begins {
            return Position { step: self.step(place), sums };
        }
        self.count.runs[place as usize].cut += 1;
        self.stop(Ended { stopped: Stopped::Bailout, place, sums, is_cut: false })
    }

    /// Stops behind the program's end.
    #[cold]
    #[inline(never)]
    pub fn halt(&mut self, at: Position) -> Position {
        let place = self.place(at.step);
        if O::IS_ACTIVE {
            self.tell(place, place, Motion::Jump);
        }
        self.stop(Ended { stopped: Stopped::Halt, place, sums: at.sums, is_cut: false })
    }

    /// The way on from a control row: one that its step knows, or to any word.
    #[inline(always)]
    pub fn turn<E: AnyOutcome>(
        &mut self,
        has_target: bool,
        now: &Step,
        step: *const Step,
        flow: Flow,
        exit: E,
    ) -> Turn {
        let number = now.exit as usize + exit.index();
        // Falling through is not counted: `FlowCounts::fold` finds it from the others.
        let is_falling = E::OUTCOMES > 1 && exit.index() == 0;
        if O::IS_ACTIVE {
            if E::OUTCOMES > 1 {
                self.pass_seen(number, false, 0);
            }
            let place = self.place(step);
            let next = match (is_falling, has_target) {
                (true, _) => place + 1,
                (false, true) => now.target,
                (false, false) => self.next_place(step, now, flow),
            };
            self.tell(place, next, flow.motion);
        }
        if is_falling {
            return Turn { step: step.wrapping_add(1), cost: now.edges[0] };
        }
        if has_target {
            self.count.take_exit(number);
            return Turn { step: self.step(now.target), cost: now.edges[1] };
        }
        self.way_to(self.next_place(step, now, flow))
    }

    /// The place of a word to which control goes. What leads to the next word leads to what stands behind it, also in a body.
    #[inline(always)]
    fn next_place(&self, step: *const Step, now: &Step, flow: Flow) -> u32 {
        if flow.next == now.slot + 1 { self.place(step) + 1 } else { self.plan.place_of(flow.next) }
    }

    /// The way on from a hop.
    #[inline(always)]
    pub fn hop(&mut self, now: &Step, step: *const Step) -> Turn {
        if O::IS_ACTIVE {
            let place = self.place(step);
            // A hop is no instruction: control leaves from the step before it.
            self.observer.walked(self.from..place);
            self.observer.go(self.plan.steps()[place as usize - 1].slot, now.slot, Motion::Jump);
            self.from = now.target;
        }
        self.count.take_exit(now.exit as usize);
        Turn { step: self.step(now.target), cost: now.edges[1] }
    }

    /// Executes an instruction with a meaning in Rust.
    pub fn unit(&mut self, registers: &mut Registers, step: *const Step, sums: u64, now: &Step) -> Position {
        let at = Position { step, sums };
        let Some(unit) = self.units.get_mut(now.unit) else { return self.stop_before(Stopped::Bailout, at) };
        let (plan, fuel, link) = (self.plan, &self.fuel, &mut *self.link);
        // Units ask for time only when they read, so it is worked out there.
        let mut read = |address, words: &mut [i32]| {
            note(plan, fuel, link, (now.slot, plan.place_of(now.slot)), sums);
            link.read(address, words)
        };
        let ending = match unit.execute(&now.fields, registers, self.buffer, &mut read, &Numbers::Nearest32) {
            Ok(ending) => ending,
            Err(Stop::Wait) => return self.stop_before(Stopped::Wait, at),
            Err(Stop::Fault(fault)) => return self.stop_before(Stopped::Fault(fault), at),
        };
        let exit = now.exit as usize + usize::from(ending.exit);
        let sums = self.pass_any(now, sums, exit, ending.units, now.exits > 1);
        // Only what may lead elsewhere ends a run, and knows where.
        let place = self.place(step);
        let has_target = now.target <= self.plan.end();
        let next = if ending.is_taken && has_target { now.target } else { place + 1 };
        let strays = ending.is_taken && next == self.plan.end();
        if !has_target && !strays {
            return self.go_on(Position { step, sums });
        }
        if O::IS_ACTIVE {
            self.tell(place, next, Motion::Jump);
        }
        if strays {
            let fault = Fault::OutsideProgram { words: self.plan.words };
            return self.stop(Ended { stopped: Stopped::Fault(fault), place: next, sums, is_cut: false });
        }
        let way = self.way_to(next);
        self.look(way.step, way.cost, sums)
    }

    /// Tells the link when it is asked.
    #[inline(always)]
    pub fn note(&mut self, at: Position, now: &Step) {
        let place = self.place(at.step);
        note(self.plan, &self.fuel, self.link, (now.slot, place), at.sums);
    }

    fn pass_seen(&mut self, exit: usize, is_only: bool, units: u32) {
        if let Some(pass) = self.plan.pass(exit) {
            self.observer.pass(pass, is_only, units);
        }
    }

    /// Counts what a straight row took, where that is not known beforehand, and yields the sums.
    #[inline(always)]
    pub fn pass<E: AnyOutcome>(&mut self, now: &Step, sums: u64, exit: E) -> u64 {
        let (number, units) = (now.exit as usize + exit.index(), exit.units());
        self.pass_any(now, sums, number, units, E::OUTCOMES > 1)
    }

    /// Count of an outcome, whatever the instruction.
    #[inline(always)]
    fn pass_any(&mut self, now: &Step, mut sums: u64, number: usize, units: u32, has_several: bool) -> u64 {
        if has_several {
            self.count.take_exit(number);
            if now.is_uneven {
                sums += self.plan.extra(number).0;
            }
            if O::IS_ACTIVE {
                self.pass_seen(number, false, 0);
            }
        }
        if units != 0 {
            self.count_units(number, units);
        }
        sums
    }

    fn count_units(&mut self, exit: usize, units: u32) {
        self.count.add_units(exit, units);
        if let Some(pass) = self.plan.pass(exit) {
            self.fuel.add_units(self.plan, pass, units);
        }
        if O::IS_ACTIVE {
            self.pass_seen(exit, true, units);
        }
    }
}

/// Tells a link when it is asked by a slot at a place.
#[inline(always)]
fn note(plan: &Plan, fuel: &Fuel, link: &mut impl TimedLink, (slot, place): (u32, u32), sums: u64) {
    let clocks = if link.keeps_time() { fuel.clocks_before(sums, plan.run_cost(place)) } else { 0 };
    link.note(RequestTime { pc: slot, clocks });
}
