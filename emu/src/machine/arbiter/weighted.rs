//! In turn, with weights: a master of weight n keeps its turn for n bursts, as long as it asks for them one right after
//! the other.

use super::{Arbiter, BusRequests, Verdict};
use crate::code::quantity::Clocks;

/// Weighted round-robin; the first turn is master 0's. With equal weights of 1 it is round-robin.
#[derive(Clone, Debug)]
pub struct Weighted {
    weights: Vec<u32>,
    turn: u32,
    /// Bursts that are left of the turn.
    left: u32,
}

impl Weighted {
    /// For that many masters; one without a weight has weight 1, and no weight counts for less.
    pub fn new(masters: u32, weights: &[u32]) -> Weighted {
        let weight = |master: u32| weights.get(master as usize).copied().unwrap_or(1).max(1);
        let weights: Vec<u32> = (0..masters.max(1)).map(weight).collect();
        let left = weights[0];
        Weighted { weights, turn: 0, left }
    }
}

impl Arbiter for Weighted {
    fn choose(&mut self, clock: Clocks, requests: &BusRequests) -> Verdict {
        let Some(master) = requests.first_from(self.turn, clock) else { return Verdict::Later(clock + Clocks(1)) };
        if master != self.turn {
            (self.turn, self.left) = (master, self.weights[master as usize]);
        }
        self.left -= 1;
        if self.left == 0 {
            self.turn = (master + 1) % self.weights.len() as u32;
            self.left = self.weights[self.turn as usize];
        }
        Verdict::Grant(master)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::arbiter::turns;

    #[test]
    fn masters_get_bursts_in_proportion_to_their_weights() {
        let mut arbiter = Weighted::new(4, &[3, 1]);
        assert_eq!(turns(&mut arbiter, &[&[0, 1, 2][..]; 10]), [0, 0, 0, 1, 2, 0, 0, 0, 1, 2]);
    }

    #[test]
    fn who_does_not_ask_loses_the_rest_of_its_turn() {
        let mut arbiter = Weighted::new(4, &[3, 2, 1]);
        assert_eq!(turns(&mut arbiter, &[&[0, 1], &[1, 2], &[0, 1, 2], &[0, 2], &[0, 1]]), [0, 1, 1, 2, 0]);
    }
}
