//! Places for a row's results: as in [`crate::code::registers`], but a vector in one piece, because what is written in pieces is read late by a host that reads
//! it at once.

use isa::number::Vector;

use crate::code::registers::Registers;

/// Sets a vector.
#[inline(always)]
pub(super) fn set_vector(registers: &mut Registers, number: u8, value: Vector) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_mm_setr_epi32, _mm_storeu_si128};
        let place = registers.padded_mut(number).as_mut_ptr();
        // SAFETY: the place has four words, and any alignment will do. The safe twin is below.
        unsafe { _mm_storeu_si128(place.cast(), _mm_setr_epi32(value[0], value[1], value[2], 0)) };
    }
    #[cfg(not(target_arch = "x86_64"))]
    registers.set_vector(number, value);
}

/// Puts a value where a written operand says.
macro_rules! put {
    ($registers:expr, $fields:expr, $letter:ident V) => {
        $crate::engine::native::operands::set_vector($registers, $fields.$letter, $letter)
    };
    ($registers:expr, $fields:expr, $letter:ident S) => {
        $registers.set_other_scalar($fields.$letter, $letter)
    };
    ($registers:expr, $fields:expr, $letter:ident V2) => {
        put!($registers, $fields, $letter vectors)
    };
    ($registers:expr, $fields:expr, $letter:ident V3) => {
        put!($registers, $fields, $letter vectors)
    };
    ($registers:expr, $fields:expr, $letter:ident V5) => {
        put!($registers, $fields, $letter vectors)
    };
    ($registers:expr, $fields:expr, $letter:ident vectors) => {
        for (at, value) in $letter.into_iter().enumerate() {
            $crate::engine::native::operands::set_vector($registers, $fields.$letter.wrapping_add(at as u8), value);
        }
    };
    ($registers:expr, $fields:expr, $letter:ident $kind:ident) => {
        $crate::registers::write!($registers, $fields, $letter $kind)
    };
}

pub(super) use put;
