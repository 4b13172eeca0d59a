//! One processor of the machine: its state, what it waits for, and where its clocks went.

use isa::number::Vector;

use super::bus::NextTransfer;
use super::cache::Cache;
use super::outcome::ProcessorUse;
use super::port::Shared;
use super::request::Request;
use super::trace::{Doing, Spans};
use super::worker::{Advance, Played, Worker};
use crate::code::Code;
use crate::code::quantity::{Clocks, Octets};
use crate::code::trap::Fault;
use crate::engine::{CoreId, Pause};

/// What a processor does without the bus, at its own clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Act {
    /// It moves octets beside the bus.
    Bypass,
    /// It reads what its cache holds.
    Hit,
    /// It takes a message.
    Receive,
    /// It leaves a barrier.
    Leave,
    /// It has halted.
    Halt,
    /// It stops the machine.
    Stop,
}

/// What a processor is at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProcessorState {
    /// Between two work items, the first thing of the next one being a receive: a message wakes it.
    Asleep,
    /// It waits for the bus.
    Asks,
    /// It does something at its own clock, or later.
    Acts {
        /// When.
        at: Clocks,
        /// What.
        act: Act,
    },
    /// It waits until the mailbox that this receiver has for it is free.
    Blocked {
        /// The receiver.
        to: u32,
    },
    /// It waits for a message.
    Listens,
    /// It waits for the others.
    Meets,
    /// It has halted and is not to start again, unless a message comes.
    Rests,
}

/// The work item that a core is at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Work {
    /// When it was begun.
    pub start: Clocks,
    /// First vector of its first message; `None` before that.
    pub subject: Option<Vector>,
    /// Whether it has used the bus, a mailbox or a barrier.
    pub has_acted: bool,
}

impl Work {
    /// Nothing received yet.
    pub fn new(start: Clocks) -> Work {
        Work { start, subject: None, has_acted: false }
    }
}

/// One processor.
pub struct Processor<'a, W> {
    /// Its program.
    pub code: &'a Code<'a>,
    /// Its number, and how long a work item may be.
    pub core: CoreId,
    /// Whoever does its work.
    pub worker: W,
    /// How far it has come.
    pub clock: Clocks,
    /// What it is at.
    pub state: ProcessorState,
    /// What it asked for last.
    pub request: Option<Request>,
    /// Why its engine stopped, while a block load that it does not wait for is on its way: what comes next begins when
    /// that has ended.
    pub held: Option<Pause>,
    /// Its cache.
    pub cache: Option<Cache>,
    /// What it does when, where that is watched.
    pub spans: Option<Spans>,
    /// What went wrong.
    pub fault: Option<Fault>,
    /// Where its clocks went.
    pub used: ProcessorUse,
    /// The work item that it is at.
    pub work: Work,
    /// Whether the first thing that its program does outside itself is a receive.
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
            work: Work::new(Clocks(0)),
            begins_by_receiving: false,
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

    /// Takes back what its master of the bus went on to, up to a transfer that ended at a clock.
    pub(super) fn take_back(&mut self, master: &mut W::Master, end: Clocks) {
        self.used.longest_wait = self.used.longest_wait.max(master.take_longest_wait());
        if let Some(Played { busy, waiting }) = self.worker.take_back(master, end) {
            self.used.busy += busy;
            self.used.waiting += waiting;
            self.clock = end;
            self.work.has_acted = true;
        }
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
        self.clock = end;
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

    /// It went wrong at its clock.
    pub fn stop(&mut self, fault: Fault) {
        self.fault = Some(fault);
        self.act(Act::Stop);
    }

    /// What it waits for, for a message about a deadlock.
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
