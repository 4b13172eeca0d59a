//! Fixed-point arithmetic on raw integers: quantization and overflow in the modes of IEEE 1666, exact quotients, and
//! correctly rounded roots, and the exact tests of rays. Which format a raw integer has is the caller's business; every function says how it rounds.

mod modes;
mod nearest;
pub mod ray;
mod root;

pub use modes::{Flags, Modes, Overflow, Quantization};
pub use nearest::Nearest32;
pub use root::square_root;

/// Three raw components.
pub type Vector = [i32; 3];

/// The machine's word length and modes. All operations take exact integers and round once.
pub trait Arithmetic {
    /// Bits of a word, 8 to 32.
    fn word(&self) -> u32;

    /// `value / 2^shift`, quantized and brought into `bits` bits (at most 64); `shift` at most 126.
    fn quantize(&self, value: i128, shift: u32, bits: u32) -> i64;

    /// `value / 2^shift` as a word.
    fn narrow(&self, value: i128, shift: u32) -> i32 {
        self.quantize(value, shift, self.word()) as i32
    }

    /// `value / 2^shift` as a word, for values of 64 bits; `shift` at most 63.
    fn narrow64(&self, value: i64, shift: u32) -> i32 {
        self.narrow(value.into(), shift)
    }

    /// `value / 2^shift` as a wide number of twice the word.
    fn widen(&self, value: i128, shift: u32) -> i64 {
        self.quantize(value, shift, 2 * self.word())
    }

    /// A number of 64 bits as a wide number of twice the word.
    fn widen64(&self, value: i64) -> i64 {
        self.widen(value.into(), 0)
    }

    /// The exact sum `a + b` as a wide number of twice the word.
    fn widen_sum(&self, a: i64, b: i64) -> i64 {
        self.widen(i128::from(a) + i128::from(b), 0)
    }

    /// The exact difference `a - b` as a wide number of twice the word.
    fn widen_difference(&self, a: i64, b: i64) -> i64 {
        self.widen(i128::from(a) - i128::from(b), 0)
    }

    /// The exact sum of three products of words as a wide number of twice the word.
    fn widen_products(&self, products: [i64; 3]) -> i64 {
        self.widen(products.into_iter().map(i128::from).sum(), 0)
    }

    /// The exact sum of three products of words, over `2^shift`, as a word; `shift` at most 63.
    fn narrow_products(&self, products: [i64; 3], shift: u32) -> i32 {
        self.narrow(products.into_iter().map(i128::from).sum(), shift)
    }

    /// The exact quotient, quantized once to a word; x / 0 overflows with the sign of x, 0 / 0 = 0.
    fn quotient(&self, dividend: i128, divisor: i128) -> i32;

    /// The square root of a non-negative integer, correctly rounded to nearest (a root is never a tie), as a word.
    fn root(&self, value: u128) -> i32 {
        self.narrow(square_root(value).into(), 0)
    }
}

/// The shift right (negative: left) after which the largest component lies in [2^(word-3), 2^(word-2)); 0 for a zero vector.
///
/// Rounding may then bring the largest component to 2^(word-2) exactly.
pub fn normalizing_shift(components: [i128; 3], word: u32) -> i32 {
    // (5, -9, 2) in a word of 32 bits: 9 has 4 bits, which come to 30 by a shift of -26.
    let largest = components.map(i128::unsigned_abs).into_iter().max().unwrap_or(0);
    if largest == 0 { 0 } else { (128 - largest.leading_zeros()) as i32 - (word as i32 - 2) }
}

/// `value` times 2^-shift, where a negative shift goes left; exact to the left, unrounded input for [`Arithmetic::quantize`].
///
/// Returns the exact numerator and the shift right that is left to do.
pub const fn split_shift(value: i128, shift: i32) -> (i128, u32) {
    if shift < 0 { (value << -shift, 0) } else { (value, shift as u32) }
}
