//! Rays a second of one core and its memory (6.3), of another machine, of the report's figures, and counted.

use kernels::annex::{cores, printed};
use schemars::JsonSchema;
use serde::Serialize;

use super::figures::Pixel;
use super::scene::OnScene;
use super::{Measurement, figures::Derived};

/// Searches for a hit that the report charges a node of the ray tree: along the reflected ray, along the refracted one, towards the light.
const SEARCHES: f64 = 3.0;
/// Nodes that it counts a pixel.
const NODES: f64 = 22.0;
/// Cores of its machine.
const CORES: f64 = 4.0;

/// A core: rays that it follows, and memory inside it.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct CoreRate {
    /// The machine, or what was drawn on ours.
    pub name: String,
    /// Place in the report, empty for our own figures.
    pub source: String,
    /// Rays a second of one core, least and most.
    pub rays_per_second: [f64; 2],
    /// Octets of memory inside it; null where nothing is said.
    pub memory_octets: Option<f64>,
}

/// Rays a second of one of so many cores that follow some rays in so many seconds together.
fn rate(rays: f64, seconds: f64, cores: f64) -> [f64; 2] {
    [rays / (seconds * cores); 2]
}

/// The cores that the report names, its own by its figures, ours for the pixel of 22 nodes and on scenes.
pub fn core_rates(measured: &[Measurement], derived: &[Derived], scenes: &[OnScene]) -> Vec<CoreRate> {
    let named = cores().iter().map(|core| CoreRate {
        name: core.name.clone(),
        source: core.source.clone(),
        rays_per_second: core.rays_per_second,
        memory_octets: Some(core.memory_octets as f64),
    });
    let proposed = printed("pixel_time").map(|milliseconds| CoreRate {
        name: "proposed".to_owned(),
        source: "6.1, 6.2".to_owned(),
        rays_per_second: rate(SEARCHES * NODES, milliseconds * 1e-3, CORES),
        memory_octets: printed("buffer.total"),
    });
    let buffer = derived.iter().find(|derived| derived.figure.id == "buffer.total").map(|derived| derived.counted);
    let searches = measured.iter().find(|measurement| measurement.row.id == "rt.pixel").map(|pixel| pixel.searches);
    let counted = Pixel::of(measured).zip(searches).map(|((pixel, _), searches)| CoreRate {
        name: "counted, 22 nodes".to_owned(),
        source: String::new(),
        rays_per_second: rate(searches as f64, pixel.microseconds() * 1e-6, CORES),
        memory_octets: buffer,
    });
    let on_scenes = scenes.iter().map(|scene| CoreRate {
        name: scene.scene.clone(),
        source: String::new(),
        rays_per_second: rate(scene.rays as f64, scene.seconds(), f64::from(scene.cores)),
        memory_octets: Some(scene.buffer_octets as f64),
    });
    named.chain(proposed).chain(counted).chain(on_scenes).collect()
}
