//! Explanation of a pixel: the machine's ray tree with double precision's beside it, ray by ray. Rays are matched by their way down the tree: a
//! reflected child with the reflected child of the ray that its parent was matched with.

use scenes::image::MemoryImage;
use scenes::model::Vec3;
use scenes::reference::{RayKind, ReferenceHit, ReferenceLight, ReferenceRay};
use scenes::vector::{add, dot, scale, sub};
use schemars::JsonSchema;
use serde::Serialize;

use super::compared::{ComparedNumber, ComparedVector, RawScales, weights};
use super::probe::{RawHit, RawPixel, RawRay, RawShadow};
use crate::job::{Job, result_name};
use crate::result::{FormatTable, RaysByKind};

/// Version of [`PixelExplanation`].
pub const SCHEMA: &str = "lancer-pixel-1";

/// Steps of the grid along a ray up to which the origins of camera rays differ by rounding.
const ROUNDED_STEPS: f64 = 16.0;

/// A pixel explained: its rays, and how its colour comes about, beside double precision.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PixelExplanation {
    /// Version of the result: a key that goes away or changes its meaning changes it, a new key does not.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: &'static str,
    /// Name of the scene.
    pub scene: String,
    /// Column and row of the pixel, from the top left.
    pub pixel: [u32; 2],
    /// Width and height of the picture.
    pub size: [u32; 2],
    /// Name of the kernels' profile.
    pub profile: &'static str,
    /// Name of the machine.
    pub machine: String,
    /// Bits of a word and fraction bits of each quantity.
    pub formats: FormatTable,
    /// Instructions that the core executed.
    pub instructions: u64,
    /// Packets that all searches went through.
    pub packets: u64,
    /// Triangles that all searches tested.
    pub triangles: u64,
    /// Rays of the machine.
    pub machine_rays: RaysByKind,
    /// Rays in double precision.
    pub reference_rays: RaysByKind,
    /// Number of the first ray at which machine and double precision decide otherwise: another triangle, another light in sight, or a ray that
    /// one of them alone follows; null where there is none.
    pub parted: Option<u32>,
    /// Colour of the pixel: the sum of what the rays add to it.
    pub colour: ComparedVector,
    /// Rays in the order in which the machine follows them, depth first; behind them those that double precision alone follows.
    pub rays: Vec<ExplainedRay>,
    /// Fault in which the program ended; left out when it halted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trap: Option<String>,
}

/// A ray of the ray tree.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ExplainedRay {
    /// Number of the ray, from 0.
    pub number: u32,
    /// `camera`, `reflected` or `refracted`.
    pub kind: &'static str,
    /// Number of the ray whose child it is; null for the camera's.
    pub parent: Option<u32>,
    /// Numbers of its children.
    pub children: Vec<u32>,
    /// Level in the tree: 0 for the camera's ray.
    pub level: u32,
    /// Instructions before its search; null for a ray of double precision alone.
    pub step: Option<u64>,
    /// Instructions up to where its colour was added.
    pub end: Option<u64>,
    /// Product of the coefficients on the way from the eye.
    pub weight: ComparedNumber,
    /// Origin, in scene units. The machine moves those of secondary rays off the surface by whole units of its grid, double precision by less;
    /// camera rays begin where the machine's does, which has none where it misses the scene's box.
    pub origin: ComparedVector,
    /// Direction of length 1.
    pub direction: ComparedVector,
    /// Packets that its search went through, empty ones included.
    pub packets: u64,
    /// Triangles that its search tested.
    pub triangles: u64,
    /// Surface that it meets; null where neither finds one.
    pub hit: Option<ExplainedHit>,
    /// Lights of the scene, as the surface sees them.
    pub lights: Vec<ExplainedLight>,
    /// Colour that it brings back before its weight: colour (ambient + intensity x sum over lights in sight of cosine x light), or the background.
    pub local: ComparedVector,
    /// Colour that it adds to the pixel: local times weight.
    pub added: ComparedVector,
    /// Colour of the pixel behind it.
    pub sum: ComparedVector,
}

/// A surface that a ray meets.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ExplainedHit {
    /// Number of the triangle in the scene; null where the machine finds none.
    pub triangle: Option<u32>,
    /// Number of the triangle that double precision finds.
    pub reference_triangle: Option<u32>,
    /// Number of the material of the machine's triangle, else of the other.
    pub material: u32,
    /// Diffuse colour of the material.
    pub colour: Vec3,
    /// Diffuse coefficient kd.
    pub intensity: f64,
    /// Specular coefficient ks.
    pub reflection: f64,
    /// Transmission coefficient kt.
    pub transmission: f64,
    /// Index of refraction; 0 for an opaque material.
    pub index: f64,
    /// Distance along the ray, in scene units.
    pub t: ComparedNumber,
    /// Weight of the second vertex: of the machine's ray at the triangle as it is stored, exactly; kernels use only its sign.
    pub u: ComparedNumber,
    /// Weight of the third vertex, in the same way.
    pub v: ComparedNumber,
    /// The point, in scene units; the machine's has been moved off the surface.
    pub point: ComparedVector,
    /// Unit normal that faces the ray.
    pub normal: ComparedVector,
}

