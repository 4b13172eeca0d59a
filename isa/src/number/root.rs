//! The correctly rounded square root of an integer.

/// Square root, rounded to the nearest integer. A tie cannot occur: (r + 1/2)^2 is never an integer.
pub fn square_root(value: u128) -> u64 {
    let floor = match u64::try_from(value) {
        Ok(small) => u128::from(small.isqrt()),
        Err(_) => value.isqrt(),
    };
    // value >= (floor + 1/2)^2 exactly when value - floor^2 > floor.
    let up = value - floor * floor > floor;
    u64::try_from(floor + u128::from(up)).unwrap_or(u64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_the_nearest_integers() {
        for (value, root) in [(0, 0), (1, 1), (2, 1), (3, 2), (6, 2), (7, 3), (12, 3), (13, 4), (u128::MAX, u64::MAX)] {
            assert_eq!(square_root(value), root, "of {value}");
        }
        for root in 1..5000u128 {
            assert_eq!(square_root(root * root + root), root as u64);
            assert_eq!(square_root(root * root + root + 1), root as u64 + 1);
        }
    }
}
