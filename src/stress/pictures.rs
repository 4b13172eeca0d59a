//! Whole pictures: the same at every scale and place, as the machine draws them, and as double precision has them.

use std::ops::Range;

use isa::number::{Modes, Vector};
use kernels::KernelSet;
use kernels::build::{Crop, SceneFeatures};
use kernels::twin;
use kernels::twin::samples::Samples;
use scenes::generate::{self, SCENES};
use scenes::image::{self, MemoryImage};
use scenes::metrics;
use scenes::model::{Material, Picture, Scene, View};
use scenes::reference::{Reference, SearchMethod};

use trials::series::Random;
use trials::tally::{TrialTally, tally, tally_in_turn};

use crate::drawing::{self, Comparison};
use crate::failure::Failure;
use crate::job::{Detail, Job};

/// Scenes that figures are quoted for.
pub const MEASURED: u64 = 5;

/// Powers of two by which scenes are scaled.
const SCALES: [i32; 21] =
    [-300, -299, -150, -64, -35, -34, -33, -10, -3, -2, -1, 1, 2, 3, 10, 29, 30, 31, 64, 150, 300];

/// A measured scene, coarse.
fn coarse(number: u64, size: (u32, u32)) -> Scene {
    let generator = &SCENES[number as usize];
    let level = generator.level.as_ref().map(|level| (*level.range.start()).max(1));
    let triangles = generator.triangles.as_ref().map(|_| 300);
    generate::scene(generator.name, &generate::GenerateOptions { level, triangles, size }).expect("a scene of the list")
}

/// The pixels that the kernels of the profile `ray` draw, by their native twin.
fn drawn(scene: &Scene, view: &View) -> Result<(MemoryImage, Vec<Vector>), String> {
    let refused = |report: messages::Report| report.render(false);
    let image = image::build(scene, view, &image::MemoryOptions::default()).map_err(refused)?;
    let features = SceneFeatures::new(scene, view, &image.formats, &kernels::KernelOptions::default());
    let (width, height) = view.size;
    let crop = Crop { column: 0, row: 0, width, height };
    let pixels = twin::render(&image, &features, &crop, KernelSet::Ray, Modes::default()).map_err(|f| f.to_string())?;
    Ok((image, pixels))
}

/// The picture in double precision, decided on edges as by the kernels.
fn exact(scene: &Scene, view: &View, image: &MemoryImage) -> Result<Picture, String> {
    let reference = Reference::new(scene, view, SearchMethod::Hierarchy).map_err(|report| report.render(false))?;
    Ok(reference.picture(Some(&Samples::new(scene, image, KernelSet::Ray, Modes::default()))).picture)
}

fn compare(scene: &Scene, other: &Scene) -> Result<f64, String> {
    let (_, one) = drawn(scene, &View::new(scene.size))?;
    let (_, two) = drawn(other, &View::new(other.size))?;
    let different = one.iter().zip(&two).filter(|(a, b)| a != b).count();
    if different == 0 { Ok(0.0) } else { Err(format!("{}: {different} pixels differ", scene.name)) }
}

fn moved(scene: &Scene, change: impl Fn([f64; 3]) -> [f64; 3]) -> Scene {
    let mut scene = scene.clone();
    scene.vertices.iter_mut().for_each(|vertex| *vertex = change(*vertex));
    scene.lights.iter_mut().for_each(|light| light.position = change(light.position));
    scene
}

/// A scene 2^-300 to 2^300 times as large: the same picture, bit for bit.
pub fn scales(_: u64, trials: Range<u64>) -> TrialTally {
    tally(trials, |trial| {
        let scene = coarse(trial % MEASURED, (12, 9));
        let exponent = SCALES[(trial / MEASURED) as usize % SCALES.len()];
        let factor = f64::from(exponent).exp2();
        compare(&scene, &moved(&scene, |point| point.map(|x| x * factor)))
            .map_err(|text| format!("2^{exponent}: {text}"))
    })
}

