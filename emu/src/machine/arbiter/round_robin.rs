//! In turn: the master after the one that had the bus last comes first. Nobody waits for more than one burst of each
//! other master.

use super::{Arbiter, BusRequests, Ranking, Verdict, grant};
use crate::code::quantity::Clocks;

/// Round-robin; the first turn is master 0's.
#[derive(Clone, Copy, Debug, Default)]
pub struct RoundRobin {
    turn: u32,
}

impl RoundRobin {
    /// Before the first turn.
    pub fn new() -> RoundRobin {
        RoundRobin::default()
    }
}

impl Arbiter for RoundRobin {
    fn choose(&mut self, clock: Clocks, requests: &BusRequests) -> Verdict {
        let chosen = requests.first_from(self.turn, clock);
        let next = chosen.map_or(self.turn, |master| master + 1);
        self.turn = if next == requests.masters() { 0 } else { next };
        grant(chosen, clock)
    }

    fn ranking(&mut self) -> Option<Ranking<'_>> {
        Some(Ranking::Circle(&mut self.turn))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::arbiter::turns;

    #[test]
    fn masters_come_in_turn_and_absent_ones_are_passed_over() {
        let mut arbiter = RoundRobin::new();
        assert_eq!(turns(&mut arbiter, &[&[0, 1, 3][..]; 4]), [0, 1, 3, 0]);
        assert_eq!(turns(&mut arbiter, &[&[0]]), [0], "a lone master need not wait for its turn");
        assert_eq!(turns(&mut arbiter, &[&[2, 3]]), [2]);
    }
}
