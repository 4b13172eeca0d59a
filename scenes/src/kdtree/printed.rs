//! Trees as the report prints their construction, slip by slip: what becomes of a tree whose builder takes a misprint at its word. For
//! measuring the misprints; no set of kernels is made for such a tree.

use super::builder::Membership;
use super::split::{Division, Side, Sweep, half_surface};
use super::{Bounds, Triangles};

/// A slip in how the report says that the tree is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PrintedTree {
    /// 5.3.1: a triangle is on a side where a part of it is beyond the plane; one that lies in the plane is on neither.
    StrictSides,
    /// 5.3.2: 1 is a factor of the cost and not its first summand, so that a division costs nothing by itself.
    FactorOne,
    /// Pseudo code 1: the lowest cost is kept, but not the plane that has it; the loop over planes ends with the last one.
    LastPlane,
}

impl PrintedTree {
    /// All of them.
    pub const ALL: [PrintedTree; 3] = [PrintedTree::StrictSides, PrintedTree::FactorOne, PrintedTree::LastPlane];

    /// Name in results.
    pub const fn name(self) -> &'static str {
        match self {
            PrintedTree::StrictSides => "strict-sides",
            PrintedTree::FactorOne => "factor-one",
            PrintedTree::LastPlane => "last-plane",
        }
    }
}

/// The report's rule for boxes, with a slip.
pub(super) struct ByPrint<'a, T: ?Sized> {
    /// The triangles, whose vertices are candidates in their order.
    pub(super) triangles: &'a T,
    /// The boxes of all triangles.
    pub(super) boxes: &'a [Bounds],
    /// The slip.
    pub(super) slip: PrintedTree,
}

/// A plane with the number of triangles on either side, as the pseudo code counts them.
struct CountedPlane {
    division: Division,
    cost: u128,
}

impl<T: Triangles + ?Sized> ByPrint<'_, T> {
    /// Candidates of a node: the coordinates of its triangles' vertices within it, each once, in the order in which they are met.
    fn candidates(&self, node: &Bounds, axis: usize, packet: &[u32]) -> Vec<i32> {
        let mut met = std::collections::HashSet::new();
        let all = packet.iter().flat_map(|&index| self.triangles.vertices(index as usize).map(|vertex| vertex[axis]));
        all.filter(|&at| at > node.low[axis] && at < node.high[axis] && met.insert(at)).collect()
    }

    /// The cost of a plane times half the node's surface. A division that costs 1 by itself costs the surface once.
    fn counted(&self, node: &Bounds, axis: usize, at: i32, packet: &[u32]) -> CountedPlane {
        let [mut left, mut right, mut flats] = [0u128; 3];
        for bounds in packet.iter().map(|&index| &self.boxes[index as usize]) {
            left += u128::from(bounds.low[axis] < at);
            right += u128::from(bounds.high[axis] > at);
            flats += u128::from(bounds.low[axis] == at && bounds.high[axis] == at);
        }
        let [lower, upper] = node.divided(axis, at).map(|part| half_surface(&part));
        let flat = if upper < lower { Side::Right } else { Side::Left };
        if self.slip == PrintedTree::StrictSides {
            flats = 0;
        }
        let itself = if self.slip == PrintedTree::FactorOne { 0 } else { half_surface(node) };
        let cost = itself + lower * left + upper * right + lower.min(upper) * flats;
        CountedPlane { division: Division { axis, at, flat }, cost }
    }
}

impl<T: Triangles + ?Sized> Membership for ByPrint<'_, T> {
    type Member = u32;

    fn index(&self, member: &u32) -> u32 {
        *member
    }

    fn best(&self, node: &Bounds, packet: &[u32], _: &mut Sweep) -> Option<Division> {
        let axis = node.longest_axis();
        let candidates = self.candidates(node, axis, packet);
        let planes = candidates.iter().map(|&at| self.counted(node, axis, at, packet));
        let best = planes.min_by_key(|plane| (plane.cost, plane.division.at))?;
        let pays = best.cost < half_surface(node) * packet.len() as u128;
        let chosen = match (self.slip, candidates.last()) {
            (PrintedTree::LastPlane, Some(&at)) => self.counted(node, axis, at, packet).division,
            _ => best.division,
        };
        pays.then_some(chosen)
    }

    fn passed(&self, &member: &u32, division: &Division, side: Side, _child: &Bounds) -> Option<u32> {
        let bounds = &self.boxes[member as usize];
        let is_flat =
            bounds.low[division.axis] == bounds.high[division.axis] && bounds.low[division.axis] == division.at;
        let is_lost = is_flat && self.slip == PrintedTree::StrictSides;
        (!is_lost && division.reaches(bounds, side)).then_some(member)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kdtree::{BuildMethod, Content, Depth, build};

    /// A wall in x = 0 between two heaps of small triangles.
    fn wall() -> (Vec<[[i32; 3]; 3]>, Bounds) {
        let mut triangles = vec![[[0, -40, -40], [0, 40, -40], [0, 0, 40]]];
        for k in 0..8 {
            let x = if k < 4 { -80 - k } else { 80 + k };
            triangles.push([[x, 0, 0], [x + 1, 5, 0], [x, 0, 5]]);
        }
        let boxes = triangles.iter().map(Bounds::of_triangle);
        let root = boxes.reduce(|a, b| a.union(&b)).unwrap().enlarged(1);
        (triangles, root)
    }

    /// Number of nodes, and the triangles that some leaf holds.
    fn built(method: BuildMethod) -> (usize, std::collections::BTreeSet<u32>) {
        let (triangles, root) = wall();
        let tree = build(&triangles[..], root, Depth::Levels(8), method).unwrap();
        let held = tree.nodes().flat_map(|node| match node.content {
            Content::Leaf { triangles } => triangles.to_vec(),
            Content::Inner { .. } => Vec::new(),
        });
        (tree.count(), held.collect())
    }

    #[test]
    fn a_triangle_in_the_plane_is_lost_where_sides_are_strict() {
        let all = wall().0.len();
        assert_eq!(built(BuildMethod::Report).1.len(), all);
        assert!(built(BuildMethod::Printed(PrintedTree::StrictSides)).1.len() < all);
        assert_eq!(built(BuildMethod::Printed(PrintedTree::FactorOne)).1.len(), all);
        assert_eq!(built(BuildMethod::Printed(PrintedTree::LastPlane)).1.len(), all);
    }

    #[test]
    fn a_division_that_costs_nothing_is_made_more_often() {
        assert!(built(BuildMethod::Printed(PrintedTree::FactorOne)).0 > built(BuildMethod::Report).0);
    }
}
