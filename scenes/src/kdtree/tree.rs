//! A tree level by level: twelve octets a node and one list of all packets. Boxes and neighbours follow from the order of the nodes, so
//! they are worked out while one goes through them. How a tree comes about is not said here.

use std::collections::VecDeque;

use super::Bounds;

/// A node of the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Node<'a> {
    /// The node's part of space.
    pub bounds: Bounds,
    /// Next node of the same level, from left to right; `None` for the last.
    pub next: Option<u32>,
    /// The node's content.
    pub content: Content<'a>,
}

/// Content of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content<'a> {
    /// A node divided at the plane `axis = at`; the right child's number is that of the left one plus 1.
    Inner {
        /// Axis of the plane, 0 to 2.
        axis: usize,
        /// Coordinate of the plane, raw.
        at: i32,
        /// Number of the left child, the side of smaller coordinates.
        left: u32,
    },
    /// A packet of triangles, by index, ascending.
    Leaf {
        /// Indices of the triangles that reach into the node.
        triangles: &'a [u32],
    },
}

/// The tree: nodes level by level, each level from left to right; node 0 is the root.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KdTree {
    root: Bounds,
    nodes: Vec<StoredNode>,
    /// The packets, leaf by leaf in the order of the nodes.
    triangles: Vec<u32>,
}

/// A node in twelve octets: its box and its neighbour follow from the order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StoredNode {
    /// A plane, and the number of the left child.
    Inner { axis: u8, at: i32, left: u32 },
    /// Place of the packet in the list of all.
    Leaf { first: u32, count: u32 },
}

const _: () = assert!(size_of::<StoredNode>() == 12);

impl KdTree {
    /// A tree in the box `root`, from nodes in their order.
    pub(super) fn new(root: Bounds, nodes: Vec<StoredNode>, triangles: Vec<u32>) -> KdTree {
        KdTree { root, nodes, triangles }
    }

    /// The tree of nodes in their order; `None` when they are not the nodes of a tree level by level.
    pub(crate) fn from_nodes<P: AsRef<[u32]>>(
        root: Bounds,
        nodes: impl Iterator<Item = UnlinkedNode<P>>,
    ) -> Option<KdTree> {
        let mut tree = KdTree { root, nodes: Vec::new(), triangles: Vec::new() };
        let mut below = 1;
        for node in nodes {
            tree.nodes.push(match node {
                UnlinkedNode::Inner { axis, at } => {
                    below += 2;
                    StoredNode::Inner { axis: u8::try_from(axis).ok().filter(|axis| *axis < 3)?, at, left: below - 2 }
                }
                UnlinkedNode::Leaf(packet) => {
                    let (first, count) = (tree.triangles.len(), packet.as_ref().len());
                    tree.triangles.extend_from_slice(packet.as_ref());
                    StoredNode::Leaf { first: u32::try_from(first).ok()?, count: u32::try_from(count).ok()? }
                }
            });
        }
        // As many nodes as the inner ones announce, and each reached: the octets may come from a damaged image.
        (tree.nodes.len() == below as usize && tree.nodes().count() == below as usize).then_some(tree)
    }

    /// Number of nodes.
    pub fn count(&self) -> usize {
        self.nodes.len()
    }

    /// Triangles of all packets together; one counts in each packet that it is in.
    pub fn references(&self) -> usize {
        self.triangles.len()
    }

    /// Content of node `number`.
    ///
    /// # Panics
    /// When there is no such node.
    pub fn content(&self, number: u32) -> Content<'_> {
        match self.nodes[number as usize] {
            StoredNode::Inner { axis, at, left } => Content::Inner { axis: axis.into(), at, left },
            StoredNode::Leaf { first, count } => {
                Content::Leaf { triangles: &self.triangles[first as usize..][..count as usize] }
            }
        }
    }

    /// All nodes in their order.
    pub fn nodes(&self) -> impl Iterator<Item = Node<'_>> {
        let mut waiting = VecDeque::from([self.root]);
        // Number of the first node of the next level.
        let mut end = 1;
        (0..self.nodes.len() as u32).map_while(move |number| {
            let bounds = waiting.pop_front()?;
            let content = self.content(number);
            if let Content::Inner { axis, at, .. } = content {
                waiting.extend(bounds.divided(axis, at));
            }
            let next = (number + 1 < end).then_some(number + 1);
            if next.is_none() {
                end = number + 1 + waiting.len() as u32;
            }
            Some(Node { bounds, next, content })
        })
    }
}

/// A node that does not know its children and neighbours yet.
pub(crate) enum UnlinkedNode<P> {
    /// A plane.
    Inner {
        /// The plane's axis.
        axis: usize,
        /// The plane's coordinate, raw.
        at: i32,
    },
    /// A packet.
    Leaf(P),
}
