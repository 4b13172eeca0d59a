//! Camera rays of a picture, searched by the kernels' functions and on exact integers over the same rounded scene: the error of the formats
//! alone.

use isa::number::ray::{self as exact, TriangleEnd};
use isa::number::{Modes, Vector};
use kernels::build::{Crop, SceneFeatures};
use kernels::set::{Decisions, Formulas};
use kernels::twin::planes::Packets;
use kernels::twin::ray::{TwinRay, TwinSearch};
use kernels::twin::surface::normal;
use kernels::twin::{Twin, report};
use rayon::prelude::*;
use scenes::image::MemoryImage;
use schemars::JsonSchema;
use serde::Serialize;

use crate::job::Job;

/// Errors of the camera rays' hits. Units in the last place (ulp) are those of the quantity's format; null where no ray hits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct RayErrors {
    /// Rays that find another triangle than exact integers do, or none, or one where there is none, per million.
    pub misclassified_per_million: f64,
    /// Error of the distance that 99 of 100 hits stay below, ulp.
    pub t_p99: Option<f64>,
    /// Largest error of the distance, ulp.
    pub t_max: Option<f64>,
    /// Error of u that 99 of 100 hits stay below, ulp; null for kernels that decide by signs and never compute it.
    pub u_p99: Option<f64>,
    /// Largest error of u, ulp.
    pub u_max: Option<f64>,
    /// Error of v that 99 of 100 hits stay below, ulp; null as u.
    pub v_p99: Option<f64>,
    /// Largest error of v, ulp.
    pub v_max: Option<f64>,
    /// Error of a component of the normal that 99 of 100 hits stay below, ulp.
    pub normal_p99: Option<f64>,
    /// Largest error of a component of the normal, ulp.
    pub normal_max: Option<f64>,
}

/// Outcome of a ray.
struct RayOutcome {
    is_right: bool,
    /// Errors of t, u, v and of the normal, of a hit that both find; not a number where the kernels do not compute it.
    errors: Option<[f64; 4]>,
}

impl RayErrors {
    /// Measures the camera rays of the drawn part of a job's picture on the image that was built for it.
    pub fn new(image: &MemoryImage, job: &Job, crop: &Crop) -> RayErrors {
        let (profile, modes) = (job.kernels.profile, job.machine.arithmetic.modes());
        let features = SceneFeatures::new(&job.scene, &job.view, &image.formats, &kernels::KernelOptions::default());
        let twin = Twin::new(image, &features, profile, modes).expect("an image that was built can be read");
        // Trace all camera rays on the native twin, and decide each again exactly.
        let ended: Vec<RayOutcome> = (0..crop.width * crop.height)
            .into_par_iter()
            .map(|pixel| end(&twin, &twin.camera_ray(crop.column + pixel % crop.width, crop.row + pixel / crop.width)))
            .collect();
        let wrong = ended.iter().filter(|ray| !ray.is_right).count();
        // Sort each kind of error, without those of quantities that the kernels do not compute.
        let errors = |which: usize| {
            let all = ended.iter().filter_map(|ray| ray.errors).map(|errors| errors[which]);
            let mut errors: Vec<f64> = all.filter(|error| !error.is_nan()).collect();
            errors.sort_by(f64::total_cmp);
            errors
        };
        let [t, u, v, normals] = [0, 1, 2, 3].map(errors);
        let p99 = |errors: &[f64]| errors.get((errors.len() * 99 / 100).min(errors.len().saturating_sub(1))).copied();
        RayErrors {
            misclassified_per_million: wrong as f64 * 1e6 / ended.len().max(1) as f64,
            t_p99: p99(&t),
            t_max: t.last().copied(),
            u_p99: p99(&u),
            u_max: u.last().copied(),
            v_p99: p99(&v),
            v_max: v.last().copied(),
            normal_p99: p99(&normals),
            normal_max: normals.last().copied(),
        }
    }

    /// Errors over several shifts: the mean of the misclassified, of all others the largest.
    pub fn worst<'a>(shifts: impl Iterator<Item = &'a RayErrors> + Clone) -> RayErrors {
        let largest = |part: fn(&RayErrors) -> Option<f64>| shifts.clone().filter_map(part).reduce(f64::max);
        let wrong: f64 = shifts.clone().map(|rays| rays.misclassified_per_million).sum();
        RayErrors {
            misclassified_per_million: wrong / shifts.clone().count().max(1) as f64,
            t_p99: largest(|rays| rays.t_p99),
            t_max: largest(|rays| rays.t_max),
            u_p99: largest(|rays| rays.u_p99),
            u_max: largest(|rays| rays.u_max),
            v_p99: largest(|rays| rays.v_p99),
            v_max: largest(|rays| rays.v_max),
            normal_p99: largest(|rays| rays.normal_p99),
            normal_max: largest(|rays| rays.normal_max),
        }
    }
}

