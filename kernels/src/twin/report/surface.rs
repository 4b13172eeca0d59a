//! Surface at a hit, and the secondary rays that start there (report 4.1, 4.2): each asks for the normal anew.

use isa::number::Vector;

use super::scalar::{cross, dot};
use crate::constants::Constants;
use crate::twin::ray::TwinRay;
use crate::twin::surface::{self, Surface};
use crate::twin::unit::sqrt;
use crate::twin::vector_arithmetic::VectorArithmetic;

/// The unit vector, with `fraction` bits, in the direction of one that is scaled into [2^(word-3), 2^(word-2)]: its product with the
/// reciprocal of its length.
pub fn unit(arithmetic: &impl VectorArithmetic, fraction: u32, vector: Vector) -> Vector {
    let inverse = 2 * arithmetic.word() - 5;
    let length = sqrt(arithmetic, arithmetic.wide_dot(vector, vector));
    let inverted = arithmetic.quotient(1 << inverse, length.into());
    arithmetic.scaled(vector, inverted, inverse - fraction)
}

/// The unit normal of a triangle on the side that the order of its vertices gives (report, Annex II).
pub fn normal(arithmetic: &impl VectorArithmetic, fraction: u32, vertices: &[Vector; 3]) -> Vector {
    let [v0, v1, v2] = *vertices;
    let scaled = |vector: Vector| arithmetic.normalized(vector.map(i64::from));
    let edges = [v1, v2].map(|vertex| scaled(arithmetic.difference(vertex, v0)));
    unit(arithmetic, fraction, scaled(cross(arithmetic, edges[0], edges[1], arithmetic.word() - 1)))
}

/// The normal on the side of the ray, -normal . direction, and the points on both sides of the surface at distance `t`, moved by a constant.
pub fn sides(
    arithmetic: &impl VectorArithmetic,
    constants: &Constants,
    ray: &TwinRay,
    t: i32,
    normal: Vector,
) -> (Vector, i32, Vector, Vector) {
    let cosine = dot(arithmetic, normal, ray.direction, constants.formats.direction);
    let (facing, cosine) = match cosine > 0 {
        true => (normal.map(|component| arithmetic.negative(component)), cosine),
        false => (normal, arithmetic.negative(cosine)),
    };
    let point = surface::point(arithmetic, constants, ray, t);
    let axis = surface::major_axis(facing);
    let offset = if facing[axis] < 0 { -constants.literal_offset } else { constants.literal_offset };
    let (mut before, mut behind) = (point, point);
    before[axis] = arithmetic.plus(point[axis], offset);
    behind[axis] = arithmetic.minus(point[axis], offset);
    (facing, cosine, before, behind)
}

/// The direction of the reflected ray, V = 2 (I . N) N - I, as D - (-2 c) N.
pub fn reflect(arithmetic: &impl VectorArithmetic, constants: &Constants, surface: &Surface) -> Vector {
    let twice = arithmetic.times(surface.cosine, -2, 0);
    arithmetic.difference(surface.incident, arithmetic.scaled(surface.facing, twice, constants.formats.direction))
}

/// Fate of a ray that goes through a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transmission {
    /// Nothing: it is totally reflected.
    Total,
    /// Refracted, in this direction.
    Through(Vector),
}

/// The refracted ray, T = eta (D + c N) - sqrt(k) N with eta = ni / nt divided anew.
pub fn refract(
    arithmetic: &impl VectorArithmetic,
    constants: &Constants,
    surface: &Surface,
    inside: bool,
) -> Transmission {
    let (bits, index) = (constants.formats.direction, constants.formats.index);
    let (one, unit_index) = (1 << bits, 1 << index);
    let (from, to) = if inside { (surface.material.index, unit_index) } else { (unit_index, surface.material.index) };
    let eta = arithmetic.quotient(i128::from(from) << index, to.into());
    let sine_squared = arithmetic.minus(one, arithmetic.times(surface.cosine, surface.cosine, bits));
    let once = arithmetic.times(sine_squared, eta, bits);
    let twice = arithmetic.times(once, eta, (2 * index).saturating_sub(bits));
    let k = arithmetic.minus(one, twice);
    if k < 0 {
        return Transmission::Total;
    }
    let root = sqrt(arithmetic, arithmetic.widen(i128::from(k) << bits, 0));
    let along = arithmetic.sum(surface.incident, arithmetic.scaled(surface.facing, surface.cosine, bits));
    let along = arithmetic.scaled(along, eta, index);
    Transmission::Through(arithmetic.difference(along, arithmetic.scaled(surface.facing, root, bits)))
}

/// Fate of the light that a surface lets through: the weight that total reflection adds to the reflected ray, and the weight and
/// direction of the refracted one.
pub fn transmitted(
    arithmetic: &impl VectorArithmetic,
    constants: &Constants,
    surface: &Surface,
    weight: i32,
    inside: bool,
) -> (i32, Option<(i32, Vector)>) {
    if surface.material.transmission == 0 {
        return (0, None);
    }
    let weight = arithmetic.times(weight, surface.material.transmission, constants.formats.weight);
    match refract(arithmetic, constants, surface, inside) {
        Transmission::Total => (weight, None),
        Transmission::Through(direction) => (0, Some((weight, direction))),
    }
}

/// Light that lies `way` from a surface, if the surface faces it: the direction to the light and the cosine of its angle with the normal.
pub fn lit(
    arithmetic: &impl VectorArithmetic,
    constants: &Constants,
    facing: Vector,
    way: Vector,
) -> Option<(Vector, i32)> {
    let bits = constants.formats.direction;
    let direction = unit(arithmetic, bits, arithmetic.normalized(way.map(i64::from)));
    let cosine = dot(arithmetic, facing, direction, bits);
    (cosine > 0).then_some((direction, cosine))
}
