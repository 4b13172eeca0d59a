//! Figures of a tree. Nothing here changes one.

use schemars::JsonSchema;
use serde::Serialize;

use super::{Content, KdTree};

/// Size and shape of a tree.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Statistics {
    /// All nodes.
    pub nodes: usize,
    /// Nodes that are not divided.
    pub leaves: usize,
    /// Leaves without a triangle.
    pub empty_leaves: usize,
    /// Triangles of all leaves together; a triangle counts once in each leaf that it reaches into.
    pub references: usize,
    /// Level of the deepest node; the root's is 0.
    pub depth: u32,
    /// Mean number of triangles of a leaf, empty leaves included.
    pub mean_triangles: f64,
    /// Largest number of triangles of a leaf.
    pub most_triangles: usize,
}

impl KdTree {
    /// Counts nodes, leaves and references.
    pub fn statistics(&self) -> Statistics {
        let packets = || {
            self.nodes.iter().filter_map(|node| match &node.content {
                Content::Leaf { triangles } => Some(triangles.len()),
                Content::Inner { .. } => None,
            })
        };
        let leaves = packets().count();
        let references = packets().sum();
        // The last node of a level is the one without a next.
        let levels = self.nodes.iter().filter(|node| node.next.is_none()).count();
        Statistics {
            nodes: self.nodes.len(),
            leaves,
            empty_leaves: packets().filter(|&count| count == 0).count(),
            references,
            depth: levels as u32 - 1,
            mean_triangles: references as f64 / leaves as f64,
            most_triangles: packets().max().unwrap_or(0),
        }
    }
}
