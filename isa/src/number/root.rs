//! The correctly rounded square root of an integer.

/// Square root, rounded to the nearest integer. A tie cannot occur: (r + 1/2)^2 is never an integer.
pub fn square_root(value: u128) -> u64 {
    let floor = match u64::try_from(value) {
        Ok(small) => u128::from(floor_root(small)),
        Err(_) => value.isqrt(),
    };
    // value >= (floor + 1/2)^2 exactly when value - floor^2 > floor.
    let up = value - floor * floor > floor;
    u64::try_from(floor + u128::from(up)).unwrap_or(u64::MAX)
}

/// The integer square root, by the host's square root of doubles and one correction either way.
///
/// A double's root of a number below 2^64 is off by less than 1, so its integer part is off by at most 1.
fn floor_root(value: u64) -> u64 {
    let guess = ((value as f64).sqrt() as u64).min(u32::MAX.into());
    if guess * guess > value {
        guess - 1
    } else if guess < u64::from(u32::MAX) && (guess + 1) * (guess + 1) <= value {
        guess + 1
    } else {
        guess
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_the_nearest_integers() {
        for (value, root) in [(0, 0), (1, 1), (2, 1), (3, 2), (6, 2), (7, 3), (12, 3), (13, 4), (u128::MAX, u64::MAX)] {
            assert_eq!(square_root(value), root, "of {value}");
        }
        for root in (1..5000).chain((1 << 32) - 5000..1 << 32).chain((1 << 31) - 5000..(1 << 31) + 5000u64) {
            for value in [root * root - 1, root * root, root * root + 1, root * root + 2 * root] {
                assert_eq!(floor_root(value), value.isqrt(), "of {value}");
            }
        }
        for value in (0..64).flat_map(|bits| [u64::MAX >> bits, (1 << bits) - 1, 1 << bits]) {
            assert_eq!(floor_root(value), value.isqrt(), "of {value}");
        }
        for root in 1..5000u128 {
            assert_eq!(square_root(root * root + root), root as u64);
            assert_eq!(square_root(root * root + root + 1), root as u64 + 1);
        }
    }
}
