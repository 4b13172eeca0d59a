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
        // The floor and the bit below it: nothing here can overflow.
        let rounded = if shift == 0 { value } else { (value >> shift) + (value >> (shift - 1) & 1) };
        rounded.clamp(i32::MIN.into(), i32::MAX.into()) as i32
    }

    #[inline]
    fn widen64(&self, value: i64) -> i64 {
        value
    }

    #[inline]
    fn widen_sum(&self, a: i64, b: i64) -> i64 {
        a.saturating_add(b)
    }

    #[inline]
    fn widen_difference(&self, a: i64, b: i64) -> i64 {
        a.saturating_sub(b)
    }

    #[inline]
    fn widen_products(&self, products: [i64; 3]) -> i64 {
        let (quarters, rest) = in_quarters(products);
        if quarters > i64::MAX >> 2 {
            i64::MAX
        } else if quarters < i64::MIN >> 2 {
            i64::MIN
        } else {
            quarters << 2 | rest
        }
    }

    #[inline]
    fn narrow_products(&self, products: [i64; 3], shift: u32) -> i32 {
        let (quarters, rest) = in_quarters(products);
        if shift < 3 {
            // Beyond 2^40 quarters any of these shifts leaves more than a word.
            return self.narrow64(quarters.clamp(-1 << 40, 1 << 40) << 2 | rest, shift);
        }
        self.narrow64(quarters, shift - 2)
    }

    #[inline]
    fn quotient(&self, dividend: i128, divisor: i128) -> i32 {
        match (i64::try_from(dividend), i64::try_from(divisor)) {
            (Ok(dividend), Ok(divisor)) if divisor != 0 && dividend != i64::MIN && divisor != i64::MIN => {
                nearest_quotient(dividend, divisor)
            }
            _ => Modes::default().quotient(dividend, divisor),
        }
    }
}

/// The sum of three products of words as 4 quarters + rest, the rest 0 to 3: it may take 65 bits.
#[inline]
fn in_quarters(products: [i64; 3]) -> (i64, i64) {
    let quarters = (products[0] >> 2) + (products[1] >> 2) + (products[2] >> 2);
    let rest = (products[0] & 3) + (products[1] & 3) + (products[2] & 3);
    (quarters + (rest >> 2), rest & 3)
}

/// The quotient to nearest, ties up, saturated; neither number is the least one, whose negation does not fit.
fn nearest_quotient(dividend: i64, divisor: i64) -> i32 {
    let (dividend, divisor) = if divisor < 0 { (-dividend, -divisor) } else { (dividend, divisor) };
    let (mut floor, mut rest) = (dividend / divisor, dividend % divisor);
    if rest < 0 {
        (floor, rest) = (floor - 1, rest + divisor);
    }
    let rounded = if rest >= divisor - rest { floor.saturating_add(1) } else { floor };
    rounded.clamp(i32::MIN.into(), i32::MAX.into()) as i32
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    use super::*;

    #[test]
    fn quotients_at_the_ends_equal_those_of_the_modes() {
        let ends = [i64::MIN, i64::MIN + 1, -3, -2, -1, 0, 1, 2, 3, i64::MAX - 1, i64::MAX];
        for (a, b) in ends.into_iter().flat_map(|a| ends.map(|b| (i128::from(a), i128::from(b)))) {
            assert_eq!(Nearest32.quotient(a, b), Modes::default().quotient(a, b), "{a} / {b}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 2000, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

        #[test]
        fn equals_the_modes_chosen_at_run_time(value: i64, high: i32, shift in 0u32..64) {
            let (fast, slow) = (Nearest32, Modes::default());
            let value128 = (i128::from(high) << 60) + i128::from(value);
            prop_assert_eq!(fast.narrow(value128, shift), slow.narrow(value128, shift));
            prop_assert_eq!(fast.widen(value128, shift), slow.widen(value128, shift));
            prop_assert_eq!(fast.narrow64(value, shift), slow.narrow64(value, shift));
        }

        #[test]
        fn sums_equal_those_of_the_modes(
            a: i64, b: i64, words in prop::array::uniform6(prop::sample::select(vec![i32::MIN, i32::MIN + 1, -3, -1, 0, 1, 2, i32::MAX])),
            components: [i32; 6], drawn in prop::array::uniform6(any::<bool>()), shift in 0u32..64,
        ) {
            let (fast, slow) = (Nearest32, Modes::default());
            prop_assert_eq!(fast.widen64(a), slow.widen64(a));
            prop_assert_eq!(fast.widen_sum(a, b), slow.widen_sum(a, b));
            prop_assert_eq!(fast.widen_difference(a, b), slow.widen_difference(a, b));
            let word = |k: usize| i64::from(if drawn[k] { components[k] } else { words[k] });
            let products = [0, 1, 2].map(|k| word(k) * word(k + 3));
            prop_assert_eq!(fast.widen_products(products), slow.widen_products(products));
            prop_assert_eq!(fast.narrow_products(products, shift), slow.narrow_products(products, shift));
        }

        #[test]
        fn quotients_equal_those_of_the_modes(dividend: i64, divisor: i64, left in 0u32..64, right in 0u32..64) {
            for (a, b) in [(dividend, divisor), (dividend >> right, divisor >> left), (dividend, divisor >> right)] {
                for (a, b) in [(a.into(), b.into()), (i128::from(a) << left, b.into()), (2 * i128::from(b) + 1, 2)] {
                    prop_assert_eq!(Nearest32.quotient(a, b), Modes::default().quotient(a, b), "{} / {}", a, b);
                }
            }
        }
    }
}