fn end(twin: &Twin<Modes>, ray: &TwinRay) -> RayOutcome {
    let mut search = TwinSearch { t: twin.constants.never, triangle: None, takes_any: false };
    // A walk that does not end finds nothing and counts as wrong.
    let is_stuck = twin.camera_packet(ray).is_some_and(|first| twin.trace(ray, first, &mut search).is_err());
    let expected = nearest(twin, ray);
    let errors = match (search.triangle, expected) {
        (Some(found), Some((t, index))) if found == index => {
            let [u, v] = barycentric_errors(twin, ray, index);
            Some([(f64::from(search.t) - t).abs(), u, v, normal_error(twin, ray.direction, index)])
        }
        _ => None,
    };
    RayOutcome { is_right: !is_stuck && search.triangle == expected.map(|(_, index)| index), errors }
}

/// The nearest hit by exact decisions: t in units of its last place, and the triangle; of equally near ones the lowest index.
fn nearest(twin: &Twin<Modes>, ray: &TwinRay) -> Option<(f64, u32)> {
    let stage = &twin.stage;
    let ray = exact::Ray { origin: ray.origin, direction: ray.direction };
    // t is a quotient of integers; this makes it units in the last place.
    let scale = f64::from(twin.constants.along()).exp2();
    let packets = Packets::new(&stage.nodes, &stage.bounds, ray);
    let indices = packets.flat_map(|packet| &stage.references[packet.start as usize..packet.end as usize]);
    let hits = indices.filter_map(|&index| {
        let met = exact::triangle(&ray, &stage.triangles[index as usize].vertices);
        // Rounded to a unit, as the kernels do, so that ties are the same ones.
        (met.end == TriangleEnd::Hit).then(|| (met.t as f64 / met.determinant as f64 * scale, index))
    });
    hits.min_by(|a, b| (a.0 + 0.5).floor().total_cmp(&(b.0 + 0.5).floor()).then(a.1.cmp(&b.1)))
}

/// Errors of u and v of a hit, each not a number where the kernels do not compute it.
fn barycentric_errors(twin: &Twin<Modes>, ray: &TwinRay, index: u32) -> [f64; 2] {
    let vertices = &twin.stage.triangles[index as usize].vertices;
    let met = exact::triangle(&exact::Ray { origin: ray.origin, direction: ray.direction }, vertices);
    let bits = twin.constants.formats.barycentric;
    let computed = match twin.profile.decisions() {
        Decisions::Rounded => report::barycentric(&twin.arithmetic, &twin.constants, ray, vertices).map(f64::from),
        Decisions::Wide => [f64::NAN; 2],
        Decisions::Exact => [met.u, met.v].map(|x| f64::from(exact::ratio(&twin.arithmetic, x, met.determinant, bits))),
    };
    let expected = [met.u, met.v].map(|x| x as f64 / met.determinant as f64 * f64::from(bits).exp2());
    [0, 1].map(|k| (computed[k] - expected[k]).abs())
}

/// The largest error of a component of a triangle's unit normal.
fn normal_error(twin: &Twin<Modes>, direction: Vector, index: u32) -> f64 {
    let bits = twin.constants.formats.direction;
    let vertices = &twin.stage.triangles[index as usize].vertices;
    let facing = match twin.profile.formulas() {
        Formulas::Printed => report::normal(&twin.arithmetic, bits, vertices),
        Formulas::Vector => normal(&twin.arithmetic, bits, direction, vertices).0,
    };
    // The exact normal is the cross product of the edges, in 128 bits; only its length is rounded.
    let [a, b, c] = vertices.map(|vertex| vertex.map(i128::from));
    let (e, f): ([i128; 3], [i128; 3]) = (std::array::from_fn(|k| b[k] - a[k]), std::array::from_fn(|k| c[k] - a[k]));
    let exact = [0, 1, 2].map(|k| (e[(k + 1) % 3] * f[(k + 2) % 3] - e[(k + 2) % 3] * f[(k + 1) % 3]) as f64);
    let length = exact.iter().map(|x| x * x).sum::<f64>().sqrt();
    let one = f64::from(bits).exp2();
    // A normal at right angles to the ray may be turned either way; the report's is not turned yet.
    let error =
        |turn: f64| (0..3).map(|k| (f64::from(facing[k]) - turn * exact[k] / length * one).abs()).fold(0.0, f64::max);
    error(1.0).min(error(-1.0))
}
