//! From a job to a picture: memory image, programs, the run of the machine, the picture in its frame, and the reference
//! that it is measured against.

use std::borrow::Cow;
use std::time::{Duration, Instant};

use emu::code::Code;
use emu::engine::Choice;
use emu::machine::{self, RunOutcome};
use emu::profile::{Profile, ProfileLevel};
use kernels::build::{Build, Crop};
use kernels::twin::samples::Samples;
use messages::{Diagnostic, Report};
use rayon::prelude::*;
use scenes::image::{MemoryImage, MemoryKind};
use scenes::layout::PIXEL;
use scenes::metrics::{self, PictureError};
use scenes::model::{Camera, Picture};
use scenes::reference::{Reference, SearchMethod};

use crate::failure::Failure;
use crate::job::{Detail, Job};
use crate::load::Load;
use crate::protection::StoredWords;
use crate::result::{self, Loss};

/// Use of the double-precision reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
    /// The picture is measured against it.
    Reference,
    /// No reference is computed, which saves its time.
    None,
}

/// Number of each pixel that a heat map shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum HeatOf {
    /// Elementary operations.
    #[default]
    Operations,
    /// Clocks from its first message to its end.
    Clocks,
    /// Clocks of those in which its core waited for transfers.
    Waits,
    /// Octets that were moved.
    Octets,
    /// Instructions.
    Instructions,
}

/// Times that the host took.
#[derive(Clone, Copy, Debug, Default)]
pub struct Times {
    /// For tree, memory image and programs.
    pub build: Duration,
    /// For the machine.
    pub run: Duration,
    /// For the reference, beside the machine.
    pub reference: Duration,
}

/// A picture that was drawn, and all that is known about how.
#[derive(Clone, Debug)]
pub struct Drawing {
    /// The scene in memory; its octets have moved into the frame's memory.
    pub image: MemoryImage,
    /// The programs.
    pub build: Build,
    /// Outcome of the run on the machine.
    pub frame: RunOutcome,
    /// The part that was drawn; pictures have its size.
    pub crop: Crop,
    /// The colours, raw.
    pub words: Vec<[i32; 3]>,
    /// The colours, linear.
    pub picture: Picture,
    /// The drawn part in double precision.
    pub reference: Option<Picture>,
    /// Engine that executed the cores' program, and why nothing faster did.
    pub engine: Choice,
    /// Difference from double precision.
    pub error: Option<PictureError>,
    /// Losses of results, where they were counted.
    pub flags: Option<Vec<Loss>>,
    /// Likely mistakes in the user's kernels.
    pub warnings: Report,
    /// Host times.
    pub times: Times,
}

/// A warning where no camera ray meets a triangle, with the reason where it is known.
///
/// # Errors
/// See [`Reference::new`].
fn unseen(job: &Job, crop: &Crop, words: &[[i32; 3]]) -> Result<Option<Diagnostic>, Report> {
    let (scene, view) = (&job.scene, &job.view);
    // A picture of several colours shows something, and a part of one may well show nothing.
    let is_whole = (crop.width, crop.height) == view.size;
    // A scene without triangles has been told where it was read.
    if scene.triangles.is_empty() || !is_whole || words.iter().any(|colour| colour != &words[0]) {
        return Ok(None);
    }
    let reference = Reference::new(scene, view, SearchMethod::Hierarchy)?;
    let is_met = |row: u32| (0..crop.width).any(|column| reference.is_met(column, row));
    if (0..crop.height).into_par_iter().any(is_met) {
        return Ok(None);
    }
    let warning = Diagnostic::warning("no camera ray meets anything: the picture shows the background alone");
    // A scene seen edge-on has nothing to meet from there, and gets a view that shows it; else the box tells where to look.
    let (low, high) = scene.bounds().unwrap_or_default();
    let hint = match &view.camera {
        Camera::Orthographic if low[0] == high[0] || low[1] == high[1] => {
            let side = if low[0] == high[0] { "width" } else { "height" };
            let size = [0, 1, 2].map(|k| high[k] - low[k]).into_iter().fold(0.0, f64::max);
            let [x, y, z] = high.map(|x| x + if size > 0.0 { size } else { 1.0 });
            format!(
                "the scene is seen edge-on: it has no {side}; another view is --camera perspective --eye {x},{y},{z}"
            )
        }
        _ => format!(
            "the scene lies between ({}, {}, {}) and ({}, {}, {})",
            low[0], low[1], low[2], high[0], high[1], high[2]
        ),
    };
    Ok(Some(warning.hint(hint)))
}

