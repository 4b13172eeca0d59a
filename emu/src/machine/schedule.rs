//! Steps all processors in the order of their clocks. Between two things that concern others a processor runs ahead by
//! itself; whatever concerns others happens in clock order, at equal clocks in a fixed one.

use std::ops::Range;
use std::sync::Arc;

use super::arbiter::NEVER;
use super::bus::{Bus, BusMasters};
use super::cache::Cache;
use super::course::BusCourse;
use super::finish::EndedRun;
use super::kinds::Kinds;
use super::outcome::Item;
use super::port::Shared;
use super::processor::{Act, Processor, ProcessorState, Work};
use super::request::{Access, Request};
use super::trace::{BusWatch, Spans};
use super::worker::{Executor, HandOver, ItemMaster, Worker};
use super::{RunFailure, Setup};
use crate::code::Code;
use crate::code::octets::{Buffer, Memory};
use crate::code::quantity::{Clocks, Octets};
use crate::code::trap::Fault;
use crate::engine::{CoreId, Demand, EngineRunner, Pause, choose};
use crate::profile::Observer;
use crate::semantics::Watch;

/// Runner of a program on a machine.
pub(super) fn runner_of<'a, T: Watch, O: Observer>(
    setup: &Setup,
    code: &'a Code<'a>,
    arithmetic: &T,
    buffer_octets: u32,
) -> EngineRunner<'a> {
    let demand = Demand::new(code, setup.options.wish(), arithmetic.computes(), buffer_octets);
    choose(&Demand { profile: setup.level::<O>(), ..demand })
}

/// Worker of the main processor, which executes its program on any machine.
pub(crate) fn main_worker<'a, T: Watch, O: Observer>(
    setup: &Setup,
    code: &'a Code<'a>,
    arithmetic: &'a T,
) -> Executor<'a, T, O> {
    let buffer_octets = setup.config.main.buffer_octets;
    let runner = runner_of::<T, O>(setup, code, arithmetic, buffer_octets);
    let initial = Arc::new(Buffer::new(&setup.main.buffer, buffer_octets));
    Executor::new(code, setup.main_id(), initial, runner, arithmetic, setup.level::<O>())
}

/// All processors, what they share, and what they have done so far.
pub(crate) struct Machine<'a, W: Worker> {
    pub setup: &'a Setup<'a>,
    /// The cores, then the main processor.
    pub processors: Vec<Processor<'a, W>>,
    pub shared: Shared,
    pub bus: Bus,
    /// Watcher of the bus, where somebody watches.
    pub bus_watch: Option<BusWatch>,
    pub course: Option<BusCourse>,
    pub kinds: Kinds,
    pub bypassed: Octets,
    /// Clock of the last thing that concerned others.
    pub now: Clocks,
    pub items: Vec<Item>,
    pub item_count: u64,
    pub has_main_halted: bool,
    /// Processors that wait at a barrier.
    pub meeting: usize,
    /// Instructions of the cores since the main processor last executed one.
    steps_without_main: u64,
    /// The masters of the bus, which go from transfer to transfer by themselves; none where somebody watches each transfer.
    pub masters: Option<BusMasters<W::Master>>,
    /// Octets that were written when the masters were told of it.
    written: Range<u64>,
    progress: &'a mut dyn FnMut(u64),
}

