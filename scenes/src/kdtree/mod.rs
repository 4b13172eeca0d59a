//! The report's kd tree, level by level, on the grid's integers (report 5.3). How a node is divided is decided in [`split`], by exact
//! comparisons; nothing here knows of memory layouts or of how rays walk through the tree.

pub mod split;
mod statistics;
#[cfg(test)]
mod tests;

use isa::diagnostic::{Diagnostic, Report};

use split::{Division, Side};
pub use statistics::Statistics;

/// Levels below the root that the report's tree has at most.
pub const DEPTH: u32 = 16;

/// Deepest tree that can be asked for: beyond it a node would be divided more often than a coordinate has bits.
pub const DEEPEST: u32 = 40;

/// References to triangles, over all leaves, beyond which a tree is refused (2^27, half a gibioctet of them).
pub const MOST_REFERENCES: usize = 1 << 27;

/// A box with its faces on the grid: corners in raw units, `low <= high` on every axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bounds {
    /// Corner with the smallest coordinates.
    pub low: [i32; 3],
    /// Corner with the largest coordinates.
    pub high: [i32; 3],
}

impl Bounds {
    /// The box of a triangle: the report's `small` and `big` corners.
    pub fn of_triangle(vertices: &[[i32; 3]; 3]) -> Bounds {
        let [a, b, c] = vertices;
        Bounds {
            low: [0, 1, 2].map(|axis| a[axis].min(b[axis]).min(c[axis])),
            high: [0, 1, 2].map(|axis| a[axis].max(b[axis]).max(c[axis])),
        }
    }

    /// The smallest box around both.
    pub fn union(&self, other: &Bounds) -> Bounds {
        Bounds {
            low: [0, 1, 2].map(|axis| self.low[axis].min(other.low[axis])),
            high: [0, 1, 2].map(|axis| self.high[axis].max(other.high[axis])),
        }
    }

    /// The box with each face moved outwards by `unit` (stopping at the ends of 32 bits).
    pub fn grown(&self, unit: i32) -> Bounds {
        Bounds { low: self.low.map(|x| x.saturating_sub(unit)), high: self.high.map(|x| x.saturating_add(unit)) }
    }

    /// Length of the box along `axis`, in raw units.
    pub fn side(&self, axis: usize) -> u32 {
        self.high[axis].abs_diff(self.low[axis])
    }

    /// The axis along which the box is longest; of equal ones the first of x, y, z.
    pub fn longest_axis(&self) -> usize {
        (1..3).fold(0, |best, axis| if self.side(axis) > self.side(best) { axis } else { best })
    }
}

/// A node of the tree.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Node {
    /// Its part of space.
    pub bounds: Bounds,
    /// Next node of the same level, from left to right; `None` for the last.
    pub next: Option<u32>,
    /// What it holds.
    pub content: Content,
}

/// What a node holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Content {
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
        triangles: Vec<u32>,
    },
}

/// The tree: nodes level by level, each level from left to right; node 0 is the root.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KdTree {
    /// All nodes.
    pub nodes: Vec<Node>,
}

/// Builds the tree of `triangles` in the box `root`, with at most `depth` levels below the root (capped at [`DEEPEST`]).
///
/// `root` has to contain the triangles; the rule is that of [`split::best`] at every node, until it finds no division that pays.
///
/// # Errors
/// When the leaves would hold more than [`MOST_REFERENCES`] triangles together.
pub fn build(triangles: &[Bounds], root: Bounds, depth: u32) -> Result<KdTree, Report> {
    let all = (0..triangles.len() as u32).collect();
    let mut nodes = vec![Node { bounds: root, next: None, content: Content::Leaf { triangles: all } }];
    let mut references = triangles.len();
    let mut sweep = split::Sweep::default();
    let mut level = 0..1;
    for _ in 0..depth.min(DEEPEST) {
        for number in level.clone() {
            let left = nodes.len() as u32;
            let Node { bounds, content, .. } = &mut nodes[number];
            let Content::Leaf { triangles: packet } = content else { continue };
            let Some(division) = sweep.best(bounds, packet.iter().map(|&index| &triangles[index as usize])) else {
                continue;
            };
            let bounds = *bounds;
            let (below, above) = divide(packet, triangles, &division);
            references = references - packet.len() + below.len() + above.len();
            if references > MOST_REFERENCES {
                return Err(Diagnostic::error(format!(
                    "the kd tree would hold more than {MOST_REFERENCES} references to {} triangles",
                    triangles.len()
                ))
                .hint("ask for a lower tree with --kd-depth")
                .into());
            }
            *content = Content::Inner { axis: division.axis, at: division.at, left };
            let (lower, upper) = division.children(&bounds);
            nodes.push(Node { bounds: lower, next: Some(left + 1), content: Content::Leaf { triangles: below } });
            nodes.push(Node { bounds: upper, next: Some(left + 2), content: Content::Leaf { triangles: above } });
        }
        if nodes.len() == level.end {
            break;
        }
        level = level.end..nodes.len();
        nodes[level.end - 1].next = None;
    }
    Ok(KdTree { nodes })
}

fn divide(packet: &[u32], triangles: &[Bounds], division: &Division) -> (Vec<u32>, Vec<u32>) {
    let side = |index: u32, side| division.reaches(&triangles[index as usize], side);
    let of = |wanted| packet.iter().copied().filter(|&index| side(index, wanted)).collect();
    (of(Side::Left), of(Side::Right))
}
