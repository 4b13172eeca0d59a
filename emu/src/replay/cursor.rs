//! Cores that replay what work items were recorded to do, in the place of an engine that does it.

use std::cell::RefCell;
use std::rc::Rc;

use super::bus_cursor::{BusCursor, HandedBack, overlap};
use super::feed::Feed;
use super::main_cursor::MainCursor;
use super::recording::{Reason, RecordedItem, Recording, Segment};
use crate::code::Code;
use crate::code::quantity::{Clocks, Octets};
use crate::code::tally::Tally;
use crate::code::trap::Fault;
use crate::engine::{CoreId, Pause, State};
use crate::machine::cache::Cache;
use crate::machine::kinds::Kinds;
use crate::machine::port::Shared;
use crate::machine::request::{Access, Request};
use crate::machine::worker::{Advance, HandOver, Played, Progress, Worker, WorkerCounts};
use crate::profile::{ClockLog, LogPart, Observer, ProfileLevel};
use crate::semantics::Watch;

/// Reason for which a recording, which knows the initial memory only, is not what happens.
const READS_WRITTEN: Reason = "the cores read what the main processor has written";

/// A core's place in the work item that it replays.
pub struct ItemCursor<'a> {
    code: &'a Code<'a>,
    core: CoreId,
    feed: Rc<RefCell<Feed<'a>>>,
    /// The work item; none before its message has come.
    recording: Option<RecordedItem>,
    /// Number of the next segment in the track of its portion.
    next: usize,
    progress: Progress,
    /// Sums of clocks, where those of functions are measured; the bus cursor has the waits of a part while it goes through the work item.
    log: Option<ClockLog>,
    /// Observer and site of the transfer that was asked for last.
    asked: (usize, u32),
}

impl<'a> ItemCursor<'a> {
    /// A core that has replayed nothing.
    pub fn new(code: &'a Code<'a>, core: CoreId, feed: Rc<RefCell<Feed<'a>>>, level: ProfileLevel) -> ItemCursor<'a> {
        let log = (level == ProfileLevel::Clocks).then(ClockLog::default);
        ItemCursor { code, core, feed, recording: None, next: 0, progress: Progress::default(), log, asked: (0, 0) }
    }

    /// Begins the work item: adds what it computes and asks for, and makes room for the waits of its observer.
    fn begin_item(&mut self) {
        let Some(recording) = &self.recording else { return };
        self.next = recording.stretch.segments.start;
        if let (Some(log), Some(clocks)) = (&mut self.log, &recording.clocks) {
            let observer = clocks.observer as usize;
            if log.parts.len() <= observer {
                log.parts.resize(observer + 1, LogPart::default());
            }
            let part = &mut log.parts[observer];
            part.add_cells(&recording.portion().cells[clocks.cells.clone()]);
            part.reserve(clocks.known as usize);
            recording.portion().asked[clocks.asked.clone()]
                .iter()
                .for_each(|&(site, asked)| part.add_asked(site, asked));
        }
    }

    /// The sums of an observer.
    fn part(&mut self, observer: usize) -> Option<&mut LogPart> {
        self.log.as_mut()?.parts.get_mut(observer)
    }

    /// Number in its track of the segment that asked for what the core waits for; none where that is its message.
    fn last(&self) -> Option<usize> {
        let first = self.recording.as_ref()?.stretch.segments.start;
        self.next.checked_sub(1).filter(|&last| last >= first)
    }

    /// The segment that asked for what the core waits for.
    fn asked(&self) -> Option<&Segment> {
        let last = self.last()?;
        self.recording.as_ref()?.portion().track.segments.get(last)
    }

    /// Notes the site of what the core waits for.
    fn note_site(&mut self) {
        let (Some(last), Some(recording)) = (self.last(), &self.recording) else { return };
        if let (Some(&site), Some(clocks)) = (recording.portion().track.sites.get(last), &recording.clocks) {
            self.asked = (clocks.observer as usize, site);
        }
    }

    /// Does what the core waits for, and yields the message that it took with its sender.
    fn act(&mut self, shared: &mut Shared, at: Clocks) -> Option<(crate::semantics::Message, u32)> {
        let own = self.core.core;
        // No segment is behind it, so it waits for its message, and the message tells which recording it is.
        let Some(segment) = self.asked() else {
            let (_, sender) = shared.mailboxes.next(own)?;
            let message = shared.mailboxes.take(own, sender)?;
            self.recording = self.feed.borrow_mut().take(&message);
            self.begin_item();
            return Some((message, sender));
        };
        match segment.request(self.core.cores) {
            Request::Send { to, .. } => {
                // The address of a segment that sends is the number of its message.
                let sent = self.recording.as_ref().map_or(&[][..], |recording| recording.portion().sent(recording));
                if let Some(&message) = sent.get(segment.address as usize) {
                    shared.mailboxes.put(to, own, at, message);
                }
            }
            // The recording saw memory as it was at first, and the octets may be others by now.
            Request::Transfer { access: Access::Load | Access::Read, .. }
                if overlap(&segment.range(), &shared.written) =>
            {
                self.feed.borrow_mut().lose::<()>(READS_WRITTEN);
            }
            _ => {}
        }
        None
    }
}

impl Worker for ItemCursor<'_> {
    type Master = BusCursor;

