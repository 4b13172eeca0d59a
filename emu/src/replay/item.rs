//! The link of work items that an engine records, and what it does.

use std::ops::Range;

use super::budget::Budget;
use super::recording::{Segment, Track};
use crate::code::octets::{Buffer, Memory};
use crate::code::quantity::Octets;
use crate::code::trap::Stop;
use crate::engine::{NotedRead, Quick, RequestTime, TimedLink};
use crate::machine::kinds::Kinds;
use crate::machine::port::widen;
use crate::machine::request::{Access, Request};
use crate::profile::SiteTable;
use crate::semantics::{Link, Message};

/// Record level: what is kept of work items beside their answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordLevel {
    /// Passes, and the segments that replaying them takes.
    Segments,
    /// Passes; segments not, as far as that saves time.
    Passes,
}

/// A work item that is recorded, behind those that its portion has already.
#[derive(Debug, Default)]
pub(super) struct ItemRecord {
    pub message: Option<Message>,
    pub sent: Vec<Message>,
    pub track: Track,
    /// Number of its first segment in the track.
    pub first_segment: usize,
    /// Number of its first message among those that were sent.
    pub first_message: usize,
    pub octets: Octets,
    /// From the first to the last octet of global memory that it has read; empty where it has read none.
    pub reads: Range<u64>,
    pub before: u64,
    /// There was no room for a segment, so that the item was recorded in vain.
    pub is_without_room: bool,
}

impl ItemRecord {
    /// Number of the item's segments.
    #[inline(always)]
    pub fn segments(&self) -> usize {
        self.track.segments.len() - self.first_segment
    }

    /// Number of the messages that the item has sent.
    pub fn messages(&self) -> usize {
        self.sent.len() - self.first_message
    }
}

/// The link of a work item: it gets at once what it asks for. Whatever has to be refused is left to the interpreter.
pub(super) struct ItemRecorder<'s> {
    pub memory: &'s Memory,
    pub main: u32,
    pub budget: &'s Budget,
    pub kinds: &'s mut Kinds,
    /// The sites, where clocks are measured.
    pub sites: Option<&'s mut SiteTable>,
    pub record: &'s mut ItemRecord,
    pub level: RecordLevel,
    pub time: RequestTime,
}

impl TimedLink for ItemRecorder<'_> {
    #[inline(always)]
    fn keeps_time(&self) -> bool {
        self.level == RecordLevel::Segments
    }

    #[inline(always)]
    fn note(&mut self, time: RequestTime) {
        self.time = time;
    }

    fn quick(&mut self) -> Option<&mut dyn Quick> {
        Some(self)
    }
}

impl Quick for ItemRecorder<'_> {
    fn memory(&self) -> Option<&[u8]> {
        self.memory.peek(0, self.memory.size() as u32)
    }

    fn kind(&mut self, address: u32) -> (u32, u32, u32) {
        self.kinds.range(address)
    }

    fn add(&mut self, kind: u32, octets: u64) {
        self.kinds.add_octets(kind as usize, Octets(octets));
    }

    fn keep(&mut self, reads: &[NotedRead], before: u64) -> bool {
        let record = &mut *self.record;
        // Many reads at once may cross the end of several shares: with 10 more after 4090, and shares of 4096, of one.
        let portions = record.segments() / Budget::SHARE;
        record.track.segments.extend(reads.iter().map(Segment::of_read));
        let ends = reads.iter().map(|read| (read.address, u64::from(read.address) + u64::from(read.octets)));
        let (start, end) = ends.fold((u32::MAX, 0), |(start, end), (from, to)| (start.min(from), end.max(to)));
        widen(&mut record.reads, start.into()..end);
        if let Some(sites) = &mut self.sites {
            let range = |address| self.kinds.range(address);
            let site = |read: &NotedRead| sites.at(read.context, read.slot, read.address, range);
            record.track.sites.extend(reads.iter().map(site));
        }
        record.octets += Octets(reads.iter().map(|read| u64::from(read.octets)).sum());
        record.before = before;
        let more = record.segments() / Budget::SHARE - portions;
        if more != 0 && !self.budget.take(more * Budget::SHARE) {
            record.is_without_room = true;
        }
        !record.is_without_room
    }

    fn before(&self) -> u64 {
        self.record.before
    }
}

