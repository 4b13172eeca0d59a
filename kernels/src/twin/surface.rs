//! What a hit looks like: its point, moved off the surface to both sides, the normal there, and the material.

use isa::number::{Arithmetic, Vector};

use super::Twin;
use super::lanes::Lanes;
use super::ray::Ray;
use super::report;
use super::stage::Material;
use super::unit::unit;
use crate::constants::Constants;
use crate::set::Formulas;

/// The place where a ray meets a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Surface {
    /// The point, moved off the surface to the side of the ray: where reflected and shadow rays start.
    pub point: Vector,
    /// The point, moved off to the other side: where refracted rays start.
    pub behind: Vector,
    /// Unit normal that faces the ray.
    pub facing: Vector,
    /// Direction of the ray that came.
    pub incident: Vector,
    /// -normal . incident, not negative.
    pub cosine: i32,
    /// The material.
    pub material: Material,
}

/// The unit normal of a triangle that faces a ray, and the cosine of incidence (report 4.1).
pub fn normal(
    arithmetic: &impl Lanes,
    direction_bits: u32,
    direction: Vector,
    vertices: &[Vector; 3],
) -> (Vector, i32) {
    let [v0, v1, v2] = *vertices;
    let (edge1, edge2) = (arithmetic.difference(v1, v0), arithmetic.difference(v2, v0));
    let normal = unit(arithmetic, direction_bits, arithmetic.normalized_cross(edge1, edge2));
    let cosine = arithmetic.dot(normal, direction, direction_bits);
    if cosine > 0 {
        (normal.map(|lane| arithmetic.negative(lane)), cosine)
    } else {
        (normal, arithmetic.negative(cosine))
    }
}

/// The points on both sides of the surface at distance `t`. The point is rounded, so it may lie on the wrong side: it moves along the
/// normal's major axis by more than that error.
pub fn sides(arithmetic: &impl Lanes, constants: &Constants, ray: &Ray, t: i32, facing: Vector) -> (Vector, Vector) {
    let point = arithmetic.sum(ray.origin, arithmetic.scaled(ray.direction, t, constants.along()));
    let length = facing.map(i32::unsigned_abs);
    let major = (1..3).fold(0, |major, k| if length[k] > length[major] { k } else { major });
    let offset = if facing[major] < 0 { -constants.offset } else { constants.offset };
    let (mut before, mut behind) = (point, point);
    before[major] = arithmetic.plus(point[major], offset);
    behind[major] = arithmetic.minus(point[major], offset);
    (before, behind)
}

impl<A: Arithmetic> Twin<A> {
    /// The surface that a ray meets: triangle `index` at distance `t`.
    pub fn surface(&self, ray: &Ray, t: i32, index: u32) -> Surface {
        let triangle = &self.stage.triangles[index as usize];
        let (arithmetic, constants) = (&self.arithmetic, &self.constants);
        let bits = constants.formats.direction;
        let (facing, cosine, point, behind) = match self.profile.formulas() {
            Formulas::Printed => {
                let normal = report::normal(arithmetic, bits, &triangle.vertices);
                report::sides(arithmetic, constants, ray, t, normal)
            }
            Formulas::Vector => {
                let (facing, cosine) = normal(arithmetic, bits, ray.direction, &triangle.vertices);
                let (point, behind) = sides(arithmetic, constants, ray, t, facing);
                (facing, cosine, point, behind)
            }
        };
        let material = self.stage.materials[triangle.material as usize];
        Surface { point, behind, facing, incident: ray.direction, cosine, material }
    }
}
