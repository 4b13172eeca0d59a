//! By age: who has asked for its burst longest comes first, at equal age the lowest master.

use super::{Arbiter, Claims, Ranking, Verdict, grant};
use crate::code::quantity::Clocks;

/// Oldest first.
#[derive(Clone, Copy, Debug)]
pub struct OldestFirst;

impl Arbiter for OldestFirst {
    fn choose(&mut self, clock: Clocks, claims: &Claims) -> Verdict {
        grant(claims.asking(clock).min_by_key(|&master| (claims.arrival(master), master)), clock)
    }

    fn ranking(&mut self) -> Option<Ranking<'_>> {
        Some(Ranking::Arrival)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::arbiter::claims;

    #[test]
    fn age_comes_before_number() {
        for (arrivals, chosen) in [([7, 5, 6], 1), ([7, 5, 5], 1), ([10, 11, 9], 2)] {
            let asking = (0..).zip(arrivals).map(|(master, arrival)| (master, arrival, 1));
            assert_eq!(OldestFirst.choose(Clocks(9), &claims(3, asking)), Verdict::Grant(chosen));
        }
    }
}
