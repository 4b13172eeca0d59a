//! Where a node is divided: the report's cost model (5.3.2) on exact integers. Builders share this rule; it does not know in which order
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

/// A plane that divides a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Division {
    /// Axis of the plane, 0 to 2.
    pub axis: usize,
    /// Its coordinate, raw.
    pub at: i32,
    /// The child that takes the triangles lying in the plane.
    pub flat: Side,
}

impl Division {
    /// Boxes of the left and of the right child of a node.
    pub fn children(&self, node: &Bounds) -> (Bounds, Bounds) {
        let (mut left, mut right) = (*node, *node);
        left.high[self.axis] = self.at;
        right.low[self.axis] = self.at;
        (left, right)
    }

    /// Whether a triangle belongs to the child `side`: it does when it reaches beyond the plane on that side, or lies in the plane and
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

/// Cost of dividing a node, times half its surface: `left` and `right` are half surface and number of triangles of each child.
pub fn scaled_cost(node: u128, left: (u128, usize), right: (u128, usize)) -> u128 {
    node + left.0 * left.1 as u128 + right.0 * right.1 as u128
}

/// The best plane of a node: among the bounds of its triangles strictly inside it, on its longest axis, the one with the lowest cost (of
/// equal costs the lowest coordinate), `None` when no plane costs less than not dividing or the node's surface is 0.
///
/// Triangles lying in the plane all go to the side that makes the cost lower, at equal cost to the left.
/// `lows`, `highs` and `flats` are the sorted bounds of the node's triangles on `axis`, `flats` those of triangles with `low == high`.
pub fn best(node: &Bounds, axis: usize, lows: &[i32], highs: &[i32], flats: &[i32]) -> Option<Division> {
    let surface = half_surface(node);
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
        let (right, in_plane) = (count - high, flat - before);
        if at >= node.high[axis] {
            return found;
        }
        if at <= node.low[axis] {
            continue;
        }
        let (lower, upper) = Division { axis, at, flat: Side::Left }.children(node);
        let (lower, upper) = (half_surface(&lower), half_surface(&upper));
        let flat_left = scaled_cost(surface, (lower, left + in_plane), (upper, right));
        let flat_right = scaled_cost(surface, (lower, left), (upper, right + in_plane));
        let (cost, side) = if flat_right < flat_left { (flat_right, Side::Right) } else { (flat_left, Side::Left) };
        if cost < lowest {
            lowest = cost;
            found = Some(Division { axis, at, flat: side });
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
    /// The best plane of a node that holds `triangles`, see [`best`].
    pub fn best<'a>(&mut self, node: &Bounds, triangles: impl Iterator<Item = &'a Bounds>) -> Option<Division> {
        let axis = node.longest_axis();
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
        self.lows.sort_unstable();
        self.highs.sort_unstable();
        self.flats.sort_unstable();
        best(node, axis, &self.lows, &self.highs, &self.flats)
    }
}
