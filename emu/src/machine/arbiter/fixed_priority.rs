//! By number: the lowest master first, so the main processor last. A busy low master can make others wait for ever.

use super::{Arbiter, BusRequests, Ranking, Verdict, grant};
use crate::code::quantity::Clocks;

/// Fixed priority.
#[derive(Clone, Copy, Debug)]
pub struct FixedPriority;

impl Arbiter for FixedPriority {
    fn choose(&mut self, clock: Clocks, requests: &BusRequests) -> Verdict {
        grant(requests.first_from(0, clock), clock)
    }

    fn ranking(&mut self) -> Option<Ranking<'_>> {
        Some(Ranking::Number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::arbiter::turns;

    #[test]
    fn the_lowest_master_comes_first_whenever_it_asks() {
        assert_eq!(turns(&mut FixedPriority, &[&[0, 1, 3], &[0, 1, 3], &[1, 3], &[3], &[2, 3]]), [0, 0, 1, 3, 2]);
    }
}
