//! Steps all processors in the order of their clocks. Between two things that concern others a processor runs ahead by
//! itself; whatever concerns others happens in clock order, at equal clocks in a fixed one.

use isa::Class;

use super::bus::Bus;
use super::frame::{Frame, Item};
use super::kinds::Kinds;
use super::mailbox::Mailboxes;
use super::processor::{Act, Processor, Standing, Work};
use super::station::{Request, Shared};
use super::{Failure, Setup};
use crate::checked::{Pause, Seat};
use crate::code::Code;
use crate::exec::Watch;
use crate::octets::Memory;
use crate::profile::{Observer, Profile};
use crate::quantity::{Clocks, Octets};
use crate::tally::Tally;
use crate::trap::{Fault, Trap};

/// Runs a frame on one arithmetic and with one kind of observer.
pub fn run<T: Watch, O: Observer>(
    setup: &Setup,
    memory: Memory,
    arithmetic: &T,
    progress: &mut dyn FnMut(u64),
) -> Result<Frame, Failure> {
    let timing = setup.config.timing();
    let core_code = Code::new(setup.core, setup.isa, timing);
    let main_code = Code::new(setup.main, setup.isa, timing);
    let mut machine: Machine<T, O> = Machine::new(setup, memory, &core_code, &main_code, arithmetic, progress);
    machine.begin();
    while machine.step()? {}
    machine.check_end()?;
    Ok(machine.finish(&core_code, &main_code))
}

struct Machine<'a, T, O> {
    setup: &'a Setup<'a>,
    arithmetic: &'a T,
    processors: Vec<Processor<'a, O>>,
    shared: Shared,
    bus: Bus,
    kinds: Kinds,
    aside: Octets,
    /// Clock of the last thing that concerned others.
    now: Clocks,
    items: Vec<Item>,
    item_count: u64,
    has_main_halted: bool,
    /// Processors that wait at a barrier.
    meeting: usize,
    /// Instructions of the cores since the main processor last executed one.
    steps_without_main: u64,
    progress: &'a mut dyn FnMut(u64),
}

