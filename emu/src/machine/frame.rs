//! What a run of the machine gives: time, traffic, counts, memory. Nothing in it depends on the host.

use isa::number::Vector;

use super::bus::BusUse;
use crate::octets::Memory;
use crate::profile::Profile;
use crate::quantity::{Clocks, Octets};
use crate::tally::Tally;

/// Where one processor's clocks went; `busy + waiting + idle` is the length of the frame.
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
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Item {
    /// First vector of its first message: what it is about.
    pub subject: Vector,
    /// The core that did it.
    pub core: u32,
    /// When it got its first message, or was begun when it got none.
    pub start: Clocks,
    /// When it halted.
    pub end: Clocks,
    /// Instructions executed.
    pub instructions: u64,
    /// Elementary operations: add, sub, mul, div and cmp.
    pub elementary: u64,
}

/// Octets moved to or from one kind of data.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KindUse {
    /// Name that the loader gave it, or `message`, or `other` for addresses without a name.
    pub kind: String,
    /// Octets moved, over the bus or beside it.
    pub octets: Octets,
}

/// The result of a run of the machine.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Length of the frame: until the last processor had nothing more to do.
    pub clocks: Clocks,
    /// Each core, then the main processor.
    pub processors: Vec<ProcessorUse>,
    /// The bus.
    pub bus: BusUse,
    /// Octets that instructions asked to move, from the counts of the instructions.
    pub asked: Octets,
    /// Octets that were moved beside the bus because the main processor's traffic is off.
    pub aside: Octets,
    /// Octets by kind, in the order in which the loader named them, then `message`, then `other`.
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
    /// Work items in the order of their start, where a record of them was asked for.
    pub items: Vec<Item>,
    /// Number of work items finished.
    pub item_count: u64,
}

impl Frame {
    /// Share of the frame in which the bus was busy, in [0, 1].
    pub fn utilisation(&self) -> f64 {
        if self.clocks.0 == 0 { 0.0 } else { self.bus.busy.0 as f64 / self.clocks.0 as f64 }
    }

    /// Length of the frame in seconds at a clock rate in hertz.
    pub fn seconds(&self, clock_hz: u64) -> f64 {
        self.clocks.0 as f64 / clock_hz as f64
    }
}
