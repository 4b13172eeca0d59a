//! The walk with planes: from packet to packet of the kd tree, with the very decisions of the ray unit's rows. It reads each node at most
//! once and needs no boxes. The other twins find the next packet from the box of the last one, so that each walk is the other's test.

use std::ops::Range;

use isa::number::ray::{BoxEnd, Plane, Ray, SplitEnd, across_box, step};
use scenes::kdtree::Bounds;

use super::stage::StageNode;

/// The packets that a ray visits, in order: ranges of references.
#[derive(Clone, Debug)]
pub struct Packets<'a> {
    nodes: &'a [StageNode],
    ray: Ray,
    /// Splits that the ray has still to cross, the next one last, each with its far child.
    notes: Vec<(Plane, u32)>,
    /// The plane by which it leaves the scene.
    outer: Plane,
    /// Next stop of the walk: a node, and the plane by which the ray comes to it.
    from: Option<(u32, Plane)>,
}

impl<'a> Packets<'a> {
    /// The packets of a tree in its box, the root being the first node.
    pub fn new(nodes: &'a [StageNode], bounds: &Bounds, ray: Ray) -> Packets<'a> {
        let (enter, outer, end) = across_box(&ray, bounds.low, bounds.high);
        let from = matches!(end, BoxEnd::Inside | BoxEnd::Entered).then_some((0, enter));
        Packets { nodes, ray, notes: Vec::new(), outer, from }
    }

    /// The plane by which the ray leaves what it is in.
    fn exit(&self) -> Plane {
        self.notes.last().map_or(self.outer, |&(split, _)| split)
    }
}

impl Iterator for Packets<'_> {
    type Item = Range<u32>;

    fn next(&mut self) -> Option<Range<u32>> {
        let (mut number, entry) = self.from.take()?;
        loop {
            let (axis, at, left) = match self.nodes[number as usize] {
                StageNode::Inner { axis, at, left } => (axis, at, left),
                StageNode::Leaf(ref references) => {
                    self.from = self.notes.pop().map(|(split, far)| (far, split));
                    return Some(references.clone());
                }
            };
            let split = Plane { axis, at };
            let found = step(&self.ray, split, entry, self.exit());
            let (first, second) =
                if found.is_right_first(&self.ray, axis) { (left + 1, left) } else { (left, left + 1) };
            if found == SplitEnd::Both {
                self.notes.push((split, second));
            }
            number = first;
        }
    }
}
