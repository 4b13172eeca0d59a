//! A test of a triangle in double precision, before the exact one: most triangles are rejected by signs that no rounding error can have turned.
//! What is near zero, and every hit, is left to the exact integers.

use super::triangle::{Meeting, TriangleEnd, exact_triangle};
use super::{Difference, Ray, difference};
use crate::number::Vector;

/// Bound on the error of a determinant of three vectors, in units of the product of their largest components.
///
/// With e = 2^-53 the relative error of one operation and m the product of the largest components of the first two vectors: a component of the cross
/// product is off by 2 e m from its two products and 2 e m from their difference, all but terms of e^2; with |component| <= 2 m its product
/// with a component of at most r is off by 6 e m r, three of them by 18 e m r, and the two additions add 4 e m r and 6 e m r. 28 e with the terms of
/// e^2 is below 29 e; the bound is 32 e, and the error of computing it, 3 e of itself, is far below the rest.
pub(super) const DETERMINANT: f64 = 1.0 / (1u64 << 48) as f64;

/// Bound on the error of det - u - v, in units of the sum of the three products: 29 e from its terms and 6 e from each difference.
pub(super) const DIFFERENCE: f64 = 2.0 * DETERMINANT;

/// Ray against triangle: equal to [`exact_triangle`] for all operands, and faster.
pub fn triangle(ray: &Ray, vertices: &[Vector; 3]) -> Meeting {
    match surely_missed(ray, vertices) {
        Some(end) => Meeting::missed(end, 0),
        None => exact_triangle(ray, vertices),
    }
}

/// The way in which the ray misses the triangle, where double precision is sure of it. All sums stay below 2^101.
///
/// A sign is sure where a number is further from 0 than its error can be. With largest components of 2^20 in the direction, both edges and the start:
///
/// | number | bound on its error | sure |
/// | --- | --- | --- |
/// | determinant, u, v, t | 2^-48 x 2^60 = 4,096 | beyond 4,096 on either side |
/// | w | 2^-47 x 2^20 x 3 x 2^40 = 24,576 | beyond 24,576 on either side |
///
/// Steps come in the order of the exact test, so a sign that is not sure ends this one: `None`, whatever later steps would say.
fn surely_missed(ray: &Ray, &[v0, v1, v2]: &[Vector; 3]) -> Option<TriangleEnd> {
    let direction = ray.direction.map(f64::from);
    let edge1 = exact(difference(v1, v0));
    let edge2 = exact(difference(v2, v0));
    let start = exact(difference(ray.origin, v0));
    let [d, a, b, s] = [direction, edge1, edge2, start].map(largest);

    // Determinant, of the direction and both edges: the bound is DETERMINANT d a b. Near 0 the ray may be parallel
    let p = cross(direction, edge2);
    let determinant = dot(p, edge1);
    let margin = DETERMINANT * d;
    if determinant.abs() <= margin * (a * b) {
        return None;
    }
    // u, of the direction, the second edge and the start: DETERMINANT d b s
    let sign = determinant.signum();
    let u = dot(p, start);
    if u * sign <= margin * (b * s) {
        return (u * sign < -margin * (b * s)).then_some(TriangleEnd::OutsideU);
    }
    // v, of the direction, the first edge and the start: DETERMINANT d a s
    let q = cross(start, edge1);
    let v = dot(q, direction);
    if v * sign <= margin * (a * s) {
        return (v * sign < -margin * (a * s)).then_some(TriangleEnd::OutsideV);
    }
    // w, what is left of the determinant: DIFFERENCE times the sum of the three products
    let w = determinant - u - v;
    let error = DIFFERENCE * d * (a * b + b * s + a * s);
    if w * sign <= error {
        return (w * sign < -error).then_some(TriangleEnd::OutsideW);
    }
    // t, of both edges and the start: DETERMINANT a b s. A hit is left to the exact test
    let t = dot(q, edge2);
    (t * sign < -DETERMINANT * (a * b * s)).then_some(TriangleEnd::Behind)
}

/// Differences of 33 bits, which doubles hold exactly.
fn exact(difference: Difference) -> [f64; 3] {
    difference.map(|component| component as f64)
}

fn largest(components: [f64; 3]) -> f64 {
    components[0].abs().max(components[1].abs()).max(components[2].abs())
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
