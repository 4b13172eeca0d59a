//! Who gets the bus next: one trait, one small file for each arbiter. When the bus is free is not decided here.

mod fixed_priority;
mod oldest_first;
mod round_robin;
mod tdma;
mod weighted;

use serde::{Deserialize, Serialize};

pub use fixed_priority::FixedPriority;
pub use oldest_first::OldestFirst;
pub use round_robin::RoundRobin;
pub use tdma::Tdma;
pub use weighted::Weighted;

use super::bus::Burst;
use super::config::BusConfig;
use crate::code::quantity::Clocks;

/// The bursts that masters ask for. A master's number is that of its core, the main processor comes after the last core.
#[derive(Clone, Debug)]
pub struct BusRequests {
    /// When each begins to ask.
    pub(super) arrivals: Vec<Clocks>,
    /// Its burst.
    pub(super) bursts: Vec<Burst>,
}

/// When a master begins to ask that does not ask.
pub const NEVER: Clocks = Clocks(u64::MAX);

impl BusRequests {
    /// Nobody asks.
    pub fn new(masters: u32) -> BusRequests {
        BusRequests { arrivals: vec![NEVER; masters as usize], bursts: vec![Burst::default(); masters as usize] }
    }

    /// A master asks for a burst from a clock on.
    #[inline]
    pub fn ask(&mut self, master: u32, arrival: Clocks, burst: Burst) {
        (self.arrivals[master as usize], self.bursts[master as usize]) = (arrival, burst);
    }

    /// A master asks no more.
    #[inline]
    pub fn withdraw(&mut self, master: u32) {
        self.arrivals[master as usize] = NEVER;
    }

    /// Number of masters, whether they ask or not.
    #[inline]
    pub fn masters(&self) -> u32 {
        self.arrivals.len() as u32
    }

    /// When a master began, or begins, to ask for its burst; beyond every clock for one that does not.
    #[inline]
    pub fn arrival(&self, master: u32) -> Clocks {
        self.arrivals[master as usize]
    }

    /// How long a master's burst will hold the bus.
    #[inline]
    pub fn length(&self, master: u32) -> Clocks {
        self.bursts[master as usize].length
    }

    /// The first clock, not before `floor`, at which anybody asks; `None` when nobody ever does.
    #[inline]
    pub fn first_at(&self, floor: Clocks) -> Option<Clocks> {
        self.arrivals.iter().copied().min().filter(|&arrival| arrival != NEVER).map(|arrival| arrival.max(floor))
    }

    /// Whether all that ask begin to before a clock.
    pub(super) fn are_before(&self, clock: u64) -> bool {
        self.arrivals.iter().all(|&arrival| arrival.0 < clock || arrival == NEVER)
    }

    /// Masters that ask at a clock, by number.
    pub fn asking(&self, clock: Clocks) -> impl Iterator<Item = u32> {
        (0..).zip(&self.arrivals).filter(move |(_, arrival)| **arrival <= clock).map(|(master, _)| master)
    }

    /// The first master from `turn` on, round the circle, that asks at a clock.
    #[inline]
    pub fn first_from(&self, turn: u32, clock: Clocks) -> Option<u32> {
        let (before, after) = self.arrivals.split_at(turn as usize);
        let asks = |arrival: &Clocks| *arrival <= clock;
        match after.iter().position(asks) {
            Some(place) => Some(turn + place as u32),
            None => before.iter().position(asks).map(|place| place as u32),
        }
    }
}

/// What an arbiter decides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The bus goes to this master, which asks.
    Grant(u32),
    /// Nobody may use the bus now; ask again at this later clock, or earlier when another master begins to ask.
    Later(Clocks),
}

/// Chooses among the masters that ask for a free bus. A grant lasts to the end of the burst.
pub trait Arbiter: Send {
    /// Decides at `clock`, when the bus is free and at least one master asks.
    fn choose(&mut self, clock: Clocks, requests: &BusRequests) -> Verdict;

