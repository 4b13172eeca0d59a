//! Faults of the bus's grants, as an arbiter around the machine's own: from a clock on a grant is lost, the arbiter is stuck, or a master that
//! has stopped is never heard of again. A bus that serves its masters by itself has [`super::muted`] instead.

use super::arbiter::{Arbiter, BusRequests, NEVER, Verdict};
use crate::code::quantity::Clocks;

/// Kind of a fault of grants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GrantFaultKind {
    /// The next grant reaches nobody: the bus is idle for its burst, and the arbiter takes the request for served. A master that asks again after
    /// some clocks is heard again; 0 for one that never does.
    Lost {
        /// Clocks after which the master asks again.
        retry: Clocks,
    },
    /// The arbiter grants to one master, whoever else asks.
    Stuck,
    /// A master has stopped, so that it asks no more.
    Stopped,
}

/// Fault of grants from a clock on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GrantFault {
    /// Kind of the fault.
    pub kind: GrantFaultKind,
    /// Clock from which it is there.
    pub at: Clocks,
    /// The master that an arbiter is stuck at, or that has stopped.
    pub master: u32,
}

#[cfg(test)]
impl GrantFault {
    /// Fault of the kind of a number, for tests that draw one.
    pub(crate) fn numbered(kind: u8, at: u64, master: u32, retry: u64) -> GrantFault {
        let kind = match kind {
            0 => GrantFaultKind::Lost { retry: Clocks(retry) },
            1 => GrantFaultKind::Stuck,
            _ => GrantFaultKind::Stopped,
        };
        GrantFault { kind, at: Clocks(at), master }
    }
}

/// A request whose grant was lost.
#[derive(Clone, Copy)]
struct LostRequest {
    master: u32,
    arrival: Clocks,
    /// Clock at which it is made again.
    again: Clocks,
    /// End of the burst that does not happen.
    idle_until: Clocks,
}

/// An arbiter with a fault.
pub(super) struct FaultyArbiter {
    inner: Box<dyn Arbiter>,
    fault: GrantFault,
    lost: Option<LostRequest>,
}

impl FaultyArbiter {
    /// An arbiter that is right before its fault.
    pub fn new(inner: Box<dyn Arbiter>, fault: GrantFault) -> FaultyArbiter {
        FaultyArbiter { inner, fault, lost: None }
    }

    /// Decision without a master, which may be asking, up to a clock.
    fn without(&mut self, master: u32, until: Clocks, clock: Clocks, requests: &BusRequests) -> Verdict {
        let mut rest = requests.clone();
        rest.withdraw(master);
        let verdict = match rest.first_at(clock) {
            Some(first) if first <= clock => self.inner.choose(clock, &rest),
            // The bus asks again of itself when another master comes.
            _ => Verdict::Later(NEVER),
        };
        match verdict {
            Verdict::Later(later) => Verdict::Later(later.min(until)),
            grant => grant,
        }
    }

    fn lose(&mut self, retry: Clocks, clock: Clocks, requests: &BusRequests) -> Verdict {
        if let Some(LostRequest { master, arrival, again, idle_until }) = self.lost {
            // The bus asks as well when another master comes in the middle of it.
            if clock < idle_until {
                return Verdict::Later(idle_until);
            }
            let is_hidden = requests.arrival(master) == arrival && clock < again;
            return match is_hidden {
                true => self.without(master, again, clock, requests),
                false => self.inner.choose(clock, requests),
            };
        }
        let verdict = self.inner.choose(clock, requests);
        if let Verdict::Grant(master) = verdict {
            let again = if retry == Clocks(0) { NEVER } else { clock + retry };
            let idle_until = clock + requests.length(master);
            self.lost = Some(LostRequest { master, arrival: requests.arrival(master), again, idle_until });
            return Verdict::Later(idle_until);
        }
        verdict
    }
}

impl Arbiter for FaultyArbiter {
    fn choose(&mut self, clock: Clocks, requests: &BusRequests) -> Verdict {
        let GrantFault { kind, at, master } = self.fault;
        if clock < at {
            // Who is put off beyond the fault meets it, whether another master comes until then or not.
            return match self.inner.choose(clock, requests) {
                Verdict::Later(later) => Verdict::Later(later.min(at)),
                grant => grant,
            };
        }
        match kind {
            GrantFaultKind::Lost { retry } => self.lose(retry, clock, requests),
            GrantFaultKind::Stuck if requests.asking(clock).any(|asking| asking == master) => Verdict::Grant(master),
            GrantFaultKind::Stuck => Verdict::Later(NEVER),
            GrantFaultKind::Stopped => self.without(master, NEVER, clock, requests),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::code::quantity::Octets;
    use crate::machine::arbiter::ArbiterKind;
    use crate::machine::bus::Bus;
    use crate::machine::config::BusConfig;

    /// A bus for three masters, served by number, of which some ask at 0 for 10 octets each.
    fn bus(kind: GrantFaultKind, master: u32, asking: u32) -> Bus {
        let config = BusConfig {
            arbiter: ArbiterKind::FixedPriority,
            octets_per_beat: 1,
            clocks_per_beat: 1,
            ..BusConfig::default()
        };
        let fault = GrantFault { kind, at: Clocks(5), master };
        let mut bus = Bus::new(&config, 0, 3).with_fault(Some(fault));
        (0..asking).for_each(|master| bus.request(master, Clocks(0), Octets(10)));
        bus
    }

    /// Masters and clocks of the grants of a bus.
    fn granted(mut bus: Bus) -> Vec<(u32, u64)> {
        let mut found = Vec::new();
        while let Some(clock) = bus.next_decision().filter(|&clock| clock < NEVER) {
            found.extend(bus.decide(clock).map(|grant| (grant.master, grant.start.0)));
        }
        found
    }

    fn grants(kind: GrantFaultKind, master: u32) -> Vec<(u32, u64)> {
        granted(bus(kind, master, 3))
    }

    #[test]
    fn faults_strike_from_their_clock_on() {
        assert_eq!(grants(GrantFaultKind::Stopped, 2), [(0, 0), (1, 10)]);
        assert_eq!(grants(GrantFaultKind::Stuck, 2), [(0, 0), (2, 10)]);
        // The grant to master 1 at 10 is lost, so that master 2 follows when its burst would have ended.
        assert_eq!(grants(GrantFaultKind::Lost { retry: Clocks(0) }, 0), [(0, 0), (2, 20)]);
        assert_eq!(grants(GrantFaultKind::Lost { retry: Clocks(50) }, 0), [(0, 0), (2, 20), (1, 60)]);
    }

    #[test]
    fn a_lost_burst_keeps_the_bus_from_those_who_come_in_the_middle() {
        for (retry, expected) in [(0, vec![(0, 0), (2, 20)]), (50, vec![(0, 0), (2, 20), (1, 60)])] {
            let mut bus = bus(GrantFaultKind::Lost { retry: Clocks(retry) }, 0, 2);
            let mut found = Vec::new();
            // The first grant, and the lost one at 10.
            for clock in [0, 10] {
                assert_eq!(bus.next_decision(), Some(Clocks(clock)));
                found.extend(bus.decide(Clocks(clock)).map(|grant| (grant.master, grant.start.0)));
            }
            bus.request(2, Clocks(12), Octets(10));
            found.extend(granted(bus));
            assert_eq!(found, expected, "{retry}");
        }
    }
}
