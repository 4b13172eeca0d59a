//! Choices of the search: the fraction bits of each quantity and the word, and the demand that they have to keep.

use std::fmt;

use scenes::cadrage::{Formats, Overrides};
use schemars::JsonSchema;
use serde::Serialize;

/// Fraction bits of each quantity, in the order of [`Overrides::NAMES`].
pub type FractionBits = [Option<i32>; 6];

/// Word and fraction bits of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FormatChoice {
    /// Bits of a register, 8 to 32; products between them have twice as many.
    pub word: u32,
    /// Fraction bits of each quantity; `None` for those that scene and word choose.
    pub bits: FractionBits,
    /// Cost of visiting a node of the kd tree in percent of testing a triangle; `None` for that of the job.
    pub visit: Option<u32>,
}

impl FormatChoice {
    /// A word in which the scene chooses all formats.
    pub const fn uniform(word: u32) -> FormatChoice {
        FormatChoice { word, bits: [None; 6], visit: None }
    }

    /// The choice with other fraction bits of a quantity, by its number.
    #[must_use]
    pub fn with(mut self, quantity: usize, bits: i32) -> FormatChoice {
        self.bits[quantity] = Some(bits);
        self
    }

    /// The formats that the loader is told.
    pub fn overrides(&self) -> Overrides {
        let [position, direction, barycentric, t, weight, colour] = self.bits;
        Overrides { position, direction, barycentric, t, weight, colour }
    }
}

/// Bits of a quantity beside its fraction bits that a scene asks for: the sign and those before the point.
pub fn integer_bits(formats: &Formats, quantity: usize) -> i32 {
    // The loader gives each quantity the finest format that holds it, so what the word has beside is what it holds.
    formats.word as i32 - formats.entries()[quantity].1
}

/// Error that pictures may have at most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DemandedError {
    /// Peak signal-to-noise ratio of a scene over all shifts, in dB, at least.
    Psnr(f64),
    /// Pixels that differ by 1/255 or more, in each picture, at most.
    Off(u64),
    /// Largest difference of a component, at most.
    Largest(f64),
}

impl DemandedError {
    /// True where the error of a scene is allowed.
    pub fn allows(&self, error: &PooledError) -> bool {
        match *self {
            // Equal pictures have no ratio, and keep any.
            DemandedError::Psnr(least) => error.psnr_db.is_none_or(|psnr| psnr >= least),
            DemandedError::Off(most) => error.worst_off <= most,
            DemandedError::Largest(most) => error.largest <= most,
        }
    }

    /// Root mean square error that comes with the demand, for first estimates.
    pub fn rmse(&self) -> f64 {
        match *self {
            DemandedError::Psnr(least) => 10f64.powf(-least / 20.0),
            // Differences of less than a step of 8 bits, evenly spread, are 1/255 / sqrt 3 in the mean square.
            DemandedError::Off(_) => scenes::metrics::STEP / 3f64.sqrt(),
            DemandedError::Largest(most) => most / 3f64.sqrt(),
        }
    }
}

impl fmt::Display for DemandedError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            DemandedError::Psnr(least) => write!(f, "a PSNR of at least {least} dB over all shifts of a scene"),
            DemandedError::Off(most) => write!(f, "at most {most} pixels off by 1/255 or more in each picture"),
            DemandedError::Largest(most) => write!(f, "no component off by more than {most:.6}"),
        }
    }
}

/// Error of the pictures of a scene, over all shifts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct PooledError {
    /// Peak signal-to-noise ratio of the mean square of all pictures in dB; null where all are equal to double precision.
    pub psnr_db: Option<f64>,
    /// Pixels off by 1/255 or more, in the mean picture.
    pub mean_off: f64,
    /// Pixels off by 1/255 or more, in the worst picture.
    pub worst_off: u64,
    /// Largest difference of a component.
    pub largest: f64,
}

/// Error of one picture, as it is pooled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureSquare {
    /// Mean square difference of the components.
    pub square: f64,
    /// Pixels off by 1/255 or more.
    pub off: u64,
    /// Largest difference of a component.
    pub largest: f64,
}

impl PooledError {
    /// The error of some pictures of one size.
    pub fn of(pictures: &[PictureSquare]) -> PooledError {
        let count = pictures.len().max(1) as f64;
        let square = pictures.iter().map(|picture| picture.square).sum::<f64>() / count;
        PooledError {
            psnr_db: (square > 0.0).then(|| -10.0 * square.log10()),
            mean_off: pictures.iter().map(|picture| picture.off as f64).sum::<f64>() / count,
            worst_off: pictures.iter().map(|picture| picture.off).max().unwrap_or(0),
            largest: pictures.iter().map(|picture| picture.largest).fold(0.0, f64::max),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_pooled_over_pictures() {
        let picture = |square, off, largest| PictureSquare { square, off, largest };
        // The mean square of 1e-6 and 3e-6 is 2e-6: 57 dB.
        let error = PooledError::of(&[picture(1e-6, 0, 0.001), picture(3e-6, 3, 0.2)]);
        assert!((error.psnr_db.unwrap() - 56.9897).abs() < 1e-4);
        assert_eq!((error.mean_off, error.worst_off, error.largest), (1.5, 3, 0.2));
        assert!(DemandedError::Psnr(56.98).allows(&error) && !DemandedError::Psnr(57.0).allows(&error));
        assert!(DemandedError::Off(3).allows(&error) && !DemandedError::Off(2).allows(&error));
        assert!(DemandedError::Largest(0.2).allows(&error) && !DemandedError::Largest(0.1).allows(&error));
        let equal = PooledError::of(&[picture(0.0, 0, 0.0)]);
        assert!(equal.psnr_db.is_none() && DemandedError::Psnr(500.0).allows(&equal));
    }
}
