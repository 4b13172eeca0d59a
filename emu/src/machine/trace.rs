//! Trace of every processor and of the bus in a window of clocks. Only gathered here; file formats are no concern of this
//! crate.

use super::bus::Grant;
use super::request::{Access, Request};
use crate::code::quantity::{Clocks, Octets};

/// A part of the frame: from `start` on, `end` no longer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// First clock.
    pub start: Clocks,
    /// First clock after it.
    pub end: Clocks,
}

impl Window {
    /// The part of a time that lies in it; `None` for none.
    fn clip(&self, start: Clocks, end: Clocks) -> Option<(Clocks, Clocks)> {
        let (start, end) = (start.max(self.start), end.min(self.end));
        (start < end).then_some((start, end))
    }

    /// True where any of a time that begins at `start` and is over at `end` lies in it; a time of no length may.
    fn touches(&self, start: Clocks, end: Clocks) -> bool {
        start < self.end && end >= self.start
    }
}

/// Activity of a processor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Doing {
    /// Executing instructions.
    Busy,
    /// Waiting for its transfer.
    Waiting,
    /// Blocked by others, or without work.
    Idle,
}

/// Activity of a processor for a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// Kind of the act.
    pub doing: Doing,
    /// From when on.
    pub start: Clocks,
    /// Until when.
    pub end: Clocks,
}

/// The spans of one processor within a window, in the order of time, without gaps between them.
#[derive(Clone, Debug)]
pub struct Spans {
    window: Window,
    list: Vec<Span>,
}

impl Spans {
    /// None yet.
    pub fn new(window: Window) -> Spans {
        Spans { window, list: Vec::new() }
    }

    /// Adds what comes next.
    pub fn add(&mut self, doing: Doing, start: Clocks, end: Clocks) {
        let Some((start, end)) = self.window.clip(start, end) else { return };
        match self.list.last_mut() {
            Some(last) if last.doing == doing && last.end == start => last.end = end,
            _ => self.list.push(Span { doing, start, end }),
        }
    }

    /// The list.
    pub fn into_list(self) -> Vec<Span> {
        self.list
    }
}

/// Cargo of a burst.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cargo {
    /// Global memory is read from this address on.
    Read(u32),
    /// Global memory is written from this address on, or read and written back.
    Write(u32),
    /// A message to this processor.
    Message(u32),
}

/// A burst on the bus, with the whole of its times even where they reach out of the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TracedBurst {
    /// Master that has the bus: a core, or the main processor after the last core.
    pub master: u32,
    /// Clock at which it asked for it.
    pub asked: Clocks,
    /// Clock at which it got it.
    pub start: Clocks,
    /// End of the burst.
    pub end: Clocks,
    /// Cargo of the burst.
    pub cargo: Cargo,
    /// Octets that it moves.
    pub octets: Octets,
}

/// Everything that happened in a window.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Trace {
    /// The window.
    pub window: Window,
    /// Spans of each core, then of the main processor.
    pub processors: Vec<Vec<Span>>,
    /// Bursts that were asked for, or not yet over, in it, in the order of their grants.
    pub bursts: Vec<TracedBurst>,
}

/// Watches the bus.
#[derive(Clone, Debug)]
pub struct BusWatch {
    window: Window,
    /// Cargo of each master's transfer, and octets of it that were moved.
    carried: Vec<Option<(Cargo, Octets)>>,
    bursts: Vec<TracedBurst>,
}

impl BusWatch {
    /// Nothing seen yet.
    pub fn new(window: Window, masters: usize) -> BusWatch {
        BusWatch { window, carried: vec![None; masters], bursts: Vec::new() }
    }

    /// A master asks for a transfer.
    pub fn ask(&mut self, master: u32, request: Option<Request>) {
        let cargo = match request {
            Some(Request::Transfer { address, access: Access::Load | Access::Read, .. }) => Cargo::Read(address),
            Some(Request::Transfer { address, access: Access::Write, .. }) => Cargo::Write(address),
            Some(Request::Send { to, .. }) => Cargo::Message(to),
            _ => return,
        };
        self.carried[master as usize] = Some((cargo, Octets(0)));
    }

    /// A burst is granted.
    pub fn grant(&mut self, grant: &Grant) {
        let Some((cargo, moved)) = &mut self.carried[grant.master as usize] else { return };
        let cargo = match *cargo {
            Cargo::Read(address) => Cargo::Read(address.saturating_add(moved.0 as u32)),
            Cargo::Write(address) => Cargo::Write(address.saturating_add(moved.0 as u32)),
            Cargo::Message(to) => Cargo::Message(to),
        };
        *moved += grant.octets;
        let asked = grant.start - grant.waited;
        if self.window.touches(asked, grant.end) {
            let Grant { master, start, end, octets, .. } = *grant;
            self.bursts.push(TracedBurst { master, asked, start, end, cargo, octets });
        }
    }

    /// Trace of what was seen, with what the processors did.
    pub fn into_trace(self, processors: Vec<Vec<Span>>) -> Trace {
        Trace { window: self.window, processors, bursts: self.bursts }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_are_cut_to_the_window_and_joined() {
        let mut spans = Spans::new(Window { start: Clocks(10), end: Clocks(20) });
        for (doing, start, end) in [
            (Doing::Busy, 0, 10),
            (Doing::Busy, 10, 12),
            (Doing::Busy, 12, 13),
            (Doing::Idle, 13, 13),
            (Doing::Waiting, 13, 30),
            (Doing::Busy, 30, 31),
        ] {
            spans.add(doing, Clocks(start), Clocks(end));
        }
        let found: Vec<_> = spans.into_list().iter().map(|span| (span.doing, span.start.0, span.end.0)).collect();
        assert_eq!(found, [(Doing::Busy, 10, 13), (Doing::Waiting, 13, 20)]);
    }
}
