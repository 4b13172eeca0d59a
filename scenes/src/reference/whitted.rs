//! Light that a ray brings back: Whitted's model as the report has it (4.1 to 4.3), with reflection, refraction, total reflection and one shadow
//! ray a light. Which triangle a ray meets is found by [`super::search`].

use super::ray_log::{RayKind, RayWitness, TreePlace};
use super::search::Search;
use super::triangle::{PreparedTriangle, ShearedRay};
use crate::model::{self, Light, Material, Scene, Vec3, View};
use crate::vector::{add, dot, scale, sub, unit};

/// Distance by which the origins of secondary rays are moved off the surface along its normal, as part of the scene's box (which is 1 to 2 long here).
/// A hit point lies off its plane by some 10^-16 of the coordinates, so this is five orders above the noise, and as far below the steps of
/// the finest grid, which are 2^-30 of the box.
const OFFSET: f64 = 1e-10;

/// Everything that shading needs beside the triangles' shapes.
#[derive(Debug)]
pub struct World<'a> {
    materials: &'a [Material],
    /// The number of its material for each triangle by its number.
    triangles: &'a [model::Triangle],
    lights: Vec<Light>,
    ambient: f64,
    background: Vec3,
    bounces: u32,
}

/// A ray of the ray tree that is still to be followed.
struct PendingRay<'a> {
    ray: ShearedRay<'a>,
    place: TreePlace,
    /// The ray runs inside a body; a refracted ray changes it, a reflected one does not.
    is_inside: bool,
}

impl<'a> World<'a> {
    /// The shading of a scene whose positions have been moved by `local`.
    pub fn new(scene: &'a Scene, view: &View, local: impl Fn(Vec3) -> Vec3) -> World<'a> {
        let lights = scene.lights.iter().map(|light| Light { position: local(light.position), colour: light.colour });
        World {
            materials: &scene.materials,
            triangles: &scene.triangles,
            lights: lights.collect(),
            ambient: view.ambient,
            background: view.background,
            bounces: view.bounces,
        }
    }

    /// The light that comes back along a ray, of which a witness is told. The ray tree is walked depth first on a stack of its own, so that
    /// its depth is not bounded by the thread's.
    pub fn colour(&self, search: &dyn Search, ray: ShearedRay, witness: &mut impl RayWitness) -> Vec3 {
        let mut colour = [0.0; 3];
        let place = TreePlace { kind: RayKind::Camera, level: 0, weight: 1.0 };
        let mut open = vec![PendingRay { ray, place, is_inside: false }];
        while let Some(branch) = open.pop() {
            witness.ray(branch.place, &branch.ray);
            let Some(hit) = search.nearest(&branch.ray) else {
                witness.seen(self.background);
                colour = add(colour, scale(self.background, branch.place.weight));
                continue;
            };
            let triangle = search.triangle(hit.index);
            let material = &self.materials[self.triangles[hit.index as usize].material as usize];
            let point = triangle.point(&branch.ray);
            let normal = facing(&triangle, branch.ray.direction);
            witness.hit(&hit, &triangle, &branch.ray, normal);
            let local = self.local(search, material, point, normal, witness);
            witness.seen(local);
            colour = add(colour, scale(local, branch.place.weight));
            if branch.place.level < self.bounces {
                self.branches(&branch, material, point, normal, &mut open);
            }
        }
        colour
    }

    /// Light that a surface sends out by itself: colour (ambient + kd sum max(0, N.L) light), over the lights that nothing hides.
    fn local(
        &self,
        search: &dyn Search,
        material: &Material,
        point: Vec3,
        normal: Vec3,
        witness: &mut impl RayWitness,
    ) -> Vec3 {
        let mut intensity = [self.ambient; 3];
        let origin = add(point, scale(normal, OFFSET));
        for (number, light) in self.lights.iter().enumerate() {
            let Some(towards) = unit(sub(light.position, point)) else { continue };
            let cosine = dot(normal, towards);
            if cosine <= 0.0 {
                continue;
            }
            witness.light(number, cosine);
            let way = sub(light.position, origin);
            let Some(direction) = unit(way) else { continue };
            let (ray, end) = (ShearedRay::new(origin, direction), dot(way, direction));
            let is_blocked = search.is_blocked(&ray, end);
            witness.shadow(search, &ray, end, is_blocked);
            if !is_blocked {
                intensity = add(intensity, scale(light.colour, material.intensity * cosine));
            }
        }
        [0, 1, 2].map(|k| material.colour[k] * intensity[k])
    }

    /// Adds the reflected and the refracted ray of a hit, as far as they have a weight.
    fn branches(
        &self,
        branch: &PendingRay,
        material: &Material,
        point: Vec3,
        normal: Vec3,
        open: &mut Vec<PendingRay<'_>>,
    ) {
        let direction = branch.ray.direction;
        let mut reflection = material.reflection;
        let mut child = |kind: RayKind, direction: Vec3, weight: f64| {
            // Weights underflow to 0 on very deep paths only, which then bring nothing.
            let weight = branch.place.weight * weight;
            if let Some(direction) = unit(direction).filter(|_| weight > 0.0) {
                let passes = kind == RayKind::Refracted;
                let side = if passes { -OFFSET } else { OFFSET };
                let ray = ShearedRay::new(add(point, scale(normal, side)), direction);
                let place = TreePlace { kind, level: branch.place.level + 1, weight };
                open.push(PendingRay { ray, place, is_inside: branch.is_inside != passes });
            }
        };
        if material.transmission() > 0.0 {
            let eta = if branch.is_inside { material.index } else { 1.0 / material.index };
            match refracted(direction, normal, eta) {
                Some(onwards) => child(RayKind::Refracted, onwards, material.transmission()),
                None => reflection += material.transmission(),
            }
        }
        if reflection > 0.0 {
            child(RayKind::Reflected, reflected(direction, normal), reflection);
        }
    }
}

/// The triangle's normal on the side that a ray comes from.
fn facing(triangle: &PreparedTriangle, direction: Vec3) -> Vec3 {
    let normal = triangle.normal().expect("a triangle that is hit has an area");
    if dot(normal, direction) > 0.0 { scale(normal, -1.0) } else { normal }
}

/// Direction of the mirrored ray; `normal` faces where the ray comes from. Report 4.1.
pub fn reflected(direction: Vec3, normal: Vec3) -> Vec3 {
    sub(direction, scale(normal, 2.0 * dot(direction, normal)))
}

/// Direction of the ray behind the surface, `None` at total reflection; `eta` is the index on this side over that on the other. Report 4.2.
pub fn refracted(direction: Vec3, normal: Vec3, eta: f64) -> Option<Vec3> {
    let cosine = -dot(direction, normal);
    let k = 1.0 - eta * eta * (1.0 - cosine * cosine);
    (k >= 0.0).then(|| add(scale(direction, eta), scale(normal, eta * cosine - k.sqrt())))
}
