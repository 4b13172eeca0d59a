//! Run time against error: pictures in many arithmetics, profiles and layouts, each measured against double precision, and its camera rays
//! against exact integers on the same grid, so that what the formats cost and what the scene's rounding costs are told apart.

#[cfg(feature = "cli")]
mod chart;
mod front;
mod rays;
mod similarity;

use std::fmt;
use std::time::Instant;

use isa::number::Quantization;
use kernels::KernelSet;
use kernels::twin::samples::Samples;
use scenes::layout::Layout;
use scenes::metrics::{self, PictureError};
use scenes::model::{Picture, Scene, View};
use scenes::reference::{Reference, SearchMethod};
use schemars::JsonSchema;
use serde::Serialize;

use crate::drawing::{self, Comparison};
use crate::energy::{EnergyResult, EnergySummary};
use crate::failure::Failure;
use crate::job::{Detail, Job};
use crate::result::{ByClass, Render};
use crate::settings::TreeSettings;
#[cfg(feature = "cli")]
pub use chart::{CostAxis, figure};
pub use front::rank;
pub use rays::RayErrors;

/// Settings of one picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variant {
    /// Set of kernels.
    pub profile: KernelSet,
    /// Bits of a word.
    pub word: u32,
    /// Rounding mode.
    pub rounding: Quantization,
    /// Structures of global memory.
    pub layout: Layout,
    /// Levels of secondary rays.
    pub bounces: u32,
    /// Weight that a secondary ray must exceed.
    pub cutoff: f64,
    /// Difference up to which corners agree, so that a pixel between them is interpolated; `None` when every pixel has its ray.
    pub interpolate: Option<f64>,
}

impl Variant {
    /// The variant with other kernels, those that were made for a layout in that.
    fn with(self, profile: KernelSet) -> Variant {
        let layout = match profile.layout() {
            own @ (Layout::Report | Layout::Packet | Layout::Packed) => own,
            Layout::Wide => self.layout,
        };
        Variant { profile, layout, ..self }
    }
}

impl fmt::Display for Variant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.profile, self.word)?;
        if self.rounding != Quantization::Rnd {
            write!(f, " {}", self.rounding)?;
        }
        if self.layout != self.profile.layout() {
            write!(f, " {}", self.layout.name())?;
        }
        if self.bounces != BOUNCES {
            write!(f, " bounces {}", self.bounces)?;
        }
        if self.cutoff != 0.0 {
            write!(f, " cutoff {}", self.cutoff)?;
        }
        if let Some(difference) = self.interpolate {
            write!(f, " interpolated {difference}")?;
        }
        Ok(())
    }
}

/// Levels of secondary rays where nothing else is said.
const BOUNCES: u32 = 5;

/// The values that are tried of each setting. The first one of each list is the base.
#[derive(Clone, Debug)]
pub struct Choices {
    /// Sets of kernels.
    pub profiles: Vec<KernelSet>,
    /// Bits of a word.
    pub words: Vec<u32>,
    /// Rounding modes.
    pub roundings: Vec<Quantization>,
    /// Layouts.
    pub layouts: Vec<Layout>,
    /// Levels of secondary rays.
    pub bounces: Vec<u32>,
    /// Weights that a secondary ray must exceed.
    pub cutoffs: Vec<f64>,
    /// Differences up to which corners agree.
    pub interpolate: Vec<Option<f64>>,
}

impl Choices {
    /// Every profile in every word (that of the report in its own layout), and for each further value of another setting the base profile in
    /// every word; `None` without a value of some setting.
    pub fn variants(&self) -> Option<Vec<Variant>> {
        let base = Variant {
            profile: *self.profiles.first()?,
            word: *self.words.first()?,
            rounding: *self.roundings.first()?,
            layout: *self.layouts.first()?,
            bounces: *self.bounces.first()?,
            cutoff: *self.cutoffs.first()?,
            interpolate: *self.interpolate.first()?,
        };
        let mut kinds: Vec<Variant> = self.profiles.iter().map(|&profile| base.with(profile)).collect();
        kinds.extend(self.roundings[1..].iter().map(|&rounding| Variant { rounding, ..base }));
        kinds.extend(self.layouts[1..].iter().map(|&layout| Variant { layout, ..base }));
        kinds.extend(self.bounces[1..].iter().map(|&bounces| Variant { bounces, ..base }));
        kinds.extend(self.cutoffs[1..].iter().map(|&cutoff| Variant { cutoff, ..base }));
        kinds.extend(self.interpolate[1..].iter().map(|&interpolate| Variant { interpolate, ..base }));
        Some(kinds.iter().flat_map(|&kind| self.words.iter().map(move |&word| Variant { word, ..kind })).collect())
    }
}

