//! The quick search: a hierarchy of boxes (bounding volume hierarchy), divided by the surface-area heuristic over 16 bins of centroids, four
//! children a node. It has nothing in common with the kd tree of the memory image.

use std::ops::Range;

use smallvec::SmallVec;

use super::search::{Hit, Search, better};
use super::short::{Boxes, LANES, ShortRay, TriangleBlock};
use super::triangle::{PreparedTriangle, Shapes, ShearedRay};
use crate::model::Vec3;

/// The hierarchy; node 0 is its root. Without triangles there is none.
#[derive(Debug)]
pub struct Hierarchy<'a> {
    shapes: Shapes<'a>,
    /// Box of all triangles.
    all: Box3,
    nodes: Vec<WideNode>,
    leaves: Leaves,
}

/// The triangles, leaf by leaf.
#[derive(Debug)]
enum Leaves {
    /// Copies, a block a leaf.
    Blocks(Vec<TriangleBlock>),
    /// Numbers alone, of which blocks are made when they are wanted: takes a twelfth of the memory and longer.
    Numbers(Vec<u32>),
}

/// A node with up to four children.
#[derive(Clone, Copy, Debug)]
struct WideNode {
    boxes: Boxes,
    /// Of each child its number, or the leaf's: that of its block, or the place of its first triangle.
    children: [u32; LANES],
    /// Triangles of each leaf, 0 for a node.
    counts: [u8; LANES],
    /// A bit for each child that there is.
    lanes: u8,
}

/// A part of the triangles before nodes are joined by fours.
struct DividedPart {
    bounds: Box3,
    range: Range<usize>,
    level: u32,
}

/// Triangles that a leaf holds without being divided: one block.
const SMALL: usize = LANES;
const BINS: usize = 16;
/// Triangles of which leaves hold copies; of more of them, building takes longer than all rays of a picture.
const MOST_COPIES: usize = 1 << 18;
/// Levels after which nodes are halved, which bounds the depth.
const UNBALANCED: u32 = 48;

/// Corners of a box, smallest and largest, in single precision and rounded outwards.
pub(super) type Box3 = ([f32; 3], [f32; 3]);

/// Box and number of triangles.
type Bin = (Box3, usize);

const EMPTY: Box3 = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);

/// A triangle while the hierarchy is built.
struct Entry {
    bounds: Box3,
    index: u32,
}

impl Entry {
    fn new(index: u32, triangle: &PreparedTriangle) -> Entry {
        let down = |x: f64| if f64::from(x as f32) > x { (x as f32).next_down() } else { x as f32 };
        let up = |x: f64| if f64::from(x as f32) < x { (x as f32).next_up() } else { x as f32 };
        let corner = |v: Vec3| (v.map(down), v.map(up));
        Entry { bounds: triangle.vertices.into_iter().map(corner).fold(EMPTY, joined), index }
    }

