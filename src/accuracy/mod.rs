//! Run time against error: pictures in many arithmetics, profiles and layouts on several machines, each measured against double precision, and its
//! camera rays against exact integers on the same grid, so that what the formats cost and what the scene's rounding costs are told apart. A study
//! of points that share recordings where only the machine differs.

mod axis;
#[cfg(feature = "cli")]
mod chart;
mod choices;
mod front;
mod pooled;
mod rays;
mod similarity;
mod study;
#[cfg(feature = "cli")]
mod text;

use std::fmt;

use isa::number::Quantization;
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
pub use choices::{Choices, PictureNumber, VariantMachine, VariantStudy};
pub use front::{MeanAndWorst, OverScenes, OverallVariant, overall, rank};
pub use rays::RayErrors;
pub use study::{AccuracyStudy, PLACES, RefusedVariant, run};
#[cfg(feature = "cli")]
pub use text::{csv, text};

/// A picture in one of the arithmetics.
#[derive(Clone, Debug, PartialEq)]
pub struct Variant {
    /// Settings of its first picture, with what goes by the scene.
    pub settings: Settings,
    /// Words that tell the machine from the others; empty for the only one.
    pub machine_words: String,
}

impl Variant {
    /// The variant in words without the word length.
    pub fn kind(&self) -> String {
        format!("{}{}", self.settings.kernels.profile, self.particulars())
    }

    /// Structures of global memory.
    pub fn layout(&self) -> Layout {
        self.settings.layout.unwrap_or(self.settings.kernels.profile.layout())
    }

    /// Words for what is not as usual.
    fn particulars(&self) -> String {
        let Settings { kernels, effort, machine, .. } = &self.settings;
        let (rounding, layout) = (machine.config.arithmetic.quantization, self.layout());
        let mut words = String::new();
        if rounding != Quantization::Rnd {
            words += &format!(" {rounding}");
        }
        if layout != kernels.profile.layout() {
            words += &format!(" {}", layout.name());
        }
        if effort.bounces != BOUNCES {
            words += &format!(" bounces {}", effort.bounces);
        }
        if effort.weight_cutoff != 0.0 {
            words += &format!(" cutoff {}", effort.weight_cutoff);
        }
        if let Some(difference) = effort.interpolate {
            words += &format!(" interpolated {difference}");
        }
        if !self.machine_words.is_empty() {
            words += &format!(" {}", self.machine_words);
        }
        words
    }
}

impl fmt::Display for Variant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Settings { kernels, machine, .. } = &self.settings;
        write!(f, "{} {}{}", kernels.profile, machine.config.arithmetic.word, self.particulars())
    }
}

/// Levels of secondary rays where nothing else is said.
const BOUNCES: u32 = 5;

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
