//! How a tree grows: node by node from the root down, both sides of a plane at the same time where they are large. Which triangles a node
//! holds and where it may be divided is a [`Membership`]'s to say; nothing here looks at a coordinate.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::split::{Division, Side, Sweep};
use super::{Bounds, Content, KdTree, MOST_REFERENCES, Node};

/// Triangles of a packet from which its two sides are worth a thread each.
const WORTH_A_THREAD: usize = 4096;

/// Which triangles belong to a node.
pub(super) trait Membership: Sync {
    /// A triangle in a node.
    type Member: Copy + Send + Sync;

    /// Number of the triangle.
    fn index(&self, member: &Self::Member) -> u32;

    /// The best plane of a node, `None` when no plane pays.
    fn best(&self, node: &Bounds, packet: &[Self::Member], sweep: &mut Sweep) -> Option<Division>;

    /// The triangle in the child `side` with the box `child`; `None` when it does not reach into it.
    fn passed(&self, member: &Self::Member, division: &Division, side: Side, child: &Bounds) -> Option<Self::Member>;
}

/// There are more references than [`MOST_REFERENCES`].
pub(super) struct TooMany;

/// A node and what grew below it.
enum Shoot {
    Leaf(Vec<u32>),
    Inner(Division, Box<[Shoot; 2]>),
}

/// Grows the tree of `packet` in the box `root`, at most `depth` levels high.
///
/// # Errors
/// When the leaves together would hold more than [`MOST_REFERENCES`] triangles.
pub(super) fn grow<M: Membership>(
    membership: &M,
    packet: Vec<M::Member>,
    root: Bounds,
    depth: u32,
) -> Result<KdTree, TooMany> {
    let growth = Growth { membership, references: AtomicUsize::new(packet.len()) };
    let shoot = growth.node(packet, root, depth, &mut Sweep::default())?;
    Ok(by_levels(shoot, root))
}

struct Growth<'a, M> {
    membership: &'a M,
    /// Members of all nodes that are not divided (yet). It never shrinks, so whether it passes the limit does not depend on the order.
    references: AtomicUsize,
}

impl<M: Membership> Growth<'_, M> {
    fn node(&self, packet: Vec<M::Member>, node: Bounds, levels: u32, sweep: &mut Sweep) -> Result<Shoot, TooMany> {
        let division = if levels == 0 { None } else { self.membership.best(&node, &packet, sweep) };
        let Some(division) = division else {
            return Ok(Shoot::Leaf(packet.iter().map(|member| self.membership.index(member)).collect()));
        };
        let (lower, upper) = division.children(&node);
        let passed = |side, child: Bounds| -> Vec<M::Member> {
            packet.iter().filter_map(|member| self.membership.passed(member, &division, side, &child)).collect()
        };
        let (below, above) = (passed(Side::Left, lower), passed(Side::Right, upper));
        let more = (below.len() + above.len()).saturating_sub(packet.len());
        if self.references.fetch_add(more, Ordering::Relaxed) + more > MOST_REFERENCES {
            return Err(TooMany);
        }
        let is_large = packet.len() >= WORTH_A_THREAD;
        drop(packet);
        let children = if is_large {
            let (left, right) = rayon::join(
                || self.node(below, lower, levels - 1, sweep),
                || self.node(above, upper, levels - 1, &mut Sweep::default()),
            );
            [left?, right?]
        } else {
            [self.node(below, lower, levels - 1, sweep)?, self.node(above, upper, levels - 1, sweep)?]
        };
        Ok(Shoot::Inner(division, Box::new(children)))
    }
}

/// The nodes level by level, each level from left to right.
fn by_levels(root: Shoot, bounds: Bounds) -> KdTree {
    let mut nodes = Vec::new();
    let mut level = vec![(root, bounds)];
    while !level.is_empty() {
        let first = nodes.len() + level.len();
        let last = first as u32 - 1;
        let mut below = Vec::new();
        for (shoot, bounds) in level {
            let number = nodes.len() as u32;
            let content = match shoot {
                Shoot::Leaf(triangles) => Content::Leaf { triangles },
                Shoot::Inner(division, children) => {
                    let left = (first + below.len()) as u32;
                    let (lower, upper) = division.children(&bounds);
                    let [left_shoot, right_shoot] = *children;
                    below.extend([(left_shoot, lower), (right_shoot, upper)]);
                    Content::Inner { axis: division.axis, at: division.at, left }
                }
            };
            nodes.push(Node { bounds, next: (number != last).then_some(number + 1), content });
        }
        level = below;
    }
    KdTree { nodes }
}
