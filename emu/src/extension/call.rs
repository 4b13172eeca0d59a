//! Call of a meaning in Rust: operands as values, results that wait for its end, the local buffer, octets from the bus.

use isa::number::Vector;
use isa::{Fields, Kind};

use super::Numbers;
use super::units::{Results, Shape};
use crate::code::octets::Buffer;
use crate::code::registers::Registers;

/// Letters of operands that are written.
pub(super) const WRITTEN: [u8; 4] = *b"dexy";

/// The place of an operand's letter.
#[inline(always)]
pub(super) const fn place(letter: char) -> usize {
    match letter {
        'd' => 0,
        'e' => 1,
        'x' => 2,
        'y' => 3,
        'a' => 4,
        'b' => 5,
        'c' => 6,
        'i' => 7,
        _ => 8,
    }
}

/// Operands, as they are before the instruction: also those that it writes.
///
/// A letter that the row does not have, or has as another kind, is a mistake in the meaning: asking for it panics.
#[derive(Clone, Copy)]
pub struct Operands<'a> {
    pub(super) registers: &'a Registers,
    pub(super) fields: &'a Fields,
    pub(super) shape: &'a Shape,
}

impl Operands<'_> {
    /// The field of an operand whose kind fits.
    #[inline(always)]
    fn field(&self, letter: char, fits: impl Fn(Kind) -> bool, what: &str) -> i64 {
        match self.shape.kinds[place(letter)] {
            Some(kind) if fits(kind) => self.fields.get(letter as u8),
            _ => self.shape.wrong(letter, what),
        }
    }

    /// The scalar in an operand of kind `S` or `A`.
    #[inline]
    pub fn scalar(&self, letter: char) -> i32 {
        self.registers.scalar(self.field(letter, |kind| matches!(kind, Kind::S | Kind::A), "a scalar") as u8)
    }

    /// The address in an operand of kind `A` or `S`, in octets.
    #[inline]
    pub fn address(&self, letter: char) -> u32 {
        self.scalar(letter) as u32
    }

    /// The vector in an operand of kind `V`, or the first one of a group.
    #[inline]
    pub fn vector(&self, letter: char) -> Vector {
        self.registers.vector(self.field(letter, |kind| kind.register_file() == Some('v'), "a vector") as u8)
    }

    /// The vectors in an operand of kind `V2`, `V3` or `V5`.
    #[inline]
    pub fn vectors<const N: usize>(&self, letter: char) -> [Vector; N] {
        let fits = |kind: Kind| kind.register_file() == Some('v') && usize::from(kind.registers()) == N;
        self.registers.vectors(self.field(letter, fits, "a group of so many vectors") as u8)
    }

    /// The wide accumulator in an operand of kind `W`, or the first one of a group.
    #[inline]
    pub fn wide(&self, letter: char) -> i64 {
        self.registers.wide(self.field(letter, |kind| kind.register_file() == Some('w'), "a wide accumulator") as u8)
    }

    /// The wide accumulators in an operand of kind `W3`.
    #[inline]
    pub fn wides(&self, letter: char) -> [i64; 3] {
        self.registers.wides(self.field(letter, |kind| kind == Kind::W3, "a group of wide accumulators") as u8)
    }

    /// The number in an operand `i` or `j`.
    #[inline]
    pub fn immediate(&self, letter: char) -> i32 {
        self.field(letter, |kind| kind.register_file().is_none(), "an immediate") as i32
    }
}

/// One execution of an instruction.
pub struct Call<'a> {
    /// Operands.
    pub operands: Operands<'a>,
    /// The core's local buffer. What is written there stays, also when the instruction traps.
    pub buffer: &'a mut Buffer,
    /// The words of global memory that [`super::Meaning::reads`] asked for.
    pub words: &'a [i32],
    /// The machine's word length and modes. Scalars and vectors that are numbers have to fit its word.
    pub arithmetic: &'a Numbers<'a>,
    pub(super) results: &'a mut Results,
}

impl Call<'_> {
    /// The place of a destination whose kind fits.
    #[inline(always)]
    fn result(&mut self, letter: char, fits: impl Fn(Kind) -> bool, what: &str) -> usize {
        let shape = self.operands.shape;
        match shape.kinds[place(letter)] {
            Some(kind) if place(letter) < WRITTEN.len() && fits(kind) => {
                self.results.written |= 1 << place(letter);
                place(letter)
            }
            _ => shape.wrong(letter, what),
        }
    }

    /// Sets a destination of kind `S` or `A`.
    #[inline]
    pub fn set_scalar(&mut self, letter: char, value: i32) {
        let place = self.result(letter, |kind| kind.register_file() == Some('s'), "a scalar that is written");
        self.results.scalars[place] = value;
    }

    /// Sets a destination of kind `V`.
    #[inline]
    pub fn set_vector(&mut self, letter: char, value: Vector) {
        self.set_vectors(letter, [value]);
    }

    /// Sets a destination of kind `V2`, `V3` or `V5`.
    #[inline]
    pub fn set_vectors<const N: usize>(&mut self, letter: char, values: [Vector; N]) {
        let fits = |kind: Kind| kind.register_file() == Some('v') && usize::from(kind.registers()) == N;
        let place = self.result(letter, fits, "so many vectors that are written");
        self.results.vectors[place][..N].copy_from_slice(&values);
    }

    /// Sets a destination of kind `W`.
    #[inline]
    pub fn set_wide(&mut self, letter: char, value: i64) {
        let place = self.result(letter, |kind| kind == Kind::W, "a wide accumulator that is written");
        self.results.wides[place][0] = value;
    }

    /// Sets a destination of kind `W3`.
    #[inline]
    pub fn set_wides(&mut self, letter: char, values: [i64; 3]) {
        let place = self.result(letter, |kind| kind == Kind::W3, "a group of wide accumulators that is written");
        self.results.wides[place] = values;
    }
}
