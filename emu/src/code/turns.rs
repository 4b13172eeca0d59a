//! Cost of units of which several are worked off at once.

use super::quantity::Clocks;

/// Units that are worked off turn by turn: triangles on the lanes of a packet unit, which wait for each other, or nodes one after the other.
///
/// 9 triangles on 4 lanes take three turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Turns {
    /// Units of a turn at most; 1 or more.
    pub at_once: u32,
    /// Time of a turn.
    pub clocks: u64,
    /// Elementary operations of a unit.
    pub elementary: u64,
}

impl Turns {
    /// Units that take nothing.
    pub const FREE: Turns = Turns { at_once: 1, clocks: 0, elementary: 0 };

    /// Clocks and elementary operations of so many units.
    #[inline]
    pub fn cost(&self, units: u32) -> (Clocks, u64) {
        let (units, at_once) = (u64::from(units), u64::from(self.at_once));
        // A division takes longer than all the rest.
        let turns = match at_once.is_power_of_two() {
            true => (units + at_once - 1) >> at_once.trailing_zeros(),
            false => units.div_ceil(at_once),
        };
        (Clocks(self.clocks * turns), self.elementary * units)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_turn_may_have_fewer_units() {
        for (at_once, units, turns) in [(1, 0, 0), (1, 3, 3), (4, 4, 1), (4, 9, 3), (3, 9, 3), (3, 10, 4), (5, 1, 1)] {
            let cost = Turns { at_once, clocks: 7, elementary: 61 }.cost(units);
            assert_eq!(cost, (Clocks(7 * turns), 61 * u64::from(units)), "{units} units, {at_once} at once");
        }
        let most = Turns { at_once: 4, clocks: 1, elementary: 1 }.cost(u32::MAX);
        assert_eq!(most, (Clocks(1 << 30), u64::from(u32::MAX)));
    }
}
