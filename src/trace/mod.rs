//! A window of a machine's clocks as files that viewers of waves and of traces read. What happened is gathered by the
//! machine; here it gets names and formats.

mod functions;
pub mod instruction;
mod open;
pub mod output;
mod perfetto;
mod wave;
pub mod window;

use emu::machine::trace::{Cargo, Doing, Span, Trace, TracedBurst, Window};
use emu::machine::{Item, RunOutcome};
use emu::quantity::Clocks;

pub use functions::{FunctionSlice, functions};
pub use perfetto::perfetto;
pub use wave::wave;

use crate::load::Load;

/// A window of a trace, with what gives it names.
pub struct TracedScene<'a> {
    /// Name of the scene.
    pub name: &'a str,
    /// Programs and memory.
    pub load: &'a Load,
    /// Clock rate in hertz.
    pub clock_hz: u64,
    /// Events of the window.
    pub trace: &'a Trace,
    /// All work items of the frame, in the order of their start.
    pub items: &'a [Item],
}

impl<'a> TracedScene<'a> {
    /// The window of a frame; `None` for a frame without one.
    pub fn new(name: &'a str, load: &'a Load, clock_hz: u64, frame: &'a RunOutcome) -> Option<TracedScene<'a>> {
        Some(TracedScene { name, load, clock_hz, trace: frame.trace.as_ref()?, items: &frame.items })
    }

    /// Number of cores.
    fn cores(&self) -> usize {
        self.trace.processors.len() - 1
    }

    /// Name of a processor.
    pub fn processor(&self, number: usize) -> String {
        if number == self.cores() { "main".to_owned() } else { format!("core {number}") }
    }

    /// Clocks of each processor that it was busy, waiting and idle, from the window's start to `end`.
    pub fn shares(&self, end: Clocks) -> Vec<[u64; 3]> {
        let share = |spans: &[Span], doing: Doing| {
            let spans = spans.iter().filter(|span| span.doing == doing && span.start < end);
            spans.map(|span| (span.end.min(end) - span.start).0).sum()
        };
        let shares = |spans: &Vec<Span>| [Doing::Busy, Doing::Waiting, Doing::Idle].map(|doing| share(spans, doing));
        self.trace.processors.iter().map(shares).collect()
    }

    /// Clocks that the bus was busy, from the window's start to `end`.
    pub fn bus_busy(&self, end: Clocks) -> u64 {
        let start = self.trace.window.start;
        let clip = |burst: &TracedBurst| (burst.start.clamp(start, end), burst.end.clamp(start, end));
        self.trace.bursts.iter().map(clip).map(|(start, end)| (end - start).0).sum()
    }

    /// The window that has all work items whole of which a part lies in the window of the scene.
    pub fn whole_items(&self) -> Window {
        let Window { start, end } = self.trace.window;
        Window {
            start: self.items().map(|item| item.start).min().unwrap_or(start).min(start),
            end: self.items().map(|item| item.end).max().unwrap_or(end).max(end),
        }
    }

    /// Work items of which a part lies in the window.
    fn items(&self) -> impl Iterator<Item = &Item> {
        let window = self.trace.window;
        self.items.iter().filter(move |item| item.start < window.end && item.end > window.start)
    }

    /// Words for the cargo of a burst.
    fn cargo(&self, cargo: Cargo) -> String {
        let kind = |address: u32| {
            let found = self.load.kinds.iter().find(|(range, _)| range.contains(&address));
            found.map_or("other", |(_, kind)| kind.as_str())
        };
        match cargo {
            Cargo::Read(address) => format!("reads {}", kind(address)),
            Cargo::Write(address) => format!("writes {}", kind(address)),
            Cargo::Message(to) => format!("message to {}", self.processor(to as usize)),
        }
    }
}

/// The address of what a burst carries, where it has one.
fn address(cargo: Cargo) -> Option<u32> {
    match cargo {
        Cargo::Read(address) | Cargo::Write(address) => Some(address),
        Cargo::Message(_) => None,
    }
}
