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

    /// The slots of a master, before its first one.
    #[inline]
    pub fn slots_of(&self, master: u32) -> OwnSlots {
        OwnSlots { slot: self.slot, frame: self.slot * self.masters, begin: u64::from(master) * self.slot }
    }

    /// True where a slot has room for bursts of a length. One that is longer would never be granted.
    #[inline]
    pub fn holds(&self, length: Clocks) -> bool {
        length.0 <= self.slot
    }
}

/// Slots of one master, from one that begins at a clock on.
#[derive(Clone, Copy, Debug)]
pub struct OwnSlots {
    slot: u64,
    /// Clocks from the beginning of a slot to that of the next one.
    frame: u64,
    /// Beginning of a slot that is not over before the clock that was asked for last.
    begin: u64,
}

impl OwnSlots {
    /// First clock, at or after one, at which the master can get the bus for a time. Clocks must not come before those that were found earlier.
    ///
    /// Slots of 10 clocks at 10, 40 and 70, and 4 clocks of the bus: at 3 that is 10, at 16 it is 16, at 17 it is 40, and at 95 it is 100.
    #[inline(always)]
    pub fn start(&mut self, clock: Clocks, length: Clocks) -> Clocks {
        let Some(mut into) = clock.0.checked_sub(self.begin) else { return Clocks(self.begin) };
        // Mostly the next burst comes within a frame, and dividing takes longer than all the rest.
        if into >= self.frame {
            self.begin += into / self.frame * self.frame;
            into %= self.frame;
        }
        // Nobody could foresee which it is, so there is no branch.
        // A transfer of nothing begins within the slot as well: its end is where the next master's begins.
        let (fits, next) = (into + length.0.max(1) <= self.slot, self.begin + self.frame);
        self.begin = if fits { self.begin } else { next };
        if fits { clock } else { Clocks(next) }
    }
}

impl Arbiter for Tdma {
    fn choose(&mut self, clock: Clocks, requests: &BusRequests) -> Verdict {
        let next = |master| (self.slots_of(master).start(clock, requests.length(master)), master);
        match requests.asking(clock).map(next).min() {
            Some((time, master)) if time == clock => Verdict::Grant(master),
            Some((time, _)) => Verdict::Later(time),
            None => Verdict::Later(clock + Clocks(1)),
        }
    }

    fn slots(&self) -> Option<Tdma> {
        Some(*self)
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
    fn slots_go_on_from_clock_to_clock() {
        let mut slots = Tdma::new(3, Clocks(10)).slots_of(1);
        for (clock, length, expected) in [(3, 4, 10), (14, 4, 14), (18, 4, 40), (44, 6, 44), (49, 0, 49), (50, 0, 70), (95, 4, 100)] {
            assert_eq!(slots.start(Clocks(clock), Clocks(length)), Clocks(expected), "{length} clocks at {clock}");
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