impl<'a, W: Worker> Machine<'a, W> {
    /// A machine before its first clock: its cores do what `core` makes for each of them, the main processor has the worker `main`. Codes are
    /// those of the cores and of the main processor.
    pub(crate) fn new(
        setup: &'a Setup<'a>,
        memory: Memory,
        [core_code, main_code]: [&'a Code<'a>; 2],
        core: impl Fn(CoreId) -> W,
        main: W,
        progress: &'a mut dyn FnMut(u64),
    ) -> Machine<'a, W> {
        let (config, cores) = (setup.config, setup.config.cores);
        let mut processors = Vec::with_capacity(cores as usize + 1);
        for number in 0..cores {
            let id = CoreId { core: number, cores, step_limit: config.step_limit };
            let mut processor = Processor::new(core_code, id, core(id));
            processor.cache = Cache::new(&config.cache, &setup.kinds);
            processors.push(processor);
        }
        let window = setup.options.window;
        let (fault, serves_itself) = (setup.options.grant_fault, window.is_none() && !setup.options.has_course);
        // Without traffic the main processor is no master, so no slot or turn of an arbiter is kept for it.
        let bus = Bus::new(&config.bus, config.protection.moved_bits(), cores + u32::from(config.main.traffic));
        // The main processor comes last: at equal clocks and acts a core goes first.
        processors.push(Processor::new(main_code, setup.main_id(), main));
        for processor in &mut processors {
            processor.spans = window.map(Spans::new);
        }
        Machine {
            setup,
            processors,
            shared: Shared::new(memory, cores + 1),
            bus: if serves_itself { bus.with_muted(fault) } else { bus.with_fault(fault) },
            bus_watch: window.map(|window| BusWatch::new(window, cores as usize + 1)),
            course: setup.options.has_course.then(BusCourse::default),
            kinds: Kinds::new(&setup.kinds),
            bypassed: Octets(0),
            now: Clocks(0),
            items: Vec::new(),
            item_count: 0,
            has_main_halted: false,
            meeting: 0,
            steps_without_main: 0,
            masters: serves_itself.then(|| BusMasters::new(cores + 1, config.cache.has_few_lines())),
            written: 0..0,
            progress,
        }
    }

    /// Runs to the end.
    ///
    /// # Errors
    /// A trap.
    pub(crate) fn run(mut self) -> Result<EndedRun, RunFailure> {
        self.begin();
        while self.step()? {}
        self.check_end()?;
        Ok(self.finish())
    }

    /// Number of the main processor.
    pub(super) fn main(&self) -> usize {
        self.processors.len() - 1
    }

    /// Starts every processor at clock 0.
    fn begin(&mut self) {
        let mut scratch = None;
        for number in 0..self.processors.len() {
            let (is_core, worker) = (number != self.main(), &self.processors[number].worker);
            let receives = is_core && worker.receives_first(&mut self.shared, &mut scratch);
            self.processors[number].begins_by_receiving = receives;
            self.start(number);
        }
    }

    /// Resets a processor at its clock and lets it run, or sleep where a message has to come first.
    pub(super) fn start(&mut self, number: usize) {
        let processor = &mut self.processors[number];
        if processor.begins_by_receiving && self.shared.mailboxes.next(number as u32).is_none() {
            processor.state = ProcessorState::Asleep;
            return;
        }
        processor.work = Work::new(processor.clock, &processor.used);
        processor.worker.restart();
        self.advance(number, false);
    }

    /// Lets a processor run up to the next thing that concerns others, and notes what that is. With permission, what it
    /// waits for is done first, at its clock.
    fn advance(&mut self, number: usize, is_permitted: bool) {
        self.run_on(number, is_permitted, false);
    }

    /// Run of a processor up to the next thing that concerns others; one that is ahead of its own transfer does that thing when the transfer has ended.
    fn run_on(&mut self, number: usize, is_permitted: bool, is_ahead: bool) {
        // What the main processor has done ahead it goes through step by step.
        let has_main_stepped = number == self.main() || self.processors[self.main()].worker.is_accounted();
        let steps_allowed = self.steps_allowed();
        let processor = &mut self.processors[number];
        // The clock and the request before the advance: what was permitted happens then, and the advance overwrites both.
        let (at, asked, used) = (processor.clock, processor.request, processor.used);
        let advance = processor.advance(&mut self.shared, is_permitted);
        self.steps_without_main = if has_main_stepped { 0 } else { self.steps_without_main + advance.steps };
        if let Some((message, _)) = advance.taken
            && processor.work.message.is_none()
        {
            let has_acted = processor.work.has_acted;
            processor.work = Work { message: Some(message), has_acted, ..Work::new(at, &used) };
        }
        // Cores could play on among themselves for ever while the main processor waits. Between two of its steps each of
        // them needs at most a work item.
        let pause = match advance.pause {
            Pause::Wait if self.steps_without_main > steps_allowed => {
                Pause::Fault(Fault::StepLimit(processor.core.step_limit))
            }
            pause => pause,
        };
        if is_ahead {
            processor.held = Some(pause);
        } else {
            self.settle(number, pause);
        }
        // Wake those who waited for it: what was permitted may be what another processor waits for.
        if let Some((_, sender)) = advance.taken {
            self.unblock(sender as usize, number as u32, at);
        }
        if let Some(Request::Send { to, .. }) = asked
            && is_permitted
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
                processor.state = ProcessorState::Blocked { to };
            }
            Some(Request::Transfer { .. } | Request::Send { .. }) => self.ask_for_transfer(number),
            Some(Request::Receive) => {
                processor.state = ProcessorState::Listens;
                self.listen(number);
            }
            Some(Request::Barrier) => {
                processor.state = ProcessorState::Meets;
                self.meeting += 1;
            }
            None => unreachable!("a link that says wait has noted what for"),
        }
    }

    /// Asks for the bus, or goes beside it where the main processor's traffic takes no time.
    pub(super) fn ask_for_transfer(&mut self, number: usize) {
        let main = self.main();
        let processor = &mut self.processors[number];
        processor.note_ask(&self.kinds);
        let is_to_main = matches!(processor.request, Some(Request::Send { to, .. }) if to as usize == main);
        if !self.setup.config.main.traffic && (number == main || is_to_main) {
            processor.act(Act::Bypass);
            return;
        }
        let mut octets = processor.asked_octets();
        // Only reads go through a cache, and only block loads of cores may be run ahead of.
        let mut is_ahead = false;
        if let Some(Request::Transfer { address, access: access @ (Access::Load | Access::Read), .. }) =
            processor.request
        {
            // A cache is asked once a request, since asking also brings lines in. What misses goes over the bus in whole lines.
            match processor.cache.as_mut().and_then(|cache| cache.read(address, octets)) {
                Some(Octets(0)) => return processor.act(Act::Hit),
                Some(filled) => octets = filled,
                None => {}
            }
            is_ahead = self.setup.config.bus.overlap && number != main && access == Access::Load;
        }
        processor.state = ProcessorState::Asks;
        if let Some(watch) = &mut self.bus_watch {
            watch.ask(number as u32, processor.request);
        }
        self.bus.request(number as u32, processor.clock, octets);
        let is_handed_over = self.masters.as_mut().is_some_and(|masters| {
            let written = &self.shared.written;
            let (clock, overlaps) = (processor.clock, self.setup.config.bus.overlap);
            let transfer = HandOver { clock, written, overlaps, cache: &mut processor.cache };
            processor.worker.hand_over(&mut masters.all[number], transfer)
        });
        if is_ahead && !is_handed_over {
            self.account(number);
            self.run_on(number, true, true);
        }
    }

    /// Adds what a processor has asked for to the totals, where those are not known already.
    fn account(&mut self, number: usize) {
        let processor = &mut self.processors[number];
        if processor.worker.is_accounted() {
            return;
        }
        processor.used.octets += processor.asked_octets();
        self.kinds.add(processor.worker.progress().pc, processor.request);
    }

    /// Does the next thing that concerns others; false when there is none.
    fn step(&mut self) -> Result<bool, RunFailure> {
        if self.meeting != 0 {
            self.leave_barrier();
        }
        // Find the next act: the earliest, at equal clocks by its kind, then by the processor's number
        let acts = self.processors.iter().enumerate().filter_map(|(number, processor)| match processor.state {
            ProcessorState::Acts { at, act } => Some((at, act, number)),
            _ => None,
        });
        let act = acts.min();
        // Nothing but decisions of the arbiter comes before the next act, as long as those wake nobody.
        let until = act.map_or(NEVER, |(at, ..)| at);
        if self.masters.is_some() {
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
        let Some(masters) = &mut self.masters else { return false };
        if self.written != self.shared.written {
            // Masters look only at recordings, so they have to be told of what might make those wrong.
            self.written = self.shared.written.clone();
            for number in 0..self.processors.len() {
                if masters.all[number].depends_on(&self.written) {
                    self.bus.go_back(masters, number as u32, self.now);
                    masters.all[number].stop_at(&self.written);
                }
            }
        }
        let Some(grant) = self.bus.serve(masters, until) else { return false };
        self.now = grant.start;
        let number = grant.master as usize;
        if self.processors[number].take_back(&mut masters.all[number], grant.end) {
            self.run_on(number, true, true);
        }
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
        self.course.iter_mut().for_each(|course| course.grant(self.setup.config.cores, &grant));
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

    fn act(&mut self, number: usize, at: Clocks, act: Act) -> Result<(), RunFailure> {
        self.now = at;
        let main = self.main();
        let processor = &mut self.processors[number];
        processor.idle_until(at);
        match act {
            Act::Bypass => {
                self.bypassed += processor.asked_octets();
                self.account(number);
                self.advance(number, true);
            }
            Act::Hit => {
                self.account(number);
                self.advance(number, true);
            }
            Act::Receive | Act::Leave => self.advance(number, true),
            Act::Halt if number == main => {
                processor.worker.end();
                processor.state = ProcessorState::Rests;
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
        processor.worker.end();
        processor.used.items += 1;
        self.item_count += 1;
        if self.setup.options.has_items {
            self.items.push(processor.item());
        }
        (self.progress)(self.item_count);
        // A message that is there already is work, also when the main processor has halted since.
        let has_letter = self.shared.mailboxes.next(number as u32).is_some();
        // A program that does nothing with the machine would start over for ever at the same clock.
        let is_going_on = !self.has_main_halted && (processor.begins_by_receiving || processor.work.has_acted);
        if has_letter || is_going_on {
            self.start(number);
        } else {
            processor.state = ProcessorState::Rests;
        }
    }
}
