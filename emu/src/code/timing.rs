//! Clocks of an instruction, from its cost in operations.

use isa::{Class, Counts};

use crate::code::quantity::Clocks;

/// Lanes of the packet unit of a machine that says nothing about them.
pub const PACKET_LANES: u32 = 4;

/// Clocks and units by class of operations: an exit takes, for each class, ceil(cost / units) times the class's clocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timing {
    /// Clocks of an operation of each class.
    pub clocks: Counts,
    /// Operations of each class that run at once; at least 1.
    pub units: Counts,
    /// Triangles of a packet that are tested at once, in the time of one; at least 1.
    pub packet_lanes: u32,
}

impl Default for Timing {
    /// One clock for each of add, sub, mul, div and cmp, one at a time but for the triangles of packets, nothing for the rest. Report 6.1.
    fn default() -> Timing {
        let clocks = Class::ALL.iter().filter(|class| class.is_elementary());
        let mut timing =
            Timing { clocks: Counts::ZERO, units: Counts([1; Class::ALL.len()]), packet_lanes: PACKET_LANES };
        for &class in clocks {
            timing.clocks[class] = 1;
        }
        timing
    }
}

impl Timing {
    /// Clocks of operations that one instruction costs.
    pub fn clocks(&self, cost: &Counts) -> Clocks {
        let class_clocks =
            |(class, count): (Class, u64)| count.div_ceil(self.units[class]).saturating_mul(self.clocks[class]);
        Clocks(cost.iter().map(class_clocks).fold(0, u64::saturating_add))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_instruction_takes_its_classes_one_after_the_other() {
        let cost = Counts::from_pairs(&[("add", 2), ("mul", 3), ("move", 5)]);
        let mut timing = Timing::default();
        assert_eq!(timing.clocks(&cost), Clocks(5));
        timing.units[Class::Mul] = 2;
        assert_eq!(timing.clocks(&cost), Clocks(4), "three products on two units take two clocks");
        timing.clocks[Class::Move] = 1;
        timing.units[Class::Move] = 5;
        assert_eq!(timing.clocks(&cost), Clocks(5));
    }
}
