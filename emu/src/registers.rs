//! The registers of a core. What their bits mean is the business of the rows.

use isa::number::Vector;

/// Registers of a core, all zero after reset.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Registers {
    scalars: [i32; 32],
    vectors: [Vector; 32],
    wides: [i64; 8],
}

/// Register numbers come from decoded fields, which the decoder has checked; the masks only tell that to the compiler.
impl Registers {
    /// `s0` to `s31`; `s0` is zero.
    #[inline]
    pub fn scalar(&self, number: u8) -> i32 {
        self.scalars[usize::from(number & 31)]
    }

    /// Sets a scalar; `s0` stays zero.
    #[inline]
    pub fn set_scalar(&mut self, number: u8, value: i32) {
        self.scalars[usize::from(number & 31)] = value;
        self.scalars[0] = 0;
    }

    /// `v0` to `v31`.
    #[inline]
    pub fn vector(&self, number: u8) -> Vector {
        self.vectors[usize::from(number & 31)]
    }

    /// Sets a vector.
    #[inline]
    pub fn set_vector(&mut self, number: u8, value: Vector) {
        self.vectors[usize::from(number & 31)] = value;
    }

    /// `N` consecutive vectors from `number` on.
    #[inline]
    pub fn vectors<const N: usize>(&self, number: u8) -> [Vector; N] {
        std::array::from_fn(|at| self.vector(number.wrapping_add(at as u8)))
    }

    /// Sets `N` consecutive vectors from `number` on.
    #[inline]
    pub fn set_vectors<const N: usize>(&mut self, number: u8, values: [Vector; N]) {
        for (at, value) in values.into_iter().enumerate() {
            self.set_vector(number.wrapping_add(at as u8), value);
        }
    }

    /// `w0` to `w7`.
    #[inline]
    pub fn wide(&self, number: u8) -> i64 {
        self.wides[usize::from(number & 7)]
    }

    /// Sets a wide accumulator.
    #[inline]
    pub fn set_wide(&mut self, number: u8, value: i64) {
        self.wides[usize::from(number & 7)] = value;
    }

    /// `N` consecutive wide accumulators from `number` on.
    #[inline]
    pub fn wides<const N: usize>(&self, number: u8) -> [i64; N] {
        std::array::from_fn(|at| self.wide(number.wrapping_add(at as u8)))
    }

    /// Sets `N` consecutive wide accumulators from `number` on.
    #[inline]
    pub fn set_wides<const N: usize>(&mut self, number: u8, values: [i64; N]) {
        for (at, value) in values.into_iter().enumerate() {
            self.set_wide(number.wrapping_add(at as u8), value);
        }
    }
}
