//! By age: who has asked for its burst longest comes first, at equal age the lowest master.

use super::{Arbiter, BusRequests, Ranking, Verdict, grant};
use crate::code::quantity::Clocks;

/// Oldest first.
#[derive(Clone, Copy, Debug)]
pub struct OldestFirst;

impl Arbiter for OldestFirst {
    fn choose(&mut self, clock: Clocks, requests: &BusRequests) -> Verdict {
        grant(requests.asking(clock).min_by_key(|&master| (requests.arrival(master), master)), clock)
    }

    fn ranking(&mut self) -> Option<Ranking<'_>> {
        Some(Ranking::Arrival)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::arbiter::requests;

    #[test]
    fn age_comes_before_number() {
        for (arrivals, chosen) in [([7, 5, 6], 1), ([7, 5, 5], 1), ([10, 11, 9], 2)] {
            let asking = (0..).zip(arrivals).map(|(master, arrival)| (master, arrival, 1));
            assert_eq!(OldestFirst.choose(Clocks(9), &requests(3, asking)), Verdict::Grant(chosen));
        }
    }
}
