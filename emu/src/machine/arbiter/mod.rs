//! Arbiters, which say who gets the bus next: one trait, one small file for each. When the bus is free is not decided here.

use serde::{Deserialize, Serialize};

use super::bus::Burst;
use super::config::BusConfig;
use crate::code::quantity::Clocks;

/// The bursts that masters ask for. A master's number is that of its core, the main processor comes after the last core.
#[derive(Clone, Debug)]
pub struct BusRequests {
    /// Clocks at which each begins to ask.
    pub(super) arrivals: Vec<Clocks>,
    /// Bursts that they ask for.
    pub(super) bursts: Vec<Burst>,
}

/// Arrival of a master that does not ask.
pub const NEVER: Clocks = Clocks(u64::MAX);

impl BusRequests {
    /// Requests of so many masters, none of which asks.
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

    /// Clock at which a master began, or begins, to ask for its burst; beyond every clock for one that does not.
    #[inline]
    pub fn arrival(&self, master: u32) -> Clocks {
        self.arrivals[master as usize]
    }

    /// Length of a master's burst in clocks.
    #[inline]
    pub fn length(&self, master: u32) -> Clocks {
        self.bursts[master as usize].length
    }

    /// The first clock, not before `floor`, at which anybody asks; `None` when nobody ever does.
    #[inline]
    pub fn first_at(&self, floor: Clocks) -> Option<Clocks> {
        self.arrivals.iter().copied().min().filter(|&arrival| arrival != NEVER).map(|arrival| arrival.max(floor))
    }

    /// True where all that ask begin to before a clock.
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

/// Decision of an arbiter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The bus goes to this master, which asks.
    Grant(u32),
    /// No master may use the bus now; ask again at this later clock, or earlier when another master begins to ask.
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

    /// The slots of time in which masters have the bus whoever else asks, where that says all.
    fn slots(&self) -> Option<Tdma> {
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

/// The arbiters that a machine can have: a line each, with its file, its type, its name in a machine's file, and how it is made for some masters.
/// The one that is the default has the attribute.
macro_rules! arbiters {
    ($($(#[$default:ident])? $file:ident $arbiter:ident $name:literal ($config:pat, $masters:pat) => $new:expr;)*) => {
        $(mod $file;)*
        $(pub use $file::$arbiter;)*

        /// Kinds of arbiters that a machine can have.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
        pub enum ArbiterKind {
            $(
                #[doc = concat!("[`", stringify!($arbiter), "`].")]
                #[serde(rename = $name)]
                $(#[$default])?
                $arbiter,
            )*
        }

        impl ArbiterKind {
            /// All of them, in the order of their names' first mention in the manual.
            pub const ALL: [ArbiterKind; [$($name),*].len()] = [$(ArbiterKind::$arbiter),*];

            /// Name, as in a machine's file.
            pub fn name(self) -> &'static str {
                match self {
                    $(ArbiterKind::$arbiter => $name,)*
                }
            }

            /// A new arbiter of the kind for that many masters, with its parameters.
            pub fn build(self, config: &BusConfig, masters: u32) -> Box<dyn Arbiter> {
                match self {
                    $(ArbiterKind::$arbiter => {
                        let ($config, $masters) = (config, masters);
                        Box::new($new)
                    })*
                }
            }
        }
    };
}

arbiters! {
    fixed_priority FixedPriority "fixed-priority" (_, _) => FixedPriority;
    #[default] round_robin RoundRobin "round-robin" (_, _) => RoundRobin::new();
    weighted Weighted "weighted" (config, masters) => Weighted::new(masters, &config.weights);
    oldest_first OldestFirst "oldest-first" (_, _) => OldestFirst;
    tdma Tdma "tdma" (config, masters) => Tdma::new(masters, Clocks(config.slot_clocks));
}

/// Requests of these masters, each from a clock on, for that long.
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
