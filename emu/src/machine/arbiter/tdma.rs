//! By the clock: each master has its slot of a frame, whether it uses it or not. What the others do cannot be felt.

use super::{Arbiter, BusRequests, Verdict};
use crate::code::quantity::Clocks;

/// Time division: slot n of each frame is master n's. A burst begins where it ends within a slot of its own, so a
/// master that asks gets the bus in less than a frame.
#[derive(Clone, Copy, Debug)]
pub struct Tdma {
    masters: u64,
    slot: u64,
}

impl Tdma {
    /// For that many masters, with slots of that length, which no burst may be longer than.
    pub fn new(masters: u32, slot: Clocks) -> Tdma {
        Tdma { masters: u64::from(masters.max(1)), slot: slot.0.max(1) }
    }

    /// Clock, at or after one, at which a master can get the bus for a time.
    fn next(&self, clock: Clocks, master: u32, length: Clocks) -> Clocks {
        let frame = self.slot * self.masters;
        let offset = u64::from(master) * self.slot;
        // Clocks since the master's last slot began, or what is missing to its first one.
        let (begin, into) = match clock.0.checked_sub(offset) {
            Some(since) => (offset + since / frame * frame, since % frame),
            None => return Clocks(offset),
        };
        if into + length.0 <= self.slot { clock } else { Clocks(begin + frame) }
    }
}

impl Arbiter for Tdma {
    fn choose(&mut self, clock: Clocks, requests: &BusRequests) -> Verdict {
        let next = |master| (self.next(clock, master, requests.length(master)), master);
        match requests.asking(clock).map(next).min() {
            Some((time, master)) if time == clock => Verdict::Grant(master),
            Some((time, _)) => Verdict::Later(time),
            None => Verdict::Later(clock + Clocks(1)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::arbiter::requests;

    #[test]
    fn a_burst_begins_where_it_ends_within_its_masters_slot() {
        // Three masters with ten clocks each: master 1 has 10..20, 40..50, 70..80.
        let mut arbiter = Tdma::new(3, Clocks(10));
        for (clock, length, expected) in [(0, 4, 10), (10, 4, 10), (16, 4, 16), (17, 4, 40), (20, 4, 40), (39, 10, 40)]
        {
            let verdict = arbiter.choose(Clocks(clock), &requests(3, [(1, 0, length)]));
            let wanted = if expected == clock { Verdict::Grant(1) } else { Verdict::Later(Clocks(expected)) };
            assert_eq!(verdict, wanted, "{length} clocks at {clock}");
        }
    }

    #[test]
    fn a_free_slot_is_no_use_to_others() {
        let mut arbiter = Tdma::new(3, Clocks(10));
        let requests = requests(3, [(1, 0, 10), (2, 0, 10)]);
        assert_eq!(arbiter.choose(Clocks(0), &requests), Verdict::Later(Clocks(10)));
        assert_eq!(arbiter.choose(Clocks(20), &requests), Verdict::Grant(2));
    }
}
