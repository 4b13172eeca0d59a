//! Witnesses of the reference's rays: a count of them, or a log of everything that decides their colour. The reference calls them in the order in
//! which it follows rays; none of them changes what it does.

use super::RayCounts;
use super::search::{Hit, Search};
use super::triangle::{PreparedTriangle, ShearedRay};
use crate::model::Vec3;
use crate::vector::shifted;

/// Kind of a ray of the ray tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RayKind {
    /// From the camera.
    Camera,
    /// Mirrored, totally reflected ones included.
    Reflected,
    /// Behind the surface that it passed.
    Refracted,
}

impl RayKind {
    /// Name in results.
    pub const fn name(self) -> &'static str {
        match self {
            RayKind::Camera => "camera",
            RayKind::Reflected => "reflected",
            RayKind::Refracted => "refracted",
        }
    }
}

/// Place of a ray in the ray tree.
#[derive(Clone, Copy, Debug)]
pub struct TreePlace {
    /// Kind of the ray.
    pub kind: RayKind,
    /// 0 for the camera's ray.
    pub level: u32,
    /// Product of the coefficients on the way from the eye.
    pub weight: f64,
}

/// Witness of the rays of one pixel.
pub trait RayWitness {
    /// A ray of the ray tree is followed.
    fn ray(&mut self, place: TreePlace, ray: &ShearedRay);
    /// The followed ray meets a triangle; the normal faces the ray.
    fn hit(&mut self, hit: &Hit, triangle: &PreparedTriangle, ray: &ShearedRay, normal: Vec3);
    /// The surface faces a light, by its number, under an angle of this cosine.
    fn light(&mut self, light: usize, cosine: f64);
    /// A ray is sent to that light, which is `end` away, and is blocked or not.
    fn shadow(&mut self, search: &dyn Search, way: &ShearedRay, end: f64, is_blocked: bool);
    /// The followed ray brings back this colour, before its weight.
    fn seen(&mut self, colour: Vec3);
}

impl RayWitness for RayCounts {
    fn ray(&mut self, place: TreePlace, _: &ShearedRay) {
        match place.kind {
            RayKind::Camera => self.camera += 1,
            RayKind::Reflected => self.reflected += 1,
            RayKind::Refracted => self.refracted += 1,
        }
    }

    fn hit(&mut self, _: &Hit, _: &PreparedTriangle, _: &ShearedRay, _: Vec3) {}

    fn light(&mut self, _: usize, _: f64) {
        self.shadow += 1;
    }

    fn shadow(&mut self, _: &dyn Search, _: &ShearedRay, _: f64, _: bool) {}

    fn seen(&mut self, _: Vec3) {}
}

/// A ray of the ray tree in double precision; places and distances in scene units.
#[derive(Clone, Debug, PartialEq)]
pub struct ReferenceRay {
    /// Kind of the ray.
    pub kind: RayKind,
    /// 0 for the camera's ray.
    pub level: u32,
    /// Product of the coefficients on the way from the eye.
    pub weight: f64,
    /// Origin of the ray; of a secondary one, off the surface by a 10^10-th of the scene's box.
    pub origin: Vec3,
    /// Direction of length 1.
    pub direction: Vec3,
    /// The surface that it meets.
    pub hit: Option<ReferenceHit>,
    /// Lights that the surface faces, in their order.
    pub lights: Vec<ReferenceLight>,
    /// The colour that it brings back, before its weight: the surface's own, or the background.
    pub colour: Vec3,
}

/// A surface that a ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceHit {
    /// Number of the triangle in the scene.
    pub triangle: u32,
    /// Distance along the ray, in scene units.
    pub t: f64,
    /// Weight of the second vertex.
    pub u: f64,
    /// Weight of the third vertex.
    pub v: f64,
    /// The point, in scene units.
    pub point: Vec3,
    /// Unit normal that faces the ray.
    pub normal: Vec3,
}

/// A light that a surface faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceLight {
    /// Number of the light in the scene.
    pub light: usize,
    /// Cosine of the angle between normal and way.
    pub cosine: f64,
    /// Direction of the ray towards it, of length 1.
    pub direction: Vec3,
    /// Distance of the light, in scene units.
    pub distance: f64,
    /// The nearest triangle that stands in the way, by its number, and its distance in scene units.
    pub blocker: Option<(u32, f64)>,
}

/// The reference's own coordinates: p = (scene - middle) / 2^power.
#[derive(Clone, Copy, Debug)]
pub struct LocalFrame {
    /// The point that becomes 0, in scene units.
    pub middle: Vec3,
    /// Power of two by which lengths are divided.
    pub power: i32,
}

impl LocalFrame {
    fn place(&self, local: Vec3) -> Vec3 {
        // Halves, as on the way there: the sum itself is representable, since it is a place near the scene.
        [0, 1, 2].map(|k| 2.0 * (shifted(local[k], self.power - 1) + self.middle[k] / 2.0))
    }

    fn length(&self, local: f64) -> f64 {
        shifted(local, self.power)
    }
}

/// Log of a pixel's rays, in the order in which they are followed.
pub(super) struct RayLog {
    /// Way back to scene units.
    pub frame: LocalFrame,
    /// The rays.
    pub rays: Vec<ReferenceRay>,
}

impl RayLog {
    fn last(&mut self) -> &mut ReferenceRay {
        self.rays.last_mut().expect("a ray comes before all that happens to it")
    }
}

impl RayWitness for RayLog {
    fn ray(&mut self, TreePlace { kind, level, weight }: TreePlace, ray: &ShearedRay) {
        let (origin, direction) = (self.frame.place(ray.origin), ray.direction);
        let (hit, lights, colour) = (None, Vec::new(), [0.0; 3]);
        self.rays.push(ReferenceRay { kind, level, weight, origin, direction, hit, lights, colour });
    }

    fn hit(&mut self, hit: &Hit, triangle: &PreparedTriangle, ray: &ShearedRay, normal: Vec3) {
        let ([u, v], point) = (triangle.weights(ray), self.frame.place(triangle.point(ray)));
        let t = self.frame.length(hit.t);
        self.last().hit = Some(ReferenceHit { triangle: hit.index, t, u, v, point, normal });
    }

    fn light(&mut self, light: usize, cosine: f64) {
        self.last().lights.push(ReferenceLight { light, cosine, direction: [0.0; 3], distance: 0.0, blocker: None });
    }

    fn shadow(&mut self, search: &dyn Search, way: &ShearedRay, end: f64, is_blocked: bool) {
        // The search said that there is one before the end, not which.
        let nearest = if is_blocked { search.nearest(way).filter(|hit| hit.t < end) } else { None };
        let blocker = nearest.map(|hit| (hit.index, self.frame.length(hit.t)));
        let (direction, distance) = (way.direction, self.frame.length(end));
        if let Some(light) = self.last().lights.last_mut() {
            *light = ReferenceLight { direction, distance, blocker, ..*light };
        }
    }

    fn seen(&mut self, colour: Vec3) {
        self.last().colour = colour;
    }
}
