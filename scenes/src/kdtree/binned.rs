//! Building of a tree by bins: planes from [`super::bins`], parts cut once ([`super::cut`]), and a bound on the references, so that time and memory grow
//! with the number of triangles whatever their shape. Where a plane lies is not decided here.

use std::ops::Range;

use super::bins::PlaneSearch;
use super::built::{BuildNode, BuiltTree, Subtree};
use super::cut::halves;
use super::membership::Part;
use super::split::{Division, Side};
use super::{Bounds, MOST_REFERENCES, Triangles, VISIT};

/// Triangles of a packet from which its two sides are worth a thread each.
const WORTH_A_THREAD: usize = 4096;

/// Triangles that stay in one leaf where a visit costs as much as a test: dividing two gains next to nothing.
const UNDIVIDED: usize = 2;

/// Most references of a tree, in triangles of its scene. Ordinary scenes have one to four; a round cap cut into thin triangles would have
/// thousands, and with this bound is still met at a tenth of the cost of boxes.
pub(super) const MOST_COPIES: usize = 64;

/// Builds the tree of `packet`, the whole triangles, in the box `root`, at most `depth` levels high, for visits of nodes that cost `visit` percent of a test
/// of a triangle. Its leaves hold at most [`MOST_COPIES`]
/// references a triangle and [`MOST_REFERENCES`] together (or each triangle once, if those are more).
pub(super) fn build<T: Triangles + ?Sized>(
    triangles: &T,
    packet: Vec<Part>,
    root: Bounds,
    (depth, visit): (u32, u32),
) -> BuiltTree {
    let most = MOST_REFERENCES as f64 / packet.len() as f64;
    let place = NodePlace { bounds: root, levels: depth, room: most.clamp(1.0, MOST_COPIES as f64) };
    BuiltTree::new(root, BinnedBuilder { triangles, visit }.large(packet, place))
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
    /// Cost of visiting a node in percent of a test.
    visit: u32,
}

