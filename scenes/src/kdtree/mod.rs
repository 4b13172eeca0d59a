//! The kd tree, the report's (5.3) or a cheaper one, level by level, on the grid's integers. Planes are chosen in [`split`], by exact comparisons,
//! or in [`bins`], in double precision; nothing here knows of memory layouts or of how rays walk through the tree.

mod binned;
mod bins;
mod builder;
mod built;
mod clip;
mod cost;
mod cut;
mod membership;
mod printed;
pub mod split;
mod statistics;
#[cfg(test)]
mod tests;
mod tree;

use messages::{Diagnostic, Report};

use builder::TooManyReferences;
pub(crate) use built::{BuiltTree, NumberedNode};
pub use cost::CostCurve;
use membership::{ByBox, ByPart};
use printed::ByPrint;
pub use printed::PrintedTree;
pub use statistics::Statistics;
pub(crate) use tree::UnlinkedNode;
pub use tree::{Content, KdTree, Node};

/// Levels below the root that the report's tree has at most.
pub const DEPTH: u32 = 16;

/// Deepest tree that can be asked for: beyond it a node would be divided more often than a coordinate has bits.
pub const DEEPEST: u32 = 40;

/// Cost of visiting a node in percent of that of testing a triangle, as the report has it.
pub const VISIT: u32 = 100;

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

    /// Nothing lies in the box: on some axis its lower corner is beyond the upper one.
    fn is_empty(&self) -> bool {
        self.low.iter().zip(&self.high).any(|(low, high)| low > high)
    }

    /// The box with each face moved outwards by `unit` (stopping at the ends of 32 bits).
    pub fn enlarged(&self, unit: i32) -> Bounds {
        Bounds { low: self.low.map(|x| x.saturating_sub(unit)), high: self.high.map(|x| x.saturating_add(unit)) }
    }

    /// Length of the box along `axis`, in raw units.
    pub fn side(&self, axis: usize) -> u32 {
        self.high[axis].abs_diff(self.low[axis])
    }

    /// The two boxes on either side of the plane `axis = at`, that of smaller coordinates first.
    pub fn divided(&self, axis: usize, at: i32) -> [Bounds; 2] {
        let (mut left, mut right) = (*self, *self);
        left.high[axis] = at;
        right.low[axis] = at;
        [left, right]
    }

    /// The axis along which the box is longest; of equal ones the first of x, y, z.
    pub fn longest_axis(&self) -> usize {
        (1..3).fold(0, |best, axis| if self.side(axis) > self.side(best) { axis } else { best })
    }
}

/// The height that a tree may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// At most so many levels below the root, capped at [`DEEPEST`].
    Levels(u32),
    /// 8 + 1.3 log2 n levels for n triangles, to the nearest: what suits the cost model (Wald and Havran 2006) where the report's 16 would
    /// leave large packets.
    Auto,
}

impl Default for Depth {
    fn default() -> Depth {
        Depth::Levels(DEPTH)
    }
}

impl Depth {
    /// Levels below the root for a number of triangles.
    pub fn levels(self, triangles: usize) -> u32 {
        match self {
            Depth::Levels(levels) => levels,
            // As pbrt chooses the greatest depth.
            Depth::Auto => (8.0 + 1.3 * (triangles.max(1) as f64).log2()).round() as u32,
        }
        .min(DEEPEST)
    }
}

/// Method of building a tree: which triangles a node holds, and where it may be divided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BuildMethod {
    /// The report's: a triangle is in a node when its box reaches into it, planes cross the longest axis.
    #[default]
    Report,
    /// A triangle is in a node when a part of it is, planes cross any axis: fewer references and cheaper trees, for a longer build.
    Exact,
    /// As `Exact`, with planes from bins and a bound on the references: trees nearly as cheap, in the time of the report's, for any triangles.
    Binned,
    /// The report's with one of its slips taken at its word: to show what the slip does, in time quadratic in a node's triangles.
    Printed(PrintedTree),
}

