//! Axes of choice: the cost and the error that variants are ranked and drawn by.

use scenes::metrics::PictureError;
use schemars::JsonSchema;
use serde::Serialize;

use super::MeasuredVariant;

/// Cost that errors are set against; less is better.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum CostAxis {
    /// Clocks of the machine.
    #[default]
    Clocks,
    /// Time of the machine.
    Seconds,
    /// Octets that the cores move.
    Octets,
    /// Nanojoules, the mean of what the published tables say least and most.
    Nj,
    /// Area of the machine's cores, the mean of what the published tables say least and most.
    Area,
    /// Time of the host.
    Host,
}

impl CostAxis {
    /// Name with its unit.
    pub const fn name(self) -> &'static str {
        match self {
            CostAxis::Clocks => "clocks a pixel",
            CostAxis::Seconds => "seconds a pixel",
            CostAxis::Octets => "octets a pixel",
            CostAxis::Nj => "nanojoules a pixel",
            CostAxis::Area => "area of the cores, square micrometres",
            CostAxis::Host => "host's nanoseconds a pixel",
        }
    }

    /// Cost of a variant; `None` where it was not measured.
    pub fn of(self, one: &MeasuredVariant) -> Option<f64> {
        match self {
            CostAxis::Clocks => Some(one.clocks),
            CostAxis::Seconds => Some(one.seconds),
            CostAxis::Octets => Some(one.octets),
            CostAxis::Nj => Some((one.energy.pixel_nj.least + one.energy.pixel_nj.most) / 2.0),
            CostAxis::Area => Some((one.energy.area_um2.least + one.energy.area_um2.most) / 2.0),
            CostAxis::Host => one.host_nanoseconds,
        }
    }
}

/// Error of the pictures of all shifts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum ErrorAxis {
    /// Peak signal-to-noise ratio.
    #[default]
    Psnr,
    /// Peak signal-to-noise ratio of the pixels that are not off.
    Others,
    /// Largest difference of a component.
    Largest,
    /// Pixels that are off by 1/255 or more, in the mean picture.
    Off,
    /// Structural similarity.
    Ssim,
}

/// PSNR of a picture without any error, for an axis.
const PERFECT: f64 = 200.0;

/// Least difference that an axis of quotients shows.
const LEAST: f64 = 1e-10;

impl ErrorAxis {
    /// Name with its unit.
    pub const fn name(self) -> &'static str {
        match self {
            ErrorAxis::Psnr => "PSNR, dB",
            ErrorAxis::Others => "PSNR of the pixels that are not off, dB",
            ErrorAxis::Largest => "largest difference of a component",
            ErrorAxis::Off => "pixels off by 1/255 or more",
            ErrorAxis::Ssim => "SSIM",
        }
    }

    /// True where more is nearer to double precision.
    pub const fn is_better_above(self) -> bool {
        matches!(self, ErrorAxis::Psnr | ErrorAxis::Others | ErrorAxis::Ssim)
    }

    /// Badness of a variant, by which fronts go: less is better.
    pub fn badness(self, one: &MeasuredVariant) -> f64 {
        match self {
            ErrorAxis::Psnr => one.error.rmse,
            ErrorAxis::Off => one.off.mean,
            _ if self.is_better_above() => -self.place_of(&one.error, one.ssim),
            _ => self.place_of(&one.error, one.ssim),
        }
    }

    /// Mean of the badnesses of several scenes: of mean squares where they are roots of such.
    pub fn mean(self, badnesses: &[f64]) -> f64 {
        let count = badnesses.len().max(1) as f64;
        match self {
            ErrorAxis::Psnr => (badnesses.iter().map(|rmse| rmse * rmse).sum::<f64>() / count).sqrt(),
            _ => badnesses.iter().sum::<f64>() / count,
        }
    }

    /// Figure of a badness, as tables and charts show it.
    pub fn figure(self, badness: f64) -> f64 {
        match self {
            ErrorAxis::Psnr if badness > 0.0 => (-20.0 * badness.log10()).min(PERFECT),
            ErrorAxis::Psnr => PERFECT,
            _ if self.is_better_above() => -badness,
            _ => badness,
        }
    }

    /// Place of a variant on a chart's axis, and the least and the most of its shifts.
    pub fn place(self, one: &MeasuredVariant) -> (f64, [f64; 2]) {
        let places = one.shifts.iter().map(|shift| self.place_of(&shift.error, shift.ssim));
        let ends = [places.clone().fold(f64::INFINITY, f64::min), places.fold(f64::NEG_INFINITY, f64::max)];
        let place = match self {
            ErrorAxis::Off => one.off.mean,
            _ => self.place_of(&one.error, one.ssim),
        };
        (place, ends)
    }

    /// Place of one error.
    fn place_of(self, error: &PictureError, ssim: Option<f64>) -> f64 {
        match self {
            ErrorAxis::Psnr => error.psnr_db.unwrap_or(PERFECT).min(PERFECT),
            // Without a ratio, either all pixels are off, or the others are equal.
            ErrorAxis::Others if error.off_per_million >= 1e6 => 0.0,
            ErrorAxis::Others => error.psnr_others_db.unwrap_or(PERFECT).min(PERFECT),
            ErrorAxis::Largest => error.max.max(LEAST),
            ErrorAxis::Off => error.off_pixels as f64,
            ErrorAxis::Ssim => ssim.unwrap_or(1.0),
        }
    }
}
