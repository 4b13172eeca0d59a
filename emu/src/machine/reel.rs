//! Recorded transfers of a work item, one after the other, as long as nothing but the arbiter stands between them. A core hands its work item
//! over when it asks for a transfer, and takes it back when something else is next.

use std::ops::Range;
use std::sync::Arc;

use super::arbiter::NEVER;
use super::bus::{Burst, Lengths};
use super::recording::{Recording, Segment};
use crate::quantity::{Clocks, Octets};

/// What a master of the bus plays by itself; nothing at first.
#[derive(Debug)]
pub struct Reel {
    /// The work item; none while its core has it.
    recording: Option<Arc<Recording>>,
    /// Segments that are behind it; the last of them is the transfer that the master asks for.
    next: usize,
    /// Clocks of computing before the next transfer; [`NEVER`] where something else comes next.
    computing: Clocks,
    /// That transfer's first burst.
    ahead: Burst,
    /// When it was handed over.
    start: Clocks,
    /// Clocks of computing since then.
    busy: Clocks,
    /// The longest wait of the master for a grant that nobody was told of.
    longest_wait: Clocks,
}

/// What a reel has done when it is handed back.
#[derive(Debug)]
pub struct Played {
    /// The work item.
    pub recording: Arc<Recording>,
    /// Segments that are behind it.
    pub next: usize,
    /// Clocks of computing.
    pub busy: Clocks,
    /// Clocks of waiting.
    pub waiting: Clocks,
}

/// What a master did while nobody else asked.
#[derive(Clone, Copy, Debug)]
pub(super) struct Alone {
    /// The burst that it asks for next.
    pub burst: Burst,
    /// When it asks for that.
    pub arrival: Clocks,
    /// When the last one ended.
    pub free: Clocks,
    /// How long all held the bus.
    pub held: Clocks,
    /// What they moved.
    pub octets: Octets,
    /// Transfers that ended.
    pub transfers: u64,
    /// Bursts, each granted at once.
    pub bursts: u64,
}

/// Clocks of computing before a transfer that reads, and its first burst; [`NEVER`] before anything else.
#[inline(always)]
fn ahead_of(segments: &[Segment], next: usize, lengths: &Lengths) -> (Clocks, Burst) {
    match segments.get(next) {
        Some(segment) if segment.is_read() => (Clocks(segment.clocks.into()), lengths.burst(segment.octets())),
        _ => (NEVER, Burst::default()),
    }
}

/// Whether two ranges have an octet in common.
pub fn overlap(one: &Range<u64>, other: &Range<u64>) -> bool {
    one.start < other.end && other.start < one.end
}

impl Default for Reel {
    fn default() -> Reel {
        let none = Clocks(0);
        let (computing, ahead) = (NEVER, Burst::default());
        Reel { recording: None, next: 0, computing, ahead, start: none, busy: none, longest_wait: none }
    }
}

impl Reel {
    /// Takes over a work item at a clock, when its core begins to ask for the last of the segments that are behind it.
    pub fn wind(&mut self, recording: Arc<Recording>, next: usize, clock: Clocks, lengths: &Lengths) {
        (self.next, self.start, self.busy) = (next, clock, Clocks(0));
        self.recording = Some(recording);
        self.look(lengths);
    }

    #[inline(always)]
    fn look(&mut self, lengths: &Lengths) {
        let segments = self.recording.as_ref().map_or(&[][..], |recording| &recording.segments);
        (self.computing, self.ahead) = ahead_of(segments, self.next, lengths);
    }

    /// Goes on from a transfer to the next one, and yields the clocks of computing between them; `None` when something else is next.
    #[inline(always)]
    pub(super) fn roll_on(&mut self, lengths: &Lengths) -> Option<(Clocks, Burst)> {
        let (computing, ahead) = (self.computing, self.ahead);
        if computing == NEVER {
            return None;
        }
        self.busy += computing;
        self.next += 1;
        self.look(lengths);
        Some((computing, ahead))
    }

    /// Goes on while its master asks before `limit`, where nobody else does: so it never waits. Where something else than a transfer comes next,
    /// the last burst before that is left.
    #[inline(never)]
    pub(super) fn roll_alone(&mut self, lengths: &Lengths, first: Burst, arrival: Clocks, limit: Clocks) -> Alone {
        let mut alone = Alone {
            burst: first,
            arrival,
            free: Clocks(0),
            held: Clocks(0),
            octets: Octets(0),
            transfers: 0,
            bursts: 0,
        };
        let segments = self.recording.as_ref().map_or(&[][..], |recording| &recording.segments);
        let (mut next, mut computing, mut ahead) = (self.next, self.computing, self.ahead);
        let before = (next, arrival);
        while alone.arrival < limit {
            let Burst { octets, rest, length } = alone.burst;
            let is_last = rest == Octets(0);
            if is_last && computing == NEVER {
                break;
            }
            alone.free = alone.arrival + length;
            alone.held += length;
            alone.octets += octets;
            alone.bursts += 1;
            if !is_last {
                (alone.burst, alone.arrival) = (lengths.burst(rest), alone.free);
                continue;
            }
            (alone.burst, alone.arrival) = (ahead, alone.free + computing);
            next += 1;
            (computing, ahead) = ahead_of(segments, next, lengths);
        }
        alone.transfers = (next - before.0) as u64;
        self.busy += alone.arrival - before.1 - alone.held;
        (self.next, self.computing, self.ahead) = (next, computing, ahead);
        alone
    }

    /// Makes it end with the transfer that its master asks for, where it reads any of these octets.
    pub fn stop_at(&mut self, written: &Range<u64>) {
        if self.recording.as_ref().is_some_and(|recording| overlap(&recording.reads, written)) {
            self.computing = NEVER;
        }
    }

    /// Notes how long its master waited.
    #[inline(always)]
    pub(super) fn note_wait(&mut self, waited: Clocks) {
        self.longest_wait = self.longest_wait.max(waited);
    }

    /// The longest wait for a grant since this was asked last.
    pub fn take_longest_wait(&mut self) -> Clocks {
        std::mem::take(&mut self.longest_wait)
    }

    /// Hands the work item back when its transfer has ended at a clock; `None` where its core has it.
    pub fn unwind(&mut self, clock: Clocks) -> Option<Played> {
        let recording = self.recording.take()?;
        self.computing = NEVER;
        Some(Played { recording, next: self.next, busy: self.busy, waiting: clock - self.start - self.busy })
    }
}