impl<'a, T: Watch, O: Observer> Machine<'a, T, O> {
    fn new(
        setup: &'a Setup<'a>,
        memory: Memory,
        core_code: &'a Code<'a>,
        main_code: &'a Code<'a>,
        arithmetic: &'a T,
        progress: &'a mut dyn FnMut(u64),
    ) -> Machine<'a, T, O> {
        let config = setup.config;
        let cores = config.cores;
        let mut processors = Vec::with_capacity(cores as usize + 1);
        for core in 0..cores {
            let seat = Seat { core, cores, step_limit: config.step_limit };
            processors.push(Processor::new(core_code, seat, config.buffer_octets));
        }
        let seat = Seat { core: cores, cores, step_limit: config.main.step_limit };
        processors.push(Processor::new(main_code, seat, config.main.buffer_octets));
        Machine {
            setup,
            arithmetic,
            processors,
            shared: Shared { memory, mailboxes: Mailboxes::new(cores + 1) },
            bus: Bus::new(&config.bus, cores + 1),
            kinds: Kinds::new(&setup.kinds),
            aside: Octets(0),
            now: Clocks(0),
            items: Vec::new(),
            item_count: 0,
            has_main_halted: false,
            meeting: 0,
            steps_without_main: 0,
            progress,
        }
    }

    fn main(&self) -> usize {
        self.processors.len() - 1
    }

    /// Starts every processor at clock 0.
    fn begin(&mut self) {
        for number in 0..self.processors.len() {
            let receives = self.processors[number].probe(&mut self.shared, self.arithmetic);
            self.processors[number].begins_by_receiving = receives && number != self.main();
            self.start(number);
        }
    }

    /// Resets a processor at its clock and lets it run, or sleep where a message has to come first.
    fn start(&mut self, number: usize) {
        let processor = &mut self.processors[number];
        if processor.begins_by_receiving && self.shared.mailboxes.next(number as u32).is_none() {
            processor.standing = Standing::Asleep;
            return;
        }
        processor.work = Work::new(processor.clock);
        processor.state.begin(processor.code, &processor.initial);
        processor.observer.begin(processor.state.pc);
        self.advance(number, false);
    }

    /// Lets a processor run up to the next thing that concerns others, and notes what that is. With leave, what it
    /// waits for is done first, at its clock.
    fn advance(&mut self, number: usize, has_leave: bool) {
        let is_main = number == self.main();
        let steps_allowed = self.steps_allowed();
        let processor = &mut self.processors[number];
        let (at, asked) = (processor.clock, processor.request);
        let advance = processor.advance(&mut self.shared, self.arithmetic, has_leave);
        self.steps_without_main = if is_main { 0 } else { self.steps_without_main + advance.steps };
        if let Some((message, _)) = advance.taken
            && processor.work.subject.is_none()
        {
            (processor.work.subject, processor.work.start) = (Some(message.first()), at);
        }
        match advance.pause {
            Pause::Halt => processor.act(Act::Halt),
            Pause::Fault(fault) => processor.stop(fault),
            // Cores could play on among themselves for ever while the main processor waits. Between two of its steps
            // each of them needs at most a work item.
            Pause::Wait if self.steps_without_main > steps_allowed => {
                processor.stop(Fault::StepLimit(processor.seat.step_limit));
            }
            Pause::Wait => self.ask(number),
        }
        // What was done with the leave may be what another processor waits for.
        if let Some((_, sender)) = advance.taken {
            self.unblock(sender as usize, number as u32, at);
        }
        if let Some(Request::Send { to, .. }) = asked
            && has_leave
        {
            self.deliver(to as usize);
        }
    }

    /// Instructions that all cores together may execute between two steps of the main processor.
    fn steps_allowed(&self) -> u64 {
        self.setup.config.step_limit.saturating_mul(self.processors.len() as u64)
    }

    /// Notes what a processor waits for.
    fn ask(&mut self, number: usize) {
        let processor = &mut self.processors[number];
        match processor.request {
            Some(Request::Send { to, .. }) if self.shared.mailboxes.is_full(to, number as u32) => {
                processor.standing = Standing::Blocked { to };
            }
            Some(Request::Transfer { .. } | Request::Send { .. }) => self.ask_for_transfer(number),
            Some(Request::Receive) => {
                processor.standing = Standing::Listens;
                self.listen(number);
            }
            Some(Request::Barrier) => {
                processor.standing = Standing::Meets;
                self.meeting += 1;
            }
            None => unreachable!("a link that says wait has noted what for"),
        }
    }

    /// Asks for the bus, or goes beside it where the main processor's traffic takes no time.
    fn ask_for_transfer(&mut self, number: usize) {
        let main = self.main();
        let processor = &mut self.processors[number];
        let is_to_main = matches!(processor.request, Some(Request::Send { to, .. }) if to as usize == main);
        if !self.setup.config.main.traffic && (number == main || is_to_main) {
            processor.act(Act::Aside);
        } else {
            processor.standing = Standing::Asks;
            self.bus.request(number as u32, processor.clock, processor.asked_octets());
        }
    }

    /// Sets when a listening processor takes its next message, when there is one.
    fn listen(&mut self, number: usize) {
        let processor = &mut self.processors[number];
        if let Some((arrival, _)) = self.shared.mailboxes.next(number as u32) {
            processor.standing = Standing::Acts { at: arrival.max(processor.clock), act: Act::Receive };
        }
    }

    /// A message has come for a processor.
    fn deliver(&mut self, receiver: usize) {
        let is_main = receiver == self.main();
        match self.processors[receiver].standing {
            Standing::Listens | Standing::Acts { act: Act::Receive, .. } => self.listen(receiver),
            Standing::Asleep => self.start(receiver),
            Standing::Rests if !is_main => {
                if let Some((arrival, _)) = self.shared.mailboxes.next(receiver as u32) {
                    let processor = &mut self.processors[receiver];
                    processor.idle_until(arrival.max(processor.clock));
                }
                self.start(receiver);
            }
            _ => {}
        }
    }

    /// A receiver has emptied the mailbox that it has for a sender.
    fn unblock(&mut self, sender: usize, receiver: u32, at: Clocks) {
        let processor = &mut self.processors[sender];
        if processor.standing == (Standing::Blocked { to: receiver }) {
            processor.idle_until(at.max(processor.clock));
            self.ask_for_transfer(sender);
        }
    }

    /// Does the next thing that concerns others; false when there is none.
    fn step(&mut self) -> Result<bool, Failure> {
        if self.meeting != 0 {
            self.leave_barrier();
        }
        let acts = self.processors.iter().enumerate().filter_map(|(number, processor)| match processor.standing {
            Standing::Acts { at, act } => Some((at, act, number)),
            _ => None,
        });
        match (acts.min(), self.bus.next_decision()) {
            (Some((at, act, number)), decision) if decision.is_none_or(|clock| at <= clock) => {
                self.act(number, at, act)?;
            }
            (_, Some(clock)) => self.decide(clock),
            (_, None) => return Ok(false),
        }
        Ok(true)
    }

    /// Lets the arbiter choose, and the chosen one do what it waits for.
    fn decide(&mut self, clock: Clocks) {
        self.now = clock;
        let Some(grant) = self.bus.decide(clock) else { return };
        let number = grant.master as usize;
        let processor = &mut self.processors[number];
        processor.wait_until(grant.start, grant.end);
        processor.used.octets += processor.asked_octets();
        self.kinds.add(processor.request);
        self.advance(number, true);
    }

    fn act(&mut self, number: usize, at: Clocks, act: Act) -> Result<(), Failure> {
        self.now = at;
        let main = self.main();
        let processor = &mut self.processors[number];
        processor.idle_until(at);
        match act {
            Act::Aside => {
                let octets = processor.asked_octets();
                processor.used.octets += octets;
                self.aside += octets;
                self.kinds.add(processor.request);
                self.advance(number, true);
            }
            Act::Receive | Act::Leave => self.advance(number, true),
            Act::Halt if number == main => {
                processor.observer.end();
                processor.standing = Standing::Rests;
                self.has_main_halted = true;
            }
            Act::Halt => self.end_item(number),
            Act::Stop => return Err(self.trap(number).into()),
        }
        Ok(())
    }

    /// A core has halted: its work item is done, and it starts over where there may be more to do.
    fn end_item(&mut self, number: usize) {
        let processor = &mut self.processors[number];
        processor.observer.end();
        processor.used.items += 1;
        self.item_count += 1;
        if self.setup.options.has_items {
            self.items.push(Item {
                subject: processor.work.subject.unwrap_or_default(),
                core: number as u32,
                start: processor.work.start,
                end: processor.clock,
                instructions: processor.state.steps,
                elementary: processor.state.elementary,
            });
        }
        (self.progress)(self.item_count);
        let has_letter = self.shared.mailboxes.next(number as u32).is_some();
        // A program that does nothing with the machine would start over for ever at the same clock.
        let is_going_on = !self.has_main_halted && (processor.begins_by_receiving || processor.work.has_acted);
        if has_letter || is_going_on {
            self.start(number);
        } else {
            processor.standing = Standing::Rests;
        }
    }

    /// Lets all leave the barrier, when nobody is missing, at the clock at which the last one came or had no more to do.
    fn leave_barrier(&mut self) {
        let is_here = |processor: &Processor<O>| match processor.standing {
            Standing::Meets | Standing::Rests => true,
            // Nobody but the main processor begins work.
            Standing::Asleep | Standing::Listens => self.has_main_halted && processor.work.subject.is_none(),
            _ => false,
        };
        if !self.processors.iter().all(is_here) {
            return;
        }
        let meets = |processor: &&mut Processor<O>| processor.standing == Standing::Meets;
        let last = self.processors.iter_mut().filter(meets).map(|processor| processor.clock).max();
        let at = last.unwrap_or_default().max(self.now);
        for processor in self.processors.iter_mut().filter(meets) {
            processor.standing = Standing::Acts { at, act: Act::Leave };
        }
        self.meeting = 0;
    }

    /// The trap of a processor that stopped.
    fn trap(&self, number: usize) -> Trap {
        let processor = &self.processors[number];
        let kind = processor.fault.unwrap_or(Fault::Deadlock);
        let trap = Trap::new(kind, number as u32, processor.state.pc, processor.code.program);
        match processor.work.subject {
            Some([x, y, z]) => {
                trap.with_detail(format!("in the work item whose first message began with {x}, {y}, {z}"))
            }
            None => trap,
        }
    }

    /// Whether everybody has done what was begun.
    fn check_end(&self) -> Result<(), Failure> {
        let is_stuck = |number: usize| {
            let processor = &self.processors[number];
            match processor.standing {
                Standing::Rests | Standing::Asleep => false,
                // A core that waits without having received anything is out of work once the main processor is done.
                Standing::Listens | Standing::Blocked { .. } if number != self.main() => {
                    !self.has_main_halted || processor.work.subject.is_some()
                }
                _ => true,
            }
        };
        let mut stuck = (0..self.processors.len()).filter(|&number| is_stuck(number));
        let Some(first) = stuck.next() else { return Ok(()) };
        let others: Vec<String> =
            std::iter::once(first).chain(stuck).map(|number| self.processors[number].waits_for()).collect();
        Err(self.trap(first).with_detail(others.join(", ")).into())
    }

    fn finish(mut self, core_code: &Code, main_code: &Code) -> Frame {
        let clocks = self.processors.iter().map(|processor| processor.clock).max().unwrap_or_default();
        for processor in &mut self.processors {
            processor.idle_until(clocks);
        }
        self.items.sort_by_key(|item| (item.start, item.core));
        let used = self.processors.iter().map(|processor| processor.used).collect();
        let main = self.processors.pop().expect("a machine has a main processor");
        let mut tally = Tally::new(core_code);
        let mut profile: Option<Profile> = None;
        for processor in self.processors {
            tally.merge(&processor.tally);
            match (&mut profile, processor.observer.into_profile(core_code, &processor.tally)) {
                (Some(profile), Some(more)) => profile.merge(&more),
                (profile, more) => *profile = more,
            }
        }
        let asked = tally.counts(core_code)[Class::Octet] + main.tally.counts(main_code)[Class::Octet];
        Frame {
            clocks,
            processors: used,
            bus: self.bus.used(),
            asked: Octets(asked),
            aside: self.aside,
            kinds: self.kinds.into_totals(),
            memory: self.shared.memory,
            tally,
            main_profile: main.observer.into_profile(main_code, &main.tally),
            main_tally: main.tally,
            profile,
            items: self.items,
            item_count: self.item_count,
        }
    }
}
