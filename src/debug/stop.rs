//! Reasons to stop before the end: breakpoints, and watches of a register, a word of the buffer or an address on the bus.

use emu::stepper::{Executed, Stepper, TransferKind};
use isa::naming::RegisterId;

use super::condition::StopCondition;
use crate::registers::{self, RegisterContents};

/// Thing that is watched.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Watched {
    /// A register: stops when it changes.
    Register(RegisterId),
    /// Octets of the local buffer: stops when they change.
    Buffer(u32, u32),
    /// Octets of global memory: stops behind each transfer that touches them.
    Bus(u32, u32),
}

/// Event that a stop point waits for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// The program comes to one of these words.
    At(Vec<u32>),
    /// Something that is watched changes, or goes over the bus.
    Watch(Watched),
}

/// A stop point of the user.
#[derive(Clone, Debug)]
pub struct StopPoint {
    /// Number by which it is named.
    pub number: u32,
    /// The place or thing, as it was typed.
    pub text: String,
    /// Event that stops the core.
    pub event: Event,
    /// StopCondition that has to hold besides.
    pub condition: Option<StopCondition>,
    /// The stop is the n-th time and every one after, counted from the program's start; 1 for every time.
    pub count: u64,
}

/// Contents of what is watched.
pub fn contents(watched: &Watched, stepper: &Stepper) -> Option<Vec<i64>> {
    match watched {
        Watched::Register(register) => Some(RegisterContents::of(&stepper.state().registers, *register).numbers()),
        Watched::Buffer(address, octets) => {
            let slice = stepper.state().buffer.slice(*address, *octets).ok()?;
            Some(slice.iter().map(|octet| i64::from(*octet)).collect())
        }
        Watched::Bus(..) => None,
    }
}

impl StopPoint {
    /// True where the state behind an instruction (`None` at the program's start) is one that the stop point waits for. `before` is what
    /// was watched before the instruction.
    pub fn is_met(&self, stepper: &Stepper, executed: Option<&Executed>, before: Option<&Vec<i64>>) -> bool {
        let happens = match &self.event {
            Event::At(words) => stepper.end().is_none() && words.contains(&stepper.state().pc),
            Event::Watch(watched @ (Watched::Register(_) | Watched::Buffer(..))) => {
                executed.is_some() && contents(watched, stepper).as_ref() != before
            }
            Event::Watch(Watched::Bus(address, octets)) => {
                executed.and_then(|executed| executed.transfer).is_some_and(|transfer| {
                    let is_message = matches!(transfer.kind, TransferKind::Send | TransferKind::Receive);
                    let (start, end) =
                        (u64::from(transfer.address), u64::from(transfer.address) + u64::from(transfer.octets));
                    !is_message && start < u64::from(*address) + u64::from(*octets) && u64::from(*address) < end
                })
            }
        };
        happens && self.condition.as_ref().is_none_or(|condition| condition.holds(stepper))
    }

    /// The stop point in a line.
    pub fn line(&self) -> String {
        let condition = self.condition.as_ref().map_or(String::new(), |condition| format!(" if {}", condition.text()));
        let count = if self.count > 1 { format!(" count {}", self.count) } else { String::new() };
        let kind = match self.event {
            Event::At(_) => "break",
            Event::Watch(_) => "watch",
        };
        format!("{}: {kind} {}{condition}{count}", self.number, self.text)
    }
}

/// Name of what is watched.
pub fn name(watched: &Watched) -> String {
    match watched {
        Watched::Register(register) => registers::name(*register),
        Watched::Buffer(address, octets) => format!("buffer {address:#x} {octets}"),
        Watched::Bus(address, octets) => format!("memory {address:#x} {octets}"),
    }
}