impl ItemRecorder<'_> {
    #[inline(always)]
    fn enter(&mut self, request: Request) -> Result<(), Stop> {
        if self.record.message.is_some() {
            return Err(Stop::Wait);
        }
        match self.level {
            RecordLevel::Passes => self.kinds.add(self.time.pc, Some(request)),
            RecordLevel::Segments => return self.keep(request),
        }
        Ok(())
    }

    fn keep(&mut self, request: Request) -> Result<(), Stop> {
        let record = &mut *self.record;
        let clocks = self.time.clocks - record.before;
        let segment = Segment::new(clocks, self.time.pc, request, record.messages()).ok_or(Stop::Wait)?;
        if (record.segments() + 1).is_multiple_of(Budget::SHARE) && !self.budget.take(Budget::SHARE) {
            return Err(Stop::Wait);
        }
        record.octets += segment.octets();
        if segment.is_read() {
            widen(&mut record.reads, segment.range());
        }
        record.before = self.time.clocks;
        record.track.segments.push(segment);
        if let Some(sites) = &mut self.sites {
            record.track.sites.push(self.kinds.site(sites, self.time.context, self.time.pc, request));
        }
        self.kinds.add(self.time.pc, Some(request));
        Ok(())
    }

    #[inline(always)]
    fn ask(&mut self, access: Access, from: u32, octets: u32) -> Result<(), Stop> {
        self.memory.holds(from, octets)?;
        self.enter(Request::Transfer { address: from, octets: Octets(octets.into()), access })
    }
}

impl Link for ItemRecorder<'_> {
    #[inline]
    fn load(&mut self, buffer: &mut Buffer, to: u32, from: u32, octets: u32) -> Result<(), Stop> {
        let place = buffer.slice_mut(to, octets)?;
        self.ask(Access::Load, from, octets)?;
        Ok(self.memory.read(from, place)?)
    }

    fn store(&mut self, _: &Buffer, _: u32, _: u32, _: u32) -> Result<(), Stop> {
        Err(Stop::Wait)
    }

    #[inline(always)]
    fn read(&mut self, address: u32, words: &mut [i32]) -> Result<(), Stop> {
        self.ask(Access::Read, address, 4 * words.len() as u32)?;
        Ok(self.memory.read_words(address, words)?)
    }

    fn read_octets(&mut self, address: u32, octets: &mut [u8]) -> Result<(), Stop> {
        self.ask(Access::Read, address, octets.len() as u32)?;
        Ok(self.memory.read(address, octets)?)
    }

    fn write(&mut self, _: u32, _: &[i32]) -> Result<(), Stop> {
        Err(Stop::Wait)
    }

    fn fetch_add(&mut self, _: u32, _: i32) -> Result<i32, Stop> {
        Err(Stop::Wait)
    }

    fn send(&mut self, to: i32, message: Message) -> Result<(), Stop> {
        // To stop here loses nothing: the interpreter tries the instruction again, and says what is wrong with it.
        if u32::try_from(to).ok() != Some(self.main) {
            return Err(Stop::Wait);
        }
        self.enter(Request::Send { to: self.main, octets: Octets(message.octets().into()) })?;
        self.record.sent.push(message);
        Ok(())
    }

    fn receive(&mut self) -> Result<(Message, u32), Stop> {
        let record = &mut *self.record;
        let message = record.message.take().ok_or(Stop::Wait)?;
        record.before = self.time.clocks;
        Ok((message, self.main))
    }
    fn barrier(&mut self) -> Result<(), Stop> {
        Err(Stop::Wait)
    }
}
