//! The quick search: a hierarchy of boxes (bounding volume hierarchy), divided by the surface area heuristic over 16 bins of centroids. It
//! has nothing in common with the kd tree of the memory image.

use std::ops::Range;

use super::search::{Hit, Search, better};
use super::tie::TIE;
use super::triangle::{PreparedTriangle, Shapes, ShearedRay};
use crate::model::Vec3;
use crate::vector::AXES;

/// The hierarchy; node 0 is its root.
#[derive(Debug)]
pub struct Hierarchy<'a> {
    shapes: Shapes<'a>,
    /// The numbers of the triangles, leaf by leaf.
    indices: Vec<u32>,
    nodes: Vec<BoxNode>,
}

#[derive(Clone, Copy, Debug)]
struct BoxNode {
    /// The node's box in single precision, rounded outwards.
    low: [f32; 3],
    high: [f32; 3],
    /// Of a leaf the place of its first triangle in the list, else the left child; the right child follows it.
    first: u32,
    /// Triangles of a leaf, 0 for an inner node.
    count: u32,
}

impl BoxNode {
    /// A leaf.
    fn new((low, high): Box3, range: &Range<usize>) -> BoxNode {
        BoxNode {
            low: low.map(|x| if f64::from(x as f32) > x { (x as f32).next_down() } else { x as f32 }),
            high: high.map(|x| if f64::from(x as f32) < x { (x as f32).next_up() } else { x as f32 }),
            first: range.start as u32,
            count: range.len() as u32,
        }
    }
}

/// Triangles that a leaf holds without being divided.
const SMALL: usize = 8;
const BINS: usize = 16;
/// Levels after which nodes are halved, which bounds the depth.
const UNBALANCED: u32 = 48;
/// At most [`UNBALANCED`] levels, then one for each halving of 2^32 triangles.
const STACK: usize = UNBALANCED as usize + 34;

type Box3 = (Vec3, Vec3);

const EMPTY: Box3 = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);

fn joined((low, high): Box3, (other_low, other_high): Box3) -> Box3 {
    (AXES.map(|k| low[k].min(other_low[k])), AXES.map(|k| high[k].max(other_high[k])))
}

fn box_of(shapes: &Shapes, index: u32) -> Box3 {
    shapes.triangle(index).vertices.iter().fold(EMPTY, |all, &v| joined(all, (v, v)))
}

fn half_surface((low, high): Box3) -> f64 {
    let [x, y, z] = AXES.map(|k| (high[k] - low[k]).max(0.0));
    x * y + y * z + z * x
}

fn middle((low, high): Box3, axis: usize) -> f64 {
    (low[axis] + high[axis]) / 2.0
}

