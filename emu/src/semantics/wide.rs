//! Semantics of the instructions on wide accumulators. Numeric rows quantize to twice the word; rows on patterns always see the
//! 64 bits of the register.

use isa::number::{Arithmetic, Vector, split_shift};
use isa::table::Done;

use super::WideRoom;

fn product(a: i32, b: i32) -> i64 {
    i64::from(a) * i64::from(b)
}

impl<T: Arithmetic> WideRoom for T {
    #[inline]
    fn wmul(&self, a: i32, b: i32) -> (i64, Done) {
        (self.widen64(product(a, b)), Done)
    }

    #[inline]
    fn wmac(&self, x: i64, a: i32, b: i32) -> (i64, Done) {
        (self.widen_sum(x, product(a, b)), Done)
    }

    #[inline]
    fn wmsub(&self, x: i64, a: i32, b: i32) -> (i64, Done) {
        (self.widen_difference(x, product(a, b)), Done)
    }

    #[inline]
    fn wdot(&self, a: Vector, b: Vector) -> (i64, Done) {
        (self.widen_products(std::array::from_fn(|k| product(a[k], b[k]))), Done)
    }

    #[inline]
    fn wadd(&self, a: i64, b: i64) -> (i64, Done) {
        (self.widen_sum(a, b), Done)
    }

    #[inline]
    fn wsub(&self, a: i64, b: i64) -> (i64, Done) {
        (self.widen_difference(a, b), Done)
    }

    #[inline]
    fn wmulw(&self, a: i64, b: i64) -> (i64, Done) {
        (self.widen(i128::from(a) * i128::from(b), 0), Done)
    }

    #[inline]
    fn wneg(&self, a: i64) -> (i64, Done) {
        (self.widen_difference(0, a), Done)
    }

    #[inline]
    fn wmov(&self, a: i64) -> (i64, Done) {
        (a, Done)
    }

    #[inline]
    fn wextend(&self, a: i32, i: i32) -> (i64, Done) {
        (self.widen(i128::from(a) << i, 0), Done)
    }

    #[inline]
    fn wround(&self, a: i64, i: i32) -> (i32, Done) {
        (self.narrow64(a, i as u32), Done)
    }

    #[inline]
    fn wscale(&self, a: i64, b: i32) -> (i32, Done) {
        let (value, shift) = split_shift(a.into(), b.clamp(-63, 63));
        (self.narrow(value, shift), Done)
    }

    #[inline]
    fn wdiv(&self, a: i64, b: i64, i: i32) -> (i32, Done) {
        (self.quotient(i128::from(a) << i, b.into()), Done)
    }

    #[inline]
    fn wsqrt(&self, a: i64, i: i32) -> (i32, Done) {
        (self.root((a.max(0) as u128) << i), Done)
    }

    #[inline]
    fn wand(&self, a: i64, b: i64) -> (i64, Done) {
        (a & b, Done)
    }

    #[inline]
    fn wsll(&self, a: i64, b: i32) -> (i64, Done) {
        (a << (b & 63), Done)
    }

    #[inline]
    fn wsrl(&self, a: i64, b: i32) -> (i64, Done) {
        ((a as u64 >> (b & 63)) as i64, Done)
    }

    #[inline]
    fn wclz(&self, a: i64) -> (i32, Done) {
        (a.leading_zeros() as i32, Done)
    }

    #[inline]
    fn wltz(&self, a: i64) -> (i64, Done) {
        (a >> 63, Done)
    }

    #[inline]
    fn wlow(&self, a: i64) -> (i32, Done) {
        (a as i32, Done)
    }

    #[inline]
    fn whigh(&self, a: i64) -> (i32, Done) {
        ((a >> 32) as i32, Done)
    }

    #[inline]
    fn wjoin(&self, a: i32, b: i32) -> (i64, Done) {
        (i64::from(a) << 32 | i64::from(b as u32), Done)
    }

    #[inline]
    fn wcross(&self, a: Vector, b: Vector) -> ([i64; 3], Done) {
        // It fits 64 bits: see the cross product of the vectors.
        let minor = |j: usize, k: usize| self.widen64(product(a[j], b[k]) - product(a[k], b[j]));
        ([minor(1, 2), minor(2, 0), minor(0, 1)], Done)
    }

    #[inline]
    fn wmixed(&self, a: [i64; 3], b: Vector, i: i32) -> (i64, Done) {
        let exact = (0..3).map(|k| i128::from(a[k]) * i128::from(b[k])).sum();
        (self.widen(exact, i as u32), Done)
    }
}
