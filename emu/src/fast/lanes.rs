//! The registers of work items that run side by side: for each register the values of all lanes one behind the other, so
//! that an instruction is a loop over neighbours. What the bits mean is the business of the rows.

use isa::number::Vector;

use crate::registers::{Registers, SCALARS, VECTORS, WIDES};

/// Work items that run side by side.
pub const LANES: usize = 32;

/// A set of lanes, a bit each.
pub type Mask = u32;

/// One value of 32 bits a lane.
pub type Words = [i32; LANES];

/// One value of 64 bits a lane.
pub type Longs = [i64; LANES];

/// The lanes of a set, lowest first.
#[inline(always)]
pub fn each(mask: Mask) -> impl Iterator<Item = usize> {
    let mut rest = mask;
    std::iter::from_fn(move || {
        let lane = rest.trailing_zeros();
        (rest != 0).then(|| {
            rest &= rest - 1;
            lane as usize
        })
    })
}

/// The lanes for which a claim holds.
#[inline(always)]
pub fn where_true(claim: impl Fn(usize) -> bool) -> Mask {
    let mut mask = 0;
    for lane in 0..LANES {
        mask |= Mask::from(claim(lane)) << lane;
    }
    mask
}

/// Sets some lanes to a value.
#[inline(always)]
pub fn fill<T: Copy>(row: &mut [T; LANES], mask: Mask, value: T) {
    for (lane, place) in row.iter_mut().enumerate() {
        *place = if mask & 1 << lane != 0 { value } else { *place };
    }
}

/// Registers of all lanes.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub struct Lanes {
    /// Scalars by number; those of number 0 are zero.
    pub scalars: [Words; SCALARS],
    /// Vectors by number, then by their own lane.
    pub vectors: [[Words; 3]; VECTORS],
    /// Wide accumulators by number.
    pub wides: [Longs; WIDES],
}

impl Default for Lanes {
    fn default() -> Lanes {
        Lanes { scalars: [[0; LANES]; SCALARS], vectors: [[[0; LANES]; 3]; VECTORS], wides: [[0; LANES]; WIDES] }
    }
}

/// Register numbers come from decoded fields, which the decoder has checked; the remainders only tell that to the compiler.
impl Lanes {
    /// All zero, as after reset.
    pub fn reset(&mut self) {
        self.scalars.fill([0; LANES]);
        self.vectors.fill([[0; LANES]; 3]);
        self.wides.fill([0; LANES]);
    }

    /// A scalar of all lanes.
    #[inline(always)]
    pub fn scalar(&self, number: u8) -> &Words {
        &self.scalars[usize::from(number) % SCALARS]
    }

    /// A scalar of all lanes, to write; number 0 is to be zero afterwards.
    #[inline(always)]
    pub fn scalar_mut(&mut self, number: u8) -> &mut Words {
        &mut self.scalars[usize::from(number) % SCALARS]
    }

    /// A vector of all lanes.
    #[inline(always)]
    pub fn vector(&self, number: u8) -> &[Words; 3] {
        &self.vectors[usize::from(number) % VECTORS]
    }

    /// A vector of all lanes, to write.
    #[inline(always)]
    pub fn vector_mut(&mut self, number: u8) -> &mut [Words; 3] {
        &mut self.vectors[usize::from(number) % VECTORS]
    }

    /// A wide accumulator of all lanes.
    #[inline(always)]
    pub fn wide(&self, number: u8) -> &Longs {
        &self.wides[usize::from(number) % WIDES]
    }

    /// A wide accumulator of all lanes, to write.
    #[inline(always)]
    pub fn wide_mut(&mut self, number: u8) -> &mut Longs {
        &mut self.wides[usize::from(number) % WIDES]
    }

    /// `N` consecutive vectors of one lane from `number` on.
    #[inline(always)]
    pub fn vectors<const N: usize>(&self, number: u8, lane: usize) -> [Vector; N] {
        std::array::from_fn(|at| {
            let vector = self.vector(number.wrapping_add(at as u8));
            [vector[0][lane], vector[1][lane], vector[2][lane]]
        })
    }

    /// Sets `N` consecutive vectors of one lane from `number` on.
    #[inline(always)]
    pub fn set_vectors<const N: usize>(&mut self, number: u8, lane: usize, values: [Vector; N]) {
        for (at, value) in values.into_iter().enumerate() {
            let vector = self.vector_mut(number.wrapping_add(at as u8));
            for (place, value) in vector.iter_mut().zip(value) {
                place[lane] = value;
            }
        }
    }

    /// Three consecutive wide accumulators of one lane from `number` on.
    #[inline(always)]
    pub fn wides3(&self, number: u8, lane: usize) -> [i64; 3] {
        std::array::from_fn(|at| self.wide(number.wrapping_add(at as u8))[lane])
    }

    /// Sets three consecutive wide accumulators of one lane from `number` on.
    #[inline(always)]
    pub fn set_wides3(&mut self, number: u8, lane: usize, values: [i64; 3]) {
        for (at, value) in values.into_iter().enumerate() {
            self.wide_mut(number.wrapping_add(at as u8))[lane] = value;
        }
    }

    /// The registers of one lane.
    pub fn registers(&self, lane: usize) -> Registers {
        let mut registers = Registers::default();
        for number in 0..SCALARS as u8 {
            registers.set_scalar(number, self.scalar(number)[lane]);
        }
        for number in 0..VECTORS as u8 {
            registers.set_vectors(number, self.vectors::<1>(number, lane));
        }
        for number in 0..WIDES as u8 {
            registers.set_wide(number, self.wide(number)[lane]);
        }
        registers
    }
}
