//! The links of work items that are recorded in lock-step, and what they do.

use super::kinds::Kinds;
use super::recording::Segment;
use super::room::Room;
use super::station::{Access, Request};
use crate::exec::{Link, Message};
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
struct StrandLink<'s, 'a> {
    all: &'s mut Strands<'a>,
    lane: usize,
    moment: Moment,
}

impl<'a> Wires for Strands<'a> {
    #[inline(always)]
    fn link(&mut self, lane: usize, moment: Moment) -> impl Link {
        StrandLink { all: self, lane, moment }
    }
}

impl StrandLink<'_, '_> {
    fn enter(&mut self, request: Request) -> Result<(), Stop> {
        let strand = &mut self.all.strands[self.lane];
        if strand.message.is_some() {
            return Err(Stop::Wait);
        }
        match self.all.keeping {
            Keeping::Nothing => return Ok(()),
            Keeping::Passes | Keeping::Segments => self.all.kinds.add(Some(request)),
        }
        if self.all.keeping == Keeping::Passes {
            return Ok(());
        }
        let clocks = self.moment.clocks - strand.before;
        let segment = Segment::new(clocks, self.moment.pc, request, strand.sent.len()).ok_or(Stop::Wait)?;
        strand.octets += segment.octets();
        strand.before = self.moment.clocks;
        strand.segments.push(segment);
        if strand.segments.len().is_multiple_of(Room::PORTION) && !self.all.room.take(Room::PORTION) {
            return Err(Stop::Wait);
        }
        Ok(())
    }

    fn read_octets(&mut self, access: Access, from: u32, octets: u32) -> Result<&[u8], Stop> {
        let memory = self.all.memory;
        let found = memory.slice(from, octets)?;
        self.enter(Request::Transfer { address: from, octets: Octets(octets.into()), access })?;
        Ok(found)
    }
}

impl Link for StrandLink<'_, '_> {
    #[inline]
    fn load(&mut self, buffer: &mut Buffer, to: u32, from: u32, octets: u32) -> Result<(), Stop> {
        let place = buffer.slice_mut(to, octets)?;
        place.copy_from_slice(self.read_octets(Access::Load, from, octets)?);
        Ok(())
    }

    fn store(&mut self, _: &Buffer, _: u32, _: u32, _: u32) -> Result<(), Stop> {
        Err(Stop::Wait)
    }

    #[inline]
    fn read(&mut self, address: u32, words: &mut [i32]) -> Result<(), Stop> {
        self.read_octets(Access::Read, address, 4 * words.len() as u32)?;
        Ok(self.all.memory.read_words(address, words)?)
    }

    fn write(&mut self, _: u32, _: &[i32]) -> Result<(), Stop> {
        Err(Stop::Wait)
    }

    fn fetch_add(&mut self, _: u32, _: i32) -> Result<i32, Stop> {
        Err(Stop::Wait)
    }

    fn send(&mut self, to: i32, message: Message) -> Result<(), Stop> {
        if u32::try_from(to).ok() != Some(self.all.main) {
            return Err(Stop::Wait);
        }
        self.enter(Request::Send { to: self.all.main, octets: Octets(message.octets().into()) })?;
        self.all.strands[self.lane].sent.push(message);
        Ok(())
    }

    fn receive(&mut self) -> Result<(Message, u32), Stop> {
        let strand = &mut self.all.strands[self.lane];
        let message = strand.message.take().ok_or(Stop::Wait)?;
        strand.before = self.moment.clocks;
        Ok((message, self.all.main))
    }

    fn barrier(&mut self) -> Result<(), Stop> {
        Err(Stop::Wait)
    }
}
