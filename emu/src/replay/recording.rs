//! Recording of a work item, apart from its clocks: computing, transfers and messages one after the other. How it is put on the
//! clock is not said here.

use std::ops::{Deref, Range};
use std::sync::Arc;

use crate::code::quantity::Octets;
use crate::engine::{NotedRead, Pause};
use crate::machine::port::widen;
use crate::machine::request::{Access, Request};
use crate::profile::SiteAsked;
use crate::semantics::Message;

/// Reason for which a program's work items cannot be replayed and have to be stepped.
pub type Reason = &'static str;

/// Computing, and what the item asks for after it: 16 octets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment {
    /// Clocks of computing.
    pub clocks: u32,
    /// Word of the instruction that asks.
    pub pc: u32,
    /// First octet in global memory, or number of the message among those that the item sends.
    pub address: u32,
    /// Octets and access in one word.
    what: u32,
}

/// A segment's access, in the lowest bits; 0 is a message.
const LOAD: u32 = 1;
const READ: u32 = 2;
const WRITE: u32 = 3;

impl Segment {
    /// The segment that ends with a request; `None` for one that no replayed item makes, or that does not fit.
    pub fn new(clocks: u64, pc: u32, request: Request, sent: usize) -> Option<Segment> {
        let (address, octets, kind) = match request {
            Request::Transfer { address, octets, access: Access::Load } => (address, octets, LOAD),
            Request::Transfer { address, octets, access: Access::Read } => (address, octets, READ),
            Request::Transfer { address, octets, access: Access::Write } => (address, octets, WRITE),
            Request::Send { octets, .. } => (u32::try_from(sent).ok()?, octets, 0),
            Request::Receive | Request::Barrier => return None,
        };
        // Octets and access share a word: 9 octets that are read are 9 << 2 | 2 = 38.
        let octets = u32::try_from(octets.0).ok().filter(|&octets| octets < 1 << 30)?;
        Some(Segment { clocks: u32::try_from(clocks).ok()?, pc, address, what: octets << 2 | kind })
    }

    /// The segment that ends with a read that an engine has done by itself.
    #[inline]
    pub fn of_read(read: &NotedRead) -> Segment {
        Segment { clocks: read.clocks, pc: read.slot, address: read.address, what: read.octets << 2 | READ }
    }

    /// All but the address, which few segments of a frame differ in: clocks, word, and octets with access.
    #[inline]
    pub fn shape(&self) -> [u32; 3] {
        [self.clocks, self.pc, self.what]
    }

    /// The segment of a shape; `None` where that is a write, which no work item that is recorded does.
    #[inline]
    pub fn of_shape([clocks, pc, what]: [u32; 3], address: u32) -> Option<Segment> {
        (what & 3 != WRITE).then_some(Segment { clocks, pc, address, what })
    }

    /// Octets that go over the bus.
    #[inline]
    pub fn octets(&self) -> Octets {
        Octets((self.what >> 2).into())
    }

    /// True where global memory is read.
    #[inline]
    pub fn is_read(&self) -> bool {
        matches!(self.what & 3, LOAD | READ)
    }

    /// True where a block is copied to the buffer, for which a core need not wait.
    #[inline]
    pub fn is_load(&self) -> bool {
        self.what & 3 == LOAD
    }

    /// The octets of global memory that a transfer moves.
    #[inline]
    pub fn range(&self) -> Range<u64> {
        u64::from(self.address)..u64::from(self.address) + self.octets().0
    }

    /// The request; messages go to the main processor, which has that number.
    pub fn request(&self, main: u32) -> Request {
        let (address, octets) = (self.address, self.octets());
        let access = match self.what & 3 {
            LOAD => Access::Load,
            READ => Access::Read,
            WRITE => Access::Write,
            _ => return Request::Send { to: main, octets },
        };
        Request::Transfer { address, octets, access }
    }
}

/// From the first to the last octet of global memory that segments read.
pub fn reads(segments: &[Segment]) -> Range<u64> {
    let mut all = 0..0;
    segments.iter().filter(|segment| segment.is_read()).for_each(|segment| widen(&mut all, segment.range()));
    all
}

/// Segments one after the other, which a core or the bus goes through.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Track {
    /// The segments.
    pub segments: Vec<Segment>,
    /// The site of each, 4 octets beside the 16 of a segment, where clocks of functions are measured; else none.
    pub sites: Vec<u32>,
}

