//! A ray against a triangle in double precision. Independent of the coprocessor's tests in method as well as in numbers: the triangle is
//! sheared so that the ray becomes the z axis, and the three edge functions are compared in that plane (Woop, Benthin, Wald 2013).
//!
//! The edge functions of an edge that two triangles share are each other's exact negatives, so no ray passes between them.

use crate::model::{self, Vec3};
use crate::vector::{cross, sub, unit};

/// A ray, with the shear that makes it the z axis.
#[derive(Clone, Copy, Debug)]
pub struct ShearedRay {
    /// The ray's origin.
    pub origin: Vec3,
    /// The ray's direction, of length 1.
    pub direction: Vec3,
    /// The axes in the order x, y, z of the sheared space: z is the direction's largest component.
    axes: [usize; 3],
    shear: Vec3,
}

impl ShearedRay {
    /// The ray from `origin` along `direction`, which is not 0.
    pub fn new(origin: Vec3, direction: Vec3) -> ShearedRay {
        let largest = |a: usize, b: usize| if direction[b].abs() > direction[a].abs() { b } else { a };
        let z = largest(largest(0, 1), 2);
        let (x, y) = ((z + 1) % 3, (z + 2) % 3);
        let shear = [direction[x] / direction[z], direction[y] / direction[z], 1.0 / direction[z]];
        ShearedRay { origin, direction, axes: [x, y, z], shear }
    }

    /// The point in sheared space, and how large the terms were that its x and y are differences of.
    fn sheared(&self, point: Vec3) -> (Vec3, [f64; 2]) {
        let p = sub(point, self.origin);
        let [x, y, z] = self.axes;
        let (across, along) = ([p[x], p[y]], [self.shear[0] * p[z], self.shear[1] * p[z]]);
        let sheared = [across[0] - along[0], across[1] - along[1], self.shear[2] * p[z]];
        (sheared, [across[0].abs() + along[0].abs(), across[1].abs() + along[1].abs()])
    }
}

/// The triangles of a scene with their vertices where the rays are.
#[derive(Clone, Debug)]
pub struct Shapes<'a> {
    /// The vertices.
    pub vertices: Vec<Vec3>,
    /// The vertices of each triangle, by number.
    pub triangles: &'a [model::Triangle],
}

impl Shapes<'_> {
    /// A triangle by its number in the scene.
    pub fn triangle(&self, index: u32) -> PreparedTriangle {
        PreparedTriangle {
            vertices: self.triangles[index as usize].vertices.map(|vertex| self.vertices[vertex as usize]),
        }
    }

    /// The numbers of the triangles that can be hit: those with an area.
    pub fn visible(&self) -> Vec<u32> {
        (0..self.triangles.len() as u32).filter(|&index| self.triangle(index).normal().is_some()).collect()
    }
}

/// A triangle.
#[derive(Clone, Copy, Debug)]
pub struct PreparedTriangle {
    /// The triangle's vertices.
    pub vertices: [Vec3; 3],
}

impl PreparedTriangle {
    /// A normal of length 1; the side it is on depends on the order of the vertices. `None` where the triangle has no area.
    pub fn normal(&self) -> Option<Vec3> {
        let [a, b, c] = self.vertices;
        unit(cross(sub(b, a), sub(c, a)))
    }

    /// Distance t > 0 along the ray at which it meets the triangle, edges included; `None` also where the triangle is seen so exactly from
    /// its edge that rounding alone decides.
    pub fn hit(&self, ray: &ShearedRay) -> Option<f64> {
        let [(a, a_terms), (b, b_terms), (c, c_terms)] = self.vertices.map(|vertex| ray.sheared(vertex));
        let u = c[0] * b[1] - c[1] * b[0];
        let v = a[0] * c[1] - a[1] * c[0];
        let w = b[0] * a[1] - b[1] * a[0];
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return None;
        }
        let determinant = u + v + w;
        // Twelve factors, each off by less than two roundings of the terms that it came from. Without this bound a ray in the plane of a
        // triangle that it misses has three edge functions of noise, and hits when they happen to have the same sign.
        let most = |k: usize| a[k].abs().max(b[k].abs()).max(c[k].abs());
        let terms = |k: usize| a_terms[k].max(b_terms[k]).max(c_terms[k]);
        if determinant.abs() <= 32.0 * f64::EPSILON * (most(0) * terms(1) + most(1) * terms(0)) {
            return None;
        }
        let t = (u * a[2] + v * b[2] + w * c[2]) / determinant;
        (t > 0.0).then_some(t)
    }

    /// The point in which a ray meets the triangle, from the vertices and not from the distance: it lies in the triangle's plane however far
    /// the ray has come. Only for rays that hit.
    pub fn point(&self, ray: &ShearedRay) -> Vec3 {
        let [a, b, c] = self.vertices.map(|vertex| ray.sheared(vertex).0);
        let weights = [c[0] * b[1] - c[1] * b[0], a[0] * c[1] - a[1] * c[0], b[0] * a[1] - b[1] * a[0]];
        let sum: f64 = weights.iter().sum();
        let [a, b, c] = self.vertices;
        [0, 1, 2].map(|k| a[k] + (weights[1] / sum) * (b[k] - a[k]) + (weights[2] / sum) * (c[k] - a[k]))
    }
}