    /// The order of those that ask, where that says all; what it does not say is asked turn by turn.
    fn ranking(&mut self) -> Option<Ranking<'_>> {
        None
    }
}

/// An order of masters which tells who of those that ask comes first.
#[derive(Debug, PartialEq, Eq)]
pub enum Ranking<'a> {
    /// From this master on, round the circle; who gets a burst makes the one behind it the first.
    Circle(&'a mut u32),
    /// By number.
    Number,
    /// By when they began to ask, then by number.
    Arrival,
}

/// The verdict for a master, where one asks.
fn grant(master: Option<u32>, clock: Clocks) -> Verdict {
    master.map_or(Verdict::Later(clock + Clocks(1)), Verdict::Grant)
}

/// The arbiters that a machine can have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ArbiterKind {
    /// [`FixedPriority`].
    FixedPriority,
    /// [`RoundRobin`].
    #[default]
    RoundRobin,
    /// [`Weighted`].
    Weighted,
    /// [`OldestFirst`].
    OldestFirst,
    /// [`Tdma`].
    Tdma,
}

impl ArbiterKind {
    /// All of them, in the order of their names' first mention in the manual.
    pub const ALL: [ArbiterKind; 5] = [
        ArbiterKind::FixedPriority,
        ArbiterKind::RoundRobin,
        ArbiterKind::Weighted,
        ArbiterKind::OldestFirst,
        ArbiterKind::Tdma,
    ];

    /// Its name, as in a machine's file.
    pub fn name(self) -> &'static str {
        match self {
            ArbiterKind::FixedPriority => "fixed-priority",
            ArbiterKind::RoundRobin => "round-robin",
            ArbiterKind::Weighted => "weighted",
            ArbiterKind::OldestFirst => "oldest-first",
            ArbiterKind::Tdma => "tdma",
        }
    }

    /// A new arbiter of the kind for that many masters, with its parameters.
    pub fn build(self, config: &BusConfig, masters: u32) -> Box<dyn Arbiter> {
        match self {
            ArbiterKind::FixedPriority => Box::new(FixedPriority),
            ArbiterKind::RoundRobin => Box::new(RoundRobin::new()),
            ArbiterKind::Weighted => Box::new(Weighted::new(masters, &config.weights)),
            ArbiterKind::OldestFirst => Box::new(OldestFirst),
            ArbiterKind::Tdma => Box::new(Tdma::new(masters, Clocks(config.slot_clocks))),
        }
    }
}

/// BusRequests of these masters, each from a clock on, for that long.
#[cfg(test)]
fn requests(masters: u32, asking: impl IntoIterator<Item = (u32, u64, u64)>) -> BusRequests {
    let mut requests = BusRequests::new(masters);
    for (master, arrival, length) in asking {
        requests.ask(master, Clocks(arrival), Burst { length: Clocks(length), ..Burst::default() });
    }
    requests
}

/// The masters that get the bus, turn by turn, with these of four masters asking for one clock each.
#[cfg(test)]
fn turns(arbiter: &mut dyn Arbiter, asking: &[&[u32]]) -> Vec<u32> {
    let turn = |masters: &&[u32]| {
        let requests = requests(4, masters.iter().map(|&master| (master, 0, 1)));
        match arbiter.choose(Clocks(0), &requests) {
            Verdict::Grant(chosen) => chosen,
            Verdict::Later(clock) => panic!("the bus stays idle until {clock:?}"),
        }
    };
    asking.iter().map(turn).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_the_machines_file() {
        for kind in ArbiterKind::ALL {
            let config = BusConfig { arbiter: kind, ..BusConfig::default() };
            let text = toml::to_string(&config).expect("a bus has nothing that TOML cannot hold");
            assert!(text.contains(&format!("arbiter = \"{}\"", kind.name())), "{text}");
        }
    }
}