/// A light as a surface sees it.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ExplainedLight {
    /// Number of the light in the scene.
    pub light: u32,
    /// `lit`, `hidden` where something stands in the way, or `away` where the surface does not face it and no ray is sent; null where the machine
    /// meets no surface.
    pub state: Option<&'static str>,
    /// State of the light in double precision.
    pub reference_state: Option<&'static str>,
    /// Colour of the light.
    pub colour: Vec3,
    /// Cosine of the angle between normal and light.
    pub cosine: ComparedNumber,
    /// Distance of the light, in scene units.
    pub distance: ComparedNumber,
    /// Direction of the shadow ray.
    pub direction: ComparedVector,
    /// Instructions before its search.
    pub step: Option<u64>,
    /// Packets that its search went through.
    pub packets: u64,
    /// Triangles that its search tested.
    pub triangles: u64,
    /// Triangle that the machine found in the way: the first, not the nearest.
    pub blocker: Option<Blocker>,
    /// Nearest triangle that stands in the way in double precision.
    pub reference_blocker: Option<Blocker>,
}

/// A triangle in the way of a light.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Blocker {
    /// Number of the triangle in the scene.
    pub triangle: u32,
    /// Distance along the shadow ray, in scene units.
    pub t: f64,
}

/// Everything that explanations are made of.
pub(super) struct Explainer<'a> {
    pub job: &'a Job,
    pub image: &'a MemoryImage,
    pub scales: RawScales,
}

/// A ray of the machine, of double precision, or both.
type RayPair<'a> = (Option<&'a RawRay>, Option<&'a ReferenceRay>);