/// A variant on a scene.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct MeasuredVariant {
    /// Name of the scene.
    pub scene: String,
    /// The variant in words.
    pub variant: String,
    /// Set of kernels.
    pub profile: &'static str,
    /// Bits of a word.
    pub word: u32,
    /// Rounding mode.
    pub rounding: &'static str,
    /// Structures of global memory.
    pub layout: &'static str,
    /// Levels of secondary rays.
    pub bounces: u32,
    /// Weight that a secondary ray must exceed.
    pub cutoff: f64,
    /// Difference up to which corners agree, so that a pixel between them is interpolated; null when every pixel has its ray.
    pub interpolate: Option<f64>,
    /// Bits of a word and fraction bits of each quantity.
    pub formats: crate::result::FormatTable,
    /// The picture against double precision with five bounces and no cut-off.
    pub error: PictureError,
    /// Structural similarity of both pictures as screens show them, 1 for equal ones.
    pub ssim: Option<f64>,
    /// The picture against double precision over the vertices as they are stored: the error without that of rounding the mesh.
    pub stored_error: PictureError,
    /// Camera rays against exact integers.
    pub rays: RayErrors,
    /// Clocks of the frame, a pixel.
    pub clocks: f64,
    /// Operations of all cores.
    pub operations: ByClass,
    /// Instructions of all cores, a pixel.
    pub instructions: f64,
    /// Octets that the cores moved, a pixel.
    pub octets: f64,
    /// Energy and area, as a range over published tables.
    pub energy: EnergySummary,
    /// Nanoseconds of the host a pixel; only when asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub host_nanoseconds: Option<f64>,
    /// True where no other variant of the scene beats it.
    pub is_on_front: bool,
    /// A variant of the scene that takes no more clocks, has no larger error and is better in one of them; null for one on the front.
    pub dominated_by: Option<String>,
}

/// Draws a scene in a variant and measures it against `reference`, that view of the scene in double precision.
///
/// # Errors
/// A scene that does not fit the formats, or a trap.
pub fn measure(
    scene: &Scene,
    view: &View,
    reference: &Reference,
    variant: &Variant,
    tree: &TreeSettings,
    has_times: bool,
) -> Result<MeasuredVariant, Failure> {
    // Draw the variant.
    let mut job = Job::new(scene.clone());
    job.view = View { bounces: variant.bounces, ..view.clone() };
    job.kernels.profile = variant.profile;
    job.kernels.weight_cutoff = variant.cutoff;
    job.kernels.interpolate = variant.interpolate;
    job.layout = Some(variant.layout);
    tree.choose(&mut job);
    job.machine.arithmetic.word = variant.word;
    job.machine.arithmetic.quantization = variant.rounding;
    job.detail = Detail::Totals;
    let start = Instant::now();
    let mut drawing = drawing::draw(&job, Comparison::None, &mut |_| {})?;
    let host = start.elapsed();
    // Measure it against the scene as it was given, and against the vertices that the format could hold: the difference is the cost of rounding the mesh.
    let error = |reference: &Picture| metrics::compare(&drawing.picture, reference).expect("both have the view's size");
    drawing.image.bytes = drawing.frame.memory.octets().to_vec();
    let stored = drawing.image.stored_scene(scene).expect("an image that was built can be read");
    let samples = Samples::new(scene, &drawing.image, variant.profile, job.machine.arithmetic.modes());
    let stored = Reference::framed(&stored, scene.bounds(), view, SearchMethod::Hierarchy)?;
    let [exact, stored] = [reference, &stored].map(|reference| reference.picture(Some(&samples)).picture);
    // Measure camera rays by themselves on the stored grid.
    let rays = RayErrors::new(&drawing.image, &job, view.size);
    let result = Render::new(&job, &drawing);
    // Counts are told a pixel, so that sizes can be compared.
    let pixels = f64::from(result.width) * f64::from(result.height);
    let each = |total: u64| total as f64 / pixels;
    Ok(MeasuredVariant {
        scene: result.scene.clone(),
        variant: variant.to_string(),
        profile: variant.profile.name(),
        word: variant.word,
        rounding: variant.rounding.name(),
        layout: variant.layout.name(),
        bounces: variant.bounces,
        cutoff: variant.cutoff,
        interpolate: variant.interpolate,
        error: error(&exact),
        ssim: similarity::structural_similarity(&drawing.picture, &exact),
        stored_error: error(&stored),
        rays,
        clocks: each(result.clocks),
        operations: result.counts,
        instructions: each(result.instructions),
        octets: each(result.octets),
        energy: EnergyResult::of(&job, &drawing, None).summary,
        host_nanoseconds: has_times.then(|| host.as_nanos() as f64 / pixels),
        formats: result.formats,
        is_on_front: false,
        dominated_by: None,
    })
}
