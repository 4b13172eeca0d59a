//! Which triangle a ray meets first, and whether it meets any: what is asked, and the answer by trying all triangles. The quick answer is in
//! [`super::hierarchy`]; it is the same, bit for bit, because both use the same test of one triangle and the same order of hits.

use super::triangle::{Ray, Triangle};

/// A triangle that is hit: its place in the searched list, and the distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the ray.
    pub t: f64,
    /// Place in the list of triangles.
    pub place: u32,
}

/// Triangles that rays can be sent at.
pub trait Search: Sync {
    /// The triangles.
    fn triangles(&self) -> &[Triangle];

    /// The hit with the smallest distance; of equal ones that of the triangle with the lowest number.
    fn nearest(&self, ray: &Ray) -> Option<Hit>;

    /// Whether any triangle is hit at a distance less than `end`.
    fn is_blocked(&self, ray: &Ray, end: f64) -> bool;
}

/// Tries all triangles.
#[derive(Debug)]
pub struct Exhaustive(pub Vec<Triangle>);

/// The better one of a hit so far and a hit at `place`.
pub fn better(triangles: &[Triangle], best: Option<Hit>, place: u32, t: f64) -> Option<Hit> {
    let index = |place: u32| triangles[place as usize].index;
    match best {
        Some(hit) if (hit.t, index(hit.place)) <= (t, index(place)) => best,
        _ => Some(Hit { t, place }),
    }
}

impl Search for Exhaustive {
    fn triangles(&self) -> &[Triangle] {
        &self.0
    }

    fn nearest(&self, ray: &Ray) -> Option<Hit> {
        let hits = (0..).zip(&self.0).filter_map(|(place, triangle)| Some((place, triangle.hit(ray)?)));
        hits.fold(None, |best, (place, t)| better(&self.0, best, place, t))
    }

    fn is_blocked(&self, ray: &Ray, end: f64) -> bool {
        self.0.iter().any(|triangle| triangle.hit(ray).is_some_and(|t| t < end))
    }
}