impl Explainer<'_> {
    /// The explanation of a pixel from both trees and the colour in double precision.
    pub fn explain(
        &self,
        pixel: [u32; 2],
        raw: &RawPixel,
        colour: Vec3,
        reference: &[ReferenceRay],
    ) -> PixelExplanation {
        let reference = &self.at_origin(raw, reference);
        let parents = parents(reference);
        // Match the trees from the root down: parents come before their children in both.
        let mut partner: Vec<Option<usize>> = vec![None; raw.rays.len()];
        // Numbers of the explained rays, of which those of the machine come first.
        let mut number_of = vec![None; reference.len()];
        for (number, ray) in raw.rays.iter().enumerate() {
            let above = ray.parent.map(|parent| partner[parent]);
            let found = (0..reference.len()).find(|&other| {
                let same_place = match (above, parents[other]) {
                    (None, None) => true,
                    (Some(Some(above)), Some(parent)) => above == parent,
                    _ => false,
                };
                same_place && reference[other].kind == ray.kind && number_of[other].is_none()
            });
            partner[number] = found;
            if let Some(found) = found {
                number_of[found] = Some(number);
            }
        }
        // Explain the machine's rays in their order, then the others.
        let mut sum = [0.0; 3];
        let sums: Vec<Vec3> = reference
            .iter()
            .map(|ray| {
                sum = add(sum, scale(ray.colour, ray.weight));
                sum
            })
            .collect();
        let mut rays: Vec<ExplainedRay> = Vec::new();
        for (number, ray) in raw.rays.iter().enumerate() {
            let other = partner[number];
            let pair = (Some(ray), other.map(|other| &reference[other]));
            rays.push(self.ray(number, ray.parent, pair, other.map(|other| sums[other])));
        }
        for (other, ray) in reference.iter().enumerate() {
            if number_of[other].is_none() {
                let parent = parents[other].and_then(|parent| number_of[parent]);
                number_of[other] = Some(rays.len());
                rays.push(self.ray(rays.len(), parent, (None, Some(ray)), Some(sums[other])));
            }
        }
        for number in 0..rays.len() {
            if let Some(parent) = rays[number].parent {
                rays[parent as usize].children.push(number as u32);
            }
        }
        let formats = &self.scales.formats;
        let work = |of: &dyn Fn(&ExplainedRay) -> u64, light: &dyn Fn(&ExplainedLight) -> u64| {
            rays.iter().map(|ray| of(ray) + ray.lights.iter().map(light).sum::<u64>()).sum()
        };
        let shadows = raw.rays.iter().map(|ray| ray.shadows.len() as u64).sum();
        PixelExplanation {
            schema: SCHEMA,
            scene: result_name(&self.job.scene),
            pixel,
            size: self.job.view.size.into(),
            profile: self.job.kernels.profile.name(),
            machine: self.job.machine_name.clone(),
            formats: formats.into(),
            instructions: raw.instructions,
            packets: work(&|ray| ray.packets, &|light| light.packets),
            triangles: work(&|ray| ray.triangles, &|light| light.triangles),
            machine_rays: by_kind(raw.rays.iter().map(|ray| ray.kind), shadows),
            reference_rays: by_kind(
                reference.iter().map(|ray| ray.kind),
                reference.iter().map(|ray| ray.lights.len() as u64).sum(),
            ),
            parted: rays.iter().find(|ray| ray.is_parted()).map(|ray| ray.number),
            colour: self.scales.vector(formats.colour, raw.colour, Some(colour)),
            rays,
            trap: raw.trap.clone(),
        }
    }

    /// The reference's rays, the camera's beginning where the machine's does: how far before the scene such a ray begins is a choice of either.
    fn at_origin(&self, raw: &RawPixel, reference: &[ReferenceRay]) -> Vec<ReferenceRay> {
        let mut rays = reference.to_vec();
        if let (Some(ray), Some(first)) = (raw.rays.first().filter(|ray| ray.is_searched), rays.first_mut()) {
            let origin = self.image.grid.scene(ray.origin);
            let along = dot(sub(origin, first.origin), first.direction);
            // A few steps of the grid are a rounding of the eye, which is to be seen.
            if along.abs() > ROUNDED_STEPS * self.image.grid.step() {
                first.origin = add(first.origin, scale(first.direction, along));
                if let Some(hit) = &mut first.hit {
                    hit.t -= along;
                }
            }
        }
        rays
    }

    fn ray(&self, number: usize, parent: Option<usize>, (raw, other): RayPair, sum: Option<Vec3>) -> ExplainedRay {
        let (scales, formats) = (&self.scales, &self.scales.formats);
        let kind = raw.map(|raw| raw.kind).or(other.map(|other| other.kind)).unwrap_or(RayKind::Camera);
        let colour = |raw: Option<[i32; 3]>, reference: Option<Vec3>| scales.vector(formats.colour, raw, reference);
        let sums = raw.and_then(|raw| raw.sums);
        let work = raw.map(|raw| raw.work).unwrap_or_default();
        ExplainedRay {
            number: number as u32,
            kind: kind.name(),
            parent: parent.map(|parent| parent as u32),
            children: Vec::new(),
            level: raw.map(|raw| raw.level).or(other.map(|other| other.level)).unwrap_or(0),
            step: raw.map(|raw| raw.steps.start),
            end: raw.map(|raw| raw.steps.end),
            weight: scales.number(formats.weight, raw.map(|raw| raw.weight), other.map(|other| other.weight)),
            // A camera ray past the scene's box has no origin that means anything.
            origin: scales.place(
                raw.filter(|raw| raw.is_searched || raw.level > 0).map(|raw| raw.origin),
                other.map(|other| other.origin),
            ),
            direction: scales.vector(
                formats.direction,
                raw.map(|raw| raw.direction),
                other.map(|other| other.direction),
            ),
            packets: work.packets,
            triangles: work.triangles,
            hit: self.hit(raw, other.and_then(|other| other.hit)),
            lights: self.lights(raw, other),
            local: colour(raw.and_then(|raw| raw.seen), other.map(|other| other.colour)),
            // The machine keeps sums alone, so its part is the difference of two.
            added: colour(
                sums.map(|[after, before]| [0, 1, 2].map(|k| after[k].wrapping_sub(before[k]))),
                other.map(|other| scale(other.colour, other.weight)),
            ),
            sum: colour(sums.map(|[after, _]| after), sum),
        }
    }

    fn hit(&self, raw: Option<&RawRay>, other: Option<ReferenceHit>) -> Option<ExplainedHit> {
        let (scales, formats) = (&self.scales, &self.scales.formats);
        let hit: Option<RawHit> = raw.and_then(|raw| raw.hit);
        let surface = raw.and_then(|raw| raw.surface);
        let triangle = hit.map(|hit| hit.triangle);
        // Name the machine's triangle, or the reference's where the machine has none
        let shown = triangle.or(other.map(|other| other.triangle))?;
        let number = self.job.scene.triangles.get(shown as usize)?.material;
        let material = self.job.scene.materials.get(number as usize)?;
        // Registers do not keep the weights, so they are computed from the ray and the triangle as it is stored.
        let met = raw.zip(triangle).and_then(|(raw, triangle)| self.weights([raw.origin, raw.direction], triangle));
        let weight = |k: usize, reference: Option<f64>| ComparedNumber::new(None, met.map(|met| met[k]), reference);
        Some(ExplainedHit {
            triangle,
            reference_triangle: other.map(|other| other.triangle),
            material: number,
            colour: material.colour,
            intensity: material.intensity,
            reflection: material.reflection,
            transmission: material.transmission(),
            index: material.index,
            t: scales.distance(hit.map(|hit| hit.t), other.map(|other| other.t)),
            u: weight(0, other.map(|other| other.u)),
            v: weight(1, other.map(|other| other.v)),
            point: scales.place(surface.map(|surface| surface.point), other.map(|other| other.point)),
            normal: scales.vector(
                formats.direction,
                surface.map(|surface| surface.facing),
                other.map(|other| other.normal),
            ),
        })
    }

    /// Weights of a triangle as it is stored where a ray meets it.
    fn weights(&self, ray: [[i32; 3]; 2], triangle: u32) -> Option<[f64; 2]> {
        let scene = &self.job.scene;
        let vertices = scene.triangles.get(triangle as usize)?.vertices;
        let place = |vertex: u32| {
            let vertex = scene.vertices[vertex as usize];
            scenes::image::stored_place(&self.image.grid, self.image.layout, vertex)
        };
        weights(ray, vertices.map(place))
    }

    fn lights(&self, raw: Option<&RawRay>, other: Option<&ReferenceRay>) -> Vec<ExplainedLight> {
        let (scales, formats) = (&self.scales, &self.scales.formats);
        // No ray is sent to a light behind the surface.
        let state = |is_sent: bool, is_hidden: bool| match (is_sent, is_hidden) {
            (false, _) => "away",
            (true, true) => "hidden",
            (true, false) => "lit",
        };
        let surface = raw.filter(|raw| raw.hit.is_some());
        let reference = other.filter(|other| other.hit.is_some());
        if surface.is_none() && reference.is_none() {
            return Vec::new();
        }
        // Pair what the machine and double precision know of each light
        let explained = |(number, light): (usize, &scenes::model::Light)| {
            let shadow: Option<&RawShadow> =
                raw.and_then(|raw| raw.shadows.iter().find(|shadow| shadow.light as usize == number));
            let seen: Option<&ReferenceLight> =
                other.and_then(|other| other.lights.iter().find(|light| light.light == number));
            let work = shadow.map(|shadow| shadow.work).unwrap_or_default();
            let blocker = shadow.and_then(|shadow| shadow.blocker);
            ExplainedLight {
                light: number as u32,
                state: surface.map(|_| state(shadow.is_some(), blocker.is_some())),
                reference_state: reference
                    .map(|_| state(seen.is_some(), seen.is_some_and(|seen| seen.blocker.is_some()))),
                colour: light.colour,
                cosine: scales.number(
                    formats.direction,
                    shadow.map(|shadow| shadow.cosine),
                    seen.map(|seen| seen.cosine),
                ),
                distance: scales.distance(shadow.map(|shadow| shadow.distance), seen.map(|seen| seen.distance)),
                direction: scales.vector(
                    formats.direction,
                    shadow.map(|shadow| shadow.ray[1]),
                    seen.map(|seen| seen.direction),
                ),
                step: shadow.map(|shadow| shadow.steps.start),
                packets: work.packets,
                triangles: work.triangles,
                blocker: blocker.map(|hit| Blocker { triangle: hit.triangle, t: scales.distance_value(hit.t) }),
                reference_blocker: seen.and_then(|seen| seen.blocker).map(|(triangle, t)| Blocker { triangle, t }),
            }
        };
        self.job.scene.lights.iter().enumerate().map(explained).collect()
    }
}

impl ExplainedRay {
    /// Machine and double precision decide otherwise here.
    fn is_parted(&self) -> bool {
        let is_alone = self.weight.raw.is_none() || self.weight.reference.is_none();
        let other_triangle = self.hit.as_ref().is_some_and(|hit| hit.triangle != hit.reference_triangle);
        is_alone || other_triangle || self.lights.iter().any(|light| light.state != light.reference_state)
    }
}

/// The ray whose child each of the reference's rays is: the last one before it that is one level up.
fn parents(rays: &[ReferenceRay]) -> Vec<Option<usize>> {
    let parent = |number: usize| rays[..number].iter().rposition(|ray| ray.level + 1 == rays[number].level);
    (0..rays.len()).map(parent).collect()
}

fn by_kind(kinds: impl Iterator<Item = RayKind>, shadow: u64) -> RaysByKind {
    let mut counts = RaysByKind { camera: 0, reflected: 0, refracted: 0, shadow };
    for kind in kinds {
        match kind {
            RayKind::Camera => counts.camera += 1,
            RayKind::Reflected => counts.reflected += 1,
            RayKind::Refracted => counts.refracted += 1,
        }
    }
    counts
}
