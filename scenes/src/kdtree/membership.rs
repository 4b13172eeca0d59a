//! Two ways to say which triangles a node holds: by their boxes, as the report does, and by what of them really lies in the node.

use super::builder::Membership;
use super::clip::clipped;
use super::split::{Division, Side, Sweep};
use super::{Bounds, Triangles};

/// The report's rule (5.3.2): a triangle is in a node when its box reaches into it; planes cross the longest axis.
pub(super) struct ByBox<'a> {
    /// Box of each triangle.
    pub(super) triangles: &'a [Bounds],
}

impl Membership for ByBox<'_> {
    type Member = u32;

    fn index(&self, member: &u32) -> u32 {
        *member
    }

    fn best(&self, node: &Bounds, packet: &[u32], sweep: &mut Sweep) -> Option<Division> {
        let triangles = packet.iter().map(|&index| &self.triangles[index as usize]);
        sweep.best(node, node.longest_axis(), triangles).map(|(division, _)| division)
    }

    fn passed(&self, &member: &u32, division: &Division, side: Side, _child: &Bounds) -> Option<u32> {
        division.reaches(&self.triangles[member as usize], side).then_some(member)
    }
}

/// A triangle is in a node when a part of it is; planes cross any axis, at the bounds of the parts (Havran and Bittner 2002).
pub(super) struct ByPart<'a, T: ?Sized> {
    /// The triangles.
    pub(super) triangles: &'a T,
}

/// The part of a triangle that lies in a node.
#[derive(Clone, Copy)]
pub(super) struct Part {
    /// Number of the triangle.
    pub(super) index: u32,
    /// The part's box.
    pub(super) bounds: Bounds,
}

impl Part {
    /// A place of a list that holds no part yet.
    pub(super) const NONE: Part = Part { index: 0, bounds: Bounds { low: [0; 3], high: [0; 3] } };
}

impl<T: Triangles + ?Sized> ByPart<'_, T> {
    /// The triangles as a node holds them that contains all of them.
    pub(super) fn whole(&self) -> Vec<Part> {
        let bounds = |index: u32| Bounds::of_triangle(&self.triangles.vertices(index as usize));
        (0..self.triangles.count() as u32).map(|index| Part { index, bounds: bounds(index) }).collect()
    }
}

impl<T: Triangles + ?Sized> Membership for ByPart<'_, T> {
    type Member = Part;

    fn index(&self, member: &Part) -> u32 {
        member.index
    }

    fn best(&self, node: &Bounds, packet: &[Part], sweep: &mut Sweep) -> Option<Division> {
        let candidates = (0..3).filter_map(|axis| sweep.best(node, axis, packet.iter().map(|part| &part.bounds)));
        // `min_by_key` keeps the first of equal costs.
        candidates.min_by_key(|(_, cost)| *cost).map(|(division, _)| division)
    }

    fn passed(&self, part: &Part, division: &Division, side: Side, child: &Bounds) -> Option<Part> {
        if !division.reaches(&part.bounds, side) {
            return None;
        }
        let is_whole = !division.reaches(&part.bounds, side.other());
        if is_whole {
            return Some(*part);
        }
        let bounds = clipped(&self.triangles.vertices(part.index as usize), child)?;
        division.reaches(&bounds, side).then_some(Part { bounds, ..*part })
    }
}
