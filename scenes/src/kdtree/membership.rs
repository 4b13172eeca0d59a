//! Two ways to say which triangles a node holds: by their boxes, as the report does, and by what of them really lies in the node.

use super::Bounds;
use super::clip::clipped;
use super::growth::Membership;
use super::split::{Division, Side, Sweep};

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
pub(super) struct ByPart<'a> {
    /// Vertices of each triangle.
    pub(super) triangles: &'a [[[i32; 3]; 3]],
}

/// What of a triangle lies in a node.
#[derive(Clone, Copy)]
pub(super) struct Part {
    index: u32,
    bounds: Bounds,
}

impl ByPart<'_> {
    /// The triangles as a node holds them that contains all of them.
    pub(super) fn whole(&self) -> Vec<Part> {
        (0..)
            .zip(self.triangles)
            .map(|(index, vertices)| Part { index, bounds: Bounds::of_triangle(vertices) })
            .collect()
    }
}

impl Membership for ByPart<'_> {
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
        let bounds = clipped(&self.triangles[part.index as usize], child)?;
        division.reaches(&bounds, side).then_some(Part { bounds, ..*part })
    }
}
