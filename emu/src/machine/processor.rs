//! One processor of the machine: its state, what it waits for, and where its clocks went.

use super::bus::NextTransfer;
use super::cache::Cache;
use super::kinds::Kinds;
use super::outcome::{Item, ProcessorUse};
use super::port::Shared;
use super::request::Request;
use super::trace::{Doing, Spans};
use super::worker::{Advance, Played, Progress, Worker};
use crate::code::Code;
use crate::code::quantity::{Clocks, Octets};
use crate::code::trap::Fault;
use crate::engine::{CoreId, Pause};
use crate::semantics::Message;

/// Act of a processor without the bus, at its own clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Act {
    /// Octets move beside the bus.
    Bypass,
    /// Reading what its cache holds.
    Hit,
    /// A message is taken.
    Receive,
    /// A barrier is left.
    Leave,
    /// The program has halted.
    Halt,
    /// The machine stops.
    Stop,
}

/// State of a processor between two things that concern others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProcessorState {
    /// Between two work items, the first thing of the next one being a receive: a message wakes it.
    Asleep,
    /// Waiting for the bus.
    Asks,
    /// About to do something at its own clock, or later.
    Acts {
        /// Clock of the act.
        at: Clocks,
        /// Kind of the act.
        act: Act,
    },
    /// Waiting until the mailbox that this receiver has for it is free.
    Blocked {
        /// The receiver.
        to: u32,
    },
    /// Waiting for a message.
    Listens,
    /// Waiting for the others at a barrier.
    Meets,
    /// Halted, not to start again unless a message comes.
    Rests,
}

/// The work item that a core is at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Work {
    /// Clock at which it was begun.
    pub start: Clocks,
    /// First message of the item; `None` before that.
    pub message: Option<Message>,
    /// The bus, a mailbox or a barrier has been used.
    pub has_acted: bool,
    /// Waiting of the processor before it.
    pub waiting_before: Clocks,
    /// Octets that the processor moved before it.
    pub octets_before: Octets,
}

impl Work {
    /// Nothing received yet.
    pub fn new(start: Clocks, used: &ProcessorUse) -> Work {
        let (waiting_before, octets_before) = (used.waiting, used.octets);
        Work { start, message: None, has_acted: false, waiting_before, octets_before }
    }
}

/// One processor.
pub struct Processor<'a, W> {
    /// Program of the processor.
    pub code: &'a Code<'a>,
    /// Number of the processor, and how long a work item may be.
    pub core: CoreId,
    /// Whoever does its work.
    pub worker: W,
    /// Clock of the processor.
    pub clock: Clocks,
    /// State of the processor.
    pub state: ProcessorState,
    /// Request that was made last.
    pub request: Option<Request>,
    /// Pause of its engine, while a block load that it does not wait for is on its way: what comes next begins when
    /// that has ended.
    pub held: Option<Pause>,
    /// Cache of the processor.
    pub cache: Option<Cache>,
    /// Spans of what it does, where that is watched.
    pub spans: Option<Spans>,
    /// Fault that stopped it.
    pub fault: Option<Fault>,
    /// Clocks by use.
    pub used: ProcessorUse,
    /// The work item that it is at.
    pub work: Work,
    /// The first thing that its program does outside itself is a receive.
    pub begins_by_receiving: bool,
}

