//! A walk down a kd tree: the steps of a ray from node to node between two planes, with what it needs of them at hand.

use super::Ray;
use super::plane::{Plane, PlaneCrossed};

/// Number of the axis by which a node says that it is a leaf.
const LEAF: usize = 3;

/// A ray on its way down, between the plane by which it came and the one by which it leaves.
#[derive(Clone, Copy, Debug)]
pub struct Descent<'a> {
    ray: &'a Ray,
    entry: PlaneCrossed,
    exit: PlaneCrossed,
}

/// Children of a node that the ray visits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Children {
    /// The node is a leaf.
    None,
    /// Only that of larger coordinates where `is_right`, else only the other one.
    One {
        /// The child of larger coordinates.
        is_right: bool,
    },
    /// First that of larger coordinates where `is_right_first`, then the other one.
    Both {
        /// The child of larger coordinates comes first.
        is_right_first: bool,
    },
}

impl Descent<'_> {
    /// The walk of a ray from where it came by `entry` up to where it leaves by `exit`.
    #[inline]
    pub fn new(ray: &Ray, entry: Plane, exit: Plane) -> Descent<'_> {
        Descent { ray, entry: PlaneCrossed::new(entry, ray), exit: PlaneCrossed::new(exit, ray) }
    }

    /// Goes on in a node that is divided at a plane, with the decisions of [`super::step`]. Where the ray visits both children, it leaves the
    /// first one by that plane.
    #[inline(always)]
    pub fn step(&mut self, split: Plane) -> Children {
        if split.axis == LEAF {
            return Children::None;
        }
        let crossing = PlaneCrossed::new(split, self.ray);
        let is_backwards = crossing.is_backwards();
        if !crossing.is_ahead() || !self.entry.is_before(crossing) {
            Children::One { is_right: !is_backwards }
        } else if !crossing.is_before(self.exit) {
            Children::One { is_right: is_backwards }
        } else {
            self.exit = crossing;
            Children::Both { is_right_first: is_backwards }
        }
    }
}