    /// Replays what [`Executor::advance`] would have done.
    ///
    /// An item of two segments, `(7 clocks, read)` and `(3 clocks, send)`, with 2 clocks after them, and a prefix of 1 clock:
    ///
    /// | advance | clocks | request |
    /// | --- | --- | --- |
    /// | after reset | 1 | receive |
    /// | permitted: takes the message and with it the recording | 7 | read |
    /// | permitted: nothing to do, nobody looks at what is read | 3 | send |
    /// | permitted: sends the recorded message | 2 | none, it halts |
    fn advance(&mut self, shared: &mut Shared, permission: Option<Clocks>) -> Advance {
        // Do what is permitted.
        let taken = permission.and_then(|at| self.act(shared, at));
        // Octets of the whole item are added when it begins: the bus cursor then has nothing to account for.
        let has_begun = taken.is_some() && self.recording.is_some();
        let octets = self.recording.as_ref().filter(|_| has_begun).map_or(Octets(0), |recording| recording.octets);
        // Go on to the next request.
        let (prefix, is_lost) = {
            let feed = self.feed.borrow();
            (feed.prefix, feed.lost.is_some())
        };
        let (mut request, mut steps) = (None, 0);
        let (clocks, pause) = match &self.recording {
            // What comes of a lost replay is thrown away; this ends it.
            _ if is_lost => (0, Pause::Fault(Fault::Deadlock)),
            None if permission.is_none() => {
                request = Some(Request::Receive);
                self.progress.pc = prefix.pc;
                (prefix.clocks, Pause::Wait)
            }
            None => (0, Pause::Fault(Fault::Deadlock)),
            Some(recording) => match recording.portion().track.segments.get(self.next) {
                Some(segment) if self.next < recording.stretch.segments.end => {
                    self.next += 1;
                    request = Some(segment.request(self.core.cores));
                    self.progress.pc = segment.pc;
                    (segment.clocks.into(), Pause::Wait)
                }
                _ => {
                    let Recording { last_pc: pc, steps: all, elementary, .. } = **recording;
                    self.progress = Progress { pc, steps: all, elementary };
                    steps = all;
                    (recording.last_clocks, recording.end)
                }
            },
        };
        Advance { pause, request, taken, clocks, steps, octets }
    }

    fn restart(&mut self) {
        (self.recording, self.next) = (None, 0);
    }

    fn end(&mut self) {}

    fn progress(&self) -> Progress {
        self.progress
    }

    fn receives_first(&self, _: &mut Shared, _: &mut Option<State>) -> bool {
        // What was recorded begins with a message.
        true
    }

    fn is_accounted(&self) -> bool {
        true
    }

