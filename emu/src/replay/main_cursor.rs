//! The main processor of a machine that replays. Its program is executed, since what it does depends on the clocks of the cores; but nobody else
//! writes global memory, so it reads ahead of the clock, and the bus goes through these reads by itself.

use std::sync::Arc;

use super::bus_cursor::{BusCursor, HandedBack};
use super::recording::{Segment, Stretch, Track};
use crate::code::octets::Buffer;
use crate::code::quantity::{Clocks, Octets};
use crate::code::trap::Stop;
use crate::engine::{Pause, RequestTime, State, TimedLink};
use crate::machine::Setup;
use crate::machine::cache::Cache;
use crate::machine::kinds::Kinds;
use crate::machine::port::{CorePort, Shared};
use crate::machine::request::{Access, Request};
use crate::machine::worker::{Advance, Executor, HandOver, Played, Progress, Worker, WorkerCounts};
use crate::profile::{CROWDED, Observer, SiteAsked};
use crate::semantics::{Link, Message, Watch};

/// Reads that the main processor does ahead, at most.
const MOST_AHEAD: usize = 1 << 12;

/// The main processor's link: reads are done at once and noted; for everything else it waits.
struct AheadPort<'a> {
    port: CorePort<'a>,
    /// Time and place of the next request, where whoever asks tells them.
    time: Option<RequestTime>,
    /// Clocks of computing up to the last read.
    before: u64,
    reads: &'a mut Vec<Segment>,
    /// Calling contexts of the reads.
    contexts: &'a mut Vec<u32>,
    /// Clocks of functions are measured, so that what is too much to be told apart has to be counted one by one.
    is_measured: bool,
}

impl AheadPort<'_> {
    /// Notes a read that is done ahead; false for one that has to wait.
    fn goes_ahead(&mut self, access: Access, address: u32, octets: u32) -> bool {
        let Some(time) = self.time.take().filter(|_| self.port.permission.is_none()) else { return false };
        if self.reads.len() == MOST_AHEAD || self.is_measured && time.context == CROWDED {
            return false;
        }
        let request = Request::Transfer { address, octets: Octets(octets.into()), access };
        let Some(segment) = Segment::new(time.clocks - self.before, time.pc, request, 0) else { return false };
        self.before = time.clocks;
        self.reads.push(segment);
        self.contexts.push(time.context);
        true
    }
}

impl TimedLink for AheadPort<'_> {
    fn keeps_time(&self) -> bool {
        true
    }

    fn note(&mut self, time: RequestTime) {
        self.time = Some(time);
    }
}

impl Link for AheadPort<'_> {
    fn load(&mut self, buffer: &mut Buffer, to: u32, from: u32, octets: u32) -> Result<(), Stop> {
        let place = buffer.slice_mut(to, octets)?;
        self.port.shared.memory.holds(from, octets)?;
        if self.goes_ahead(Access::Load, from, octets) {
            return Ok(self.port.shared.memory.read(from, place)?);
        }
        self.port.load(buffer, to, from, octets)
    }

    fn store(&mut self, buffer: &Buffer, to: u32, from: u32, octets: u32) -> Result<(), Stop> {
        self.time = None;
        self.port.store(buffer, to, from, octets)
    }

    fn read(&mut self, address: u32, words: &mut [i32]) -> Result<(), Stop> {
        let octets = 4 * words.len() as u32;
        self.port.shared.memory.holds(address, octets)?;
        if self.goes_ahead(Access::Read, address, octets) {
            return Ok(self.port.shared.memory.read_words(address, words)?);
        }
        self.port.read(address, words)
    }

    fn read_octets(&mut self, address: u32, octets: &mut [u8]) -> Result<(), Stop> {
        let length = octets.len() as u32;
        self.port.shared.memory.holds(address, length)?;
        if self.goes_ahead(Access::Read, address, length) {
            return Ok(self.port.shared.memory.read(address, octets)?);
        }
        self.port.read_octets(address, octets)
    }

    fn write(&mut self, address: u32, words: &[i32]) -> Result<(), Stop> {
        self.time = None;
        self.port.write(address, words)
    }

    fn fetch_add(&mut self, address: u32, more: i32) -> Result<i32, Stop> {
        self.time = None;
        self.port.fetch_add(address, more)
    }

    fn send(&mut self, to: i32, message: Message) -> Result<(), Stop> {
        self.time = None;
        self.port.send(to, message)
    }

    fn receive(&mut self) -> Result<(Message, u32), Stop> {
        self.time = None;
        self.port.receive()
    }

    fn barrier(&mut self) -> Result<(), Stop> {
        self.time = None;
        self.port.barrier()
    }
}

/// The main processor, with the reads that it has done ahead of the clock.
pub struct MainCursor<'a, T, O> {
    executor: Executor<'a, T, O>,
    /// Reads that were done ahead.
    track: Arc<Track>,
    /// Calling contexts of the reads.
    contexts: Vec<u32>,
    /// Reads that are behind it, the one that it waits for among them; 0 where it has done all of them and goes on with its program.
    next: usize,
    /// Advance of its program behind them.
    rest: Advance,
    /// Octets of all that it has read ahead.
    kinds: Kinds,
    /// Number of the main processor.
    number: u32,
}

