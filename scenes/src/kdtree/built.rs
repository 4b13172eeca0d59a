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
        let mut tree = BuiltTree { root, subtrees, levels: Vec::new() };
        let mut sizes: Vec<[u32; 2]> = Vec::new();
        for (level, _, packet) in tree.walk() {
            if level == sizes.len() {
                sizes.push([0; 2]);
            }
            sizes[level][0] += 1;
            sizes[level][1] += packet.len() as u32;
        }
        // Nodes and references of all levels above, which is where a level's numbers begin.
        let mut before = [0; 2];
        tree.levels.push(before);
        for size in sizes {
            before = [0, 1].map(|k| before[k] + size[k]);
            tree.levels.push(before);
        }
        tree
    }

    /// All nodes in the order of a walk, each with its level and, if it is a leaf, its packet.
    #[inline]
    fn walk(&self) -> impl Iterator<Item = (usize, BuildNode, &[u32])> {
        let mut subtrees = self.subtrees.iter();
        let (mut nodes, mut packets): (std::slice::Iter<BuildNode>, &[u32]) = ([].iter(), &[]);
        // Left sides come first: behind a leaf comes the right side that has waited least.
        let (mut below, mut waiting) = (0, Vec::new());
        std::iter::from_fn(move || {
            let node = loop {
                if let Some(&node) = nodes.next() {
                    break node;
                }
                let subtree = subtrees.next()?;
                (nodes, packets) = (subtree.nodes.iter(), &subtree.triangles);
            };
            let level = below;
            Some(match node {
                BuildNode::Inner { .. } => {
                    below = level + 1;
                    waiting.push(below);
                    (level, node, [].as_slice())
                }
                BuildNode::Leaf { count } => {
                    below = waiting.pop().unwrap_or(0);
                    let (packet, others) = packets.split_at(count as usize);
                    packets = others;
                    (level, node, packet)
                }
            })
        })
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
        let mut bounds = self.root;
        let mut waiting = Vec::new();
        self.walk().map(move |(level, node, triangles)| {
            let [number, first] = places[level];
            places[level] = [number + 1, first + triangles.len() as u32];
            let here = bounds;
            let content = match node {
                BuildNode::Inner { axis, at } => {
                    let (axis, left) = (axis.into(), places[level + 1][0]);
                    let [lower, upper] = here.divided(axis, at);
                    waiting.push(upper);
                    bounds = lower;
                    Content::Inner { axis, at, left }
                }
                BuildNode::Leaf { .. } => {
                    bounds = waiting.pop().unwrap_or(self.root);
                    Content::Leaf { triangles }
                }
            };
            let next = (number + 1 < self.levels[level + 1][0]).then_some(number + 1);
            NumberedNode { number, first, node: Node { bounds: here, next, content } }
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
        let mut places = self.levels.clone();
        for (level, node, triangles) in self.walk() {
            let [number, first] = places[level];
            places[level] = [number + 1, first + triangles.len() as u32];
            nodes[number as usize] = match node {
                BuildNode::Inner { axis, at } => StoredNode::Inner { axis, at, left: places[level + 1][0] },
                BuildNode::Leaf { count } => {
                    references[first as usize..][..triangles.len()].copy_from_slice(triangles);
                    StoredNode::Leaf { first, count }
                }
            };
        }
        KdTree::new(self.root, nodes, references)
    }
}