impl BuildMethod {
    /// Every method that a tree can be asked for with.
    pub const ALL: [BuildMethod; 3] = [BuildMethod::Report, BuildMethod::Exact, BuildMethod::Binned];

    /// Name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            BuildMethod::Report => "report",
            BuildMethod::Exact => "exact",
            BuildMethod::Binned => "binned",
            BuildMethod::Printed(slip) => slip.name(),
        }
    }
}

/// Triangles by number: a list of them, or a mesh of which they share the vertices.
pub trait Triangles: Sync {
    /// The number of triangles.
    fn count(&self) -> usize;

    /// The vertices of one, raw.
    ///
    /// # Panics
    /// When there is no such triangle.
    fn vertices(&self, index: usize) -> [[i32; 3]; 3];
}

impl<T: AsRef<[[[i32; 3]; 3]]> + Sync + ?Sized> Triangles for T {
    fn count(&self) -> usize {
        self.as_ref().len()
    }

    fn vertices(&self, index: usize) -> [[i32; 3]; 3] {
        self.as_ref()[index]
    }
}

/// Builds the tree of `triangles` in the box `root`.
///
/// `root` has to contain the triangles. A node is divided at the plane of the lowest cost, as [`split::best`] has it, until no plane pays (with
/// [`BuildMethod::Binned`] at one nearly as cheap, from three triangles on). Sorting is by digits, so a level takes time linear in its references; both sides of a large node are built at the same time, on all
/// threads of the current pool. The tree is the same for any number of them.
///
/// # Errors
/// A tree whose leaves would hold more than [`MOST_REFERENCES`] triangles together; [`BuildMethod::Binned`] makes none.
pub fn build(
    triangles: &(impl Triangles + ?Sized),
    root: Bounds,
    depth: Depth,
    method: BuildMethod,
) -> Result<KdTree, Report> {
    build_in_order(triangles, root, depth, method, VISIT).map(|tree| tree.by_levels())
}

/// The tree of [`build`] in the order of a walk, from which the memory image is written, for visits of nodes that cost so many percent of a test of a
/// triangle, 1 to [`VISIT`]; other costs than that are for [`BuildMethod::Binned`].
pub(crate) fn build_in_order(
    triangles: &(impl Triangles + ?Sized),
    root: Bounds,
    depth: Depth,
    method: BuildMethod,
    visit: u32,
) -> Result<BuiltTree, Report> {
    if visit != VISIT && method != BuildMethod::Binned {
        let message =
            format!("visits of nodes cost {visit} % of a test, but the kd tree is built by `{}`", method.name());
        let hint = "only `--kd-build binned` goes by `--kd-visit`";
        return Err(Diagnostic::error(message).hint(hint).into());
    }
    let count = triangles.count();
    let levels = depth.levels(count);
    let tree = match method {
        BuildMethod::Report => {
            let boxes: Vec<Bounds> = (0..count).map(|index| Bounds::of_triangle(&triangles.vertices(index))).collect();
            builder::build(&ByBox { triangles: &boxes }, (0..count as u32).collect(), root, levels)
        }
        BuildMethod::Printed(slip) => {
            let boxes: Vec<Bounds> = (0..count).map(|index| Bounds::of_triangle(&triangles.vertices(index))).collect();
            let membership = ByPrint { triangles, boxes: &boxes, slip };
            builder::build(&membership, (0..count as u32).collect(), root, levels)
        }
        BuildMethod::Binned => {
            let membership = ByPart { triangles };
            Ok(binned::build(triangles, membership.whole(), root, (levels, visit)))
        }
        BuildMethod::Exact => {
            // Parts are cut from the triangles themselves, so no list of boxes is kept.
            let membership = ByPart { triangles };
            builder::build(&membership, membership.whole(), root, levels)
        }
    };
    tree.map_err(|TooManyReferences| {
        Diagnostic::error(format!("the kd tree would hold more than {MOST_REFERENCES} references to {count} triangles"))
            .hint("ask for a lower tree with --kd-depth")
            .into()
    })
}
