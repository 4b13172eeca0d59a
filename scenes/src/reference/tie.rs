//! Ties: rays that double precision cannot tell from one through an edge, or from one that meets two triangles at the same distance. On
//! which side such a ray passes is nobody's error, so it is decided as the coprocessor decides it. Nothing here finds a tie.

use super::triangle::ShearedRay;
use crate::model::Vec3;
use crate::vector::{AXES, cross};

/// Part of the scene's box (which is 1 to 2 long here) up to which a ray is on an edge: a thousand roundings of double precision, and a
/// thousandth of the finest grid's steps.
pub const TIE: f64 = 1.0 / (1u64 << 42) as f64;

/// Answers of the coprocessor for its camera rays, which start and go where its words let them.
pub trait Ties: Sync {
    /// Distance, in any unit, at which the camera ray of a column and row (row 0 on top) hits a triangle of the scene; `None` when it misses
    /// it.
    fn distance(&self, sample: [u32; 2], triangle: u32) -> Option<i64>;
}

/// Camera ray of a column and row whose ties are known.
#[derive(Clone, Copy)]
pub struct Sample<'a> {
    /// Column and row, row 0 on top.
    pub pixel: [u32; 2],
    /// The answers.
    pub ties: &'a dyn Ties,
}

impl Sample<'_> {
    /// The distance at which the coprocessor's ray hits a triangle.
    pub fn distance(&self, triangle: u32) -> Option<i64> {
        self.ties.distance(self.pixel, triangle)
    }
}

/// Sign of the edge function of two points, seen from the ray's origin, for a ray on their edge: that of a direction which is moved by
/// (e, e^2, e^3), e infinitely small, so that of the edge's normal along the first axis where it has one. `tie` is the size up to which a
/// component of the normal is nothing but rounding.
pub fn perturbed_sign(ray: &ShearedRay, from: Vec3, to: Vec3, tie: f64) -> f64 {
    let normal = cross(from, to);
    let decisive = AXES.into_iter().map(|k| normal[k]).find(|component| component.abs() > tie);
    decisive.map_or(0.0, |component| component.signum() * ray.forward())
}
