//! A ray against a triangle in double precision. Independent of the coprocessor's tests in method as well as in numbers: the triangle is
//! sheared so that the ray becomes the z axis, and the three edge functions are compared in that plane (Woop, Benthin, Wald 2013).
//!
//! The edge functions of an edge that two triangles share are each other's exact negatives, so no ray passes between them.

use super::tie::{Sample, TIE, perturbed_sign};
use crate::model::{self, Vec3};
use crate::vector::{cross, sub, unit};

/// A ray, with the shear that makes it the z axis.
#[derive(Clone, Copy)]
pub struct ShearedRay<'a> {
    /// The ray's origin.
    pub origin: Vec3,
    /// The ray's direction, of length 1.
    pub direction: Vec3,
    /// The sample of a camera ray, where the coprocessor's answers are known.
    pub sample: Option<Sample<'a>>,
    /// The axes in the order x, y, z of the sheared space: z is the direction's largest component.
    axes: [usize; 3],
    shear: Vec3,
}

impl ShearedRay<'_> {
    /// The ray from `origin` along `direction`, which is not 0.
    pub fn new(origin: Vec3, direction: Vec3) -> ShearedRay<'static> {
        let largest = |a: usize, b: usize| if direction[b].abs() > direction[a].abs() { b } else { a };
        let z = largest(largest(0, 1), 2);
        let (x, y) = ((z + 1) % 3, (z + 2) % 3);
        let shear = [direction[x] / direction[z], direction[y] / direction[z], 1.0 / direction[z]];
        ShearedRay { origin, direction, sample: None, axes: [x, y, z], shear }
    }

    /// The ray as the camera's through a sample.
    pub fn of(self, sample: Option<Sample<'_>>) -> ShearedRay<'_> {
        ShearedRay { sample, ..self }
    }

    /// 1 where the direction's largest component is positive, else -1: the sign by which edge functions in sheared space differ from those in space.
    pub fn forward(&self) -> f64 {
        self.direction[self.axes[2]].signum()
    }

    /// Size of the terms that the origin has in sheared space: small also for a far origin, where the ray comes from it along an axis.
    pub fn origin_terms(&self) -> f64 {
        let [x, y, z] = self.axes.map(|axis| self.origin[axis].abs());
        (x + self.shear[0].abs() * z).max(y + self.shear[1].abs() * z)
    }

    /// The point in sheared space, and how large the terms were that its x and y are differences of.
    #[inline]
    fn sheared(&self, point: Vec3) -> (Vec3, [f64; 2]) {
        let p = sub(point, self.origin);
        let [x, y, z] = self.axes;
        let (across, along) = ([p[x], p[y]], [self.shear[0] * p[z], self.shear[1] * p[z]]);
        let sheared = [across[0] - along[0], across[1] - along[1], self.shear[2] * p[z]];
        (sheared, [across[0].abs() + along[0].abs(), across[1].abs() + along[1].abs()])
    }
}

