//! Work of a processor: who does it, and what the machine has to know of that. [`Executor`] executes the processor's program.

use std::ops::Range;
use std::sync::Arc;

use super::bus::NextTransfer;
use super::cache::Cache;
use super::kinds::Kinds;
use super::port::{CorePort, Shared};
use super::request::Request;
use crate::code::Code;
use crate::code::octets::Buffer;
use crate::code::quantity::{Clocks, Octets};
use crate::code::tally::Tally;
use crate::engine::{Choice, CoreId, EngineRunner, Pause, State, TimedLink, Timeless, interpreter};
use crate::profile::{ClockKeys, ClockLog, Observer, Profile, ProfileLevel, TransferMeter, Unobserved};
use crate::semantics::{Message, Watch};

/// One advance of a worker: what it did, and what it waits for now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Advance {
    /// Reason for which it stopped.
    pub pause: Pause,
    /// The request that it waits for, where it stopped to wait.
    pub request: Option<Request>,
    /// The message that it took, and its sender.
    pub taken: Option<(Message, u32)>,
    /// Clocks of computing.
    pub clocks: u64,
    /// Instructions executed.
    pub steps: u64,
    /// Octets of transfers still to come, where a worker knows them beforehand: those [are accounted](Worker::is_accounted).
    pub octets: Octets,
}

/// Progress of a work item.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Progress {
    /// Slot of the next instruction.
    pub pc: u32,
    /// Instructions executed since its reset.
    pub steps: u64,
    /// Elementary operations of those.
    pub elementary: u64,
}

/// Clocks of a worker in which it was a master of the bus by itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Played {
    /// Clocks of computing.
    pub busy: Clocks,
    /// Clocks of waiting for transfers.
    pub waiting: Clocks,
    /// Clock of the core: the end of its last transfer, or the beginning of one that it does not wait for.
    pub clock: Clocks,
    /// The last transfer is a load beside which it goes on computing.
    pub is_ahead: bool,
}

/// Transfer with which a worker may hand its work item over to its master.
pub struct HandOver<'a> {
    /// Clock at which it is asked for.
    pub clock: Clocks,
    /// Part of global memory that was written so far.
    pub written: &'a Range<u64>,
    /// Workers go on computing while their loads are on their way.
    pub overlaps: bool,
    /// Cache of the processor, which goes with the work item.
    pub cache: &'a mut Option<Cache>,
}

/// Master that may hold the work item of a worker.
pub trait ItemMaster: NextTransfer {
    /// True where what it goes on to may depend on what was written.
    fn depends_on(&self, written: &Range<u64>) -> bool {
        let _ = written;
        false
    }

    /// Makes one that depends on what was written stop after the transfer that it asks for.
    fn stop_at(&mut self, written: &Range<u64>) {
        let _ = written;
    }
}

/// Whoever does the work of a processor, item after item.
pub trait Worker {
    /// The worker as a master of the bus, where it can go from transfer to transfer by itself.
    type Master: ItemMaster;

    /// Goes on up to the next thing that concerns others. With permission, what the worker waits for is done first, at that clock.
    fn advance(&mut self, shared: &mut Shared, permission: Option<Clocks>) -> Advance;

    /// Starts the next work item from reset.
    fn restart(&mut self);

    /// Is told that the work item is over.
    fn end(&mut self);

    /// Progress of the work item.
    fn progress(&self) -> Progress;

    /// True where the first thing that a work item does outside itself is a receive; finding out takes a state, which workers of the same program
    /// hand on to each other.
    fn receives_first(&self, shared: &mut Shared, scratch: &mut Option<State>) -> bool;

    /// True where the octets of what it asks for now are known already, so that the machine does not add them up.
    fn is_accounted(&self) -> bool;

    /// Hands the work item over to its master when a transfer is asked for, where nothing but the bus is needed for what comes next; true where
    /// that is done.
    fn hand_over(&mut self, master: &mut Self::Master, transfer: HandOver) -> bool;

    /// Notes that the processor asks for a transfer of octets by the worker's last request, where clocks of functions are measured.
    fn note_ask(&mut self, request: Request, octets: Octets, kinds: &Kinds);

    /// Notes a wait for what was asked for last.
    fn note_wait(&mut self, clocks: Clocks);

    /// Takes the work item back, and the cache, when the last transfer that its master went on to has ended at a clock; `None` where it was not
    /// handed over.
    fn take_back(&mut self, master: &mut Self::Master, end: Clocks, cache: &mut Option<Cache>) -> Option<Played>;

    /// Everything that was counted of its program.
    fn into_counts(self) -> WorkerCounts;
}

/// Counts of a worker.
pub struct WorkerCounts {
    /// Passes of its program.
    pub tally: Tally,
    /// Functions and regions, where they were measured.
    pub profile: Option<Profile>,
    /// Clocks of those, where they were measured.
    pub clocks: Option<ClockLog>,
    /// Meaning of the numbers in that, where the worker knows it.
    pub keys: Option<ClockKeys>,
    /// Octets by kind of what the machine did not add up.
    pub kinds: Option<Kinds>,
}

/// Master that goes on to nothing by itself.
#[derive(Clone, Debug, Default)]
pub struct PlainMaster {
    longest_wait: Clocks,
}

impl ItemMaster for PlainMaster {}

impl NextTransfer for PlainMaster {
    fn next_transfer(&mut self, _: Clocks) -> Option<(Clocks, Octets)> {
        None
    }

    fn note_wait(&mut self, waited: Clocks) {
        self.longest_wait = self.longest_wait.max(waited);
    }

