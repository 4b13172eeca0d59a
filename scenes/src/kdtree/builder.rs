//! Building of a tree: node by node from the root down, both sides of a plane at the same time where they are large. Which triangles a node
//! holds and where it may be divided is a [`Membership`]'s to say; nothing here looks at a coordinate.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::built::{BuildNode, BuiltTree, Subtree};
use super::split::{Division, Side, Sweep};
use super::{Bounds, MOST_REFERENCES};

/// Triangles of a packet from which its two sides are worth a thread each.
const WORTH_A_THREAD: usize = 4096;

/// Rule that says which triangles belong to a node.
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
pub(super) struct TooManyReferences;

/// Builds the tree of `packet` in the box `root`, at most `depth` levels high.
///
/// # Errors
/// When the leaves together would hold more than [`MOST_REFERENCES`] triangles.
pub(super) fn build<M: Membership>(
    membership: &M,
    packet: Vec<M::Member>,
    root: Bounds,
    depth: u32,
) -> Result<BuiltTree, TooManyReferences> {
    let builder = Builder { membership, references: AtomicUsize::new(packet.len()) };
    Ok(BuiltTree::new(root, builder.large(packet, root, depth, &mut Sweep::default())?))
}

struct Builder<'a, M> {
    membership: &'a M,
    /// Members of all nodes that are not divided (yet). It never shrinks, so whether it passes the limit does not depend on the order.
    references: AtomicUsize,
}

/// Outcome of looking for a plane through a node.
enum Divided<T> {
    Leaf(Vec<T>),
    /// The plane, and what is on either side of it.
    Inner(BuildNode, [(Vec<T>, Bounds); 2]),
}

impl<M: Membership> Builder<'_, M> {
    /// A node of which both sides may be worth a thread each.
    fn large(
        &self,
        packet: Vec<M::Member>,
        node: Bounds,
        levels: u32,
        sweep: &mut Sweep,
    ) -> Result<Vec<Subtree>, TooManyReferences> {
        let mut subtree = Subtree::default();
        if packet.len() < WORTH_A_THREAD {
            self.small(packet, node, levels, sweep, &mut subtree)?;
            subtree.nodes.shrink_to_fit();
            subtree.triangles.shrink_to_fit();
            return Ok(vec![subtree]);
        }
        match self.divide(packet, node, levels, sweep)? {
            Divided::Leaf(packet) => {
                self.leaf(&packet, &mut subtree);
                Ok(vec![subtree])
            }
            Divided::Inner(node, [(below, lower), (above, upper)]) => {
                subtree.nodes.push(node);
                let (left, right) = rayon::join(
                    || self.large(below, lower, levels - 1, sweep),
                    // The right side may run on another thread, so it has lists of its own to sort in.
                    || self.large(above, upper, levels - 1, &mut Sweep::default()),
                );
                Ok([vec![subtree], left?, right?].into_iter().flatten().collect())
            }
        }
    }

    /// A node that one thread builds, at the end of a subtree.
    fn small(
        &self,
        packet: Vec<M::Member>,
        node: Bounds,
        levels: u32,
        sweep: &mut Sweep,
        subtree: &mut Subtree,
    ) -> Result<(), TooManyReferences> {
        match self.divide(packet, node, levels, sweep)? {
            Divided::Leaf(packet) => self.leaf(&packet, subtree),
            Divided::Inner(node, [(below, lower), (above, upper)]) => {
                subtree.nodes.push(node);
                self.small(below, lower, levels - 1, sweep, subtree)?;
                self.small(above, upper, levels - 1, sweep, subtree)?;
            }
        }
        Ok(())
    }

    fn leaf(&self, packet: &[M::Member], subtree: &mut Subtree) {
        subtree.nodes.push(BuildNode::Leaf { count: packet.len() as u32 });
        subtree.triangles.extend(packet.iter().map(|member| self.membership.index(member)));
    }

    fn divide(
        &self,
        packet: Vec<M::Member>,
        node: Bounds,
        levels: u32,
        sweep: &mut Sweep,
    ) -> Result<Divided<M::Member>, TooManyReferences> {
        let division = if levels == 0 { None } else { self.membership.best(&node, &packet, sweep) };
        let Some(division) = division else { return Ok(Divided::Leaf(packet)) };
        let [lower, upper] = node.divided(division.axis, division.at);
        let passed = |side, child: Bounds| -> Vec<M::Member> {
            packet.iter().filter_map(|member| self.membership.passed(member, &division, side, &child)).collect()
        };
        let (below, above) = (passed(Side::Left, lower), passed(Side::Right, upper));
        // Only what crosses the plane is new. Threads share the sum, so that a tree is refused before it fills the memory.
        let more = (below.len() + above.len()).saturating_sub(packet.len());
        if self.references.fetch_add(more, Ordering::Relaxed) + more > MOST_REFERENCES {
            return Err(TooManyReferences);
        }
        let node = BuildNode::Inner { axis: division.axis as u8, at: division.at };
        Ok(Divided::Inner(node, [(below, lower), (above, upper)]))
    }
}
