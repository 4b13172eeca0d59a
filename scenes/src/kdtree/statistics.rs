//! Figures of a tree. Nothing here changes one.

use schemars::JsonSchema;
use serde::Serialize;

use super::split::half_surface;
use super::{Content, KdTree, Node};

/// Size and shape of a tree.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Statistics {
    /// Number of nodes.
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
    /// Expected cost, by the cost model, of a ray that crosses the whole tree: nodes visited plus triangles tested, each weighted with its
    /// node's share of the root's surface (report 5.3.2). 0 for a root without surface.
    pub expected_cost: f64,
}

impl Statistics {
    /// The figures of a tree with these nodes, in any order.
    pub(super) fn new<'a>(nodes: impl Iterator<Item = Node<'a>>) -> Statistics {
        let (mut count, mut leaves, mut empty_leaves, mut references, mut most_triangles) = (0, 0, 0, 0, 0);
        let (mut levels, mut root, mut sum) = (0, 0, 0u128);
        for node in nodes {
            count += 1;
            // The last node of a level is the one without a next.
            levels += u32::from(node.next.is_none());
            let surface = half_surface(&node.bounds);
            root = surface.max(root);
            let cost = match node.content {
                Content::Inner { .. } => 1,
                Content::Leaf { triangles } => {
                    leaves += 1;
                    empty_leaves += usize::from(triangles.is_empty());
                    references += triangles.len();
                    most_triangles = most_triangles.max(triangles.len());
                    triangles.len()
                }
            };
            // Below 2^66 times 2^27 references.
            sum += surface * cost as u128;
        }
        Statistics {
            nodes: count,
            leaves,
            empty_leaves,
            references,
            depth: levels - 1,
            mean_triangles: references as f64 / leaves as f64,
            most_triangles,
            expected_cost: if root == 0 { 0.0 } else { sum as f64 / root as f64 },
        }
    }
}

impl KdTree {
    /// Counts nodes, leaves and references.
    pub fn statistics(&self) -> Statistics {
        Statistics::new(self.nodes())
    }
}
