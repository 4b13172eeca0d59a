//! The registers of a core. What their bits mean is the business of the rows.

use isa::number::Vector;

/// Scalar registers that programs can name.
pub const SCALARS: usize = 32;

/// Vector registers that programs can name.
pub const VECTORS: usize = 32;

/// Wide accumulators that programs can name.
pub const WIDES: usize = 8;

/// Registers of a core, all zero after reset.
///
/// Behind those that programs can name come hidden ones (scalars and vectors 32 to 63, wide accumulators 8 to 15), in which bodies of
/// extension instructions work. A body reads none that it has not written, so what one leaves there no other one sees.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Registers {
    scalars: [i32; 64],
    vectors: [Vector; 64],
    wides: [i64; 16],
}

impl Default for Registers {
    fn default() -> Registers {
        Registers { scalars: [0; 64], vectors: [[0; 3]; 64], wides: [0; 16] }
    }
}

/// Register numbers come from decoded fields, which the decoder has checked; the masks only tell that to the compiler.
impl Registers {
    /// `s0` to `s31`; `s0` is zero.
    #[inline]
    pub fn scalar(&self, number: u8) -> i32 {
        self.scalars[usize::from(number & 63)]
    }

    /// Sets a scalar; `s0` stays zero.
    #[inline]
    pub fn set_scalar(&mut self, number: u8, value: i32) {
        self.scalars[usize::from(number & 63)] = value;
        self.scalars[0] = 0;
    }

    /// `v0` to `v31`.
    #[inline]
    pub fn vector(&self, number: u8) -> Vector {
        self.vectors[usize::from(number & 63)]
    }

    /// Sets a vector.
    #[inline]
    pub fn set_vector(&mut self, number: u8, value: Vector) {
        self.vectors[usize::from(number & 63)] = value;
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
        self.wides[usize::from(number & 15)]
    }

    /// Sets a wide accumulator.
    #[inline]
    pub fn set_wide(&mut self, number: u8, value: i64) {
        self.wides[usize::from(number & 15)] = value;
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
