//! In turn: the master after the one that had the bus last comes first. Nobody waits for more than one transfer of each
//! other master.

use super::{Arbiter, Claim, Verdict};
use crate::quantity::Clocks;

/// Round-robin; the first turn is master 0's.
#[derive(Clone, Debug)]
pub struct RoundRobin {
    masters: u32,
    turn: u32,
}

impl RoundRobin {
    /// For that many masters.
    pub fn new(masters: u32) -> RoundRobin {
        RoundRobin { masters, turn: 0 }
    }
}

impl Arbiter for RoundRobin {
    fn choose(&mut self, _: Clocks, claims: &[Claim]) -> Verdict {
        let chosen = claims.iter().position(|claim| claim.master >= self.turn).unwrap_or(0);
        self.turn = (claims[chosen].master + 1) % self.masters;
        Verdict::Grant(chosen)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn masters_come_in_turn_and_absent_ones_are_passed_over() {
        let mut arbiter = RoundRobin::new(4);
        let claim = |master| Claim { master, arrival: Clocks(0), length: Clocks(1) };
        let mut next = |masters: &[u32]| {
            let claims: Vec<Claim> = masters.iter().copied().map(claim).collect();
            match arbiter.choose(Clocks(0), &claims) {
                Verdict::Grant(chosen) => claims[chosen].master,
                Verdict::Later(_) => panic!("round-robin never leaves the bus idle"),
            }
        };
        assert_eq!(next(&[0, 1, 3]), 0);
        assert_eq!(next(&[0, 1, 3]), 1);
        assert_eq!(next(&[0, 1, 3]), 3);
        assert_eq!(next(&[0, 1, 3]), 0);
        assert_eq!(next(&[0]), 0, "a lone master need not wait for its turn");
        assert_eq!(next(&[2, 3]), 2);
    }
}