/// Draws a picture and measures it against double precision.
///
/// # Errors
/// See [`draw`].
pub fn render(job: &Job) -> Result<Drawing, Failure> {
    draw(job, Comparison::Reference, &mut |_| {})
}

/// Draws a picture. `progress` is told the number of pixels that are done.
///
/// # Errors
/// A scene that does not fit its formats, errors in the user's kernels, a machine out of its ranges, a trap.
pub fn draw(job: &Job, comparison: Comparison, progress: &mut dyn FnMut(u64)) -> Result<Drawing, Failure> {
    let start = Instant::now();
    // Build tree, memory image and programs, and the reference's hierarchy.
    let (load, image) = Load::picture(job)?;
    let reference = match comparison {
        Comparison::Reference => Some(Reference::new(&job.scene, &job.reference_view(), SearchMethod::Hierarchy)?),
        Comparison::None => None,
    };
    let crop = load.build.crop;
    let built = Instant::now();
    // Run the machine, with the reference beside it on a thread of its own.
    let profile = match job.detail {
        Detail::Totals => ProfileLevel::None,
        Detail::Functions => ProfileLevel::Totals,
        Detail::Clocks | Detail::Course => ProfileLevel::Clocks,
        Detail::Extremes => ProfileLevel::Extremes,
    };
    let (has_losses, has_course, engine) = (job.flags, job.detail == Detail::Course, job.engine);
    let options = machine::RunOptions {
        profile,
        has_items: true,
        has_losses,
        has_course,
        engine,
        ..machine::RunOptions::default()
    };
    let setup = load.setup(&job.machine, options);
    let engine = setup.engine();
    let samples = Samples::new(&job.scene, &image, job.kernels.profile, job.machine.arithmetic.modes());
    let (frame, reference) = std::thread::scope(|scope| {
        let beside = scope.spawn(|| reference.as_ref().map(|reference| timed(|| part(reference, &samples, &crop))));
        let frame = timed(|| emu::run(&setup, load.memory.clone(), progress));
        (frame, beside.join().expect("the reference does not panic"))
    });
    let (frame, run) = frame;
    let mut frame = frame?;
    // Totals of functions take time while running; without them only exclusive counts are known.
    if profile == ProfileLevel::None {
        let code = |program| Code::new(program, &load.isa, job.machine.timing());
        frame.profile = Some(Profile::exclusive(&code(&load.build.cores), &frame.tally));
        frame.main_profile = Some(Profile::exclusive(&code(&load.build.main), &frame.main_tally));
    }
    let (reference, reference_time) = reference.map_or((None, Duration::ZERO), |(picture, time)| (Some(picture), time));
    // Read the picture out of global memory and measure it.
    let words = colour_words(&image, &frame, &crop);
    let picture = picture(&image, &words, (crop.width, crop.height));
    let error = reference.as_ref().and_then(|reference| metrics::compare(&picture, reference));
    let flags = job.flags.then(|| {
        let code = Code::new(&load.build.cores, &load.isa, job.machine.timing());
        result::losses(&code, &frame.tally)
    });
    let build = load.build;
    let mut warnings = build.warnings.clone();
    warnings.0.extend(unseen(job, &crop, &words)?);
    let times = Times { build: built - start, run, reference: reference_time };
    Ok(Drawing { image, build, frame, crop, words, picture, reference, engine, error, flags, warnings, times })
}

