//! The choice of a node's plane: the report's cost model (5.3.2) on exact integers. Builders share this rule; it does not know in which order
//! nodes are visited.
//!
//! The cost of a plane is C = 1 + (SA(left) n_left + SA(right) n_right) / SA(node) against n for not dividing. Both are compared after
//! multiplication by half of SA(node), in 128-bit integers, so nothing is rounded.

use super::Bounds;

/// One of the two children of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The child of smaller coordinates.
    Left,
    /// The child of larger coordinates.
    Right,
}

impl Side {
    /// The other child.
    pub fn other(self) -> Side {
        match self {
            Side::Left => Side::Right,
            Side::Right => Side::Left,
        }
    }
}

/// A plane that divides a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Division {
    /// Axis of the plane, 0 to 2.
    pub axis: usize,
    /// The plane's coordinate, raw.
    pub at: i32,
    /// The child that takes the triangles lying in the plane.
    pub flat: Side,
}

impl Division {
    /// A triangle belongs to the child `side`: it does when it reaches beyond the plane on that side, or lies in the plane and
    /// flat triangles go there.
    pub fn reaches(&self, triangle: &Bounds, side: Side) -> bool {
        let (low, high) = (triangle.low[self.axis], triangle.high[self.axis]);
        let beyond = match side {
            Side::Left => low < self.at,
            Side::Right => high > self.at,
        };
        beyond || (low == self.at && high == self.at && self.flat == side)
    }
}

/// Half the surface of a box, in square raw units (below 2^64 for boxes of 32-bit coordinates, kept wide for the products to come).
pub fn half_surface(bounds: &Bounds) -> u128 {
    let [x, y, z] = [0, 1, 2].map(|axis| u128::from(bounds.side(axis)));
    x * y + y * z + z * x
}

/// Half the surface of the part of a node below a plane, as a function of its length along the plane's axis: it is linear.
struct Slice {
    /// Surface per unit of length.
    slope: u128,
    /// Surface at length 0: one face across the axis.
    face: u128,
}

impl Slice {
    fn new(node: &Bounds, axis: usize) -> Slice {
        let [a, b] = [(axis + 1) % 3, (axis + 2) % 3].map(|other| u128::from(node.side(other)));
        Slice { slope: a + b, face: a * b }
    }

    fn half_surface(&self, length: u32) -> u128 {
        self.slope * u128::from(length) + self.face
    }
}

/// The best plane of a node on `axis`, and its cost times half the node's surface: among the bounds of its triangles strictly inside it the
/// one with the lowest cost (of equal costs the lowest coordinate), `None` when no plane costs less than not dividing.
///
/// Triangles lying in the plane all go to the side that makes the cost lower, at equal cost to the left. A node whose surface is 0 is not
/// divided. `lows`, `highs` and `flats` are the sorted bounds of the node's triangles on `axis`, `flats` those of triangles with
/// `low == high`.
pub fn best(node: &Bounds, axis: usize, lows: &[i32], highs: &[i32], flats: &[i32]) -> Option<(Division, u128)> {
    let surface = half_surface(node);
    let slice = Slice::new(node, axis);
    let count = lows.len();
    let mut lowest = surface * count as u128;
    let mut found = None;
    // Numbers of bounds below, for `highs` below or at, the candidate.
    let (mut low, mut high, mut flat) = (0, 0, 0);
    loop {
        let at = match (lows.get(low), highs.get(high)) {
            (Some(&a), Some(&b)) => a.min(b),
            (None, Some(&b)) => b,
            _ => return found,
        };
        let left = low;
        low += lows[low..].iter().take_while(|&&x| x == at).count();
        high += highs[high..].iter().take_while(|&&x| x == at).count();
        let before = flat;
        flat += flats[flat..].iter().take_while(|&&x| x <= at).count();
        // Those before the candidate were counted away with their own coordinate, so what remains lies in the plane.
        let (right, in_plane) = ((count - high) as u128, (flat - before) as u128);
        // A plane in a face of the node divides nothing off. Triangles that reach beyond the node have bounds there or
        // further out, which still count as before or behind the others.
        if at >= node.high[axis] {
            return found;
        }
        if at <= node.low[axis] {
            continue;
        }
        let lower = slice.half_surface(at.abs_diff(node.low[axis]));
        let upper = slice.half_surface(at.abs_diff(node.high[axis]));
        let cost = surface + lower * left as u128 + upper * right;
        let (cost, flat) = match upper < lower {
            true => (cost + upper * in_plane, Side::Right),
            false => (cost + lower * in_plane, Side::Left),
        };
        let flat = if in_plane == 0 { Side::Left } else { flat };
        if cost < lowest {
            lowest = cost;
            found = Some((Division { axis, at, flat }, cost));
        }
    }
}

/// Storage for sorting the bounds of one node after another.
#[derive(Debug, Default)]
pub struct Sweep {
    lows: Vec<i32>,
    highs: Vec<i32>,
    flats: Vec<i32>,
}

impl Sweep {
    /// The best plane across `axis` of a node that holds `triangles`, and its cost, see [`best`].
    pub fn best<'a>(
        &mut self,
        node: &Bounds,
        axis: usize,
        triangles: impl Iterator<Item = &'a Bounds>,
    ) -> Option<(Division, u128)> {
        self.lows.clear();
        self.highs.clear();
        self.flats.clear();
        for triangle in triangles {
            let (low, high) = (triangle.low[axis], triangle.high[axis]);
            self.lows.push(low);
            self.highs.push(high);
            if low == high {
                self.flats.push(low);
            }
        }
        for bounds in [&mut self.lows, &mut self.highs, &mut self.flats] {
            sort(bounds);
        }
        best(node, axis, &self.lows, &self.highs, &self.flats)
    }
}

/// Coordinates from which sorting digit by digit beats comparing.
const WORTH_DIGITS: usize = 512;

fn sort(coordinates: &mut [i32]) {
    if coordinates.len() < WORTH_DIGITS { coordinates.sort_unstable() } else { radsort::sort(coordinates) }
}
