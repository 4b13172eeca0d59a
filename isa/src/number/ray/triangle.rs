//! A ray against a triangle, by the formulas of Möller and Trumbore (report 3.1.2) on unbounded integers: the specification.
//!
//! For any operands of 32 bits a difference has 33 bits with its sign, a cross product of two of them 67, one with a direction 66, and the
//! determinants below 100, so 128 bits hold everything.

use super::{Difference, Ray, difference};
use crate::number::Vector;

/// End of the test of a triangle; tests are made in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TriangleEnd {
    /// The determinant is 0: the ray is parallel to the plane, or the triangle has no area.
    Parallel,
    /// u < 0.
    OutsideU,
    /// v < 0.
    OutsideV,
    /// u + v > 1.
    OutsideW,
    /// t <= 0.
    Behind,
    /// The ray hits the triangle.
    Hit,
}

/// Result of the test of a ray and a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Meeting {
    /// The end of the test.
    pub end: TriangleEnd,
    /// Edges that the ray met exactly and that had to be decided by the sign of their normals.
    pub ties: u32,
    /// The determinant of the ray's direction and two edges; 0 where there is no hit, as the three below.
    pub determinant: i128,
    /// u times the determinant: the weight of the second vertex.
    pub u: i128,
    /// v times the determinant: the weight of the third vertex.
    pub v: i128,
    /// t times the determinant.
    pub t: i128,
}

impl Meeting {
    /// No hit.
    pub(super) const fn missed(end: TriangleEnd, ties: u32) -> Meeting {
        Meeting { end, ties, determinant: 0, u: 0, v: 0, t: 0 }
    }
}

fn cross(a: Difference, b: Difference) -> [i128; 3] {
    let minor = |j: usize, k: usize| i128::from(a[j]) * i128::from(b[k]) - i128::from(a[k]) * i128::from(b[j]);
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

fn dot(a: [i128; 3], b: Difference) -> i128 {
    (0..3).map(|k| a[k] * i128::from(b[k])).sum()
}

/// An edge function has the sign of the determinant.
///
/// One that is 0 gets the sign by which it would change if the direction moved by (e, e^2, e^3): that of the first component other than 0 of its
/// gradient, the normal of the plane through the origin and the edge. Both triangles of an edge see the same normal with opposite signs. A
/// normal of 0, of an edge whose line goes through the origin, is outside.
fn is_inside(edge: i128, is_positive: bool, ray: &Ray, [from, to]: [Vector; 2], ties: &mut u32) -> bool {
    if edge != 0 {
        return (edge > 0) == is_positive;
    }
    *ties += 1;
    let normal = cross(difference(from, ray.origin), difference(to, ray.origin));
    normal.into_iter().find(|&component| component != 0).is_some_and(|component| (component > 0) == is_positive)
}

/// Ray against triangle on exact integers, without a shortcut.
pub fn exact_triangle(ray: &Ray, &[v0, v1, v2]: &[Vector; 3]) -> Meeting {
    let mut ties = 0;
    // Compute the determinant: edges have 33 bits, products of three below 99.
    let direction = ray.direction.map(i64::from);
    let (edge1, edge2) = (difference(v1, v0), difference(v2, v0));
    let p = cross(direction, edge2);
    let determinant = dot(p, edge1);
    debug_assert!(determinant.unsigned_abs() < 1 << 99);
    if determinant == 0 {
        return Meeting::missed(TriangleEnd::Parallel, ties);
    }
    let is_positive = determinant > 0;
    // Compute u and v times the determinant, with the third edge's as what is left of it; each edge takes part in the tie rule.
    let start = difference(ray.origin, v0);
    let u = dot(p, start);
    if !is_inside(u, is_positive, ray, [v0, v2], &mut ties) {
        return Meeting::missed(TriangleEnd::OutsideU, ties);
    }
    let q = cross(start, edge1);
    let v = dot(q, direction);
    if !is_inside(v, is_positive, ray, [v1, v0], &mut ties) {
        return Meeting::missed(TriangleEnd::OutsideV, ties);
    }
    let w = determinant - u - v;
    if !is_inside(w, is_positive, ray, [v2, v1], &mut ties) {
        return Meeting::missed(TriangleEnd::OutsideW, ties);
    }
    // Decide by the sign of t alone; the quotients are rounded by whoever needs them.
    let t = dot(q, edge2);
    debug_assert!(t.unsigned_abs() < 1 << 100);
    if t == 0 || (t > 0) != is_positive {
        return Meeting::missed(TriangleEnd::Behind, ties);
    }
    Meeting { end: TriangleEnd::Hit, ties, determinant, u, v, t }
}
