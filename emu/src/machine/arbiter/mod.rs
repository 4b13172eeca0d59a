//! Who gets the bus next: one trait, one small file for each arbiter. When the bus is free is not decided here.

mod round_robin;

use serde::{Deserialize, Serialize};

pub use round_robin::RoundRobin;

use crate::quantity::Clocks;

/// A master that asks for the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Claim {
    /// Number of the master: a core, or the main processor after the last core.
    pub master: u32,
    /// When it began to ask.
    pub arrival: Clocks,
    /// How long its transfer will hold the bus.
    pub length: Clocks,
}

/// What an arbiter decides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The bus goes to this one of the claims, counted from 0.
    Grant(usize),
    /// Nobody may use the bus now; ask again at this later clock, or earlier when another master begins to ask.
    Later(Clocks),
}

/// Chooses among the masters that ask for a free bus. A grant lasts to the end of the transfer.
pub trait Arbiter: Send {
    /// Decides at `clock`, when the bus is free. There is at least one claim, all have arrived by then, and they stand
    /// in the order of their masters.
    fn choose(&mut self, clock: Clocks, claims: &[Claim]) -> Verdict;
}

/// The arbiters that a machine can have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ArbiterKind {
    /// [`RoundRobin`].
    #[default]
    RoundRobin,
}

impl ArbiterKind {
    /// A new arbiter of the kind for that many masters.
    pub fn build(self, masters: u32) -> Box<dyn Arbiter> {
        match self {
            ArbiterKind::RoundRobin => Box::new(RoundRobin::new(masters)),
        }
    }
}
