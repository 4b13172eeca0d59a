//! Run time against error: pictures in many arithmetics, profiles and layouts on several machines, each measured against double precision, and its
//! camera rays against exact integers on the same grid, so that what the formats cost and what the scene's rounding costs are told apart. A study
//! of points that share recordings where only the machine differs.

mod axis;
#[cfg(feature = "cli")]
mod chart;
mod front;
mod pooled;
mod rays;
mod similarity;
mod study;
#[cfg(feature = "cli")]
mod text;

use std::fmt;
use std::sync::Arc;

use isa::number::Quantization;
use kernels::KernelSet;
use scenes::layout::Layout;
use scenes::metrics::PictureError;
use schemars::JsonSchema;
use serde::Serialize;

use crate::energy::EnergySummary;
use crate::result::{ByClass, FormatTable};
use crate::settings::Settings;
pub use axis::{CostAxis, ErrorAxis};
#[cfg(feature = "cli")]
pub use chart::{ChartAxes, figure};
pub use front::{MeanAndWorst, OverScenes, OverallVariant, overall, rank};
pub use rays::RayErrors;
pub use study::{AccuracyStudy, PLACES, RefusedVariant, run};
#[cfg(feature = "cli")]
pub use text::{csv, text};

/// Settings that variants share, on one of the machines.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyBase {
    /// Everything but the scene and what variants vary.
    pub settings: Settings,
    /// Words that tell the machine from the others; empty for the only one.
    pub words: String,
}

/// Settings of one picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Variant {
    /// The machine and all that no variant varies.
    pub base: Arc<StudyBase>,
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
    fn with(&self, profile: KernelSet) -> Variant {
        let layout = match profile.layout() {
            own @ (Layout::Report | Layout::Packet | Layout::Packed) => own,
            Layout::Wide => self.layout,
        };
        Variant { profile, layout, ..self.clone() }
    }

    /// Settings of the picture of a scene, with its samples moved by `shift` beside the shift that all share.
    pub fn settings(&self, scene: &str, shift: [f64; 2]) -> Settings {
        let mut settings = self.base.settings.clone();
        scene.clone_into(&mut settings.scene.name);
        settings.view.shift = [0, 1].map(|k| settings.view.shift[k] + shift[k]);
        settings.kernels.profile = self.profile;
        settings.layout = Some(self.layout);
        settings.machine.config.arithmetic.word = self.word;
        settings.machine.config.arithmetic.quantization = self.rounding;
        settings.effort.bounces = self.bounces;
        settings.effort.weight_cutoff = self.cutoff;
        settings.effort.interpolate = self.interpolate;
        settings
    }

    /// The variant in words without the word length.
    pub fn kind(&self) -> String {
        format!("{}{}", self.profile, self.particulars())
    }

    /// Words for what is not as usual.
    fn particulars(&self) -> String {
        let mut words = String::new();
        if self.rounding != Quantization::Rnd {
            words += &format!(" {}", self.rounding);
        }
        if self.layout != self.profile.layout() {
            words += &format!(" {}", self.layout.name());
        }
        if self.bounces != BOUNCES {
            words += &format!(" bounces {}", self.bounces);
        }
        if self.cutoff != 0.0 {
            words += &format!(" cutoff {}", self.cutoff);
        }
        if let Some(difference) = self.interpolate {
            words += &format!(" interpolated {difference}");
        }
        if !self.base.words.is_empty() {
            words += &format!(" {}", self.base.words);
        }
        words
    }
}

impl fmt::Display for Variant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}{}", self.profile, self.word, self.particulars())
    }
}

/// Levels of secondary rays where nothing else is said.
const BOUNCES: u32 = 5;