fn timed<T>(work: impl FnOnce() -> T) -> (T, Duration) {
    let start = Instant::now();
    let result = work();
    (result, start.elapsed())
}

/// The part of the reference picture that is drawn.
pub(crate) fn part(reference: &Reference, samples: &Samples, crop: &Crop) -> Picture {
    let row = |row: u32| -> Vec<_> {
        (0..crop.width).map(|column| reference.pixel(crop.column + column, crop.row + row, Some(samples)).0).collect()
    };
    let rows: Vec<Vec<_>> = (0..crop.height).into_par_iter().map(row).collect();
    Picture { size: (crop.width, crop.height), pixels: rows.into_iter().flatten().collect() }
}

/// Octets of the drawn part in the frame, where it lies row by row from its start.
pub(crate) fn colour_octets<'f>(image: &MemoryImage, frame: &'f RunOutcome, crop: &Crop) -> Cow<'f, [u8]> {
    let start = image.region(MemoryKind::Frame).start;
    let octets = frame.memory.slice(start, crop.width * crop.height * PIXEL.octets());
    octets.expect("the image has a frame for the whole picture")
}

/// The colours in the frame.
pub(crate) fn colour_words(image: &MemoryImage, frame: &RunOutcome, crop: &Crop) -> Vec<[i32; 3]> {
    let octets = colour_octets(image, frame, crop);
    let word = |octets: &[u8], at: usize| i32::from_le_bytes(std::array::from_fn(|k| octets[4 * at + k]));
    octets.chunks_exact(PIXEL.octets() as usize).map(|pixel| std::array::from_fn(|k| word(pixel, k))).collect()
}

/// The picture in the frame.
pub(crate) fn read(image: &MemoryImage, frame: &RunOutcome, crop: &Crop) -> Picture {
    picture(image, &colour_words(image, frame, crop), (crop.width, crop.height))
}

/// The colours as numbers, from raw words.
pub(crate) fn picture(image: &MemoryImage, words: &[[i32; 3]], size: (u32, u32)) -> Picture {
    let scale = (-f64::from(image.formats.colour)).exp2();
    Picture { size, pixels: words.iter().map(|colour| colour.map(|raw| f64::from(raw) * scale)).collect() }
}

impl Drawing {
    /// Words of the programs and octets of global memory.
    pub fn stored_words(&self) -> StoredWords {
        StoredWords {
            program: self.build.cores.words.len() as u64,
            main_program: self.build.main.words.len() as u64,
            memory_octets: self.frame.memory.size() as u64,
        }
    }

    /// Pixels that had no ray of their own.
    pub fn interpolated(&self) -> u64 {
        (self.words.len() - self.frame.items.len()) as u64
    }

    /// Elementary operations of each pixel, row 0 first.
    pub fn operations(&self) -> Vec<u64> {
        self.heat(HeatOf::Operations)
    }

    /// Number of each pixel, row 0 first; 0 for pixels that were interpolated.
    pub fn heat(&self, of: HeatOf) -> Vec<u64> {
        let mut heat = vec![0; self.words.len()];
        for item in &self.frame.items {
            // The first component of a work item's message is the number of its pixel.
            if let Some(pixel) = usize::try_from(item.subject[0]).ok().and_then(|at| heat.get_mut(at)) {
                *pixel += match of {
                    HeatOf::Operations => item.elementary,
                    HeatOf::Clocks => (item.end - item.start).0,
                    HeatOf::Waits => item.waiting.0,
                    HeatOf::Octets => item.octets.0,
                    HeatOf::Instructions => item.instructions,
                };
            }
        }
        heat
    }

    /// The difference of each pixel from the reference, where there is one.
    pub fn differences(&self) -> Option<Vec<f64>> {
        metrics::error_map(&self.picture, self.reference.as_ref()?)
    }
}