/// A scene moved by whole steps of the grid: the same picture, bit for bit.
pub fn translations(seed: u64, trials: Range<u64>) -> TrialTally {
    tally(trials, |trial| {
        let scene = coarse(trial % MEASURED, (16, 12));
        let view = View::new(scene.size);
        let grid =
            image::build(&scene, &view, &image::MemoryOptions::default()).map_err(|report| report.render(false))?.grid;
        // On the grid first, so that moving does not round.
        let scene = moved(&scene, |point| grid.scene(grid.raw(point)));
        let step = grid.step();
        // Steps of the grid are powers of two, so this sum of two doubles is exact.
        let by = Random::new(seed, trial).point(1 << 28).map(|steps| f64::from(steps) * step);
        compare(&scene, &moved(&scene, |point| std::array::from_fn(|k| point[k] + by[k])))
            .map_err(|text| format!("moved by {by:?}: {text}"))
    })
}

/// Pictures that the machine draws, in the emulator, against the native twins that the other cases rely on.
pub fn kernels(_: u64, trials: Range<u64>) -> TrialTally {
    tally_in_turn(trials, |trial| {
        let scene = coarse(trial % MEASURED, (16, 12));
        let mut job = Job::new(scene);
        job.view = View::new(job.scene.size);
        job.kernels.profile = KernelSet::Ray;
        job.detail = Detail::Totals;
        let drawing = drawing::draw(&job, Comparison::None, &mut |_| {}).map_err(|failure| match failure {
            Failure::Message { report, .. } => report.render(false),
            Failure::ClosedPipe => "nobody reads".into(),
        })?;
        let (_, pixels) = drawn(&job.scene, &job.view)?;
        let different = pixels.iter().zip(&drawing.words).filter(|(a, b)| a != b).count();
        if different == 0 { Ok(0.0) } else { Err(format!("{}: {different} pixels differ", job.scene.name)) }
    })
}

/// Five bounces: the largest difference of a component from double precision, in steps of 1/255.
pub fn bounces(_: u64, trials: Range<u64>) -> TrialTally {
    tally(trials, |trial| {
        let scene = coarse(trial % MEASURED, (40, 30));
        let view = View::new(scene.size);
        let (image, pixels) = drawn(&scene, &view)?;
        let exact = exact(&scene, &view, &image)?;
        let error = metrics::compare(&picture(&image, &pixels), &exact).ok_or("pictures of two sizes")?;
        Ok(error.max * 255.0)
    })
}

fn picture(image: &MemoryImage, pixels: &[Vector]) -> Picture {
    let step = (-f64::from(image.formats.colour)).exp2();
    Picture { size: image.size, pixels: pixels.iter().map(|pixel| pixel.map(|raw| f64::from(raw) * step)).collect() }
}

/// Lights so bright that colours leave their format: they end at the largest number, none wraps. The largest difference from double precision,
/// clamped to that number, in steps of 1/255 of it.
pub fn colours(_: u64, trials: Range<u64>) -> TrialTally {
    tally(trials, |trial| {
        // The terrain has neither mirrors nor glass, so that nothing is weighted after it has saturated.
        let mut scene = coarse(4, (40, 30));
        // White and matt, so that sums saturate where the picture does.
        let white = Material { colour: [1.0; 3], reflection: 0.0, intensity: 1.0, index: 0.0 };
        scene.materials.fill(white);
        let light = scene.lights[0];
        scene.lights = vec![light; 2 + trial as usize % 6];
        let view = View { ambient: 0.4, ..View::new(scene.size) };
        let mut options = image::MemoryOptions::default();
        options.formats.colour = Some(30);
        let image = image::build(&scene, &view, &options).map_err(|report| report.render(false))?;
        let features = SceneFeatures::new(&scene, &view, &image.formats, &kernels::KernelOptions::default());
        let crop = Crop { column: 0, row: 0, width: 40, height: 30 };
        let pixels = twin::render(&image, &features, &crop, KernelSet::Ray, Modes::default());
        let pixels = picture(&image, &pixels.map_err(|failure| failure.to_string())?).pixels;
        let exact = exact(&scene, &view, &image)?.pixels;
        let differences = pixels.iter().flatten().zip(exact.iter().flatten()).map(|(a, b)| (a - b.min(2.0)).abs());
        Ok(differences.fold(0.0, f64::max) * 255.0 / 2.0)
    })
}
