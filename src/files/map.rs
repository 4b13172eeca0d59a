//! Maps of a picture: one number a pixel, shown in the colours of viridis, which stay apart in grey and for the colour
//! blind.

use super::picture::Pixels;

/// Ten colours of viridis at equal distances.
const VIRIDIS: [[u8; 3]; 10] = [
    [0x44, 0x01, 0x54],
    [0x48, 0x28, 0x78],
    [0x3e, 0x49, 0x89],
    [0x31, 0x68, 0x8e],
    [0x26, 0x82, 0x8e],
    [0x1f, 0x9e, 0x89],
    [0x35, 0xb7, 0x79],
    [0x6e, 0xce, 0x58],
    [0xb5, 0xde, 0x2b],
    [0xfd, 0xe7, 0x25],
];

/// Smallest difference that an error map tells from nothing; it is the darkest colour, and 1 the brightest.
pub const LEAST_ERROR: f64 = 1e-9;

/// The colour of a number in [0, 1]: dark violet, blue, green, yellow.
pub fn colour(at: f64) -> [u8; 3] {
    let steps = VIRIDIS.len() - 1;
    let place = at.clamp(0.0, 1.0) * steps as f64;
    let first = (place as usize).min(steps - 1);
    let share = place - first as f64;
    let between = |k: usize| {
        let (from, to) = (f64::from(VIRIDIS[first][k]), f64::from(VIRIDIS[first + 1][k]));
        (from + share * (to - from)).round() as u8
    };
    [between(0), between(1), between(2)]
}

/// A heat map: from the least number (dark) to the largest (bright), logarithmic, so that both the sky and the glass
/// show their structure. Numbers below 1 count as 1.
pub fn heat(size: (u32, u32), values: &[u64]) -> Pixels {
    let logarithm = |value: u64| (value.max(1) as f64).ln();
    let least = logarithm(values.iter().copied().min().unwrap_or(0));
    let most = logarithm(values.iter().copied().max().unwrap_or(0));
    let shade = |&value: &u64| colour(if most > least { (logarithm(value) - least) / (most - least) } else { 0.0 });
    Pixels { size, colours: values.iter().map(shade).collect() }
}

/// An error map: differences from [`LEAST_ERROR`] (dark) to 1 (bright), logarithmic; no difference at all is black.
pub fn error(size: (u32, u32), differences: &[f64]) -> Pixels {
    let decades = -LEAST_ERROR.log10();
    let shade = |&difference: &f64| match difference > 0.0 {
        true => colour(1.0 + difference.log10() / decades),
        false => [0; 3],
    };
    Pixels { size, colours: differences.iter().map(shade).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn luminance([r, g, b]: [u8; 3]) -> f64 {
        0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b)
    }

    #[test]
    fn more_is_brighter_everywhere() {
        let shades: Vec<f64> = (0..=900).map(|k| luminance(colour(f64::from(k) / 900.0))).collect();
        assert!(shades.windows(2).all(|pair| pair[1] >= pair[0] - 0.9), "rounding may lose less than a step");
        assert_eq!((colour(0.0), colour(1.0)), (VIRIDIS[0], VIRIDIS[9]));
        assert_eq!((colour(-3.0), colour(f64::INFINITY)), (VIRIDIS[0], VIRIDIS[9]));
    }

    #[test]
    fn heat_is_logarithmic_between_least_and_largest() {
        let map = heat((4, 1), &[2, 1024, 4, 8]);
        assert_eq!(map.colours, [VIRIDIS[0], VIRIDIS[9], VIRIDIS[1], VIRIDIS[2]]);
        assert_eq!(heat((2, 1), &[7, 7]).colours, [VIRIDIS[0]; 2]);
        assert_eq!(heat((2, 1), &[0, 1]).colours, [VIRIDIS[0]; 2]);
    }

    #[test]
    fn errors_are_logarithmic_and_none_is_black() {
        let map = error((5, 1), &[0.0, 1e-9, 1e-12, 1e-3, 1.0]);
        assert_eq!(map.colours, [[0; 3], VIRIDIS[0], VIRIDIS[0], VIRIDIS[6], VIRIDIS[9]]);
    }
}
