//! One processor of the machine: its state, what it waits for, and where its clocks went.

use isa::number::Vector;

use super::cache::Cache;
use super::frame::ProcessorUse;
use super::station::{Request, Shared, Station};
use super::tape::Tape;
use super::trace::{Doing, Spans};
use crate::code::Code;
use crate::engine::{Choice, Pause, Runner, Seat, State, interpreter};
use crate::exec::{Message, Watch};
use crate::octets::Buffer;
use crate::profile::{RunObserver, Unobserved};
use crate::quantity::{Clocks, Octets};
use crate::tally::Tally;
use crate::trap::Fault;

/// What a processor does without the bus, at its own clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Act {
    /// It moves octets beside the bus.
    Aside,
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
pub enum Standing {
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

/// What an engine's run was given leave for and did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Advance {
    /// Why it stopped.
    pub pause: Pause,
    /// The message that it took, and its sender.
    pub taken: Option<(Message, u32)>,
    /// Instructions executed.
    pub steps: u64,
}

/// One processor.
pub struct Processor<'a, O> {
    /// Its program.
    pub code: &'a Code<'a>,
    /// What executes it.
    runner: Runner<'a>,
    /// Who it is.
    pub seat: Seat,
    /// What its program sees.
    pub state: State,
    /// The buffer after reset.
    pub initial: Buffer,
    tally: Tally,
    /// Who watches it.
    pub observer: O,
    /// The work item that it replays instead of running its program.
    pub tape: Option<Tape>,
    /// How far it has come.
    pub clock: Clocks,
    /// What it is at.
    pub standing: Standing,
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

impl<'a, O: RunObserver> Processor<'a, O> {
    /// A processor after reset, with what executes its program.
    pub fn new(code: &'a Code<'a>, seat: Seat, buffer_octets: u32, runner: Runner<'a>) -> Processor<'a, O> {
        let initial = Buffer::new(&code.program.buffer, buffer_octets);
        Processor {
            code,
            runner,
            seat,
            state: State::new(code, initial.clone()),
            initial,
            tally: Tally::new(code),
            observer: O::new(code),
            tape: None,
            clock: Clocks(0),
            standing: Standing::Asleep,
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

    /// The engine that executes its program.
    pub fn engine(&self) -> Choice {
        self.runner.choice()
    }

    /// Whether the program, from reset, comes to a receive before it does anything else outside itself. What runs for
    /// that is not counted.
    pub fn probe<T: Watch>(&self, shared: &mut Shared, arithmetic: &T) -> bool {
        let mut state = State::new(self.code, self.initial.clone());
        let mut station = Station::new(shared, self.seat.core, None);
        let mut tally = Tally::new(self.code);
        let mut nobody = Unobserved;
        let pause =
            interpreter::run(self.code, self.seat, &mut state, arithmetic, &mut station, &mut tally, &mut nobody);
        pause == Pause::Wait && station.request == Some(Request::Receive)
    }

    /// Runs the engine up to the next thing that concerns others, with leave for the one that it waits for, done at
    /// the processor's clock, or without.
    pub fn advance<T: Watch>(&mut self, shared: &mut Shared, arithmetic: &T, has_leave: bool) -> Advance {
        if let Some(tape) = self.tape.take() {
            return self.replay(tape, shared, has_leave);
        }
        let (clocks, steps) = (self.state.clocks, self.state.steps);
        let mut station = Station::new(shared, self.seat.core, has_leave.then_some(self.clock));
        let (state, tally, observer) = (&mut self.state, &mut self.tally, &mut self.observer);
        let pause = self.runner.run(self.seat, state, arithmetic, &mut station, tally, observer);
        self.request = station.request;
        let taken = station.taken;
        let steps = self.state.steps - steps;
        self.spend(self.state.clocks - clocks, steps, has_leave);
        Advance { pause, taken, steps }
    }

    /// The passes of its program so far.
    pub fn take_tally(&mut self) -> Tally {
        self.runner.fold(&mut self.tally);
        std::mem::replace(&mut self.tally, Tally::new(self.code))
    }

    /// Starts its program, or the next recorded work item, from reset.
    pub fn restart(&mut self) {
        match &mut self.tape {
            Some(tape) => *tape = Tape::default(),
            None => {
                self.state.begin(self.code, &self.initial);
                self.observer.begin(self.state.pc);
            }
        }
    }
}

impl<O> Processor<'_, O> {
    /// Notes what it does from its clock on.
    #[inline]
    fn note(&mut self, doing: Doing, until: Clocks) {
        if let Some(spans) = &mut self.spans {
            spans.add(doing, self.clock, until);
        }
    }

    /// Computes for some clocks.
    pub(super) fn spend(&mut self, clocks: u64, steps: u64, has_leave: bool) {
        self.note(Doing::Busy, self.clock + Clocks(clocks));
        self.clock += Clocks(clocks);
        self.used.busy += Clocks(clocks);
        self.used.instructions += steps;
        self.work.has_acted |= has_leave;
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
        self.standing = Standing::Acts { at: self.clock, act };
    }

    /// It went wrong at its clock.
    pub fn stop(&mut self, fault: Fault) {
        self.fault = Some(fault);
        self.act(Act::Stop);
    }

    /// What it waits for, for a message about a deadlock.
    pub fn waits_for(&self) -> String {
        let what = match self.standing {
            Standing::Blocked { to } => format!("waits until core {to} takes its last message"),
            Standing::Listens => "waits for a message".to_owned(),
            Standing::Meets => "waits at a barrier".to_owned(),
            _ => "has more to do".to_owned(),
        };
        let place = self
            .code
            .program
            .place(self.code.word(self.state.pc))
            .map_or(String::new(), |place| format!(" at {place}"));
        format!("core {} {what}{place}", self.seat.core)
    }
}
