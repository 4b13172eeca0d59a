//! The shared bus: one transfer at a time, to its end. Who comes next is the arbiter's choice.

use super::arbiter::{Arbiter, Claim, Verdict};
use super::config::BusConfig;
use crate::quantity::{Clocks, Octets};

/// What happened on the bus.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BusUse {
    /// Clocks in which a transfer held it.
    pub busy: Clocks,
    /// Octets that went over it.
    pub moved: Octets,
    /// Transfers, messages included.
    pub transfers: u64,
    /// Longest time from a request to its grant.
    pub longest_wait: Clocks,
}

/// A transfer that was granted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grant {
    /// Who got the bus.
    pub master: u32,
    /// When its transfer begins.
    pub start: Clocks,
    /// When it ends and the bus is free again.
    pub end: Clocks,
}

/// A bus with its arbiter and the requests that wait for it. It knows nothing of what is transferred, so it serves the
/// stepped machine and a replay of recorded transfers alike.
pub struct Bus {
    config: BusConfig,
    arbiter: Box<dyn Arbiter>,
    free_at: Clocks,
    not_before: Clocks,
    waiting: Vec<(Claim, Octets)>,
    present: Vec<Claim>,
    used: BusUse,
}

impl Bus {
    /// An idle bus for that many masters.
    pub fn new(config: &BusConfig, masters: u32) -> Bus {
        Bus {
            arbiter: config.arbiter.build(masters),
            config: config.clone(),
            free_at: Clocks(0),
            not_before: Clocks(0),
            waiting: Vec::with_capacity(masters as usize),
            present: Vec::with_capacity(masters as usize),
            used: BusUse::default(),
        }
    }

    /// A master begins to ask; each has at most one request at a time.
    pub fn request(&mut self, master: u32, arrival: Clocks, octets: Octets) {
        debug_assert!(self.waiting.iter().all(|(claim, _)| claim.master != master), "one request a master");
        let claim = Claim { master, arrival, length: self.config.length(octets) };
        let place = self.waiting.partition_point(|(other, _)| other.master < master);
        self.waiting.insert(place, (claim, octets));
        self.not_before = self.not_before.min(arrival);
    }

    /// When the arbiter has something to decide, if nobody else begins to ask before.
    pub fn next_decision(&self) -> Option<Clocks> {
        let earliest = self.waiting.iter().map(|(claim, _)| claim.arrival).min()?;
        Some(earliest.max(self.free_at).max(self.not_before))
    }

    /// Lets the arbiter decide at a clock that [`Bus::next_decision`] gave; `None` when it leaves the bus idle for now.
    pub fn decide(&mut self, clock: Clocks) -> Option<Grant> {
        self.present.clear();
        self.present.extend(self.waiting.iter().map(|&(claim, _)| claim).filter(|claim| claim.arrival <= clock));
        match self.arbiter.choose(clock, &self.present) {
            Verdict::Grant(chosen) => {
                let Claim { master, arrival, length } = self.present[chosen];
                let place = self.waiting.iter().position(|(claim, _)| claim.master == master)?;
                let (_, octets) = self.waiting.remove(place);
                let end = clock + length;
                self.free_at = end;
                self.not_before = Clocks(0);
                self.used.busy += length;
                self.used.moved += octets;
                self.used.transfers += 1;
                self.used.longest_wait = self.used.longest_wait.max(clock - arrival);
                Some(Grant { master, start: clock, end })
            }
            Verdict::Later(later) => {
                let others = self.waiting.iter().map(|(claim, _)| claim.arrival).filter(|&arrival| arrival > clock);
                let next = others.min().map_or(later, |arrival| arrival.min(later));
                self.not_before = next.max(clock + Clocks(1));
                None
            }
        }
    }

    /// What has happened so far.
    pub fn used(&self) -> BusUse {
        self.used
    }
}
