//! How a tree grows: node by node from the root down, both sides of a plane at the same time where they are large. Which triangles a node
//! holds and where it may be divided is a [`Membership`]'s to say; nothing here looks at a coordinate.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::grown::{Grown, Shoot, Sprout};
use super::split::{Division, Side, Sweep};
use super::{Bounds, MOST_REFERENCES};

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

/// Grows the tree of `packet` in the box `root`, at most `depth` levels high.
///
/// # Errors
/// When the leaves together would hold more than [`MOST_REFERENCES`] triangles.
pub(super) fn grow<M: Membership>(
    membership: &M,
    packet: Vec<M::Member>,
    root: Bounds,
    depth: u32,
) -> Result<Grown, TooMany> {
    let growth = Growth { membership, references: AtomicUsize::new(packet.len()) };
    Ok(Grown::new(root, growth.large(packet, root, depth, &mut Sweep::default())?))
}

struct Growth<'a, M> {
    membership: &'a M,
    /// Members of all nodes that are not divided (yet). It never shrinks, so whether it passes the limit does not depend on the order.
    references: AtomicUsize,
}

/// What becomes of a node.
enum Fate<T> {
    Leaf(Vec<T>),
    /// The plane, and what is on either side of it.
    Inner(Sprout, [(Vec<T>, Bounds); 2]),
}

impl<M: Membership> Growth<'_, M> {
    /// A node of which both sides may be worth a thread each.
    fn large(
        &self,
        packet: Vec<M::Member>,
        node: Bounds,
        levels: u32,
        sweep: &mut Sweep,
    ) -> Result<Vec<Shoot>, TooMany> {
        let mut shoot = Shoot::default();
        if packet.len() < WORTH_A_THREAD {
            self.small(packet, node, levels, sweep, &mut shoot)?;
            shoot.nodes.shrink_to_fit();
            shoot.triangles.shrink_to_fit();
            return Ok(vec![shoot]);
        }
        match self.divide(packet, node, levels, sweep)? {
            Fate::Leaf(packet) => {
                self.leaf(&packet, &mut shoot);
                Ok(vec![shoot])
            }
            Fate::Inner(sprout, [(below, lower), (above, upper)]) => {
                shoot.nodes.push(sprout);
                let (left, right) = rayon::join(
                    || self.large(below, lower, levels - 1, sweep),
                    || self.large(above, upper, levels - 1, &mut Sweep::default()),
                );
                Ok([vec![shoot], left?, right?].into_iter().flatten().collect())
            }
        }
    }

    /// A node that one thread grows, at the end of a shoot.
    fn small(
        &self,
        packet: Vec<M::Member>,
        node: Bounds,
        levels: u32,
        sweep: &mut Sweep,
        shoot: &mut Shoot,
    ) -> Result<(), TooMany> {
        match self.divide(packet, node, levels, sweep)? {
            Fate::Leaf(packet) => self.leaf(&packet, shoot),
            Fate::Inner(sprout, [(below, lower), (above, upper)]) => {
                shoot.nodes.push(sprout);
                self.small(below, lower, levels - 1, sweep, shoot)?;
                self.small(above, upper, levels - 1, sweep, shoot)?;
            }
        }
        Ok(())
    }

    fn leaf(&self, packet: &[M::Member], shoot: &mut Shoot) {
        shoot.nodes.push(Sprout::Leaf { count: packet.len() as u32 });
        shoot.triangles.extend(packet.iter().map(|member| self.membership.index(member)));
    }

    fn divide(
        &self,
        packet: Vec<M::Member>,
        node: Bounds,
        levels: u32,
        sweep: &mut Sweep,
    ) -> Result<Fate<M::Member>, TooMany> {
        let division = if levels == 0 { None } else { self.membership.best(&node, &packet, sweep) };
        let Some(division) = division else { return Ok(Fate::Leaf(packet)) };
        let [lower, upper] = node.divided(division.axis, division.at);
        let passed = |side, child: Bounds| -> Vec<M::Member> {
            packet.iter().filter_map(|member| self.membership.passed(member, &division, side, &child)).collect()
        };
        let (below, above) = (passed(Side::Left, lower), passed(Side::Right, upper));
        let more = (below.len() + above.len()).saturating_sub(packet.len());
        if self.references.fetch_add(more, Ordering::Relaxed) + more > MOST_REFERENCES {
            return Err(TooMany);
        }
        let sprout = Sprout::Inner { axis: division.axis as u8, at: division.at };
        Ok(Fate::Inner(sprout, [(below, lower), (above, upper)]))
    }
}
