//! Surface at a hit: its point, moved off the surface to both sides, the normal there, and the material.

use isa::number::{Arithmetic, Vector};

use super::Twin;
use super::ray::TwinRay;
use super::report;
use super::stage::StageMaterial;
use super::unit::unit;
use super::vector_arithmetic::VectorArithmetic;
use crate::constants::{Constants, SIDE_MARGIN};
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
    pub material: StageMaterial,
}

/// The unit normal of a triangle that faces a ray, and the cosine of incidence (report 4.1).
pub fn normal(
    arithmetic: &impl VectorArithmetic,
    direction_bits: u32,
    direction: Vector,
    vertices: &[Vector; 3],
) -> (Vector, i32) {
    let [v0, v1, v2] = *vertices;
    let (edge1, edge2) = (arithmetic.difference(v1, v0), arithmetic.difference(v2, v0));
    let normal = unit(arithmetic, direction_bits, arithmetic.normalized_cross(edge1, edge2));
    let cosine = arithmetic.dot(normal, direction, direction_bits);
    if cosine > 0 {
        (normal.map(|component| arithmetic.negative(component)), cosine)
    } else {
        (normal, arithmetic.negative(cosine))
    }
}

/// The point at distance `t` along a ray, each component rounded.
pub fn point(arithmetic: &impl VectorArithmetic, constants: &Constants, ray: &TwinRay, t: i32) -> Vector {
    arithmetic.sum(ray.origin, arithmetic.scaled(ray.direction, t, constants.along()))
}

/// The axis along which a vector is longest; of equal ones the first of x, y, z.
pub fn major_axis(vector: Vector) -> usize {
    let length = vector.map(i32::unsigned_abs);
    (1..3).fold(0, |major, k| if length[k] > length[major] { k } else { major })
}

/// Height of a point over a triangle's plane along an axis, in units of positions with `side_fraction` fraction bits: the volume of the
/// edges and the way from a corner, by the area of the triangle's shadow along the axis.
pub fn height(
    arithmetic: &impl VectorArithmetic,
    constants: &Constants,
    point: Vector,
    axis: usize,
    vertices: &[Vector; 3],
) -> i32 {
    let [a, b, way] =
        [vertices[1], vertices[2], point].map(|corner| arithmetic.difference(corner, vertices[0]).map(i128::from));
    let minor = |p: [i128; 3], q: [i128; 3], k: usize| {
        let (j, l) = ((k + 1) % 3, (k + 2) % 3);
        p[j] * q[l] - p[l] * q[j]
    };
    // Exact: three factors of at most 32 bits each, and a sum of six products.
    let volume: i128 = (0..3).map(|k| a[k] * minor(b, way, k)).sum();
    let (volume, area) = (arithmetic.widen(volume, constants.side_shift), arithmetic.widen(minor(a, b, axis), 0));
    let fraction = constants.side_shift + constants.side_fraction;
    arithmetic.quotient(i128::from(volume) << fraction, area.into())
}

/// The points on both sides of the surface at distance `t`: that of the ray first. The point is rounded, so it may lie in the surface or on the
/// wrong side. Each moves along the normal's major axis by the fewest units, 0 or more, for which it lies strictly on its side.
pub fn sides(
    arithmetic: &impl VectorArithmetic,
    constants: &Constants,
    ray: &TwinRay,
    t: i32,
    facing: Vector,
    vertices: &[Vector; 3],
) -> (Vector, Vector) {
    let point = point(arithmetic, constants, ray, t);
    let axis = major_axis(facing);
    let height = height(arithmetic, constants, point, axis, vertices);
    // The fewest units up from a height that are sure to end above 0: from -1.5 units it is 2, from 0 it is 1, from 1 it is 0.
    // Numbers wrap around in 32 bits, as the machine's whole numbers do; heights of points near the plane are far from that.
    let least =
        |missing: i32| (i64::from(missing.max(-1)) + 1).unsigned_abs().div_ceil(1 << constants.side_fraction) as i32;
    let moved = |coordinate: i32| {
        let mut place = point;
        place[axis] = coordinate;
        place
    };
    let above = moved(arithmetic.plus(point[axis], least(SIDE_MARGIN.wrapping_sub(height))));
    let below = moved(arithmetic.minus(point[axis], least(SIDE_MARGIN.wrapping_add(height))));
    if facing[axis] < 0 { (below, above) } else { (above, below) }
}

impl<A: Arithmetic> Twin<A> {
    /// The surface that a ray meets: triangle `index` at distance `t`.
    pub fn surface(&self, ray: &TwinRay, t: i32, index: u32) -> Surface {
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
                let (point, behind) = sides(arithmetic, constants, ray, t, facing, &triangle.vertices);
                (facing, cosine, point, behind)
            }
        };
        let material = self.stage.materials[triangle.material as usize];
        Surface { point, behind, facing, incident: ray.direction, cosine, material }
    }
}