    fn longest_wait(&self) -> Clocks {
        self.longest_wait
    }

    fn take_longest_wait(&mut self) -> Clocks {
        std::mem::take(&mut self.longest_wait)
    }
}

/// Worker that executes a program on an engine.
pub struct Executor<'a, T, O> {
    code: &'a Code<'a>,
    core: CoreId,
    runner: EngineRunner<'a>,
    arithmetic: &'a T,
    initial: Arc<Buffer>,
    tally: Tally,
    /// Meter of its transfers, where clocks of functions are measured.
    meter: Option<Box<TransferMeter>>,
    /// State that the program sees.
    pub state: State,
    /// Observer of the program.
    pub observer: O,
}

impl<'a, T: Watch, O: Observer> Executor<'a, T, O> {
    /// A worker before its first item, whose buffer is then as at first; it has none of its own before that.
    pub fn new(
        code: &'a Code<'a>,
        core: CoreId,
        initial: Arc<Buffer>,
        runner: EngineRunner<'a>,
        arithmetic: &'a T,
        level: ProfileLevel,
    ) -> Executor<'a, T, O> {
        Executor {
            code,
            core,
            runner,
            arithmetic,
            tally: Tally::new(code),
            meter: (level == ProfileLevel::Clocks).then(Box::default),
            state: State::new(code, Buffer::unallocated()),
            initial,
            observer: O::new(code, level),
        }
    }

    /// The engine that executes its program.
    pub fn engine(&self) -> Choice {
        self.runner.choice()
    }

    /// Runs up to the next thing that concerns others, or that the link makes wait; yields why it stopped, and the clocks and instructions that
    /// took.
    pub(crate) fn run(&mut self, link: &mut impl TimedLink) -> (Pause, u64, u64) {
        let (clocks, steps) = (self.state.clocks, self.state.steps);
        let (state, tally, observer) = (&mut self.state, &mut self.tally, &mut self.observer);
        let pause = self.runner.run_timed(self.core, state, self.arithmetic, link, tally, observer);
        (pause, self.state.clocks - clocks, self.state.steps - steps)
    }

    /// Meter of its transfers, where clocks of functions are measured.
    pub(crate) fn meter(&mut self) -> Option<&mut TransferMeter> {
        self.meter.as_deref_mut()
    }

    /// The passes of its program so far.
    pub fn take_tally(&mut self) -> Tally {
        // Its links are told of all reads.
        self.runner.fold(&mut self.tally, &mut |_, _| {}, self.observer.profiler());
        std::mem::replace(&mut self.tally, Tally::new(self.code))
    }
}

impl<T: Watch, O: Observer> Worker for Executor<'_, T, O> {
    type Master = PlainMaster;

    fn advance(&mut self, shared: &mut Shared, permission: Option<Clocks>) -> Advance {
        let mut port = CorePort::new(shared, self.core.core, permission);
        let (pause, clocks, steps) = self.run(&mut Timeless(&mut port));
        Advance { pause, request: port.request, taken: port.taken, clocks, steps, octets: Octets(0) }
    }

    fn restart(&mut self) {
        self.state.begin(self.code, &self.initial);
        self.observer.begin(self.state.pc);
    }

    fn end(&mut self) {
        self.observer.end();
    }

    fn progress(&self) -> Progress {
        let State { pc, steps, elementary, .. } = self.state;
        Progress { pc, steps, elementary }
    }

    /// The program runs for that, and is not counted.
    fn receives_first(&self, shared: &mut Shared, scratch: &mut Option<State>) -> bool {
        let state = scratch.get_or_insert_with(|| State::new(self.code, Buffer::unallocated()));
        state.begin(self.code, &self.initial);
        let mut port = CorePort::new(shared, self.core.core, None);
        let (mut tally, nobody) = (Tally::new(self.code), &mut Unobserved);
        let pause = interpreter::run(self.code, self.core, state, self.arithmetic, &mut port, &mut tally, nobody);
        pause == Pause::Wait && port.request == Some(Request::Receive)
    }

    fn is_accounted(&self) -> bool {
        false
    }

    fn hand_over(&mut self, _: &mut PlainMaster, _: HandOver) -> bool {
        false
    }

    fn note_ask(&mut self, request: Request, octets: Octets, kinds: &Kinds) {
        if let (Some(meter), Some(profiler)) = (&mut self.meter, self.observer.profiler()) {
            let (context, pc) = (profiler.contexts.current(), self.state.pc);
            let site = kinds.site(&mut meter.table, context, pc, request);
            meter.ask(site, octets, profiler.contexts.crowded_around(pc));
        }
    }

    fn note_wait(&mut self, clocks: Clocks) {
        if let Some(meter) = &mut self.meter {
            meter.wait(clocks);
        }
    }

    fn take_back(&mut self, _: &mut PlainMaster, _: Clocks, _: &mut Option<Cache>) -> Option<Played> {
        None
    }

    fn into_counts(mut self) -> WorkerCounts {
        let tally = self.take_tally();
        let (mut clocks, mut keys) = (None, None);
        if let (Some(meter), Some(profiler)) = (self.meter.take(), self.observer.profiler()) {
            let contexts = &profiler.contexts;
            keys = Some(ClockKeys { paths: contexts.paths().cloned().collect(), sites: meter.table.all().to_vec() });
            clocks = Some(meter.into_log(contexts));
        }
        WorkerCounts { profile: self.observer.into_profile(self.code, &tally), tally, clocks, keys, kinds: None }
    }
}
