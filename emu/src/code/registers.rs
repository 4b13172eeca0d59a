//! The registers of a core. What their bits mean is the business of the rows.

use isa::number::Vector;

/// Scalar registers that programs can name.
pub const SCALARS: usize = 32;

/// Vector registers that programs can name.
pub const VECTORS: usize = 32;

/// Wide accumulators that programs can name.
pub const WIDES: usize = 8;

/// A vector with a component that is always 0: moved at once where the host can.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(align(16))]
struct Padded([i32; 4]);

/// Registers of a core, all zero after reset.
///
/// Behind those that programs can name come hidden ones (scalars and vectors 32 to 63, wide accumulators 8 to 15), in which bodies of
/// extension instructions work. A body reads none that it has not written, so what one leaves there no other one sees.
///
/// There is room for every number of eight bits, so that none has to be checked.
#[derive(Clone, Debug)]
pub struct Registers {
    scalars: [i32; ROOM],
    vectors: [Padded; ROOM],
    wides: [i64; ROOM],
}

/// Numbers of eight bits.
const ROOM: usize = 1 << 8;

/// Scalars and vectors that are used at all, hidden ones included; of wide accumulators there are fewer.
const USED: usize = 64;

impl Default for Registers {
    fn default() -> Registers {
        Registers { scalars: [0; ROOM], vectors: [Padded([0; 4]); ROOM], wides: [0; ROOM] }
    }
}

impl PartialEq for Registers {
    fn eq(&self, other: &Registers) -> bool {
        self.scalars[..USED] == other.scalars[..USED]
            && self.vectors[..USED] == other.vectors[..USED]
            && self.wides[..USED] == other.wides[..USED]
    }
}

impl Eq for Registers {}

impl Registers {
    /// The scalar that takes what is written to `s0` where nobody reads it.
    pub(crate) const NOWHERE: u8 = u8::MAX;

    /// Place of a scalar, in octets from the beginning.
    #[cfg(feature = "native")]
    pub(crate) const fn scalar_offset(number: u8) -> i32 {
        (std::mem::offset_of!(Registers, scalars) + size_of::<i32>() * number as usize) as i32
    }

    /// Place of a vector of four components, of which the last one is 0, in octets from the beginning.
    #[cfg(feature = "native")]
    pub(crate) const fn vector_offset(number: u8) -> i32 {
        (std::mem::offset_of!(Registers, vectors) + size_of::<Padded>() * number as usize) as i32
    }

    /// Place of a wide accumulator, in octets from the beginning.
    #[cfg(feature = "native")]
    pub(crate) const fn wide_offset(number: u8) -> i32 {
        (std::mem::offset_of!(Registers, wides) + size_of::<i64>() * number as usize) as i32
    }

    /// All zero, as after reset.
    pub fn reset(&mut self) {
        self.scalars[..USED].fill(0);
        self.vectors[..USED].fill(Padded([0; 4]));
        self.wides[..USED].fill(0);
    }

    /// Sets a scalar that is not `s0`.
    #[cfg(feature = "native")]
    #[inline]
    pub(crate) fn set_other_scalar(&mut self, number: u8, value: i32) {
        debug_assert!(number != 0);
        self.scalars[usize::from(number)] = value;
    }

    /// `s0` to `s31`; `s0` is zero.
    #[inline]
    pub fn scalar(&self, number: u8) -> i32 {
        self.scalars[usize::from(number)]
    }

    /// Sets a scalar; `s0` stays zero.
    #[inline]
    pub fn set_scalar(&mut self, number: u8, value: i32) {
        self.scalars[usize::from(number)] = value;
        self.scalars[0] = 0;
    }

    /// `v0` to `v31`.
    #[inline]
    pub fn vector(&self, number: u8) -> Vector {
        let [x, y, z, _] = self.vectors[usize::from(number)].0;
        [x, y, z]
    }

    /// A vector with a fourth component, which is 0.
    #[cfg(feature = "native")]
    #[inline]
    pub(crate) fn padded(&self, number: u8) -> &[i32; 4] {
        &self.vectors[usize::from(number)].0
    }

    /// Four words of a vector, to write; the fourth is to stay 0.
    #[cfg(feature = "native")]
    #[inline]
    pub(crate) fn padded_mut(&mut self, number: u8) -> &mut [i32; 4] {
        &mut self.vectors[usize::from(number)].0
    }

    /// Sets a vector.
    #[inline]
    pub fn set_vector(&mut self, number: u8, value: Vector) {
        let [x, y, z] = value;
        self.vectors[usize::from(number)] = Padded([x, y, z, 0]);
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
        self.wides[usize::from(number)]
    }

    /// Sets a wide accumulator.
    #[inline]
    pub fn set_wide(&mut self, number: u8, value: i64) {
        self.wides[usize::from(number)] = value;
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
    ($registers:expr, $fields:expr, $letter:ident Sh) => {
        $fields.$letter
    };
    ($registers:expr, $fields:expr, $letter:ident Im) => {
        $fields.$letter
    };
    ($registers:expr, $fields:expr, $letter:ident Un) => {
        $fields.$letter
    };
    ($registers:expr, $fields:expr, $letter:ident Off) => {
        $fields.$letter
    };
    ($registers:expr, $fields:expr, $letter:ident Rel) => {
        $fields.$letter
    };
    ($registers:expr, $fields:expr, $letter:ident Lane) => {
        $fields.$letter
    };
    ($registers:expr, $fields:expr, $letter:ident $kind:ident) => {
        compile_error!(concat!(
            "operands of kind `",
            stringify!($kind),
            "` are not read: say in `read!` (emu/src/code/registers.rs) from where"
        ))
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
    ($registers:expr, $fields:expr, $letter:ident $kind:ident) => {
        compile_error!(concat!(
            "operands of kind `",
            stringify!($kind),
            "` are not written: say in `write!` (emu/src/code/registers.rs) where to"
        ))
    };
}

pub(crate) use {read, write};