/// Part of a track, which one item goes through.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Stretch {
    /// Numbers of its segments.
    pub segments: Range<usize>,
    /// From the first to the last octet of global memory that they read; empty where it does not matter who writes there meanwhile.
    pub reads: Range<u64>,
}

/// Clocks by function of a work item, apart from its waits, under the numbers of the observer of those who recorded it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ItemClocks {
    /// Number of that observer.
    pub observer: u32,
    /// Clocks of computing by cell, among those of its portion; those that are not empty.
    pub cells: Range<usize>,
    /// Transfers by site, among those of its portion, of the sites that have some: whatever the machine, the item asks for the same.
    pub asked: Range<usize>,
    /// Number of sites that the observer knew at its end.
    pub known: u32,
}

/// A work item from its first message to its end. What there are several of stands in its portion.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recording {
    /// The message that it began with.
    pub message: Message,
    /// Segments after that.
    pub stretch: Stretch,
    /// Octets of all of those.
    pub octets: Octets,
    /// The messages that it sent to the main processor, among those of its portion.
    pub sent: Range<usize>,
    /// Clocks by function, where they were asked for.
    pub clocks: Option<ItemClocks>,
    /// Clocks of computing after the last segment.
    pub last_clocks: u64,
    /// Word of the instruction at which it ended.
    pub last_pc: u32,
    /// End of the item: by halting or by a fault.
    pub end: Pause,
    /// Instructions that it executed, those before its first message included.
    pub steps: u64,
    /// Elementary operations of those.
    pub elementary: u64,
    /// Dependence of what it did on the number of cores is possible.
    pub depends_on_cores: bool,
}

/// Work items that were recorded one after the other, and take room together: so an item costs no room of its own, which one thread would take and
/// another give back.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Portion {
    /// The items.
    pub items: Vec<Recording>,
    /// Segments of all of them.
    pub track: Arc<Track>,
    /// Messages that they sent.
    pub sent: Vec<Message>,
    /// Clocks of computing by cell.
    pub cells: Vec<(u32, u64)>,
    /// Transfers by site.
    pub asked: Vec<(u32, SiteAsked)>,
}

impl Portion {
    /// No items, with room for about as much as the portion before had, since room that grows is copied again and again.
    pub fn with_room(previous: Option<&Portion>) -> Portion {
        let Some(previous) = previous else { return Portion::default() };
        let room = |length: usize| length + length / 8;
        let Track { segments, sites } = &*previous.track;
        Portion {
            items: Vec::with_capacity(previous.items.len()),
            track: Arc::new(Track {
                segments: Vec::with_capacity(room(segments.len())),
                sites: Vec::with_capacity(room(sites.len())),
            }),
            sent: Vec::with_capacity(room(previous.sent.len())),
            cells: Vec::with_capacity(room(previous.cells.len())),
            asked: Vec::with_capacity(room(previous.asked.len())),
        }
    }

    /// The segments of an item.
    pub fn segments(&self, item: &Recording) -> &[Segment] {
        &self.track.segments[item.stretch.segments.clone()]
    }

    /// The messages that an item sent.
    pub fn sent(&self, item: &Recording) -> &[Message] {
        &self.sent[item.sent.clone()]
    }

    /// The portion, which nobody else has and which gets no more items, without room that it took in vain.
    #[must_use]
    pub fn closed(mut self) -> Arc<Portion> {
        if self.items.len() < self.items.capacity() / 2 {
            self.items.shrink_to_fit();
            self.sent.shrink_to_fit();
            self.cells.shrink_to_fit();
            self.asked.shrink_to_fit();
        }
        if let Some(track) = Arc::get_mut(&mut self.track)
            && track.segments.len() < track.segments.capacity() / 2
        {
            track.segments.shrink_to_fit();
            track.sites.shrink_to_fit();
        }
        Arc::new(self)
    }
}

/// A work item of a portion, which stays as long as somebody has one of its items.
#[derive(Clone, Debug)]
pub struct RecordedItem {
    portion: Arc<Portion>,
    number: usize,
}

impl RecordedItem {
    /// All items of a portion.
    pub fn all(portion: &Arc<Portion>) -> impl Iterator<Item = RecordedItem> {
        (0..portion.items.len()).map(|number| RecordedItem { portion: portion.clone(), number })
    }

    /// The portion that it belongs to.
    #[inline]
    pub fn portion(&self) -> &Portion {
        &self.portion
    }
}

impl Deref for RecordedItem {
    type Target = Recording;

    #[inline]
    fn deref(&self) -> &Recording {
        &self.portion.items[self.number]
    }
}