/// Outcome of a ray at a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Encounter {
    /// The ray passes by.
    Miss,
    /// The ray meets the inside of the triangle at this distance.
    Hit(f64),
    /// The ray meets the border at this distance, as far as double precision can tell.
    Border {
        /// Distance along the ray.
        t: f64,
        /// True where a direction moved by an infinitely small amount passes inside.
        is_inside: bool,
    },
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

    /// Distance t > 0 at which a ray hits a triangle; `None` also where it is seen so exactly from its edge that rounding alone decides. On the
    /// triangle's border the coprocessor decides, for rays of which its answers are not known the rule that it decides by.
    pub fn hit(&self, index: u32, ray: &ShearedRay) -> Option<f64> {
        match self.triangle(index).meet(ray) {
            Encounter::Miss => None,
            Encounter::Hit(t) => Some(t),
            Encounter::Border { t, is_inside } => {
                ray.sample.map_or(is_inside, |sample| sample.distance(index).is_some()).then_some(t)
            }
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

    /// The ray at the triangle, in front of its origin.
    pub fn meet(&self, ray: &ShearedRay) -> Encounter {
        let [(a, a_terms), (b, b_terms), (c, c_terms)] = self.vertices.map(|vertex| ray.sheared(vertex));
        let u = c[0] * b[1] - c[1] * b[0];
        let v = a[0] * c[1] - a[1] * c[0];
        let w = b[0] * a[1] - b[1] * a[0];
        let determinant = u + v + w;
        // Twelve factors, each off by less than two roundings of the terms that it came from. Without this bound a ray in the plane of a
        // triangle that it misses has three edge functions of noise, and hits when they happen to have the same sign.
        let most = |k: usize| a[k].abs().max(b[k].abs()).max(c[k].abs());
        let terms = |k: usize| a_terms[k].max(b_terms[k]).max(c_terms[k]);
        // An edge function is the distance from the edge times the edge's length. Most are larger than any edge of the triangle lets a tie be.
        let near = TIE * (1.0 + terms(0).max(terms(1)));
        let least = u.abs().min(v.abs()).min(w.abs());
        let is_apart = least > near * 2.0 * (most(0) + most(1));
        if is_apart && (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return Encounter::Miss;
        }
        if determinant.abs() <= 32.0 * f64::EPSILON * (most(0) * terms(1) + most(1) * terms(0)) {
            return Encounter::Miss;
        }
        let t = (u * a[2] + v * b[2] + w * c[2]) / determinant;
        if t <= 0.0 {
            return Encounter::Miss;
        }
        if is_apart {
            return Encounter::Hit(t);
        }
        self.at_border(ray, [(u, [c, b]), (v, [a, c]), (w, [b, a])], near, t)
    }

    /// The encounter at distance `t` with a triangle of which the ray comes near an edge. Each edge has its function and both ends in sheared
    /// space; within `near` of it the ray is on it.
    fn at_border(&self, ray: &ShearedRay, edges: [(f64, [Vec3; 2]); 3], near: f64, t: f64) -> Encounter {
        let [a, b, c] = self.vertices.map(|vertex| sub(vertex, ray.origin));
        let ends = [[c, b], [a, c], [b, a]];
        let determinant: f64 = edges.iter().map(|edge| edge.0).sum();
        let (mut is_on_edge, mut is_inside) = (false, true);
        for ((function, [from, to]), [start, end]) in edges.into_iter().zip(ends) {
            let tie = near * ((to[0] - from[0]).abs() + (to[1] - from[1]).abs());
            let sign = if function.abs() > tie {
                if (function > 0.0) != (determinant > 0.0) {
                    return Encounter::Miss;
                }
                continue;
            } else {
                perturbed_sign(ray, start, end, tie)
            };
            is_on_edge = true;
            is_inside &= sign * determinant > 0.0;
        }
        if is_on_edge { Encounter::Border { t, is_inside } } else { Encounter::Hit(t) }
    }

    /// Weights of the second and the third vertex in the point in which a ray meets the triangle. Only for rays that hit.
    pub fn weights(&self, ray: &ShearedRay) -> [f64; 2] {
        let [a, b, c] = self.vertices.map(|vertex| ray.sheared(vertex).0);
        let weights = [c[0] * b[1] - c[1] * b[0], a[0] * c[1] - a[1] * c[0], b[0] * a[1] - b[1] * a[0]];
        let sum: f64 = weights.iter().sum();
        [weights[1] / sum, weights[2] / sum]
    }

    /// The point in which a ray meets the triangle, from the vertices and not from the distance: it lies in the triangle's plane however far
    /// the ray has come. Only for rays that hit.
    pub fn point(&self, ray: &ShearedRay) -> Vec3 {
        let ([u, v], [a, b, c]) = (self.weights(ray), self.vertices);
        [0, 1, 2].map(|k| a[k] + u * (b[k] - a[k]) + v * (c[k] - a[k]))
    }
}
