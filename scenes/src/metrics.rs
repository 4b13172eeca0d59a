//! Distance of one picture from another. All figures are over the linear components of all pixels, before any quantization to 8 bits, after
//! clamping both pictures to [0, 1].

use schemars::JsonSchema;
use serde::Serialize;

use crate::model::{Picture, Vec3};

/// The smallest difference of a component that counts as seen: one step of 8 bits.
pub const STEP: f64 = 1.0 / 255.0;

/// Figures of the difference of two pictures.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct PictureError {
    /// Root of the mean square difference of the components.
    pub rmse: f64,
    /// Peak signal to noise ratio -20 log10 rmse in dB; `None` for equal pictures.
    pub psnr_db: Option<f64>,
    /// Largest difference of a component.
    pub max: f64,
    /// Pixels with any component off by [`STEP`] or more.
    pub off_pixels: u64,
    /// Such pixels per million.
    pub off_per_million: f64,
    /// The ratio over the pixels that are not off; `None` when they are equal, or when all are off.
    pub psnr_others_db: Option<f64>,
}

/// Largest difference of a component of two clamped colours.
pub fn difference(a: Vec3, b: Vec3) -> f64 {
    differences(a, b).into_iter().fold(0.0, f64::max)
}

/// The differences of all pixels of two pictures, row 0 first: an error map. `None` when their sizes differ.
pub fn error_map(a: &Picture, b: &Picture) -> Option<Vec<f64>> {
    let is_comparable = a.size == b.size && a.pixels.len() == b.pixels.len();
    is_comparable.then(|| a.pixels.iter().zip(&b.pixels).map(|(&a, &b)| difference(a, b)).collect())
}

/// Compares two pictures; `None` when their sizes differ. Pictures without pixels are equal.
pub fn compare(a: &Picture, b: &Picture) -> Option<PictureError> {
    let map = error_map(a, b)?;
    let (mut sum, mut others) = (0.0, 0.0);
    let (mut off_pixels, mut max) = (0u64, 0.0f64);
    for (largest, (&a, &b)) in map.iter().zip(a.pixels.iter().zip(&b.pixels)) {
        let square: f64 = differences(a, b).iter().map(|d| d * d).sum();
        sum += square;
        max = max.max(*largest);
        if *largest >= STEP {
            off_pixels += 1;
        } else {
            others += square;
        }
    }
    let pixels = map.len() as u64;
    let rmse = |sum: f64, pixels: u64| if pixels == 0 { 0.0 } else { (sum / (3.0 * pixels as f64)).sqrt() };
    let psnr = |rmse: f64| (rmse > 0.0).then(|| -20.0 * rmse.log10());
    Some(PictureError {
        rmse: rmse(sum, pixels),
        psnr_db: psnr(rmse(sum, pixels)),
        max,
        off_pixels,
        off_per_million: if pixels == 0 { 0.0 } else { off_pixels as f64 * 1e6 / pixels as f64 },
        psnr_others_db: psnr(rmse(others, pixels - off_pixels)),
    })
}

/// A component that is not a number counts as 0.
fn differences(a: Vec3, b: Vec3) -> Vec3 {
    let clamped = |x: f64| if x.is_nan() { 0.0 } else { x.clamp(0.0, 1.0) };
    [0, 1, 2].map(|k| (clamped(a[k]) - clamped(b[k])).abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(values: &[f64]) -> Picture {
        Picture { size: (values.len() as u32, 1), pixels: values.iter().map(|&x| [x; 3]).collect() }
    }

    #[test]
    fn equal_pictures_have_no_ratio() {
        let picture = grey(&[0.0, 0.5, 1.0]);
        let error = compare(&picture, &picture).unwrap();
        assert_eq!(
            (error.rmse, error.psnr_db, error.max, error.off_pixels, error.psnr_others_db),
            (0.0, None, 0.0, 0, None)
        );
        assert_eq!(compare(&grey(&[]), &grey(&[])).unwrap().psnr_db, None);
        assert_eq!(compare(&picture, &grey(&[0.0])), None);
    }

    #[test]
    fn colours_are_clamped_first() {
        let error = compare(&grey(&[-3.0, 7.0, f64::NAN]), &grey(&[0.0, 1.0, 0.0])).unwrap();
        assert_eq!((error.max, error.off_pixels), (0.0, 0));
    }

    #[test]
    fn figures_of_a_small_picture() {
        // Four pixels: equal, 0.1 off in all components, 0.001 off in one, equal.
        let a = grey(&[0.0, 0.5, 0.5, 1.0]);
        let mut b = grey(&[0.0, 0.6, 0.5, 1.0]);
        b.pixels[2][1] += 0.001;
        let error = compare(&a, &b).unwrap();
        let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
        assert!(near(error.rmse, ((0.03 + 1e-6) / 12.0f64).sqrt()));
        assert!(near(error.psnr_db.unwrap(), -10.0 * ((0.03 + 1e-6) / 12.0f64).log10()));
        assert!(near(error.max, 0.1));
        assert_eq!((error.off_pixels, error.off_per_million), (1, 250_000.0));
        assert!(near(error.psnr_others_db.unwrap(), -10.0 * (1e-6f64 / 9.0).log10()));
        assert_eq!(compare(&b, &a), Some(error));
    }

    #[test]
    fn one_step_of_eight_bits_is_off_and_less_is_not() {
        let error = |d: f64| compare(&grey(&[0.0]), &grey(&[d])).unwrap().off_pixels;
        assert_eq!((error(STEP), error(STEP * 0.999)), (1, 0));
        assert_eq!(compare(&grey(&[0.0]), &grey(&[1.0])).unwrap().psnr_others_db, None);
    }
}
