//! Ray against triangle: Möller-Trumbore on exact determinants, signs before the one division (report 3.1.2).

use isa::number::Vector;

use super::ray::TwinRay;
use super::vector_arithmetic::{VectorArithmetic, WideVector};
use crate::constants::Constants;

/// The distance at which a ray hits a triangle, or [`Constants::missed`].
///
/// An edge that the ray meets exactly is decided as if the direction were moved by (e, e^2, e^3), e infinitely small. Decisions are exact
/// as long as [`Constants::edge_shift`] is 0; beyond, both triangles of an edge round the same determinant of it, so that a ray that hits
/// the edge still hits one of them.
pub fn triangle(
    arithmetic: &impl VectorArithmetic,
    constants: &Constants,
    ray: &TwinRay,
    vertices: &[Vector; 3],
) -> i32 {
    let &Constants { edge_shift, t_shift, missed, .. } = constants;
    let [v0, v1, v2] = *vertices;
    let edge1 = arithmetic.difference(v1, v0);
    let edge2 = arithmetic.difference(v2, v0);
    let start = arithmetic.difference(ray.origin, v0);

    // The determinant is D . (E1 x E2): 0 for a ray in the triangle's plane, which the perturbed direction leaves to its neighbours.
    let p = arithmetic.wide_cross(ray.direction, edge2);
    let determinant = arithmetic.wide_mixed(p, edge1, edge_shift);
    if determinant == 0 {
        return missed;
    }
    let is_positive = determinant > 0;

    // Edge functions of the first two edges, against the determinant's sign: no division for a miss.
    let u = arithmetic.wide_mixed(p, start, edge_shift);
    if !is_inside(u, is_positive, || arithmetic.wide_cross(edge2, start)) {
        return missed;
    }
    let q = arithmetic.wide_cross(start, edge1);
    let v = arithmetic.wide_mixed(q, ray.direction, edge_shift);
    if !is_inside(v, is_positive, || q) {
        return missed;
    }
    // The third edge function follows from the other two, but for what rounding lost.
    let third = || arithmetic.wide_cross(arithmetic.difference(edge2, start), arithmetic.difference(edge1, start));
    let w = arithmetic.wide_difference(arithmetic.wide_difference(determinant, u), v);
    // Each of the three numbers is rounded by less than 1, so their difference is off by less than 3: from -4 to 3 the edge's own determinant
    // decides.
    let w = match arithmetic.widen(i128::from(w) + 4, 0) {
        _ if edge_shift == 0 => w,
        0..=7 => arithmetic.wide_mixed(third(), ray.direction, edge_shift),
        moved => moved,
    };
    if !is_inside(w, is_positive, third) {
        return missed;
    }
    // In front of the origin only; then the one division.
    let t = arithmetic.wide_mixed(q, edge2, t_shift);
    if t == 0 || (t > 0) != is_positive {
        return missed;
    }
    arithmetic.quotient(i128::from(t) << constants.t_quotient(), determinant.into())
}

/// Sign test of an edge function against the determinant's; where the function is 0, the first component of its normal that is not 0 decides.
fn is_inside(edge: i64, is_positive: bool, normal: impl Fn() -> WideVector) -> bool {
    let decisive = if edge != 0 { edge } else { normal().into_iter().find(|&component| component != 0).unwrap_or(0) };
    decisive != 0 && (decisive > 0) == is_positive
}
