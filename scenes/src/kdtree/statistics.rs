//! Figures of a tree. Nothing here changes one.

use schemars::JsonSchema;
use serde::Serialize;

use super::split::half_surface;
use super::{Content, KdTree, Node};

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
    /// What the cost model expects of a ray that crosses the whole tree: nodes visited plus triangles tested, each weighted with its
    /// node's share of the root's surface (report 5.3.2). 0 for a root without surface.
    pub expected_cost: f64,
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
            expected_cost: self.expected_cost(),
        }
    }

    fn expected_cost(&self) -> f64 {
        let root = half_surface(&self.nodes[0].bounds) as f64;
        if root == 0.0 {
            return 0.0;
        }
        let cost = |node: &Node| match &node.content {
            Content::Inner { .. } => 1.0,
            Content::Leaf { triangles } => triangles.len() as f64,
        };
        self.nodes.iter().map(|node| half_surface(&node.bounds) as f64 / root * cost(node)).sum()
    }
}