    fn middle(&self) -> [f32; 3] {
        let (low, high) = self.bounds;
        [(low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0, (low[2] + high[2]) / 2.0]
    }
}

#[inline]
fn joined((low, high): Box3, (other_low, other_high): Box3) -> Box3 {
    // Comparisons alone, since there is nothing here that is no number.
    let smaller = |a: f32, b: f32| if a < b { a } else { b };
    let larger = |a: f32, b: f32| if a > b { a } else { b };
    let ([x, y, z], [ox, oy, oz]) = (low, other_low);
    let ([hx, hy, hz], [ohx, ohy, ohz]) = (high, other_high);
    ([smaller(x, ox), smaller(y, oy), smaller(z, oz)], [larger(hx, ohx), larger(hy, ohy), larger(hz, ohz)])
}

fn bounds(part: &[Entry]) -> Box3 {
    part.iter().fold(EMPTY, |all, entry| joined(all, entry.bounds))
}

fn half_surface((low, high): Box3) -> f32 {
    let side = |k: usize| (high[k] - low[k]).max(0.0);
    side(0) * side(1) + side(1) * side(2) + side(2) * side(0)
}

impl<'a> Hierarchy<'a> {
    /// The hierarchy of the triangles with these numbers.
    pub fn new(shapes: Shapes<'a>, indices: Vec<u32>) -> Hierarchy<'a> {
        Hierarchy::with_copies(shapes, indices, MOST_COPIES)
    }

    /// The hierarchy whose leaves hold copies of their triangles if there are at most `most` of them.
    pub fn with_copies(shapes: Shapes<'a>, mut indices: Vec<u32>, most: usize) -> Hierarchy<'a> {
        let entry = |index: &u32| Entry::new(*index, &shapes.triangle(*index));
        let mut entries: Vec<Entry> = indices.iter().map(entry).collect();
        let all = bounds(&entries);
        let mut nodes = Vec::new();
        // Nodes whose parts are still to be divided, each with the place that names it.
        let root = DividedPart { bounds: all, range: 0..entries.len(), level: 0 };
        let mut open = if entries.is_empty() { Vec::new() } else { vec![(root, None)] };
        while let Some((part, place)) = open.pop() {
            let number = nodes.len();
            if let Some((parent, lane)) = place {
                let parent: &mut WideNode = &mut nodes[parent];
                parent.children[lane] = number as u32;
            }
            let parts = divided(&mut entries, part);
            let boxes = Boxes::new(&parts.iter().map(|part| part.bounds).collect::<SmallVec<[Box3; LANES]>>());
            let (mut children, mut counts) = ([0; LANES], [0; LANES]);
            let lanes = (1 << parts.len()) - 1;
            for (lane, part) in parts.into_iter().enumerate() {
                if part.range.len() <= SMALL {
                    children[lane] = part.range.start as u32;
                    counts[lane] = part.range.len() as u8;
                } else {
                    open.push((part, Some((number, lane))));
                }
            }
            nodes.push(WideNode { boxes, children, counts, lanes });
        }
        // The boxes make room for the blocks.
        indices.iter_mut().zip(&entries).for_each(|(index, entry)| *index = entry.index);
        drop(entries);
        let mut hierarchy = Hierarchy { shapes, all, nodes, leaves: Leaves::Numbers(indices) };
        hierarchy.copy(most);
        hierarchy
    }

    /// Copies at most `most` triangles into blocks.
    fn copy(&mut self, most: usize) {
        let Leaves::Numbers(indices) = &self.leaves else { return };
        if indices.len() > most {
            return;
        }
        let mut blocks = Vec::with_capacity(indices.len() / 3 + 1);
        for node in &mut self.nodes {
            for (child, &count) in node.children.iter_mut().zip(&node.counts).filter(|(_, count)| **count > 0) {
                let first = *child as usize;
                *child = blocks.len() as u32;
                blocks.push(block(&self.shapes, &indices[first..first + usize::from(count)]));
            }
        }
        self.leaves = Leaves::Blocks(blocks);
    }

    /// Visits triangles that the ray may meet before `end`, near ones first; `visit` returns the new end.
    fn walk(&self, ray: &ShearedRay, end: f64, mut visit: impl FnMut(u32) -> f64) {
        if self.nodes.is_empty() {
            return;
        }
        let Some(short) = ShortRay::entering(self.all, ray, end) else { return };
        let mut end = short.end(end);
        // Rarely more than a few wait; the depth of the tree bounds them, not this number.
        let mut waiting: SmallVec<[(u32, u8, f32); 32]> = SmallVec::new();
        let (mut next, mut count) = (0, 0);
        loop {
            let first = next as usize;
            if count > 0 {
                let made;
                let block = match &self.leaves {
                    Leaves::Blocks(blocks) => &blocks[first],
                    Leaves::Numbers(indices) => {
                        made = block(&self.shapes, &indices[first..first + usize::from(count)]);
                        &made
                    }
                };
                let mut candidates = block.candidates(&short);
                while candidates != 0 {
                    end = short.end(visit(block.index(candidates.trailing_zeros() as usize)));
                    candidates &= candidates - 1;
                }
            } else {
                let node = &self.nodes[first];
                let (distances, met) = node.boxes.enter(&short, end);
                let mut met = met & u32::from(node.lanes);
                let bottom = waiting.len();
                while met != 0 {
                    let lane = met.trailing_zeros() as usize;
                    met &= met - 1;
                    // The nearest one on top: a hit there often ends the search before the others are opened.
                    waiting.push((node.children[lane], node.counts[lane], distances[lane]));
                    let mut place = waiting.len() - 1;
                    while place > bottom && waiting[place - 1].2 < waiting[place].2 {
                        waiting.swap(place - 1, place);
                        place -= 1;
                    }
                }
            }
            (next, count) = loop {
                let Some((child, count, distance)) = waiting.pop() else { return };
                // Hits since this one was put aside may lie in front of it.
                if distance <= end {
                    break (child, count);
                }
            };
        }
    }
}

fn block(shapes: &Shapes, indices: &[u32]) -> TriangleBlock {
    TriangleBlock::new(indices, |index| shapes.triangle(index))
}

/// Divides a part into up to four.
fn divided(entries: &mut [Entry], part: DividedPart) -> SmallVec<[DividedPart; LANES]> {
    let mut parts: SmallVec<[DividedPart; LANES]> = SmallVec::from_iter([part]);
    while parts.len() < LANES {
        let surface = |part: &DividedPart| if part.range.len() > SMALL { half_surface(part.bounds) } else { -1.0 };
        let largest = (1..parts.len()).fold(0, |a, b| if surface(&parts[b]) > surface(&parts[a]) { b } else { a });
        let DividedPart { range, level, .. } = &parts[largest];
        if range.len() <= SMALL {
            break;
        }
        let (range, level) = (range.clone(), *level);
        let middle = range.start + divide(&mut entries[range.clone()], level);
        let half =
            |range: Range<usize>| DividedPart { bounds: bounds(&entries[range.clone()]), range, level: level + 1 };
        let halves = [half(range.start..middle), half(middle..range.end)];
        parts.remove(largest);
        parts.insert_many(largest, halves);
    }
    parts
}

/// Orders the triangles so that the first ones, as many as is returned, are the left part.
fn divide(part: &mut [Entry], level: u32) -> usize {
    let (low, high) = part.iter().fold(EMPTY, |all, entry| joined(all, (entry.middle(), entry.middle())));
    let side = [high[0] - low[0], high[1] - low[1], high[2] - low[2]];
    let axis = (1..3).fold(0, |best, k| if side[k] > side[best] { k } else { best });
    // The largest middle would come into a bin of its own, behind the last.
    let scale = BINS as f32 / side[axis];
    let bin = |entry: &Entry| (((entry.middle()[axis] - low[axis]) * scale) as usize).min(BINS - 1);
    // Far down the tree is halved, which bounds its depth.
    if level < UNBALANCED && side[axis] > 0.0 && part.len() > 2 * SMALL {
        let mut bins = [(EMPTY, 0usize); BINS];
        let join = |(all, n): Bin, (bounds, m): Bin| (joined(all, bounds), n + m);
        for entry in &*part {
            let slot = &mut bins[bin(entry)];
            *slot = join(*slot, (entry.bounds, 1));
        }
        let cost = |(all, count): Bin| if count == 0 { f32::INFINITY } else { half_surface(all) * count as f32 };
        // What lies behind each place between two bins, from the last one on.
        let mut behind = bins;
        for at in (1..BINS - 1).rev() {
            behind[at] = join(behind[at], behind[at + 1]);
        }
        let mut before = (EMPTY, 0);
        let costs = (1..BINS).map(|at| {
            before = join(before, bins[at - 1]);
            (cost(before) + cost(behind[at]), at)
        });
        if let Some((cost, at)) = costs.min_by(|a, b| a.0.total_cmp(&b.0))
            && cost.is_finite()
        {
            let mut left = 0;
            for place in 0..part.len() {
                if bin(&part[place]) < at {
                    part.swap(place, left);
                    left += 1;
                }
            }
            return left;
        }
    }
    part.sort_by(|a, b| a.middle()[axis].total_cmp(&b.middle()[axis]));
    // What fits two blocks fills the first.
    if part.len() > 2 * SMALL { part.len() / 2 } else { SMALL }
}

impl Search for Hierarchy<'_> {
    fn triangle(&self, index: u32) -> PreparedTriangle {
        self.shapes.triangle(index)
    }

    fn nearest(&self, ray: &ShearedRay) -> Option<Hit> {
        let mut best = None;
        self.walk(ray, f64::INFINITY, |index| {
            if let Some(t) = self.shapes.hit(index, ray) {
                best = better(ray, best, Hit { t, index });
            }
            best.map_or(f64::INFINITY, |hit| hit.t)
        });
        best
    }

    fn is_blocked(&self, ray: &ShearedRay, end: f64) -> bool {
        let mut is_blocked = false;
        self.walk(ray, end, |index| {
            is_blocked = is_blocked || self.shapes.hit(index, ray).is_some_and(|t| t < end);
            if is_blocked { f64::NEG_INFINITY } else { end }
        });
        is_blocked
    }
}
