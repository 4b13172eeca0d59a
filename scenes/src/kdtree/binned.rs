//! Building of a tree by bins: planes from [`super::bins`], parts cut once ([`super::cut`]), and a bound on the references, so that time and memory grow
//! with the number of triangles whatever their shape. Where a plane lies is not decided here.

use super::bins::PlaneSearch;
use super::built::{BuildNode, BuiltTree, Subtree};
use super::cut::halves;
use super::membership::Part;
use super::split::{Division, Side};
use super::{Bounds, MOST_REFERENCES, Triangles};

/// Triangles of a packet from which its two sides are worth a thread each.
const WORTH_A_THREAD: usize = 4096;

/// Triangles that stay in one leaf: dividing two gains next to nothing.
const UNDIVIDED: usize = 2;

/// Most references of a tree, in triangles of its scene. Ordinary scenes have one to four; a round cap cut into thin triangles would have
/// thousands, and with this bound is still met at a tenth of the cost of boxes.
pub(super) const MOST_COPIES: usize = 64;

/// Builds the tree of `packet`, the whole triangles, in the box `root`, at most `depth` levels high. Its leaves hold at most [`MOST_COPIES`]
/// references a triangle and [`MOST_REFERENCES`] together (or each triangle once, if those are more).
pub(super) fn build<T: Triangles + ?Sized>(triangles: &T, packet: Vec<Part>, root: Bounds, depth: u32) -> BuiltTree {
    let most = MOST_REFERENCES as f64 / packet.len() as f64;
    let place = NodePlace { bounds: root, levels: depth, room: most.clamp(1.0, MOST_COPIES as f64) };
    BuiltTree::new(root, BinnedBuilder { triangles }.large(packet, place))
}

/// A node to build.
#[derive(Clone, Copy)]
struct NodePlace {
    bounds: Bounds,
    /// Levels that may follow below it.
    levels: u32,
    /// References that its leaves may hold, in triangles of its packet, at least 1.
    room: f64,
}

impl NodePlace {
    /// The places of both children, for packets of `left` and `right` of the node's `count` triangles; `None` when these are more than there is room for.
    ///
    /// The room that is left is shared out by size: with room for 3 a triangle, 100 triangles that become 60 and 60 leave 2.5, and 2.5 (60 + 60) is
    /// 3 x 100 again. So no thread has to know what the others need.
    fn children(self, division: &Division, count: usize, [left, right]: [usize; 2]) -> Option<[NodePlace; 2]> {
        let room = self.room * count as f64 / (left + right) as f64;
        let is_room = left + right <= count || room >= 1.0;
        let place = |bounds| NodePlace { bounds, levels: self.levels - 1, room };
        is_room.then(|| self.bounds.divided(division.axis, division.at).map(place))
    }
}

struct BinnedBuilder<'a, T: ?Sized> {
    triangles: &'a T,
}

impl<T: Triangles + ?Sized> BinnedBuilder<'_, T> {
    /// A node of which both sides may be worth a thread each.
    fn large(&self, mut packet: Vec<Part>, place: NodePlace) -> Vec<Subtree> {
        let mut subtree = Subtree::default();
        let mut search = PlaneSearch::default();
        let count = packet.len();
        if count < WORTH_A_THREAD {
            self.small(&mut packet, 0, place, &mut search, &mut subtree);
            subtree.nodes.shrink_to_fit();
            subtree.triangles.shrink_to_fit();
            return vec![subtree];
        }
        let Some(division) = plane(&place, &packet, &mut search) else {
            leaf(packet.iter(), &mut subtree);
            return vec![subtree];
        };
        // What goes to the left stays in its place in the list, closed up, so a node allocates for one side only.
        let mut above = Vec::with_capacity(count / 2 + count / 8);
        let mut kept = 0;
        for at in 0..count {
            let [left, right] = self.sides(packet[at], &division);
            above.extend(right);
            if let Some(part) = left {
                packet[kept] = part;
                kept += 1;
            }
        }
        packet.truncate(kept);
        let Some([lower, upper]) = place.children(&division, count, [kept, above.len()]) else {
            united(&packet, &above, &mut subtree);
            return vec![subtree];
        };
        subtree.nodes.push(BuildNode::Inner { axis: division.axis as u8, at: division.at });
        let (left, right) = rayon::join(|| self.large(packet, lower), || self.large(above, upper));
        [vec![subtree], left, right].into_iter().flatten().collect()
    }

    /// A node that one thread builds, at the end of a subtree. Its packet is the end of `stack` from `start` on, and taken off.
    fn small(
        &self,
        stack: &mut Vec<Part>,
        start: usize,
        mut place: NodePlace,
        search: &mut PlaneSearch,
        subtree: &mut Subtree,
    ) {
        loop {
            let packet = &stack[start..];
            let (count, end) = (packet.len(), stack.len());
            let Some(division) = plane(&place, packet, search) else {
                leaf(packet.iter(), subtree);
                break;
            };
            // The right side stays, closed up; the left one, which comes first in a walk, goes on top.
            let mut kept = start;
            for at in start..end {
                let [left, right] = self.sides(stack[at], &division);
                stack.extend(left);
                if let Some(part) = right {
                    stack[kept] = part;
                    kept += 1;
                }
            }
            let Some([lower, upper]) = place.children(&division, count, [stack.len() - end, kept - start]) else {
                united(&stack[end..], &stack[start..kept], subtree);
                break;
            };
            subtree.nodes.push(BuildNode::Inner { axis: division.axis as u8, at: division.at });
            self.small(stack, end, lower, search, subtree);
            stack.truncate(kept);
            place = upper;
        }
        stack.truncate(start);
    }

    /// Pieces of a part left and right of a plane.
    #[inline]
    fn sides(&self, part: Part, division: &Division) -> [Option<Part>; 2] {
        let (low, high) = (part.bounds.low[division.axis], part.bounds.high[division.axis]);
        if low < division.at && high > division.at {
            let halves = halves(&self.triangles.vertices(part.index as usize), &part.bounds, division);
            return halves.map(|half| half.map(|bounds| Part { bounds, ..part }));
        }
        let is_flat = low == division.at && high == division.at;
        let is_left = if is_flat { division.flat == Side::Left } else { high <= division.at };
        if is_left { [Some(part), None] } else { [None, Some(part)] }
    }
}

/// The plane that divides a node, if one may and does pay.
fn plane(place: &NodePlace, packet: &[Part], search: &mut PlaneSearch) -> Option<Division> {
    let may_divide = place.levels > 0 && packet.len() > UNDIVIDED;
    may_divide.then(|| search.plane(&place.bounds, packet)).flatten()
}

fn leaf<'a>(packet: impl ExactSizeIterator<Item = &'a Part>, subtree: &mut Subtree) {
    subtree.nodes.push(BuildNode::Leaf { count: packet.len() as u32 });
    subtree.triangles.extend(packet.map(|part| part.index));
}

/// A leaf of what lies on both sides of a plane for which there is no room.
fn united(left: &[Part], right: &[Part], subtree: &mut Subtree) {
    let mut packet: Vec<&Part> = left.iter().chain(right).collect();
    packet.sort_unstable_by_key(|part| part.index);
    packet.dedup_by_key(|part| part.index);
    leaf(packet.into_iter(), subtree);
}
