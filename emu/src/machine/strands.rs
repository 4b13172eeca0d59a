//! The links of work items that are recorded by the fast engines, and what they do.

use super::kinds::Kinds;
use super::recording::Segment;
use super::room::Room;
use super::station::{Access, Request};
use crate::exec::{Link, Message};
use crate::fast::single::Wire;
use crate::fast::{Moment, Wires};
use crate::octets::{Buffer, Memory};
use crate::quantity::Octets;
use crate::trap::Stop;

/// What is kept of work items beside their answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keeping {
    /// Passes, and the segments that replaying them takes.
    Segments,
    /// Passes; segments not, as far as that saves time.
    Passes,
    /// Nothing, as far as that saves time.
    Nothing,
}

/// The work items of a group that is recorded in lock-step.
pub(super) struct Strands<'a> {
    pub memory: &'a Memory,
    pub main: u32,
    pub room: &'a Room,
    pub kinds: Kinds,
    pub strands: Vec<Strand>,
    pub keeping: Keeping,
}

/// One of them.
#[derive(Debug, Default)]
pub(super) struct Strand {
    pub message: Option<Message>,
    pub sent: Vec<Message>,
    pub segments: Vec<Segment>,
    pub octets: Octets,
    pub before: u64,
}

/// The link of one of them: it gets at once what it asks for. Whatever has to be refused is left to the interpreter.
pub(super) struct StrandLink<'s> {
    pub memory: &'s Memory,
    pub main: u32,
    pub room: &'s Room,
    pub kinds: &'s mut Kinds,
    pub strand: &'s mut Strand,
    pub keeping: Keeping,
    pub moment: Moment,
}

impl<'a> Wires for Strands<'a> {
    #[inline(always)]
    fn link(&mut self, lane: usize, moment: Moment) -> impl Link {
        let Strands { memory, main, room, kinds, strands, keeping } = self;
        StrandLink { memory, main: *main, room, kinds, strand: &mut strands[lane], keeping: *keeping, moment }
    }
}

impl Wire for StrandLink<'_> {
    #[inline(always)]
    fn keeps_time(&self) -> bool {
        self.keeping == Keeping::Segments
    }

    #[inline(always)]
    fn note(&mut self, moment: Moment) {
        self.moment = moment;
    }
}

impl StrandLink<'_> {
    #[inline(always)]
    fn enter(&mut self, request: Request) -> Result<(), Stop> {
        if self.strand.message.is_some() {
            return Err(Stop::Wait);
        }
        match self.keeping {
            Keeping::Nothing => {}
            Keeping::Passes => self.kinds.add(self.moment.pc, Some(request)),
            Keeping::Segments => return self.keep(request),
        }
        Ok(())
    }

    fn keep(&mut self, request: Request) -> Result<(), Stop> {
        let strand = &mut *self.strand;
        let clocks = self.moment.clocks - strand.before;
        let segment = Segment::new(clocks, self.moment.pc, request, strand.sent.len()).ok_or(Stop::Wait)?;
        if (strand.segments.len() + 1).is_multiple_of(Room::PORTION) && !self.room.take(Room::PORTION) {
            return Err(Stop::Wait);
        }
        strand.octets += segment.octets();
        strand.before = self.moment.clocks;
        strand.segments.push(segment);
        self.kinds.add(self.moment.pc, Some(request));
        Ok(())
    }

    #[inline(always)]
    fn ask(&mut self, access: Access, from: u32, octets: u32) -> Result<(), Stop> {
        self.memory.holds(from, octets)?;
        self.enter(Request::Transfer { address: from, octets: Octets(octets.into()), access })
    }
}

impl Link for StrandLink<'_> {
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

    fn write(&mut self, _: u32, _: &[i32]) -> Result<(), Stop> {
        Err(Stop::Wait)
    }

    fn fetch_add(&mut self, _: u32, _: i32) -> Result<i32, Stop> {
        Err(Stop::Wait)
    }

    fn send(&mut self, to: i32, message: Message) -> Result<(), Stop> {
        if u32::try_from(to).ok() != Some(self.main) {
            return Err(Stop::Wait);
        }
        self.enter(Request::Send { to: self.main, octets: Octets(message.octets().into()) })?;
        self.strand.sent.push(message);
        Ok(())
    }

    fn receive(&mut self) -> Result<(Message, u32), Stop> {
        let strand = &mut *self.strand;
        let message = strand.message.take().ok_or(Stop::Wait)?;
        strand.before = self.moment.clocks;
        Ok((message, self.main))
    }

    fn barrier(&mut self) -> Result<(), Stop> {
        Err(Stop::Wait)
    }
}
