//! The machine's default arithmetic, known at compile time: 32 bits, to nearest with ties up, saturating.

use super::{Arithmetic, Modes};

/// Words of 32 bits, RND and SAT; equal to [`Modes::default`] and faster.
#[derive(Clone, Copy, Debug, Default)]
pub struct Nearest32;

impl Arithmetic for Nearest32 {
    #[inline]
    fn word(&self) -> u32 {
        32
    }

    #[inline]
    fn quantize(&self, value: i128, shift: u32, bits: u32) -> i64 {
        let rounded = if shift == 0 { value } else { ((value >> (shift - 1)) + 1) >> 1 };
        let largest = i64::MAX >> (64 - bits);
        rounded.clamp((-largest - 1).into(), largest.into()) as i64
    }

    #[inline]
    fn narrow64(&self, value: i64, shift: u32) -> i32 {
        let rounded = if shift == 0 { value } else { (value >> (shift - 1)).saturating_add(1) >> 1 };
        rounded.clamp(i32::MIN.into(), i32::MAX.into()) as i32
    }

    #[inline]
    fn quotient(&self, dividend: i128, divisor: i128) -> i32 {
        Modes::default().quotient(dividend, divisor)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn equals_the_modes_chosen_at_run_time(value: i64, high: i32, shift in 0u32..64) {
            let (fast, slow) = (Nearest32, Modes::default());
            let value128 = (i128::from(high) << 60) + i128::from(value);
            prop_assert_eq!(fast.narrow(value128, shift), slow.narrow(value128, shift));
            prop_assert_eq!(fast.widen(value128, shift), slow.widen(value128, shift));
            prop_assert_eq!(fast.narrow64(value, shift), slow.narrow64(value, shift));
        }
    }
}
