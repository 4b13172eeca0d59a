//! Clipping: the part of a triangle that lies in a box.

use super::Bounds;

/// Units by which the box is enlarged before the triangle is cut, and that a computed coordinate is never off: coordinates have 32 bits and
/// f64 has 53, so a point on an edge is off by less than 2^-18.
const MARGIN: f64 = 1.0 / 1024.0;

/// A triangle cut by six planes has no more corners.
const MOST_CORNERS: usize = 9;

/// A corner of what is left of a triangle.
#[derive(Clone, Copy, Default)]
struct Corner {
    at: [f64; 3],
    /// Bound on its error: 0 for the triangle's own vertices.
    margin: f64,
}

/// The smallest box on the grid around what of the triangle lies in `node`; `None` when nothing of it does.
///
/// It errs on the large side only: by up to one unit where an edge leaves the node, and a triangle that passes within 2^-10 units of the
/// node may count as touching it.
pub(super) fn clipped(vertices: &[[i32; 3]; 3], node: &Bounds) -> Option<Bounds> {
    let whole = Bounds::of_triangle(vertices);
    let mut corners = [Corner::default(); MOST_CORNERS];
    for (corner, vertex) in corners.iter_mut().zip(vertices) {
        corner.at = vertex.map(f64::from);
    }
    let mut count = 3;
    // Cut with the planes that the triangle crosses, moved outwards so that rounding loses no corner that lies in one
    for axis in 0..3 {
        if whole.low[axis] < node.low[axis] {
            let plane = f64::from(node.low[axis]) - MARGIN;
            (corners, count) = cut(&corners[..count], axis, |x| x - plane);
        }
        if whole.high[axis] > node.high[axis] {
            let plane = f64::from(node.high[axis]) + MARGIN;
            (corners, count) = cut(&corners[..count], axis, |x| plane - x);
        }
    }
    let left = &corners[..count];
    if left.is_empty() {
        return None;
    }
    // Round outwards to whole units, but never beyond the triangle or the node: a computed corner at 4 may be at 4.001 and ends the box
    // at 5, a vertex at 4 is exact and ends it at 4
    let bounds = Bounds {
        low: [0, 1, 2].map(|axis| {
            let low = left.iter().map(|c| c.at[axis] - c.margin).fold(f64::INFINITY, f64::min);
            (low.floor() as i32).max(whole.low[axis]).max(node.low[axis])
        }),
        high: [0, 1, 2].map(|axis| {
            let high = left.iter().map(|c| c.at[axis] + c.margin).fold(f64::NEG_INFINITY, f64::max);
            (high.ceil() as i32).min(whole.high[axis]).min(node.high[axis])
        }),
    };
    (0..3).all(|axis| bounds.low[axis] <= bounds.high[axis]).then_some(bounds)
}

/// The part of a convex polygon where `inside` of the coordinate is not negative (Sutherland and Hodgman 1974). `inside` is the coordinate
/// or its negative, moved.
fn cut(polygon: &[Corner], axis: usize, inside: impl Fn(f64) -> f64) -> ([Corner; MOST_CORNERS], usize) {
    let mut corners = [Corner::default(); MOST_CORNERS];
    let mut count = 0;
    let mut keep = |corner| {
        corners[count] = corner;
        count += 1;
    };
    for (index, to) in polygon.iter().enumerate() {
        let from = &polygon[index.checked_sub(1).unwrap_or(polygon.len() - 1)];
        let (before, after) = (inside(from.at[axis]), inside(to.at[axis]));
        if (before < 0.0) != (after < 0.0) {
            let share = before / (before - after);
            let at = [0, 1, 2].map(|k| from.at[k] + share * (to.at[k] - from.at[k]));
            keep(Corner { at, margin: MARGIN });
        }
        if after >= 0.0 {
            keep(*to);
        }
    }
    (corners, count)
}