impl<'a> Hierarchy<'a> {
    /// Builds the hierarchy of the triangles with these numbers.
    pub fn new(shapes: Shapes<'a>, mut indices: Vec<u32>) -> Hierarchy<'a> {
        // Mostly half as many; growing by doubling would hold three times of it at once.
        let mut nodes = Vec::with_capacity(indices.len().max(1));
        nodes.push(BoxNode::new(EMPTY, &(0..0)));
        let mut open = vec![(0usize, 0..indices.len(), 0)];
        while let Some((number, range, level)) = open.pop() {
            let part = &mut indices[range.clone()];
            let split = if part.len() <= SMALL { None } else { Some(divide(&shapes, part, level)) };
            nodes[number] = BoxNode::new(part.iter().map(|&index| box_of(&shapes, index)).fold(EMPTY, joined), &range);
            if let Some(at) = split {
                let left = nodes.len();
                nodes[number].first = left as u32;
                nodes[number].count = 0;
                nodes.extend([nodes[number]; 2]);
                open.push((left, range.start..range.start + at, level + 1));
                open.push((left + 1, range.start + at..range.end, level + 1));
            }
        }
        Hierarchy { shapes, indices, nodes }
    }

    /// Visits the leaves that the ray passes before `end`, near ones first; `visit` returns the new end.
    fn walk(&self, ray: &ShearedRay, mut end: f64, mut visit: impl FnMut(&[u32]) -> f64) {
        // A component 0 gives an infinite reciprocal, and with it the comparisons that are right for such a ray.
        let reciprocal = ray.direction.map(|d| 1.0 / d);
        let entry = |node: &BoxNode, end: f64| enters(node, ray.origin, reciprocal, end);
        let mut stack = [(0u32, 0.0f64); STACK];
        let mut height = 0;
        let mut number = 0;
        if entry(&self.nodes[0], end).is_none() {
            return;
        }
        loop {
            let node = &self.nodes[number as usize];
            if node.count > 0 || self.indices.is_empty() {
                let range = node.first as usize..(node.first + node.count) as usize;
                end = visit(&self.indices[range]);
            } else {
                let (left, right) = (node.first, node.first + 1);
                let enter = |child: u32| Some((child, entry(&self.nodes[child as usize], end)?));
                let near = match (enter(left), enter(right)) {
                    (Some(a), Some(b)) => {
                        // The nearer child first: a hit there often ends the search before the other one is opened.
                        let (near, far) = if a.1 <= b.1 { (a, b) } else { (b, a) };
                        stack[height] = far;
                        height += 1;
                        Some(near)
                    }
                    (a, b) => a.or(b),
                };
                if let Some((child, _)) = near {
                    number = child;
                    continue;
                }
            }
            number = loop {
                if height == 0 {
                    return;
                }
                height -= 1;
                let (waiting, t) = stack[height];
                // Hits since this one was put aside may lie in front of it.
                if t <= end {
                    break waiting;
                }
            };
        }
    }
}

/// Distance at which the ray enters the box, `None` when it misses it before `end`. The box is taken a little larger, by more than all roundings here and
/// what the test of a triangle calls its border, so that no hit is lost.
fn enters(node: &BoxNode, origin: Vec3, reciprocal: Vec3, end: f64) -> Option<f64> {
    const SLACK: f64 = 4.0 * TIE;
    let (mut near, mut far) = (0.0f64, end);
    for k in AXES {
        // An origin on the face of a box that it runs along gives 0 * infinity; min and max skip it.
        let a = (f64::from(node.low[k]) - origin[k] - SLACK * (1.0 + origin[k].abs())) * reciprocal[k];
        let b = (f64::from(node.high[k]) - origin[k] + SLACK * (1.0 + origin[k].abs())) * reciprocal[k];
        near = near.max(a.min(b));
        far = far.min(a.max(b));
    }
    (near <= far * (1.0 + SLACK)).then_some(near * (1.0 - SLACK))
}

/// Orders the triangles so that the first ones, as many as is returned, are the left part.
fn divide(shapes: &Shapes, part: &mut [u32], level: u32) -> usize {
    let box_of = |&index: &u32| box_of(shapes, index);
    let centroids = part.iter().map(box_of).fold(EMPTY, |all, b| {
        let point = AXES.map(|k| middle(b, k));
        joined(all, (point, point))
    });
    let side = AXES.map(|k| centroids.1[k] - centroids.0[k]);
    let axis = (1..3).fold(0, |best, k| if side[k] > side[best] { k } else { best });
    let half = part.len() / 2;
    // The largest centroid would come into a bin of its own, behind the last.
    let bin = |b: Box3| (((middle(b, axis) - centroids.0[axis]) / side[axis] * BINS as f64) as usize).min(BINS - 1);
    // Far down the tree is halved, so that the stack of a walk is never too small.
    if level < UNBALANCED && side[axis] > 0.0 {
        let mut bins = [(EMPTY, 0usize); BINS];
        for b in part.iter().map(box_of) {
            let slot = &mut bins[bin(b)];
            *slot = (joined(slot.0, b), slot.1 + 1);
        }
        let cost = |bins: &[(Box3, usize)]| {
            let (all, count) = bins.iter().fold((EMPTY, 0), |(all, n), &(b, m)| (joined(all, b), n + m));
            if count == 0 { f64::INFINITY } else { half_surface(all) * count as f64 }
        };
        let best = (1..BINS).map(|at| (cost(&bins[..at]) + cost(&bins[at..]), at)).min_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((cost, at)) = best
            && cost.is_finite()
        {
            let (left, right): (Vec<u32>, Vec<u32>) = part.iter().partition(|index| bin(box_of(index)) < at);
            let (first, last) = part.split_at_mut(left.len());
            first.copy_from_slice(&left);
            last.copy_from_slice(&right);
            return left.len();
        }
    }
    part.sort_by(|a, b| middle(box_of(a), axis).total_cmp(&middle(box_of(b), axis)));
    half
}

impl Search for Hierarchy<'_> {
    fn triangle(&self, index: u32) -> PreparedTriangle {
        self.shapes.triangle(index)
    }

    fn nearest(&self, ray: &ShearedRay) -> Option<Hit> {
        let mut best = None;
        self.walk(ray, f64::INFINITY, |leaf| {
            for &index in leaf {
                if let Some(t) = self.shapes.hit(index, ray) {
                    best = better(ray, best, Hit { t, index });
                }
            }
            best.map_or(f64::INFINITY, |hit| hit.t)
        });
        best
    }

    fn is_blocked(&self, ray: &ShearedRay, end: f64) -> bool {
        let mut is_blocked = false;
        self.walk(ray, end, |leaf| {
            is_blocked |= leaf.iter().any(|&index| self.shapes.hit(index, ray).is_some_and(|t| t < end));
            if is_blocked { f64::NEG_INFINITY } else { end }
        });
        is_blocked
    }
}
