//! Semantics of the numeric instructions on scalars.

use isa::number::{Arithmetic, split_shift};
use isa::table::Done;

use super::ScalarRoom;

impl<T: Arithmetic> ScalarRoom for T {
    #[inline]
    fn add(&self, a: i32, b: i32) -> (i32, Done) {
        (self.narrow64(i64::from(a) + i64::from(b), 0), Done)
    }

    #[inline]
    fn sub(&self, a: i32, b: i32) -> (i32, Done) {
        (self.narrow64(i64::from(a) - i64::from(b), 0), Done)
    }

    #[inline]
    fn neg(&self, a: i32) -> (i32, Done) {
        (self.narrow64(-i64::from(a), 0), Done)
    }

    #[inline]
    fn abs(&self, a: i32) -> (i32, Done) {
        (self.narrow64(i64::from(a).abs(), 0), Done)
    }

    #[inline]
    fn mul(&self, a: i32, b: i32, i: i32) -> (i32, Done) {
        (self.narrow64(i64::from(a) * i64::from(b), i as u32), Done)
    }

    #[inline]
    fn div(&self, a: i32, b: i32, i: i32) -> (i32, Done) {
        (self.quotient(i128::from(a) << i, b.into()), Done)
    }

    #[inline]
    fn min(&self, a: i32, b: i32) -> (i32, Done) {
        (self.narrow64(Ord::min(a, b).into(), 0), Done)
    }

    #[inline]
    fn max(&self, a: i32, b: i32) -> (i32, Done) {
        (self.narrow64(Ord::max(a, b).into(), 0), Done)
    }

    #[inline]
    fn rshift(&self, a: i32, i: i32) -> (i32, Done) {
        (self.narrow64(a.into(), i as u32), Done)
    }

    #[inline]
    fn lshift(&self, a: i32, i: i32) -> (i32, Done) {
        (self.narrow(i128::from(a) << i, 0), Done)
    }

    #[inline]
    fn scale(&self, a: i32, b: i32) -> (i32, Done) {
        let (value, shift) = split_shift(a.into(), b.clamp(-63, 63));
        (self.narrow(value, shift), Done)
    }
}
