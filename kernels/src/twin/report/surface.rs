//! What a hit looks like, and the secondary rays that start there (report 4.1, 4.2): each asks for the normal anew.

use isa::number::{Arithmetic, Vector};

use super::scalar::{cross, dot};
use crate::constants::Constants;
use crate::twin::Twin;
use crate::twin::lanes::Lanes;
use crate::twin::ray::Ray;
use crate::twin::stage::Material;
use crate::twin::surface::{self, Surface};
use crate::twin::unit::sqrt;

/// The unit vector, with `fraction` bits, in the direction of one that is scaled into [2^(word-3), 2^(word-2)]: its product with the
/// reciprocal of its length.
pub fn unit(arithmetic: &impl Lanes, fraction: u32, vector: Vector) -> Vector {
    let inverse = 2 * arithmetic.word() - 5;
    let length = sqrt(arithmetic, arithmetic.wide_dot(vector, vector));
    let inverted = arithmetic.quotient(1 << inverse, length.into());
    arithmetic.scaled(vector, inverted, inverse - fraction)
}

/// The unit normal of a triangle on the side that the order of its vertices gives (report, Annex II).
pub fn normal(arithmetic: &impl Lanes, fraction: u32, vertices: &[Vector; 3]) -> Vector {
    let [v0, v1, v2] = *vertices;
    let scaled = |vector: Vector| arithmetic.normalized(vector.map(i64::from));
    let edges = [v1, v2].map(|vertex| scaled(arithmetic.difference(vertex, v0)));
    unit(arithmetic, fraction, scaled(cross(arithmetic, edges[0], edges[1], arithmetic.word() - 1)))
}

/// The normal on the side of the ray, -normal . direction, and the points on both sides of the surface at distance `t`.
pub fn sides(
    arithmetic: &impl Lanes,
    constants: &Constants,
    ray: &Ray,
    t: i32,
    normal: Vector,
) -> (Vector, i32, Vector, Vector) {
    let cosine = dot(arithmetic, normal, ray.direction, constants.formats.direction);
    let (facing, cosine) = match cosine > 0 {
        true => (normal.map(|lane| arithmetic.negative(lane)), cosine),
        false => (normal, arithmetic.negative(cosine)),
    };
    let constants = Constants { offset: constants.literal_offset, ..*constants };
    let (point, behind) = surface::sides(arithmetic, &constants, ray, t, facing);
    (facing, cosine, point, behind)
}

/// The direction of the reflected ray, V = 2 (I . N) N - I, as D - (-2 c) N.
pub fn reflect(arithmetic: &impl Lanes, constants: &Constants, surface: &Surface) -> Vector {
    let twice = arithmetic.times(surface.cosine, -2, 0);
    arithmetic.difference(surface.incident, arithmetic.scaled(surface.facing, twice, constants.formats.direction))
}

/// What becomes of a ray that goes through a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refraction {
    /// Nothing: it is totally reflected.
    Total,
    /// It goes in this direction.
    Through(Vector),
}

/// The refracted ray, T = eta (D + c N) - sqrt(k) N with eta = ni / nt divided anew.
pub fn refract(arithmetic: &impl Lanes, constants: &Constants, surface: &Surface, inside: bool) -> Refraction {
    let (bits, index) = (constants.formats.direction, constants.formats.index);
    let (one, unit_index) = (1 << bits, 1 << index);
    let (from, to) = if inside { (surface.material.index, unit_index) } else { (unit_index, surface.material.index) };
    let eta = arithmetic.quotient(i128::from(from) << index, to.into());
    let sine_squared = arithmetic.minus(one, arithmetic.times(surface.cosine, surface.cosine, bits));
    let once = arithmetic.times(sine_squared, eta, bits);
    let twice = arithmetic.times(once, eta, (2 * index).saturating_sub(bits));
    let k = arithmetic.minus(one, twice);
    if k < 0 {
        return Refraction::Total;
    }
    let root = sqrt(arithmetic, arithmetic.widen(i128::from(k) << bits, 0));
    let along = arithmetic.sum(surface.incident, arithmetic.scaled(surface.facing, surface.cosine, bits));
    let along = arithmetic.scaled(along, eta, index);
    Refraction::Through(arithmetic.difference(along, arithmetic.scaled(surface.facing, root, bits)))
}

impl<A: Arithmetic> Twin<A> {
    /// The surface that a ray meets: triangle `index` at distance `t`.
    pub(super) fn literal_surface(&self, ray: &Ray, t: i32, index: u32) -> Surface {
        let triangle = &self.stage.triangles[index as usize];
        let normal = normal(&self.arithmetic, self.constants.formats.direction, &triangle.vertices);
        let (facing, cosine, point, behind) = sides(&self.arithmetic, &self.constants, ray, t, normal);
        let material: Material = self.stage.materials[triangle.material as usize];
        Surface { point, behind, facing, incident: ray.direction, cosine, material }
    }
}
