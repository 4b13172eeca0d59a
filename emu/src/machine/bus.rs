//! The shared bus: one burst at a time, to its end. Who comes next is the arbiter's choice.

use super::arbiter::{Arbiter, Claims, NEVER, Verdict};
use super::config::BusConfig;
use super::waits::Waits;
use crate::quantity::{Clocks, Octets};

/// What happened on the bus.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BusUse {
    /// Clocks in which a burst held it.
    pub busy: Clocks,
    /// Octets that went over it.
    pub moved: Octets,
    /// Transfers, messages included.
    pub transfers: u64,
    /// Grants: a transfer takes one for each of its bursts.
    pub bursts: u64,
    /// Longest time from asking for a burst to its grant.
    pub longest_wait: Clocks,
}

/// A burst that was granted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grant {
    /// Who got the bus.
    pub master: u32,
    /// When its burst begins.
    pub start: Clocks,
    /// When it ends and the bus is free again.
    pub end: Clocks,
    /// How long the master waited for it.
    pub waited: Clocks,
    /// Octets that it moves.
    pub octets: Octets,
    /// Whether the transfer is over with it; otherwise the master asks for the next burst at its end.
    pub is_last: bool,
}

/// What a master's transfer that has not ended moves.
#[derive(Clone, Copy, Debug, Default)]
struct Pending {
    /// Octets of the burst that it asks for.
    burst: Octets,
    /// Octets after that.
    rest: Octets,
}

/// A bus with its arbiter and the requests that wait for it. It knows nothing of what is transferred, so it serves the
/// stepped machine and a replay of recorded transfers alike.
pub struct Bus {
    config: BusConfig,
    longest_burst: Octets,
    /// Binary logarithm of the octets of a beat, where it is whole.
    beat_shift: Option<u32>,
    arbiter: Box<dyn Arbiter>,
    free_at: Clocks,
    not_before: Clocks,
    claims: Claims,
    pending: Vec<Pending>,
    used: BusUse,
    waits: Vec<Waits>,
}

impl Bus {
    /// An idle bus for that many masters.
    pub fn new(config: &BusConfig, masters: u32) -> Bus {
        Bus {
            arbiter: config.arbiter.build(config, masters),
            longest_burst: config.longest_burst(),
            beat_shift: config.octets_per_beat.is_power_of_two().then(|| config.octets_per_beat.trailing_zeros()),
            config: config.clone(),
            free_at: Clocks(0),
            not_before: Clocks(0),
            claims: Claims::new(masters),
            pending: vec![Pending::default(); masters as usize],
            used: BusUse::default(),
            waits: vec![Waits::default(); masters as usize],
        }
    }

    /// A master begins to ask; each has at most one transfer at a time.
    #[inline]
    pub fn request(&mut self, master: u32, arrival: Clocks, octets: Octets) {
        debug_assert_eq!(self.claims.arrival(master), NEVER, "one transfer a master");
        self.not_before = self.not_before.min(arrival);
        self.ask(master, arrival, octets);
    }

    #[inline]
    fn ask(&mut self, master: u32, arrival: Clocks, octets: Octets) {
        let burst = octets.min(self.longest_burst);
        // Dividing takes longer than all the rest.
        let beats = match self.beat_shift {
            Some(shift) => (burst.0 + self.config.octets_per_beat - 1) >> shift,
            None => burst.0.div_ceil(self.config.octets_per_beat),
        };
        let length = Clocks(self.config.setup_clocks + beats * self.config.clocks_per_beat);
        self.claims.ask(master, arrival, length);
        self.pending[master as usize] = Pending { burst, rest: octets - burst };
    }

    /// When the arbiter has something to decide, if nobody else begins to ask before.
    #[inline]
    pub fn next_decision(&self) -> Option<Clocks> {
        self.claims.first_at(self.free_at.max(self.not_before))
    }

    /// Lets the arbiter decide at a clock that [`Bus::next_decision`] gave; `None` when it leaves the bus idle for now.
    #[inline]
    pub fn decide(&mut self, clock: Clocks) -> Option<Grant> {
        let master = match self.arbiter.choose(clock, &self.claims) {
            Verdict::Grant(master) => master,
            Verdict::Later(later) => {
                let others = (0..self.claims.masters()).map(|master| self.claims.arrival(master));
                let next = others.filter(|&arrival| arrival > clock).min().map_or(later, |arrival| arrival.min(later));
                self.not_before = next.max(clock + Clocks(1));
                return None;
            }
        };
        let (waited, length) = (clock - self.claims.arrival(master), self.claims.length(master));
        let Pending { burst, rest } = self.pending[master as usize];
        let (end, is_last) = (clock + length, rest == Octets(0));
        self.free_at = end;
        self.not_before = Clocks(0);
        if is_last {
            self.claims.withdraw(master);
            self.used.transfers += 1;
        } else {
            self.ask(master, end, rest);
        }
        self.used.busy += length;
        self.used.moved += burst;
        self.used.bursts += 1;
        self.used.longest_wait = self.used.longest_wait.max(waited);
        self.waits[master as usize].add(waited);
        Some(Grant { master, start: clock, end, waited, octets: burst, is_last })
    }

    /// What has happened so far.
    pub fn used(&self) -> BusUse {
        self.used
    }

    /// How long each master waited, burst by burst.
    pub fn waits(&self) -> &[Waits] {
        &self.waits
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_burst_is_as_long_with_a_shift_as_with_a_division() {
        for octets_per_beat in 1..10 {
            let config = BusConfig { octets_per_beat, setup_clocks: 3, ..BusConfig::default() };
            for octets in 0..70 {
                let mut bus = Bus::new(&config, 1);
                bus.request(0, Clocks(5), Octets(octets));
                let grant = bus.decide(Clocks(5)).expect("it is alone");
                assert_eq!(grant.end - grant.start, config.length(Octets(octets)), "{octets_per_beat} {octets}");
            }
        }
    }
}