impl<'a, W: Worker> Processor<'a, W> {
    /// A processor after reset, with whoever does its work.
    pub fn new(code: &'a Code<'a>, core: CoreId, worker: W) -> Processor<'a, W> {
        Processor {
            code,
            core,
            worker,
            clock: Clocks(0),
            state: ProcessorState::Asleep,
            request: None,
            held: None,
            cache: None,
            spans: None,
            fault: None,
            used: ProcessorUse::default(),
            work: Work::new(Clocks(0), &ProcessorUse::default()),
            begins_by_receiving: false,
        }
    }

    /// The work item that has ended at its clock.
    pub fn item(&self) -> Item {
        let Progress { steps, elementary, .. } = self.worker.progress();
        Item {
            subject: self.work.message.map_or([0; 3], |message| message.first()),
            message: self.work.message.filter(|_| self.spans.is_some()).map(Box::new),
            core: self.core.core,
            start: self.work.start,
            end: self.clock,
            waiting: self.used.waiting - self.work.waiting_before,
            octets: self.used.octets - self.work.octets_before,
            instructions: steps,
            elementary,
        }
    }

    /// Goes on up to the next thing that concerns others, with permission for the one that it waits for, done at the processor's clock, or
    /// without.
    pub fn advance(&mut self, shared: &mut Shared, is_permitted: bool) -> Advance {
        let advance = self.worker.advance(shared, is_permitted.then_some(self.clock));
        self.request = advance.request;
        self.used.octets += advance.octets;
        self.spend(advance.clocks, advance.steps, is_permitted);
        advance
    }

    /// Takes back what its master of the bus went on to, up to a transfer that ended at a clock; true where it is ahead of that transfer and
    /// has to go on from its own clock.
    pub(super) fn take_back(&mut self, master: &mut W::Master, end: Clocks) -> bool {
        self.used.longest_wait = self.used.longest_wait.max(master.take_longest_wait());
        let Some(Played { busy, waiting, clock, is_ahead }) = self.worker.take_back(master, end, &mut self.cache)
        else {
            return false;
        };
        self.used.busy += busy;
        self.used.waiting += waiting;
        self.clock = clock;
        self.work.has_acted = true;
        is_ahead
    }

    /// Notes what it does from its clock on.
    #[inline]
    fn note(&mut self, doing: Doing, until: Clocks) {
        if let Some(spans) = &mut self.spans {
            spans.add(doing, self.clock, until);
        }
    }

    /// Computes for some clocks.
    fn spend(&mut self, clocks: u64, steps: u64, is_permitted: bool) {
        self.note(Doing::Busy, self.clock + Clocks(clocks));
        self.clock += Clocks(clocks);
        self.used.busy += Clocks(clocks);
        self.used.instructions += steps;
        self.work.has_acted |= is_permitted;
    }

    /// Does nothing until a clock.
    pub fn idle_until(&mut self, clock: Clocks) {
        self.note(Doing::Idle, clock);
        self.used.idle += clock - self.clock;
        self.clock = clock;
    }

    /// Waits for a transfer until it has ended, if it has not yet.
    pub fn wait_until(&mut self, end: Clocks) {
        let end = end.max(self.clock);
        self.note(Doing::Waiting, end);
        self.used.waiting += end - self.clock;
        self.worker.note_wait(end - self.clock);
        self.clock = end;
    }

    /// Notes that it asks for a transfer.
    pub fn note_ask(&mut self, kinds: &Kinds) {
        if let Some(request) = self.request {
            self.worker.note_ask(request, self.asked_octets(), kinds);
        }
    }

    /// Octets of the transfer that it asked for.
    pub fn asked_octets(&self) -> Octets {
        match self.request {
            Some(Request::Transfer { octets, .. } | Request::Send { octets, .. }) => octets,
            _ => Octets(0),
        }
    }

    /// Something is next that needs no bus, at its clock.
    pub fn act(&mut self, act: Act) {
        self.state = ProcessorState::Acts { at: self.clock, act };
    }

    /// Stop by a fault at its clock.
    pub fn stop(&mut self, fault: Fault) {
        self.fault = Some(fault);
        self.act(Act::Stop);
    }

    /// Description of what it waits for, for a message about a deadlock.
    pub fn waits_for(&self) -> String {
        let what = match self.state {
            ProcessorState::Blocked { to } => format!("waits until core {to} takes its last message"),
            ProcessorState::Listens => "waits for a message".to_owned(),
            ProcessorState::Meets => "waits at a barrier".to_owned(),
            _ => "has more to do".to_owned(),
        };
        let place = self
            .code
            .program
            .place(self.code.word(self.worker.progress().pc))
            .map_or(String::new(), |place| format!(" at {place}"));
        format!("core {} {what}{place}", self.core.core)
    }
}
