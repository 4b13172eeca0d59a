//! Structural similarity of two pictures.

use scenes::model::Picture;

use crate::files::picture::displayed;

/// Side of a window in pixels; those at the right and lower edges have what is left.
const WINDOW: usize = 8;

/// Constants that keep the quotients of dark and of plain windows finite: (0.01 L)^2 and (0.03 L)^2 with L = 255.
const C1: f64 = 0.01 * 255.0 * (0.01 * 255.0);
const C2: f64 = 0.03 * 255.0 * (0.03 * 255.0);

/// Structural similarity (Wang et al. 2004) of the luma of two pictures as screens show them, 8 bits each: the mean over windows of 8 x 8
/// pixels that do not overlap, each as often as it has pixels, 1 for equal ones. Variances are sums over a window, not means. `None` for
/// pictures of different sizes and without pixels.
pub fn structural_similarity(a: &Picture, b: &Picture) -> Option<f64> {
    let (width, height) = (a.size.0 as usize, a.size.1 as usize);
    if a.size != b.size || width == 0 || height == 0 {
        return None;
    }
    Some(mean_similarity(&luma(a), &luma(b), width))
}

/// The mean over the windows of two pictures of one width.
fn mean_similarity(a: &[f64], b: &[f64], width: usize) -> f64 {
    let height = a.len() / width;
    let mut sum = 0.0;
    for left in (0..width).step_by(WINDOW) {
        for top in (0..height).step_by(WINDOW) {
            let rows = top..height.min(top + WINDOW);
            let columns = left..width.min(left + WINDOW);
            let window: Vec<(f64, f64)> = rows
                .flat_map(|row| columns.clone().map(move |column| row * width + column))
                .map(|at| (a[at], b[at]))
                .collect();
            sum += window_similarity(&window) * window.len() as f64;
        }
    }
    sum / a.len() as f64
}

/// The similarity of a window: of its means, times that of its structure.
fn window_similarity(pixels: &[(f64, f64)]) -> f64 {
    let mean = |part: fn(&(f64, f64)) -> f64| pixels.iter().map(part).sum::<f64>() / pixels.len() as f64;
    let (mean_a, mean_b) = (mean(|pixel| pixel.0), mean(|pixel| pixel.1));
    let (mut variance_a, mut variance_b, mut covariance) = (0.0, 0.0, 0.0);
    for (a, b) in pixels {
        variance_a += (a - mean_a) * (a - mean_a);
        variance_b += (b - mean_b) * (b - mean_b);
        covariance += (a - mean_a) * (b - mean_b);
    }
    (2.0 * mean_a * mean_b + C1) * (2.0 * covariance + C2)
        / ((mean_a * mean_a + mean_b * mean_b + C1) * (variance_a + variance_b + C2))
}

/// Rec. 709 luma, whole numbers from 0 to 255.
fn luma(picture: &Picture) -> Vec<f64> {
    let weighted = |[r, g, b]: [u8; 3]| 0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b);
    displayed(picture).colours.into_iter().map(|colour| weighted(colour).round()).collect()
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

    #[test]
    fn windows_at_the_edges_are_smaller() {
        // Black against a grey of 5: c1 / (25 + c1) in every window, whatever its size.
        let (black, grey) = ([0.0; 9 * 11], [5.0; 9 * 11]);
        assert!((mean_similarity(&black, &grey, 9) - 0.206_412_189_508_769_16).abs() < 1e-15);
        // One bright pixel in the window of one column and one row weighs 1 of 81.
        let mut spot = [0.0; 81];
        spot[80] = 255.0;
        let expected = (80.0 + C1 / (255.0 * 255.0 + C1)) / 81.0;
        assert!((mean_similarity(&[0.0; 81], &spot, 9) - expected).abs() < 1e-12);
    }
}
