//! Steps all processors in the order of their clocks. Between two things that concern others a processor runs ahead by
//! itself; whatever concerns others happens in clock order, at equal clocks in a fixed one.

use std::ops::Range;

use super::arbiter::NEVER;
use super::bus::Bus;
use super::cache::Cache;
use super::ending::Ending;
use super::frame::{Frame, Item};
use super::kinds::Kinds;
use super::library::Library;
use super::processor::{Act, Processor, Standing, Work};
use super::reel::Reel;
use super::station::{Access, Request, Shared};
use super::tape::Tape;
use super::trace::{BusWatch, Spans};
use super::{Failure, Setup};
use crate::code::Code;
use crate::engine::{Demand, EngineKind, Pause, Seat, Wish, choose};
use crate::exec::Watch;
use crate::octets::Memory;
use crate::profile::RunObserver;
use crate::quantity::{Clocks, Octets};
use crate::trap::Fault;

/// Runs a frame on one arithmetic and with one kind of observer. With recorded work items the cores replay them; their
/// counts are then missing from the frame.
pub fn run<T: Watch, O: RunObserver>(
    setup: &Setup,
    memory: Memory,
    arithmetic: &T,
    library: Option<Library>,
    progress: &mut dyn FnMut(u64),
) -> Result<Frame, Ending> {
    let timing = setup.config.timing();
    let core_code = Code::new(setup.core, setup.isa, timing);
    let main_code = Code::new(setup.main, setup.isa, timing);
    let shared = Shared::new(memory, setup.config.cores + 1, library);
    let mut machine: Machine<T, O> = Machine::new(setup, shared, &core_code, &main_code, arithmetic, progress);
    let done = machine.run();
    if let Some(library) = &mut machine.shared.library {
        if done.is_ok() && library.lost.is_none() && !library.is_used_up() {
            library.lose::<()>("the main processor hands out other work than it would to many cores");
        }
        if let Some(reason) = library.lost {
            return Err(Ending::Lost(reason));
        }
    }
    done.map_err(Ending::Failure)?;
    Ok(machine.finish(&core_code, &main_code))
}

/// All processors, what they share, and what they have done so far.
pub(super) struct Machine<'a, T, O> {
    pub setup: &'a Setup<'a>,
    arithmetic: &'a T,
    /// The cores, then the main processor.
    pub processors: Vec<Processor<'a, O>>,
    pub shared: Shared,
    pub bus: Bus,
    /// Who watches the bus, where somebody does.
    pub bus_watch: Option<BusWatch>,
    pub kinds: Kinds,
    pub aside: Octets,
    /// Clock of the last thing that concerned others.
    pub now: Clocks,
    pub items: Vec<Item>,
    pub item_count: u64,
    pub has_main_halted: bool,
    /// Processors that wait at a barrier.
    pub meeting: usize,
    /// Instructions of the cores since the main processor last executed one.
    steps_without_main: u64,
    /// What the masters of the bus play by themselves, where a recorded transfer is nothing but a transfer: no cache, no overlap, nobody who
    /// watches.
    reels: Option<Vec<Reel>>,
    /// Octets that were written when the reels were looked at.
    written: Range<u64>,
    progress: &'a mut dyn FnMut(u64),
}