impl<'a, T: Watch, O: Observer> MainCursor<'a, T, O> {
    /// A main processor before its first clock, whose program is executed by `executor`.
    pub fn new(setup: &Setup, executor: Executor<'a, T, O>) -> MainCursor<'a, T, O> {
        let rest = Advance { pause: Pause::Wait, request: None, taken: None, clocks: 0, steps: 0, octets: Octets(0) };
        MainCursor {
            executor,
            track: Arc::default(),
            contexts: Vec::new(),
            next: 0,
            rest,
            kinds: Kinds::new(&setup.kinds),
            number: setup.config.cores,
        }
    }

    /// The read that it waits for; none where its program waits.
    fn asked(&self) -> Option<&Segment> {
        self.track.segments.get(self.next.checked_sub(1)?)
    }

    /// The site of that, where clocks of functions are measured.
    fn asked_site(&self) -> Option<u32> {
        self.track.sites.get(self.next.checked_sub(1)?).copied()
    }

    /// Goes on with the next read, or with what the program came to behind the last one.
    fn go_on(&mut self) -> Advance {
        match self.track.segments.get(self.next) {
            Some(read) => {
                self.next += 1;
                let (request, clocks) = (Some(read.request(self.number)), read.clocks.into());
                Advance { pause: Pause::Wait, request, taken: None, clocks, steps: 0, octets: Octets(0) }
            }
            None => {
                self.next = 0;
                self.rest
            }
        }
    }

    /// Adds the octets of what was read ahead, by kind and by site.
    fn add_reads(&mut self) -> Octets {
        let Some(track) = Arc::get_mut(&mut self.track) else { return Octets(0) };
        for (segment, &context) in track.segments.iter().zip(&self.contexts) {
            let request = segment.request(self.number);
            self.kinds.add(segment.pc, Some(request));
            if let Some(meter) = self.executor.meter() {
                let site = self.kinds.site(&mut meter.table, context, segment.pc, request);
                meter.part.add_asked(site, SiteAsked { transfers: 1, octets: segment.octets().0 });
                track.sites.push(site);
            }
        }
        track.segments.iter().fold(Octets(0), |sum, segment| sum + segment.octets())
    }
}

impl<T: Watch, O: Observer> Worker for MainCursor<'_, T, O> {
    type Master = BusCursor;

    /// Executes the program up to what has to wait, and goes through what it has read on the way.
    ///
    /// A program that computes for 3 clocks, reads, computes for 4, reads and sends 5 clocks later advances by 3 clocks to a read, by 4 to a
    /// read and by 5 to the message, as if it had been executed bit by bit.
    fn advance(&mut self, shared: &mut Shared, permission: Option<Clocks>) -> Advance {
        if self.next != 0 {
            // What is permitted was done already.
            return self.go_on();
        }
        // Take the room of the last reads, unless somebody has kept a copy of them
        if Arc::get_mut(&mut self.track).is_none() {
            self.track = Arc::default();
        }
        let track = Arc::get_mut(&mut self.track).expect("nobody else has it");
        track.segments.clear();
        track.sites.clear();
        self.contexts.clear();
        // Execute
        let begun = self.executor.state.clocks;
        let is_measured = self.executor.meter().is_some();
        let (reads, contexts) = (&mut track.segments, &mut self.contexts);
        let port = CorePort::new(shared, self.number, permission);
        let mut link = AheadPort { port, time: None, before: begun, reads, contexts, is_measured };
        let (pause, clocks, steps) = self.executor.run(&mut link);
        // Clocks of the reads are theirs: of 12 clocks up to a message, with reads after 3 and 7, 5 are left.
        let (left, CorePort { request, taken, .. }) = (clocks - (link.before - begun), link.port);
        self.rest = Advance { pause, request, taken: None, clocks: left, steps, octets: Octets(0) };
        let octets = self.add_reads();
        Advance { taken, octets, ..self.go_on() }
    }

    fn restart(&mut self) {
        self.next = 0;
        self.executor.restart();
    }

    fn end(&mut self) {
        self.executor.end();
    }

    fn progress(&self) -> Progress {
        let progress = self.executor.progress();
        self.asked().map_or(progress, |read| Progress { pc: read.pc, ..progress })
    }

    fn receives_first(&self, shared: &mut Shared, scratch: &mut Option<State>) -> bool {
        self.executor.receives_first(shared, scratch)
    }

    fn is_accounted(&self) -> bool {
        self.next != 0
    }

    fn hand_over(&mut self, master: &mut BusCursor, transfer: HandOver) -> bool {
        // Alone, the last read needs nobody to go on from it.
        if self.next == 0 || self.next == self.track.segments.len() {
            return false;
        }
        let waits = self.executor.meter().map_or(Vec::new(), |meter| {
            meter.part.reserve(meter.table.all().len());
            std::mem::take(&mut meter.part.waits)
        });
        // It has no cache, and waits for each load.
        let transfer = HandOver { overlaps: false, cache: &mut None, ..transfer };
        // Nobody else writes while they wait, so it does not matter what they read.
        let stretch = Stretch { segments: 0..self.track.segments.len(), reads: 0..0 };
        master.begin((self.track.clone(), stretch), self.next, transfer, waits);
        true
    }

    fn note_ask(&mut self, request: Request, octets: Octets, kinds: &Kinds) {
        // Reads that were done ahead are added already.
        if self.next == 0 {
            self.executor.note_ask(request, octets, kinds);
        }
    }

    fn note_wait(&mut self, clocks: Clocks) {
        match (self.asked_site(), self.executor.meter()) {
            (Some(site), Some(meter)) => meter.part.add_wait(site, clocks),
            _ => self.executor.note_wait(clocks),
        }
    }

    fn take_back(&mut self, master: &mut BusCursor, end: Clocks, _: &mut Option<Cache>) -> Option<Played> {
        let HandedBack { next, played, waits, .. } = master.end(end)?;
        if let Some(meter) = self.executor.meter() {
            meter.part.waits = waits;
        }
        self.next = next;
        Some(played)
    }

    fn into_counts(self) -> WorkerCounts {
        WorkerCounts { kinds: Some(self.kinds), ..self.executor.into_counts() }
    }
}
