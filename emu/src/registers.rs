//! The registers of a core. What their bits mean is the business of the rows.

use isa::number::Vector;

/// Scalar registers that programs can name.
pub const SCALARS: usize = 32;

/// Vector registers that programs can name.
pub const VECTORS: usize = 32;

/// Wide accumulators that programs can name.
pub const WIDES: usize = 8;

/// A vector with a lane that is always 0: moved at once where the host can.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(align(16))]
struct Padded([i32; 4]);

/// Registers of a core, all zero after reset.
///
/// Behind those that programs can name come hidden ones (scalars and vectors 32 to 63, wide accumulators 8 to 15), in which bodies of
/// extension instructions work. A body reads none that it has not written, so what one leaves there no other one sees.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Registers {
    scalars: [i32; 64],
    vectors: [Padded; 64],
    wides: [i64; 16],
}

impl Default for Registers {
    fn default() -> Registers {
        Registers { scalars: [0; 64], vectors: [Padded([0; 4]); 64], wides: [0; 16] }
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
        let [x, y, z, _] = self.vectors[usize::from(number & 63)].0;
        [x, y, z]
    }

    /// A vector with a fourth lane, which is 0.
    #[inline]
    pub(crate) fn padded(&self, number: u8) -> &[i32; 4] {
        &self.vectors[usize::from(number & 63)].0
    }

    /// The same to write; the fourth lane is to stay 0.
    #[inline]
    pub(crate) fn padded_mut(&mut self, number: u8) -> &mut [i32; 4] {
        &mut self.vectors[usize::from(number & 63)].0
    }

    /// Sets a vector.
    #[inline]
    pub fn set_vector(&mut self, number: u8, value: Vector) {
        let [x, y, z] = value;
        self.vectors[usize::from(number & 63)] = Padded([x, y, z, 0]);
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

/// The value of an operand that a meaning reads.
macro_rules! read {
    ($registers:expr, $fields:expr, $letter:ident S) => {
        $registers.scalar($fields.$letter)
    };
    ($registers:expr, $fields:expr, $letter:ident A) => {
        $registers.scalar($fields.$letter) as u32
    };
    ($registers:expr, $fields:expr, $letter:ident V) => {
        $registers.vector($fields.$letter)
    };
    ($registers:expr, $fields:expr, $letter:ident W) => {
        $registers.wide($fields.$letter)
    };
    ($registers:expr, $fields:expr, $letter:ident V2) => {
        $registers.vectors::<2>($fields.$letter)
    };
    ($registers:expr, $fields:expr, $letter:ident V3) => {
        $registers.vectors::<3>($fields.$letter)
    };
    ($registers:expr, $fields:expr, $letter:ident V5) => {
        $registers.vectors::<5>($fields.$letter)
    };
    ($registers:expr, $fields:expr, $letter:ident W3) => {
        $registers.wides::<3>($fields.$letter)
    };
    ($registers:expr, $fields:expr, $letter:ident $immediate:ident) => {
        $fields.$letter
    };
}

/// Puts a value where a written operand says.
macro_rules! write {
    ($registers:expr, $fields:expr, $letter:ident S) => {{
        let value: i32 = $letter;
        $registers.set_scalar($fields.$letter, value)
    }};
    ($registers:expr, $fields:expr, $letter:ident V) => {{
        let value: isa::number::Vector = $letter;
        $registers.set_vector($fields.$letter, value)
    }};
    ($registers:expr, $fields:expr, $letter:ident W) => {{
        let value: i64 = $letter;
        $registers.set_wide($fields.$letter, value)
    }};
    ($registers:expr, $fields:expr, $letter:ident V2) => {
        $registers.set_vectors::<2>($fields.$letter, $letter)
    };
    ($registers:expr, $fields:expr, $letter:ident V3) => {
        $registers.set_vectors::<3>($fields.$letter, $letter)
    };
    ($registers:expr, $fields:expr, $letter:ident V5) => {
        $registers.set_vectors::<5>($fields.$letter, $letter)
    };
    ($registers:expr, $fields:expr, $letter:ident W3) => {
        $registers.set_wides::<3>($fields.$letter, $letter)
    };
}

pub(crate) use {read, write};
