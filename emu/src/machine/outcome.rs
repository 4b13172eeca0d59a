//! Outcome of a run of the machine: time, traffic, counts, memory. Nothing in it depends on the host.

use isa::number::Vector;

use super::bus::BusUse;
use super::cache::CacheUse;
use super::course::BusCourse;
use super::trace::Trace;
use super::waits::Waits;
use crate::code::octets::Memory;
use crate::code::quantity::{Clocks, Octets};
use crate::code::tally::Tally;
use crate::profile::{Profile, ProgramClocks};
use crate::semantics::Message;

/// Clocks of one processor by use; `busy + waiting + idle` is the length of the frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ProcessorUse {
    /// Clocks of instructions.
    pub busy: Clocks,
    /// Clocks from a bus request to the end of its transfer.
    pub waiting: Clocks,
    /// Clocks blocked in a receive, a barrier or a send to a full mailbox, or without work.
    pub idle: Clocks,
    /// Octets that it moved, over the bus or beside it.
    pub octets: Octets,
    /// Longest time from a request to its grant.
    pub longest_wait: Clocks,
    /// Work items that it finished.
    pub items: u64,
    /// Instructions that it executed.
    pub instructions: u64,
}

/// One work item.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Item {
    /// First vector of its first message: what it is about.
    pub subject: Vector,
    /// First message of the item, where the run is traced; `None` where it got none.
    pub message: Option<Box<Message>>,
    /// The core that did it.
    pub core: u32,
    /// Clock at which it got its first message, or was begun when it got none.
    pub start: Clocks,
    /// Clock at which it halted.
    pub end: Clocks,
    /// Clocks of those in which the core waited for transfers.
    pub waiting: Clocks,
    /// Octets that it moved, over the bus or beside it.
    pub octets: Octets,
    /// Instructions executed.
    pub instructions: u64,
    /// Elementary operations: add, sub, mul, div and cmp.
    pub elementary: u64,
}

/// Octets moved to or from one kind of data.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KindUse {
    /// Name that the loader gave it, or `messages`, or `other` for addresses without a name.
    pub kind: String,
    /// Octets moved, over the bus or beside it.
    pub octets: Octets,
}

/// Method by which a frame was run; its result does not depend on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Work items ran by themselves, and what they did was replayed on the machine's clock.
    Replayed,
    /// Everything happened in the order of the machine's clock.
    Stepped {
        /// Reason for which it could not be replayed; empty when stepping was asked for.
        why: &'static str,
    },
}

impl Method {
    /// In a word: `replayed` or `stepped`.
    pub fn name(self) -> &'static str {
        match self {
            Method::Replayed => "replayed",
            Method::Stepped { .. } => "stepped",
        }
    }

    /// Reason for which it was stepped; `None` when it was not.
    pub fn reason(self) -> Option<&'static str> {
        match self {
            Method::Replayed => None,
            Method::Stepped { why } => Some(why),
        }
    }
}

/// The result of a run of the machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RunOutcome {
    /// Method of the run.
    pub method: Method,
    /// Length of the frame: until the last processor had nothing more to do.
    pub clocks: Clocks,
    /// Each core, then the main processor.
    pub processors: Vec<ProcessorUse>,
    /// The bus.
    pub bus: BusUse,
    /// Waits of each master for its bursts: the cores, then the main processor where it uses the bus.
    pub waits: Vec<Waits>,
    /// The cores' caches together. What was asked for is what was moved over the bus and beside it, without the lines
    /// that were filled, and with what was asked of the caches.
    pub cache: CacheUse,
    /// Octets that instructions asked to move, from the counts of the instructions.
    pub asked: Octets,
    /// Octets that were moved beside the bus because the main processor's traffic is off.
    pub bypassed: Octets,
    /// Octets by kind, in the order in which the loader named them, then `messages`, then `other`.
    pub kinds: Vec<KindUse>,
    /// Global memory at the end.
    pub memory: Memory,
    /// Passes of all cores.
    pub tally: Tally,
    /// Passes of the main processor.
    pub main_tally: Tally,
    /// Functions and regions of the cores' program, where a profile was asked for.
    pub profile: Option<Profile>,
    /// Functions and regions of the main processor's program, where a profile was asked for.
    pub main_profile: Option<Profile>,
    /// Clocks of functions and regions of each core, where they were asked for.
    pub core_clocks: Vec<ProgramClocks>,
    /// Work items in the order of their start, where a record of them was asked for.
    pub items: Vec<Item>,
    /// Trace of the window that was asked for.
    pub trace: Option<Trace>,
    /// Clocks of the bus over time, where they were asked for.
    pub course: Option<BusCourse>,
    /// Number of work items finished.
    pub item_count: u64,
}

impl RunOutcome {
    /// Share of the frame in which the bus was busy, in [0, 1].
    pub fn utilisation(&self) -> f64 {
        if self.clocks.0 == 0 { 0.0 } else { self.bus.busy.0 as f64 / self.clocks.0 as f64 }
    }

    /// Length of the frame in seconds at a clock rate in hertz.
    pub fn seconds(&self, clock_hz: u64) -> f64 {
        self.clocks.0 as f64 / clock_hz as f64
    }
}
