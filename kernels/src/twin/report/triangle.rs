//! Ray against triangle as the report writes it (3.1.2): scalar operations, each rounded to a word.

use isa::number::{Vector, normalizing_shift, split_shift};

use super::scalar::{cross, dot};
use crate::constants::Constants;
use crate::twin::ray::TwinRay;
use crate::twin::vector_arithmetic::VectorArithmetic;

/// Results of the formulas of 3.1.2.
struct Solution {
    determinant: i32,
    t: i32,
    u: i32,
    v: i32,
}

/// Ray against triangle by the formulas of 3.1.2, or [`Constants::missed`]: no early out, inclusive comparisons, (1 / det) x three times.
/// Edges and determinant are shifted into range, and quotients back.
pub fn triangle(
    arithmetic: &impl VectorArithmetic,
    constants: &Constants,
    ray: &TwinRay,
    vertices: &[Vector; 3],
) -> i32 {
    let Solution { determinant, t, u, v } = solve(arithmetic, constants, ray, vertices);
    let one = 1 << constants.formats.barycentric;
    let is_outside = u < 0 || u > one || v < 0 || v > one || arithmetic.plus(v, u) > one;
    if determinant == 0 || is_outside || t <= 0 { constants.missed } else { t }
}

/// u and v by the same formulas, for a ray that hits.
pub fn barycentric(
    arithmetic: &impl VectorArithmetic,
    constants: &Constants,
    ray: &TwinRay,
    vertices: &[Vector; 3],
) -> [i32; 2] {
    let Solution { u, v, .. } = solve(arithmetic, constants, ray, vertices);
    [u, v]
}

fn solve(arithmetic: &impl VectorArithmetic, constants: &Constants, ray: &TwinRay, vertices: &[Vector; 3]) -> Solution {
    let formats = &constants.formats;
    let (word, bits, barycentric) = (formats.word, formats.direction, formats.barycentric);
    // Fraction bits of 1 / det beyond those of a determinant.
    let inverse = 2 * word - 5;
    let [v0, v1, v2] = *vertices;
    let (edge1, shift1) = into_range(arithmetic, arithmetic.difference(v1, v0));
    let (edge2, shift2) = into_range(arithmetic, arithmetic.difference(v2, v0));
    let start = arithmetic.difference(ray.origin, v0);
    let p = cross(arithmetic, ray.direction, edge2, bits);
    let q = cross(arithmetic, start, edge1, word);
    let ([determinant, ..], shift) = into_range(arithmetic, [dot(arithmetic, p, edge1, word), 0, 0]);
    let over = |x: i32, edge: i32, fraction: i32| {
        let inverted = arithmetic.quotient(1 << inverse, determinant.into());
        let shifted = shifted(arithmetic, shifted(arithmetic, x, shift), edge);
        arithmetic.times(inverted, shifted, (inverse as i32 - fraction).max(0) as u32)
    };
    let u = over(dot(arithmetic, p, start, word), shift1, barycentric as i32);
    let v = over(dot(arithmetic, q, ray.direction, bits), shift2, barycentric as i32);
    let t = over(dot(arithmetic, q, edge2, word), 0, word as i32 + formats.t - formats.position);
    Solution { determinant, t, u, v }
}

/// The vector with its largest component in [2^(word-3), 2^(word-2)], and by how much it was shifted right.
fn into_range(arithmetic: &impl VectorArithmetic, vector: Vector) -> (Vector, i32) {
    let components = vector.map(i64::from);
    (arithmetic.normalized(components), normalizing_shift(components.map(i128::from), arithmetic.word()))
}

/// A number shifted right, or left by a negative shift.
fn shifted(arithmetic: &impl VectorArithmetic, x: i32, shift: i32) -> i32 {
    let (value, right) = split_shift(x.into(), shift);
    arithmetic.narrow(value, right)
}