    fn hand_over(&mut self, master: &mut BusCursor, transfer: HandOver) -> bool {
        let is_safe = |recording: &Recording| {
            self.asked().is_some_and(Segment::is_read) && !overlap(&recording.stretch.reads, transfer.written)
        };
        let Some(recording) = self.recording.as_ref().filter(|recording| is_safe(recording)) else { return false };
        let (track, stretch) = (recording.portion().track.clone(), recording.stretch.clone());
        let (observer, _) = self.asked;
        let waits = self.part(observer).map_or(Vec::new(), |part| std::mem::take(&mut part.waits));
        master.begin((track, stretch), self.next, transfer, waits);
        true
    }

    fn note_ask(&mut self, _: Request, _: Octets, _: &Kinds) {
        // What it asks for was added when the work item began.
        self.note_site();
    }

    fn note_wait(&mut self, waiting: Clocks) {
        if waiting != Clocks(0) {
            let (observer, site) = self.asked;
            if let Some(part) = self.part(observer) {
                part.add_wait(site, waiting);
            }
        }
    }

    fn take_back(&mut self, master: &mut BusCursor, end: Clocks, cache: &mut Option<Cache>) -> Option<Played> {
        let HandedBack { next, played, waits, cache: own, is_lost } = master.end(end)?;
        *cache = own;
        if is_lost {
            self.feed.borrow_mut().lose::<()>(READS_WRITTEN);
        }
        let (observer, _) = self.asked;
        if let Some(part) = self.part(observer) {
            part.waits = waits;
        }
        // What is waited for from now on is the last transfer that the master asked for.
        self.next = next;
        self.note_site();
        self.progress.pc = self.asked().map_or(self.progress.pc, |segment| segment.pc);
        Some(played)
    }

    fn into_counts(self) -> WorkerCounts {
        WorkerCounts { tally: Tally::new(self.code), profile: None, clocks: self.log, keys: None, kinds: None }
    }
}

/// Workers of a machine that replays: cores do, the main processor executes its program.
pub enum Replayer<'a, T, O> {
    /// A core.
    Core(ItemCursor<'a>),
    /// The main processor.
    Main(Box<MainCursor<'a, T, O>>),
}

/// Hands a method on to whichever it is.
macro_rules! each {
    ($self:expr, $worker:ident => $do:expr) => {
        match $self {
            Replayer::Core($worker) => $do,
            Replayer::Main($worker) => $do,
        }
    };
}

impl<T: Watch, O: Observer> Worker for Replayer<'_, T, O> {
    type Master = BusCursor;

    #[inline]
    fn advance(&mut self, shared: &mut Shared, permission: Option<Clocks>) -> Advance {
        each!(self, worker => worker.advance(shared, permission))
    }

    fn restart(&mut self) {
        each!(self, worker => worker.restart());
    }

    fn end(&mut self) {
        each!(self, worker => worker.end());
    }

    fn progress(&self) -> Progress {
        each!(self, worker => worker.progress())
    }

    fn receives_first(&self, shared: &mut Shared, scratch: &mut Option<State>) -> bool {
        each!(self, worker => worker.receives_first(shared, scratch))
    }

    fn is_accounted(&self) -> bool {
        each!(self, worker => worker.is_accounted())
    }

    fn hand_over(&mut self, master: &mut BusCursor, transfer: HandOver) -> bool {
        each!(self, worker => worker.hand_over(master, transfer))
    }

    fn take_back(&mut self, master: &mut BusCursor, end: Clocks, cache: &mut Option<Cache>) -> Option<Played> {
        each!(self, worker => worker.take_back(master, end, cache))
    }

    fn note_ask(&mut self, request: Request, octets: Octets, kinds: &Kinds) {
        each!(self, worker => worker.note_ask(request, octets, kinds));
    }

    #[inline]
    fn note_wait(&mut self, clocks: Clocks) {
        each!(self, worker => worker.note_wait(clocks));
    }

    fn into_counts(self) -> WorkerCounts {
        match self {
            Replayer::Core(core) => core.into_counts(),
            Replayer::Main(main) => main.into_counts(),
        }
    }
}
