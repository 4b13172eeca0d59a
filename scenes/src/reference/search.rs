//! Search for the triangle that a ray meets first, or for any that it meets: the questions, and the answer by trying all triangles. The quick
//! answer is in [`super::hierarchy`]; it is the same, bit for bit, because both use the same test of one triangle and the same order of hits.

use super::tie::TIE;
use super::triangle::{PreparedTriangle, Shapes, ShearedRay};

/// A triangle that is hit, and the distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the ray.
    pub t: f64,
    /// Number of the triangle in the scene.
    pub index: u32,
}

/// Triangles that rays can be sent at.
pub trait Search: Sync {
    /// A triangle by its number in the scene.
    fn triangle(&self, index: u32) -> PreparedTriangle;

    /// The hit with the smallest distance; of equal ones that of the triangle with the lowest number.
    fn nearest(&self, ray: &ShearedRay) -> Option<Hit>;

    /// Some triangle is hit at a distance less than `end`.
    fn is_blocked(&self, ray: &ShearedRay, end: f64) -> bool;
}

/// Tries all triangles.
#[derive(Debug)]
pub struct Exhaustive<'a> {
    /// The places of the triangles.
    pub shapes: Shapes<'a>,
    /// The numbers of those that are tried.
    pub indices: Vec<u32>,
}

/// The better one of two hits: the nearer one, and of two that double precision cannot tell apart the one that the coprocessor takes, the
/// lower index of equal distances.
pub fn better(ray: &ShearedRay, best: Option<Hit>, hit: Hit) -> Option<Hit> {
    let Some(best) = best else { return Some(hit) };
    if (hit.t - best.t).abs() > TIE * hit.t {
        return Some(if hit.t < best.t { hit } else { best });
    }
    let place = |index: u32| (ray.sample.and_then(|sample| sample.distance(index)), index);
    let index = if place(best.index) <= place(hit.index) { best.index } else { hit.index };
    Some(Hit { t: best.t.min(hit.t), index })
}

impl Search for Exhaustive<'_> {
    fn triangle(&self, index: u32) -> PreparedTriangle {
        self.shapes.triangle(index)
    }

    fn nearest(&self, ray: &ShearedRay) -> Option<Hit> {
        let hit = |&index: &u32| Some(Hit { t: self.shapes.hit(index, ray)?, index });
        self.indices.iter().filter_map(hit).fold(None, |best, hit| better(ray, best, hit))
    }

    fn is_blocked(&self, ray: &ShearedRay, end: f64) -> bool {
        self.indices.iter().any(|&index| self.shapes.hit(index, ray).is_some_and(|t| t < end))
    }
}
