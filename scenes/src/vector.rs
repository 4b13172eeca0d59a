//! Arithmetic of double-precision vectors, and scaling by powers of two. The coprocessor's own numbers are not here.

use crate::model::Vec3;

/// The three axes.
pub const AXES: [usize; 3] = [0, 1, 2];

/// `a + b`.
pub fn add(a: Vec3, b: Vec3) -> Vec3 {
    AXES.map(|k| a[k] + b[k])
}

/// `a - b`.
pub fn sub(a: Vec3, b: Vec3) -> Vec3 {
    AXES.map(|k| a[k] - b[k])
}

/// `a * factor`.
pub fn scale(a: Vec3, factor: f64) -> Vec3 {
    a.map(|x| x * factor)
}

/// Dot product.
pub fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Cross product.
pub fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Largest absolute component.
pub fn largest(a: Vec3) -> f64 {
    a[0].abs().max(a[1].abs()).max(a[2].abs())
}

/// The vector of length 1 in the direction of `a`, for components of any size; `None` when `a` is 0 or not finite.
pub fn unit(a: Vec3) -> Option<Vec3> {
    let most = largest(a);
    if !(a.iter().all(|x| x.is_finite()) && most > 0.0) {
        return None;
    }
    // Bringing the largest component into [1, 2) first keeps the squares in range, and gives the same bits for a * 2^k. Most vectors need not be brought
    // anywhere: powers of two change no rounding there.
    const NEAR: f64 = (1u64 << 63) as f64;
    let near = if most > 1.0 / NEAR && most < NEAR { a } else { a.map(|x| shifted(x, 1 - exponent(most))) };
    Some(scale(near, 1.0 / dot(near, near).sqrt()))
}

/// `x * 2^power`, exact unless the result leaves the range of double precision.
pub fn shifted(x: f64, power: i32) -> f64 {
    const STEP: i32 = 1000;
    let two_to = |n: i32| f64::from_bits(((1023 + n) as u64) << 52);
    let (mut x, mut power) = (x, power.clamp(-4 * STEP, 4 * STEP));
    while power > STEP {
        (x, power) = (x * two_to(STEP), power - STEP);
    }
    while power < -STEP {
        (x, power) = (x * two_to(-STEP), power + STEP);
    }
    x * two_to(power)
}

/// The smallest `n` with `|x| < 2^n`, for finite `x` other than 0; for 0 it is 0.
pub fn exponent(x: f64) -> i32 {
    if x == 0.0 {
        return 0;
    }
    let biased = |x: f64| (x.to_bits() >> 52 & 0x7ff) as i32;
    match biased(x) {
        0 => biased(x * shifted(1.0, 64)) - 1022 - 64,
        normal => normal - 1022,
    }
}

/// The nearest integer; ties go up.
pub fn nearest(x: f64) -> f64 {
    let below = x.floor();
    if x - below >= 0.5 { below + 1.0 } else { below }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_are_exact_over_the_whole_range() {
        for (x, n) in [(1.0, 1), (0.75, 0), (-3.0, 2), (5e-324, -1073), (f64::MAX, 1024), (f64::MIN_POSITIVE, -1021)] {
            assert_eq!(exponent(x), n, "{x}");
            let fraction = shifted(x, -n);
            assert!((0.5..1.0).contains(&fraction.abs()), "{x} {fraction}");
            assert_eq!(shifted(fraction, n), x);
        }
        assert_eq!((shifted(1.0, 5000), shifted(1.0, -5000)), (f64::INFINITY, 0.0));
    }

    #[test]
    fn ties_go_up() {
        let cases = [
            (0.5, 1.0),
            (-0.5, 0.0),
            (-1.5, -1.0),
            (0.49999999999999994, 0.0),
            (2.4, 2.0),
            (4503599627370497.5, 4503599627370498.0),
        ];
        for (x, n) in cases {
            assert_eq!(nearest(x), n, "{x}");
        }
    }

    #[test]
    fn directions_have_length_one_whatever_the_size() {
        for size in [1e300, 1.0, 1e-300, 5e-324] {
            let d = unit([0.0, -size, size]).unwrap();
            assert!((dot(d, d) - 1.0).abs() < 1e-15 && d[1] == -d[2], "{size}: {d:?}");
        }
        assert_eq!(unit([0.0; 3]), None);
        assert_eq!(unit([1.0, f64::INFINITY, 0.0]), None);
        assert_eq!(unit([f64::NAN, 1.0, 0.0]), None);
    }
}
