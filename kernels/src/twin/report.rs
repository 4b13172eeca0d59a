//! The functions as the report writes them: scalar operations, each rounded to a word.

use std::array::from_fn;

use isa::number::Vector;

use super::lanes::Lanes;
use super::ray::Ray;
use crate::constants::Constants;

/// Ray against triangle by the formulas of 3.1.2, or [`Constants::missed`]: no early out, inclusive comparisons, (1 / det) x three times.
pub fn triangle(arithmetic: &impl Lanes, constants: &Constants, ray: &Ray, vertices: &[Vector; 3]) -> i32 {
    let formats = &constants.formats;
    let (word, bits, barycentric) = (formats.word, formats.direction, formats.barycentric);
    // Fraction bits of 1 / det beyond those of a determinant.
    let inverse = 3 * word / 2 - 2;
    let [v0, v1, v2] = *vertices;
    let edge1 = arithmetic.difference(v1, v0);
    let edge2 = arithmetic.difference(v2, v0);
    let start = arithmetic.difference(ray.origin, v0);
    let p = cross(arithmetic, ray.direction, edge2, bits);
    let q = cross(arithmetic, start, edge1, word);
    let determinant = dot(arithmetic, p, edge1, word);
    let over = |x: i32, fraction: i32| {
        let inverted = arithmetic.quotient(1 << inverse, determinant.into());
        arithmetic.times(inverted, x, (inverse as i32 - fraction).max(0) as u32)
    };
    let u = over(dot(arithmetic, p, start, word), barycentric as i32);
    let v = over(dot(arithmetic, q, ray.direction, bits), barycentric as i32);
    let t = over(dot(arithmetic, q, edge2, word), word as i32 + formats.t - formats.position);

    let one = 1 << barycentric;
    let is_outside = u < 0 || u > one || v < 0 || v > one || arithmetic.plus(v, u) > one;
    if determinant == 0 || is_outside || t <= 0 { constants.missed } else { t }
}

/// a x b, two products and their difference a lane.
fn cross(arithmetic: &impl Lanes, a: Vector, b: Vector, shift: u32) -> Vector {
    from_fn(|k| {
        let (next, last) = ((k + 1) % 3, (k + 2) % 3);
        arithmetic.minus(arithmetic.times(a[next], b[last], shift), arithmetic.times(a[last], b[next], shift))
    })
}

/// a . b, three products and two sums.
fn dot(arithmetic: &impl Lanes, a: Vector, b: Vector, shift: u32) -> i32 {
    let [x, y, z] = from_fn(|k| arithmetic.times(a[k], b[k], shift));
    arithmetic.plus(arithmetic.plus(x, y), z)
}
