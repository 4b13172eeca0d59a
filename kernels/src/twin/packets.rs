//! The search of the set `packet`: whole packets at a time, and the walk in steps that keep what they need, with the very decisions of the rows.
//! The other twins test one triangle after the other, so that each search is the other's test.

use isa::number::Arithmetic;
use isa::number::ray::{
    BoxEnd, Children, Descent, PACKET_WORDS, PacketHit, PacketWords, Plane, Ray, across_box, is_surely_before,
};

use super::ray::TwinSearch;
use super::stage::{StageNode, TwinStage};
use crate::constants::Constants;

/// The packets of a stage as the rows take them.
#[derive(Clone, Debug)]
pub struct PackedLeaves {
    /// Octets of each leaf, by the number of its node; none of other nodes.
    leaves: Vec<Box<[u8]>>,
}

impl PackedLeaves {
    /// The packets of a stage; a triangle's name is its index.
    pub fn new(stage: &TwinStage) -> PackedLeaves {
        let packed = |node: &StageNode| match node {
            StageNode::Inner { .. } => Box::default(),
            StageNode::Leaf(references) => {
                let indices = &stage.references[references.start as usize..references.end as usize];
                let components = (0..PACKET_WORDS - 1).flat_map(|kind| {
                    let component =
                        move |&index: &u32| stage.triangles[index as usize].vertices.as_flattened()[kind] as u32;
                    indices.iter().map(component)
                });
                indices.iter().copied().chain(components).flat_map(u32::to_le_bytes).collect()
            }
        };
        PackedLeaves { leaves: stage.nodes.iter().map(packed).collect() }
    }

    /// Follows a ray from where it starts in, or enters, the scene's box until the search is over.
    pub fn search(
        &self,
        stage: &TwinStage,
        arithmetic: &impl Arithmetic,
        constants: &Constants,
        ray: &Ray,
        search: &mut TwinSearch,
    ) {
        let (entry, outer, end) = across_box(ray, stage.bounds.low, stage.bounds.high);
        if !matches!(end, BoxEnd::Inside | BoxEnd::Entered) {
            return;
        }
        let shift = constants.along();
        let mut notes: Vec<(Plane, u32)> = Vec::new();
        let (mut number, mut entry) = (0, entry);
        loop {
            // Go down between the plane that the ray came by and the one that it leaves by.
            let mut exit = notes.last().map_or(outer, |&(split, _)| split);
            let mut descent = Descent::new(ray, entry, exit);
            let packet = loop {
                let (axis, at, left) = match self.node(stage, number) {
                    Ok(inner) => inner,
                    Err(packet) => break packet,
                };
                let child = |is_right: bool| left + u32::from(is_right);
                let split = Plane { axis, at };
                number = match descent.step(split) {
                    Children::None => unreachable!("a plane in space is no leaf"),
                    Children::One { is_right } => child(is_right),
                    Children::Both { is_right_first } => {
                        notes.push((split, child(!is_right_first)));
                        exit = split;
                        child(is_right_first)
                    }
                };
            };
            // Meet the packet, and go on behind it where the search is not over.
            if search.takes_any {
                if let Some((_, PacketHit { t, name })) = packet.any(arithmetic, ray, shift, search.t) {
                    (search.t, search.triangle) = (t, Some(name));
                    return;
                }
            } else {
                let known = PacketHit { t: search.t, name: search.triangle.unwrap_or(0) };
                let found = packet.nearest(arithmetic, ray, shift, known);
                if found != known {
                    (search.t, search.triangle) = (found.t, Some(found.name));
                }
            }
            if is_surely_before(ray, exit, search.t, shift) {
                return;
            }
            let Some((split, far)) = notes.pop() else { return };
            (entry, number) = (split, far);
        }
    }

    /// An inner node's axis, plane and left child, or the packet of a leaf.
    fn node(&self, stage: &TwinStage, number: u32) -> Result<(usize, i32, u32), PacketWords<'_>> {
        match stage.nodes[number as usize] {
            StageNode::Inner { axis, at, left } => Ok((axis, at, left)),
            StageNode::Leaf(_) => Err(PacketWords::new(&self.leaves[number as usize])),
        }
    }
}