/// The values that are tried of each setting. The first one of each list is the base.
#[derive(Clone, Debug)]
pub struct Choices {
    /// Machines, each with all that no variant varies.
    pub bases: Vec<Arc<StudyBase>>,
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
    /// every word; all of them on each machine. `None` without a value of some setting.
    pub fn variants(&self) -> Option<Vec<Variant>> {
        let base = Variant {
            base: self.bases.first()?.clone(),
            profile: *self.profiles.first()?,
            word: *self.words.first()?,
            rounding: *self.roundings.first()?,
            layout: *self.layouts.first()?,
            bounces: *self.bounces.first()?,
            cutoff: *self.cutoffs.first()?,
            interpolate: *self.interpolate.first()?,
        };
        let with = |change: &dyn Fn(&mut Variant)| {
            let mut variant = base.clone();
            change(&mut variant);
            variant
        };
        let mut kinds: Vec<Variant> = self.profiles.iter().map(|&profile| base.with(profile)).collect();
        kinds.extend(self.roundings[1..].iter().map(|&rounding| with(&|one| one.rounding = rounding)));
        kinds.extend(self.layouts[1..].iter().map(|&layout| with(&|one| one.layout = layout)));
        kinds.extend(self.bounces[1..].iter().map(|&bounces| with(&|one| one.bounces = bounces)));
        kinds.extend(self.cutoffs[1..].iter().map(|&cutoff| with(&|one| one.cutoff = cutoff)));
        kinds.extend(self.interpolate[1..].iter().map(|&interpolate| with(&|one| one.interpolate = interpolate)));
        let mut variants = Vec::new();
        for base in &self.bases {
            for kind in &kinds {
                variants.extend(self.words.iter().map(|&word| Variant { word, base: base.clone(), ..kind.clone() }));
            }
        }
        Some(variants)
    }
}

/// Error of the picture of one shift.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ShiftError {
    /// Place of a ray in its pixel, in pixels to the right of the middle and above it.
    pub shift: [f64; 2],
    /// The picture against double precision with five bounces and no cut-off.
    #[serde(flatten)]
    pub error: PictureError,
    /// Structural similarity.
    pub ssim: Option<f64>,
}

/// A variant on a scene; errors and costs are those of the pictures of all shifts together.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct MeasuredVariant {
    /// Number of the variant among all that were asked for.
    #[serde(skip)]
    pub number: usize,
    /// The variant in words without the word length.
    #[serde(skip)]
    pub kind: String,
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
    /// Name of the machine.
    pub machine: String,
    /// Cores.
    pub cores: u32,
    /// Arbiter of the bus.
    pub arbiter: &'static str,
    /// Bits of a word and fraction bits of each quantity.
    pub formats: FormatTable,
    /// Pixels off by 1/255 or more, of the mean and of the worst picture of all shifts.
    pub off: MeanAndWorst,
    /// The pictures against double precision with five bounces and no cut-off.
    pub error: PictureError,
    /// Structural similarity of both pictures as screens show them, 1 for equal ones; the mean of all shifts.
    pub ssim: Option<f64>,
    /// The error by shift.
    pub shifts: Vec<ShiftError>,
    /// The pictures against double precision over the vertices as they are stored: the error without that of rounding the mesh.
    pub stored_error: PictureError,
    /// Camera rays against exact integers.
    pub rays: RayErrors,
    /// Clocks of the frame, a pixel.
    pub clocks: f64,
    /// Seconds of the machine, a pixel.
    pub seconds: f64,
    /// Operations of all cores, in the pictures of all shifts.
    pub operations: ByClass,
    /// Instructions of all cores, a pixel.
    pub instructions: f64,
    /// Octets that the cores moved, a pixel.
    pub octets: f64,
    /// Energy and area, as a range over published tables; of several shifts the mean.
    pub energy: EnergySummary,
    /// Nanoseconds of the host a pixel; only when asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub host_nanoseconds: Option<f64>,
    /// Method by which its frames came about: replayed, or stepped where one of them had to be.
    pub method: &'static str,
    /// True where no other variant of the scene beats it.
    pub is_on_front: bool,
    /// A variant of the scene that costs no more, has no larger error and is better in one of them; null for one on the front.
    pub dominated_by: Option<String>,
}
