//! The scene as the twins read it: what the octets of a memory image hold, in arrays that a search runs through quickly.

use std::ops::Range;

use isa::number::Vector;
use scenes::image::{MemoryImage, StoredTriangle};
use scenes::kdtree::{Bounds, Content, KdTree};

use super::ray::Packet;

/// A node of the kd tree.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StageNode {
    /// Divided at the plane `axis = at`; the right child follows the left one.
    Inner {
        /// Axis of the plane.
        axis: usize,
        /// Coordinate of the plane, raw.
        at: i32,
        /// Number of the left child.
        left: u32,
    },
    /// A packet: a range of references.
    Leaf(Range<u32>),
}

/// A surface: raw coefficients in the weight format, indices of refraction in theirs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StageMaterial {
    /// Diffuse colour.
    pub colour: Vector,
    /// Specular coefficient ks.
    pub reflection: i32,
    /// Diffuse coefficient kd.
    pub intensity: i32,
    /// Transmission coefficient kt, 0 for an opaque material.
    pub transmission: i32,
    /// Index of refraction: the ratio for a ray that leaves a body.
    pub index: i32,
    /// Reciprocal of the index: the ratio for a ray that enters.
    pub inverse_index: i32,
}

/// A point light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StageLight {
    /// Position of the light, raw, or in steps of its own.
    pub position: Vector,
    /// Raw units in its steps as a direction, where it has some of its own.
    pub scale: Option<i32>,
    /// The light's colour in the colour format.
    pub colour: Vector,
}

/// A scene in arrays.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TwinStage {
    /// Box of the tree's root, raw.
    pub bounds: Bounds,
    /// The tree's nodes; the first is the root.
    pub nodes: Vec<StageNode>,
    /// Triangles by index, packet by packet.
    pub references: Vec<u32>,
    /// Triangles, by index.
    pub triangles: Vec<StoredTriangle>,
    /// Materials, by number.
    pub materials: Vec<StageMaterial>,
    /// Lights, by number.
    pub lights: Vec<StageLight>,
}

impl TwinStage {
    /// The scene of an image; `None` when its octets hold none.
    pub fn new(image: &MemoryImage) -> Option<TwinStage> {
        let contents = image.decode()?;
        let (nodes, references) = tree(&contents.tree);
        let stage = TwinStage {
            bounds: image.bounds,
            nodes,
            references,
            triangles: contents.triangles,
            materials: contents.materials.iter().map(|fields| StageMaterial::new(fields)).collect::<Option<_>>()?,
            lights: contents.lights.iter().map(|fields| StageLight::new(fields)).collect::<Option<_>>()?,
        };
        stage.is_sound().then_some(stage)
    }

    /// From the root down to a packet; `is_right` decides at each split, by its axis and coordinate.
    pub fn descend(&self, is_right: impl Fn(usize, i32) -> bool) -> Packet {
        let mut bounds = self.bounds;
        let mut number = 0;
        loop {
            let (axis, at, left) = match self.nodes[number as usize] {
                StageNode::Inner { axis, at, left } => (axis, at, left),
                StageNode::Leaf(ref references) => return Packet { bounds, references: references.clone() },
            };
            // The children share the plane: it becomes a face of the one that is entered.
            if is_right(axis, at) {
                bounds.low[axis] = at;
                number = left + 1;
            } else {
                bounds.high[axis] = at;
                number = left;
            }
        }
    }

    /// Every search ends and finds what it looks for: there is a root, children come after their parents, materials exist.
    fn is_sound(&self) -> bool {
        let has_children = |(number, node): (usize, &StageNode)| match node {
            StageNode::Inner { left, .. } => number < *left as usize && (*left as usize) < self.nodes.len() - 1,
            StageNode::Leaf(_) => true,
        };
        // Searches rely on this instead of checking at each step.
        !self.nodes.is_empty()
            && self.nodes.iter().enumerate().all(has_children)
            && self.triangles.iter().all(|triangle| (triangle.material as usize) < self.materials.len())
    }
}

/// A tree as nodes and references: triangles by index, packet by packet.
pub fn tree(tree: &KdTree) -> (Vec<StageNode>, Vec<u32>) {
    let mut references = Vec::with_capacity(tree.references());
    let node = |number| match tree.content(number) {
        Content::Inner { axis, at, left } => StageNode::Inner { axis, at, left },
        Content::Leaf { triangles } => {
            let first = references.len() as u32;
            references.extend_from_slice(triangles);
            StageNode::Leaf(first..references.len() as u32)
        }
    };
    let nodes = (0..tree.count() as u32).map(node).collect();
    (nodes, references)
}

impl StageMaterial {
    fn new(fields: &[i64]) -> Option<StageMaterial> {
        let &[r, g, b, reflection, intensity, transmission, index, inverse_index] = words(fields).first_chunk()?;
        Some(StageMaterial { colour: [r, g, b], reflection, intensity, transmission, index, inverse_index })
    }
}

impl StageLight {
    fn new(fields: &[i64]) -> Option<StageLight> {
        let fields = words(fields);
        let &[x, y, z, r, g, b] = fields.first_chunk()?;
        Some(StageLight { position: [x, y, z], colour: [r, g, b], scale: fields.get(6).copied() })
    }
}

fn words(fields: &[i64]) -> Vec<i32> {
    fields.iter().map(|&field| field as i32).collect()
}