impl<T: Triangles + ?Sized> BinnedBuilder<'_, T> {
    /// A node of which both sides may be worth a thread each.
    fn large(&self, mut packet: Vec<Part>, place: NodePlace) -> Vec<Subtree> {
        let mut subtree = Subtree::default();
        let mut space = BuildSpace::default();
        let count = packet.len();
        if count < WORTH_A_THREAD {
            space.parts = packet;
            self.small(&mut space, 0..count, place, &mut subtree);
            subtree.nodes.shrink_to_fit();
            subtree.triangles.shrink_to_fit();
            return vec![subtree];
        }
        let Some(division) = self.plane(&place, &packet, &mut space.search) else {
            leaf(packet.iter(), &mut subtree);
            return vec![subtree];
        };
        // What goes to the left stays in its place in the list, closed up, so a node allocates for one side only.
        let mut above = Vec::with_capacity(count / 2 + count / 8);
        let mut kept = 0;
        space.parts.resize(AT_ONCE, Part::NONE);
        for start in (0..count).step_by(AT_ONCE) {
            let some = &mut packet[start..count.min(start + AT_ONCE)];
            let [stay, go] = self.divide(some, &mut space.parts, &mut space.cuts, &division, Side::Left);
            above.extend_from_slice(&space.parts[..go]);
            packet.copy_within(start..start + stay, kept);
            kept += stay;
        }
        packet.truncate(kept);
        let Some([lower, upper]) = place.children(&division, count, [kept, above.len()]) else {
            united(&packet, &above, &mut subtree);
            return vec![subtree];
        };
        drop(space);
        subtree.nodes.push(BuildNode::Inner { axis: division.axis as u8, at: division.at });
        let (left, right) = rayon::join(|| self.large(packet, lower), || self.large(above, upper));
        [vec![subtree], left, right].into_iter().flatten().collect()
    }

    /// A node that one thread builds, at the end of a subtree. Its packet are the parts `packet`; what is behind them may be overwritten.
    fn small(&self, space: &mut BuildSpace, packet: Range<usize>, mut place: NodePlace, subtree: &mut Subtree) {
        let Range { start, mut end } = packet;
        loop {
            let count = end - start;
            let packet = &space.parts[start..end];
            let Some(division) = self.plane(&place, packet, &mut space.search) else {
                leaf(packet.iter(), subtree);
                return;
            };
            if space.parts.len() < end + count {
                space.parts.resize(end + count, Part::NONE);
            }
            // The right side stays, closed up; the left one, which comes first in a walk, goes behind it.
            let (packet, behind) = space.parts[start..].split_at_mut(count);
            let [stay, go] = self.divide(packet, behind, &mut space.cuts, &division, Side::Right);
            let Some([lower, upper]) = place.children(&division, count, [go, stay]) else {
                united(&behind[..go], &packet[..stay], subtree);
                return;
            };
            subtree.nodes.push(BuildNode::Inner { axis: division.axis as u8, at: division.at });
            self.small(space, end..end + go, lower, subtree);
            (end, place) = (start + stay, upper);
        }
    }

    /// The plane that divides a node, if one may and does pay.
    fn plane(&self, place: &NodePlace, packet: &[Part], search: &mut PlaneSearch) -> Option<Division> {
        let undivided = if self.visit < VISIT { 1 } else { UNDIVIDED };
        let may_divide = place.levels > 0 && packet.len() > undivided;
        may_divide.then(|| search.plane(&place.bounds, packet, f64::from(self.visit) / f64::from(VISIT))).flatten()
    }

    /// Divides a packet: what is on the side `kept` stays, closed up, the rest goes to the front of `moved`, both in their order. Returns the numbers of both.
    ///
    /// Nobody can foresee on which side a part is, so there is no branch that asks: each part is written to both lists, of which only those grow that it
    /// belongs to. Parts on both sides are cut when all have their places.
    ///
    /// Four parts at a plane at 10, of which the left side is kept and flat parts go to the right. The lists are shown up to their lengths:
    ///
    /// | part | along the axis | `packet` | `moved` | `places` |
    /// | --- | --- | --- | --- | --- |
    /// | a | 2 to 8 | a | | |
    /// | b | 4 to 14 | a b | b | (1, 0) |
    /// | c | 10 to 10 | a b | b c | (1, 0) |
    /// | d | 12 to 15 | a b | b c d | (1, 0) |
    ///
    /// Then b is cut: place 1 of `packet` gets its left half, place 0 of `moved` its right one, and the numbers are 2 and 3.
    fn divide(
        &self,
        packet: &mut [Part],
        moved: &mut [Part],
        cuts: &mut Vec<[u32; 2]>,
        division: &Division,
        kept: Side,
    ) -> [usize; 2] {
        let Division { axis, at, flat } = *division;
        let count = packet.len();
        if cuts.len() < count {
            cuts.resize(count, [0; 2]);
        }
        let (moved, places) = (&mut moved[..count], &mut cuts[..count]);
        // Write each part to both lists, in `packet` never ahead of what is read, and let those grow that it belongs to
        let [mut stay, mut go, mut cut] = [0; 3];
        for number in 0..count {
            let part = packet[number];
            let is_left = part.bounds.low[axis] < at;
            let is_right = part.bounds.high[axis] > at;
            let is_flat = !(is_left | is_right);
            let in_left = is_left | (is_flat & (flat == Side::Left));
            let in_right = is_right | (is_flat & (flat == Side::Right));
            let [is_kept, is_moved] = if kept == Side::Left { [in_left, in_right] } else { [in_right, in_left] };
            (packet[stay], moved[go], places[cut]) = (part, part, [stay as u32, go as u32]);
            stay += usize::from(is_kept);
            go += usize::from(is_moved);
            cut += usize::from(is_left & is_right);
        }
        // Cut the parts on both sides
        let mut is_any_gone = false;
        for &[stays, goes] in &places[..cut] {
            let (stays, goes) = (&mut packet[stays as usize], &mut moved[goes as usize]);
            let [left, right] = halves(&self.triangles.vertices(stays.index as usize), &stays.bounds, division);
            (stays.bounds, goes.bounds) = if kept == Side::Left { (left, right) } else { (right, left) };
            is_any_gone |= left.is_empty() | right.is_empty();
        }
        // Close up what has lost halves: the triangle may leave its part's box before the plane
        if is_any_gone { [closed_up(&mut packet[..stay]), closed_up(&mut moved[..go])] } else { [stay, go] }
    }
}

/// Parts that [`BinnedBuilder::divide`] divides at once in a large node, so that what it writes stays near.
const AT_ONCE: usize = 1024;

/// Storage that serves one node after another.
#[derive(Default)]
struct BuildSpace {
    /// Packets of the node in work and of those that wait for it, each with what is left of it at its start.
    parts: Vec<Part>,
    /// Places of the parts that a plane cuts, in both lists.
    cuts: Vec<[u32; 2]>,
    search: PlaneSearch,
}

/// Moves parts that are not empty to the front, in their order, and counts them.
fn closed_up(parts: &mut [Part]) -> usize {
    let mut kept = 0;
    for number in 0..parts.len() {
        let part = parts[number];
        parts[kept] = part;
        kept += usize::from(!part.bounds.is_empty());
    }
    kept
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
