//! A built tree in the order of a walk, from which the memory image is written: eight octets a node, numbers, boxes and neighbours worked
//! out on the way. Where planes lie is not said here.

use super::tree::StoredNode;
use super::{Bounds, Content, KdTree, Node, Statistics};

/// A built tree, in pieces, from left to right.
pub(crate) struct BuiltTree {
    root: Bounds,
    subtrees: Vec<Subtree>,
    /// Nodes and references before each level, and before what would be the next one.
    levels: Vec<[u32; 2]>,
}

/// Nodes and their packets in the order in which one walks through them: a node, then all of its left side, then its right one.
#[derive(Default)]
pub(super) struct Subtree {
    pub(super) nodes: Vec<BuildNode>,
    pub(super) triangles: Vec<u32>,
}

/// A node of a subtree; the nodes below it follow it.
#[derive(Clone, Copy)]
pub(super) enum BuildNode {
    Inner { axis: u8, at: i32 },
    Leaf { count: u32 },
}

const _: () = assert!(size_of::<BuildNode>() == 8);

/// A node and its place.
pub(crate) struct NumberedNode<'a> {
    /// The node's number, level by level and from left to right.
    pub(crate) number: u32,
    /// References of the leaves with lower numbers.
    pub(crate) first: u32,
    /// The node.
    pub(crate) node: Node<'a>,
}

impl BuiltTree {
    /// The tree in the box `root`.
    pub(super) fn new(root: Bounds, subtrees: Vec<Subtree>) -> BuiltTree {
        let mut sizes: Vec<[u32; 2]> = Vec::new();
        // Nodes stand in the order of a walk, left side first: behind a leaf comes the right side that has waited least.
        let (mut level, mut waiting) = (0, Vec::new());
        for &node in subtrees.iter().flat_map(|subtree| &subtree.nodes) {
            if level == sizes.len() {
                sizes.push([0; 2]);
            }
            sizes[level][0] += 1;
            level = match node {
                BuildNode::Inner { .. } => {
                    waiting.push(level + 1);
                    level + 1
                }
                BuildNode::Leaf { count } => {
                    sizes[level][1] += count;
                    waiting.pop().unwrap_or(0)
                }
            };
        }
        // Nodes and references of all levels above, which is where a level's numbers begin.
        let mut before = [0; 2];
        let mut levels = vec![before];
        for size in sizes {
            before = [0, 1].map(|k| before[k] + size[k]);
            levels.push(before);
        }
        BuiltTree { root, subtrees, levels }
    }

    fn size(&self) -> [u32; 2] {
        self.levels.last().copied().unwrap_or_default()
    }

    /// Number of nodes.
    pub(crate) fn count(&self) -> u32 {
        self.size()[0]
    }

    /// Triangles of all packets together; one counts in each packet that it is in.
    pub(crate) fn references(&self) -> u32 {
        self.size()[1]
    }

    /// All nodes: each one, then all of its left side, then its right one.
    pub(crate) fn nodes(&self) -> impl Iterator<Item = NumberedNode<'_>> {
        let mut places = self.levels.clone();
        let mut here = (0, self.root);
        let mut waiting = Vec::new();
        let nodes = self.subtrees.iter().flat_map(|subtree| {
            let mut packets = subtree.triangles.as_slice();
            subtree.nodes.iter().map(move |&node| {
                let count = if let BuildNode::Leaf { count } = node { count } else { 0 };
                let (packet, others) = packets.split_at(count as usize);
                packets = others;
                (node, packet)
            })
        });
        nodes.map(move |(node, triangles)| {
            let (level, bounds) = here;
            let [number, first] = places[level];
            places[level] = [number + 1, first + triangles.len() as u32];
            let content = match node {
                BuildNode::Inner { axis, at } => {
                    let (axis, left) = (axis.into(), places[level + 1][0]);
                    let [lower, upper] = bounds.divided(axis, at);
                    waiting.push((level + 1, upper));
                    here = (level + 1, lower);
                    Content::Inner { axis, at, left }
                }
                BuildNode::Leaf { .. } => {
                    here = waiting.pop().unwrap_or((0, self.root));
                    Content::Leaf { triangles }
                }
            };
            let next = (number + 1 < self.levels[level + 1][0]).then_some(number + 1);
            NumberedNode { number, first, node: Node { bounds, next, content } }
        })
    }

    /// Size and shape of the tree.
    pub(crate) fn statistics(&self) -> Statistics {
        Statistics::new(self.nodes().map(|numbered| numbered.node))
    }

    /// The tree with its nodes level by level, each level from left to right.
    pub(super) fn by_levels(&self) -> KdTree {
        let mut nodes = vec![StoredNode::Leaf { first: 0, count: 0 }; self.count() as usize];
        let mut references = vec![0; self.references() as usize];
        for NumberedNode { number, first, node } in self.nodes() {
            nodes[number as usize] = match node.content {
                Content::Inner { axis, at, left } => StoredNode::Inner { axis: axis as u8, at, left },
                Content::Leaf { triangles } => {
                    references[first as usize..][..triangles.len()].copy_from_slice(triangles);
                    StoredNode::Leaf { first, count: triangles.len() as u32 }
                }
            };
        }
        KdTree::new(self.root, nodes, references)
    }
}
