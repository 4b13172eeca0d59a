//! Ray against triangle as the ray unit decides it: exactly, with one rounding. Written from the volumes of the pyramids that the origin
//! and the direction span with the edges, where the row itself goes by Möller and Trumbore.

use isa::number::Vector;
use isa::number::ray::ratio;

use super::ray::TwinRay;
use super::vector_arithmetic::VectorArithmetic;
use crate::constants::Constants;

type ExactVector = [i128; 3];

fn cross(a: ExactVector, b: ExactVector) -> ExactVector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: ExactVector, b: ExactVector) -> i128 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The distance at which a ray hits a triangle, or [`Constants::missed`], which a distance beyond the word is too.
///
/// An edge that the ray meets exactly is decided as if the direction were moved by (e, e^2, e^3), e infinitely small.
pub fn exact_triangle(
    arithmetic: &impl VectorArithmetic,
    constants: &Constants,
    ray: &TwinRay,
    vertices: &[Vector; 3],
) -> i32 {
    let seen = |vertex: Vector| std::array::from_fn(|k| i128::from(vertex[k]) - i128::from(ray.origin[k]));
    let [a, b, c]: [ExactVector; 3] = vertices.map(seen);
    let direction = ray.direction.map(i128::from);
    let edges = [cross(a, b), cross(b, c), cross(c, a)];
    let whole: i128 = edges.iter().map(|&edge| dot(edge, direction)).sum();
    let sign = |edge: &ExactVector| {
        let in_order = [dot(*edge, direction), edge[0], edge[1], edge[2]];
        in_order.into_iter().find(|&part| part != 0).unwrap_or(0).signum()
    };
    let along = dot(a, edges[1]);
    let is_hit =
        whole != 0 && edges.iter().all(|edge| sign(edge) == whole.signum()) && along.signum() == whole.signum();
    if is_hit { ratio(arithmetic, along, whole, constants.along()) } else { constants.missed }
}
