//! The order of the nodes of a kd tree in the layout `packet`: the top of the tree level by level, then blocks of nodes that belong together, so
//! that what a walk needs next mostly lies in the block that it has.

use std::collections::VecDeque;

use crate::kdtree::{BuiltTree, Content, NumberedNode};
use crate::layout::{BLOCK_NODES, TOP_NODES};

/// Place of each node, by its number.
///
/// Nodes are placed in pairs, a left child and its right one. The first [`TOP_NODES`] nodes keep their numbers. Below, a block begins with the
/// children of a node above and is filled level by level, up to [`BLOCK_NODES`]: the seven nodes of three levels, for example, have their
/// six lower ones in one block of eight, and the pair that comes next. Pairs that find no room begin blocks of their own.
pub(super) fn places(tree: &BuiltTree) -> Vec<u32> {
    let count = tree.count();
    // The left child of each node; none is 0, which is the root.
    let mut children = vec![0; count as usize];
    for NumberedNode { number, node, .. } in tree.nodes() {
        if let Content::Inner { left, .. } = node.content {
            children[number as usize] = left;
        }
    }
    let pairs_below =
        |left: u32| [left, left + 1].map(|node| children[node as usize]).into_iter().filter(|&pair| pair != 0);
    let top = TOP_NODES.min(count);
    let mut places: Vec<u32> = (0..count).collect();
    let below = children[..top as usize].iter().copied().filter(|&pair| pair >= top);
    let mut roots: VecDeque<u32> = below.collect();
    let mut next = top;
    while let Some(root) = roots.pop_front() {
        let mut block = VecDeque::from([root]);
        let end = next + BLOCK_NODES;
        while let Some(pair) = block.pop_front() {
            if next + 2 > end {
                roots.push_back(pair);
                continue;
            }
            places[pair as usize] = next;
            places[pair as usize + 1] = next + 1;
            next += 2;
            block.extend(pairs_below(pair));
        }
    }
    debug_assert_eq!(next, count);
    places
}
