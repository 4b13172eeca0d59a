//! How alike two pictures look.

use image_compare::prelude::GrayImage;
use image_compare::{Algorithm, gray_similarity_structure};
use scenes::model::Picture;

use crate::files::picture::displayed;

/// Structural similarity (Wang et al. 2004) of the luma of two pictures as screens show them, 8 bits each: the mean over windows of 8 x 8
/// pixels, 1 for equal ones. `None` for pictures of different sizes and without pixels.
pub fn structural_similarity(a: &Picture, b: &Picture) -> Option<f64> {
    if a.size.0 == 0 || a.size.1 == 0 {
        return None;
    }
    gray_similarity_structure(&Algorithm::MSSIMSimple, &luma(a)?, &luma(b)?).ok().map(|similarity| similarity.score)
}

/// Rec. 709 luma.
fn luma(picture: &Picture) -> Option<GrayImage> {
    let weighted = |[r, g, b]: [u8; 3]| 0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b);
    let luma = displayed(picture).colours.into_iter().map(|colour| weighted(colour).round() as u8).collect();
    GrayImage::from_raw(picture.size.0, picture.size.1, luma)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(size: (u32, u32), value: impl Fn(u32) -> f64) -> Picture {
        Picture { size, pixels: (0..size.0 * size.1).map(|k| [value(k); 3]).collect() }
    }

    #[test]
    fn likeness_falls_with_what_differs() {
        let stripes = picture((16, 16), |k| f64::from(k % 2));
        let similarity = |other: &Picture| structural_similarity(&stripes, other).unwrap();
        assert_eq!(similarity(&stripes), 1.0);
        let one_off = picture((16, 16), |k| if k == 0 { 1.0 } else { f64::from(k % 2) });
        let inverse = picture((16, 16), |k| f64::from(1 - k % 2));
        assert!(similarity(&one_off) < 1.0 && similarity(&one_off) > 0.9);
        // Equal means and opposite structure: (c2 - 2 v) / (c2 + 2 v), close to -1.
        assert!(similarity(&inverse) < -0.9, "{}", similarity(&inverse));
        assert_eq!(structural_similarity(&stripes, &picture((8, 16), |_| 0.0)), None);
    }
}