impl<'a, T: Watch, O: RunObserver> Machine<'a, T, O> {
    fn new(
        setup: &'a Setup<'a>,
        shared: Shared,
        core_code: &'a Code<'a>,
        main_code: &'a Code<'a>,
        arithmetic: &'a T,
        progress: &'a mut dyn FnMut(u64),
    ) -> Machine<'a, T, O> {
        let config = setup.config;
        let cores = config.cores;
        let mut processors = Vec::with_capacity(cores as usize + 1);
        // Who replays executes nothing.
        let Wish { kind, simd } = setup.options.wish();
        let core_kind = if shared.library.is_none() { kind } else { EngineKind::Checked };
        let runner = |kind, code| {
            choose(kind, &Demand { code, simd, is_default_arithmetic: !T::IS_WATCHING, follows_cores: false })
        };
        let core_runner = runner(core_kind, core_code);
        for core in 0..cores {
            let seat = Seat { core, cores, step_limit: config.step_limit };
            let mut processor = Processor::new(core_code, seat, config.buffer_octets, core_runner.clone());
            processor.tape = shared.library.is_some().then(Tape::default);
            processor.cache = Cache::new(&config.cache, &setup.kinds);
            processors.push(processor);
        }
        let window = setup.options.window;
        let seat = Seat { core: cores, cores, step_limit: config.main.step_limit };
        processors.push(Processor::new(main_code, seat, config.main.buffer_octets, runner(kind, main_code)));
        for processor in &mut processors {
            processor.spans = window.map(Spans::new);
        }
        Machine {
            setup,
            arithmetic,
            processors,
            shared,
            bus: Bus::new(&config.bus, cores + u32::from(config.main.traffic)),
            bus_watch: window.map(|window| BusWatch::new(window, cores as usize + 1)),
            kinds: Kinds::new(&setup.kinds),
            aside: Octets(0),
            now: Clocks(0),
            items: Vec::new(),
            item_count: 0,
            has_main_halted: false,
            meeting: 0,
            steps_without_main: 0,
            reels: (config.cache.octets == 0 && !config.bus.overlap && window.is_none())
                .then(|| (0..=cores).map(|_| Reel::default()).collect()),
            written: 0..0,
            progress,
        }
    }

    /// Runs to the end.
    fn run(&mut self) -> Result<(), Failure> {
        self.begin();
        while self.step()? {}
        self.check_end()
    }

    /// Number of the main processor.
    pub(super) fn main(&self) -> usize {
        self.processors.len() - 1
    }

    /// Starts every processor at clock 0.
    fn begin(&mut self) {
        for number in 0..self.processors.len() {
            // What was recorded begins with a message.
            let processor = &self.processors[number];
            let receives = processor.tape.is_some() || processor.probe(&mut self.shared, self.arithmetic);
            self.processors[number].begins_by_receiving = receives && number != self.main();
            self.start(number);
        }
    }

    /// Resets a processor at its clock and lets it run, or sleep where a message has to come first.
    pub(super) fn start(&mut self, number: usize) {
        let processor = &mut self.processors[number];
        if processor.begins_by_receiving && self.shared.mailboxes.next(number as u32).is_none() {
            processor.standing = Standing::Asleep;
            return;
        }
        processor.work = Work::new(processor.clock);
        processor.restart();
        self.advance(number, false);
    }

    /// Lets a processor run up to the next thing that concerns others, and notes what that is. With leave, what it
    /// waits for is done first, at its clock.
    fn advance(&mut self, number: usize, has_leave: bool) {
        self.run_on(number, has_leave, false);
    }

    /// The same; who runs ahead of its own transfer does the next thing when that has ended.
    fn run_on(&mut self, number: usize, has_leave: bool, is_ahead: bool) {
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
        // Cores could play on among themselves for ever while the main processor waits. Between two of its steps each of
        // them needs at most a work item.
        let pause = match advance.pause {
            Pause::Wait if self.steps_without_main > steps_allowed => {
                Pause::Fault(Fault::StepLimit(processor.seat.step_limit))
            }
            pause => pause,
        };
        if is_ahead {
            processor.held = Some(pause);
        } else {
            self.settle(number, pause);
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

    /// Notes why an engine has stopped.
    fn settle(&mut self, number: usize, pause: Pause) {
        let processor = &mut self.processors[number];
        match pause {
            Pause::Halt => processor.act(Act::Halt),
            Pause::Fault(fault) => processor.stop(fault),
            Pause::Wait => self.ask(number),
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
    pub(super) fn ask_for_transfer(&mut self, number: usize) {
        let main = self.main();
        let processor = &mut self.processors[number];
        let is_to_main = matches!(processor.request, Some(Request::Send { to, .. }) if to as usize == main);
        if !self.setup.config.main.traffic && (number == main || is_to_main) {
            processor.act(Act::Aside);
            return;
        }
        let mut octets = processor.asked_octets();
        let mut is_ahead = false;
        if let Some(Request::Transfer { address, access: access @ (Access::Load | Access::Read), .. }) =
            processor.request
        {
            match processor.cache.as_mut().and_then(|cache| cache.read(address, octets)) {
                Some(Octets(0)) => return processor.act(Act::Hit),
                Some(filled) => octets = filled,
                None => {}
            }
            is_ahead = self.setup.config.bus.overlap && number != main && access == Access::Load;
        }
        processor.standing = Standing::Asks;
        if let Some(watch) = &mut self.bus_watch {
            watch.ask(number as u32, processor.request);
        }
        self.bus.request(number as u32, processor.clock, octets);
        if let Some(reels) = &mut self.reels {
            processor.wind(&mut reels[number], &self.shared, &self.bus.lengths);
        }
        if is_ahead {
            self.account(number);
            self.run_on(number, true, true);
        }
    }

    /// Adds what a processor has asked for to the totals; of recorded work items they are known already.
    fn account(&mut self, number: usize) {
        let processor = &mut self.processors[number];
        if processor.tape.is_some() {
            return;
        }
        processor.used.octets += processor.asked_octets();
        self.kinds.add(processor.state.pc, processor.request);
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
        let act = acts.min();
        // Nothing but decisions of the arbiter comes before the next act, as long as those wake nobody.
        let until = act.map_or(NEVER, |(at, ..)| at);
        if self.reels.is_some() {
            if self.play(until) {
                return Ok(true);
            }
        } else {
            while let Some(clock) = self.bus.next_decision().filter(|&clock| clock < until) {
                if self.decide(clock) {
                    return Ok(true);
                }
            }
        }
        let Some((at, act, number)) = act else { return Ok(false) };
        self.act(number, at, act)?;
        Ok(true)
    }

    /// Lets the arbiter choose before a clock, and the chosen ones do what they wait for; true when anyone but the arbiter may have something to
    /// do now.
    fn play(&mut self, until: Clocks) -> bool {
        let Some(reels) = &mut self.reels else { return false };
        if self.written != self.shared.written {
            self.written = self.shared.written.clone();
            reels.iter_mut().for_each(|reel| reel.stop_at(&self.written));
        }
        let Some(grant) = self.bus.serve(reels, until) else { return false };
        self.now = grant.start;
        let number = grant.master as usize;
        self.processors[number].unwind(&mut reels[number], grant.end);
        self.end_transfer(number, grant.end);
        true
    }

    /// Lets the arbiter choose at a clock, and the chosen one do what it waits for; true when anyone but the arbiter may have something to do now.
    fn decide(&mut self, clock: Clocks) -> bool {
        self.now = clock;
        let Some(grant) = self.bus.decide(clock) else { return false };
        if let Some(watch) = &mut self.bus_watch {
            watch.grant(&grant);
        }
        let number = grant.master as usize;
        let processor = &mut self.processors[number];
        processor.used.longest_wait = processor.used.longest_wait.max(grant.waited);
        if grant.is_last {
            self.end_transfer(number, grant.end);
        }
        grant.is_last
    }

    /// A processor's transfer ends at a clock, and it does what it waits for.
    fn end_transfer(&mut self, number: usize, end: Clocks) {
        let processor = &mut self.processors[number];
        processor.wait_until(end);
        match processor.held.take() {
            Some(pause) => self.settle(number, pause),
            None => {
                self.account(number);
                self.advance(number, true);
            }
        }
    }

    fn act(&mut self, number: usize, at: Clocks, act: Act) -> Result<(), Failure> {
        self.now = at;
        let main = self.main();
        let processor = &mut self.processors[number];
        processor.idle_until(at);
        match act {
            Act::Aside => {
                self.aside += processor.asked_octets();
                self.account(number);
                self.advance(number, true);
            }
            Act::Hit => {
                self.account(number);
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
}
