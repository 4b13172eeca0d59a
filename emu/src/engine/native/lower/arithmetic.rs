//! Rounding and overflow in generated code, in the machine's modes: what [`isa::number::Modes`] does to exact integers of 64 bits. The
//! modes that wrap with saturated bits have no form; rows are calls there.

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::types::{I32, I64};
use cranelift_codegen::ir::{InstBuilder, Value};
use isa::number::{Overflow, Quantization};

use super::Lower;

impl Lower<'_, '_> {
    /// Bits of a word.
    pub fn word(&self) -> u32 {
        self.source.recipe.computes.modes.word
    }

    /// Results are brought into their bits by instructions here.
    pub fn has_form(&self) -> bool {
        matches!(
            self.source.recipe.computes.modes.overflow,
            Overflow::Sat | Overflow::SatZero | Overflow::SatSym | Overflow::Wrap(0)
        )
    }

    /// A sum that left its bits becomes the nearest number that fits.
    pub fn saturates(&self) -> bool {
        matches!(self.source.recipe.computes.modes.overflow, Overflow::Sat | Overflow::SatSym)
    }

    /// 1 as 64 bits where a claim holds.
    fn one_if(&mut self, claim: Value) -> Value {
        self.b.ins().uextend(I64, claim)
    }

    /// `value / 2^shift`, quantized, as 64 bits; `shift` at most 63.
    ///
    /// Six values at a shift of 2. The rest is that of the floor, so it is never negative, and 2 of 4 is a tie:
    ///
    /// | value | 6 | -6 | 10 | -10 | 7 | -7 |
    /// | --- | --- | --- | --- | --- | --- | --- |
    /// | exact | 1.5 | -1.5 | 2.5 | -2.5 | 1.75 | -1.75 |
    /// | floor, rest | 1, 2 | -2, 2 | 2, 2 | -3, 2 | 1, 3 | -2, 1 |
    /// | `Trn` | 1 | -2 | 2 | -3 | 1 | -2 |
    /// | `TrnZero` | 1 | -1 | 2 | -2 | 1 | -1 |
    /// | `Rnd` | 2 | -1 | 3 | -2 | 2 | -2 |
    /// | `RndZero` | 1 | -1 | 2 | -2 | 2 | -2 |
    /// | `RndInf` | 2 | -2 | 3 | -3 | 2 | -2 |
    /// | `RndConv` | 2 | -2 | 2 | -2 | 2 | -2 |
    /// | `RndMinInf` | 1 | -2 | 2 | -3 | 2 | -2 |
    pub fn rounded(&mut self, value: Value, shift: u32) -> Value {
        if shift == 0 {
            return value;
        }
        // All modes begin with the floor; they differ in when 1 is added
        let floor = self.b.ins().sshr_imm_s(value, i64::from(shift));
        let quantization = self.source.recipe.computes.modes.quantization;
        let up = match quantization {
            Quantization::Trn => return floor,
            Quantization::Rnd => {
                // The highest bit of the rest is the half: 1 for ties and for what is above
                let half = self.b.ins().ushr_imm_s(value, i64::from(shift - 1));
                self.b.ins().band_imm_s(half, 1)
            }
            _ => {
                // Compare the rest with the middle
                let rest = self.b.ins().band_imm_s(value, (1i64 << shift).wrapping_sub(1));
                let middle = self.c64(1 << (shift - 1));
                let is_tie = self.b.ins().icmp(IntCC::Equal, rest, middle);
                let is_above = self.b.ins().icmp(IntCC::SignedGreaterThan, rest, middle);
                // Decide ties; two modes ask for something else and return
                let goes_up = match quantization {
                    Quantization::TrnZero => {
                        let is_negative = self.b.ins().icmp_imm_s(IntCC::SignedLessThan, value, 0);
                        let has_rest = self.b.ins().icmp_imm_s(IntCC::NotEqual, rest, 0);
                        let goes_up = self.b.ins().band(is_negative, has_rest);
                        let up = self.one_if(goes_up);
                        return self.b.ins().iadd(floor, up);
                    }
                    Quantization::RndZero => self.b.ins().icmp_imm_s(IntCC::SignedLessThan, value, 0),
                    Quantization::RndInf => self.b.ins().icmp_imm_s(IntCC::SignedGreaterThanOrEqual, value, 0),
                    Quantization::RndConv => {
                        let odd = self.b.ins().band_imm_s(floor, 1);
                        self.b.ins().icmp_imm_s(IntCC::NotEqual, odd, 0)
                    }
                    Quantization::RndMinInf | Quantization::Rnd | Quantization::Trn => {
                        let up = self.one_if(is_above);
                        return self.b.ins().iadd(floor, up);
                    }
                };
                // Go up from above the middle, and from those ties
                let tie_up = self.b.ins().band(is_tie, goes_up);
                let goes_up = self.b.ins().bor(is_above, tie_up);
                self.one_if(goes_up)
            }
        };
        self.b.ins().iadd(floor, up)
    }

    /// A number of 64 bits brought into `bits` bits, at most 63.
    fn fit(&mut self, value: Value, bits: u32) -> Value {
        let largest = (1i64 << (bits - 1)) - 1;
        match self.source.recipe.computes.modes.overflow {
            Overflow::Sat => self.clamp(value, -largest - 1, largest),
            Overflow::SatSym => self.clamp(value, -largest, largest),
            Overflow::SatZero => {
                let room = i64::from(64 - bits);
                let left = self.b.ins().ishl_imm_s(value, room);
                let back = self.b.ins().sshr_imm_s(left, room);
                let fits = self.b.ins().icmp(IntCC::Equal, back, value);
                let zero = self.c64(0);
                self.b.ins().select(fits, value, zero)
            }
            _ => {
                let room = i64::from(64 - bits);
                let left = self.b.ins().ishl_imm_s(value, room);
                self.b.ins().sshr_imm_s(left, room)
            }
        }
    }

    fn clamp(&mut self, value: Value, least: i64, largest: i64) -> Value {
        let (least, largest) = (self.c64(least), self.c64(largest));
        let value = self.b.ins().smax(value, least);
        self.b.ins().smin(value, largest)
    }

    /// `value / 2^shift` as a word: [`isa::number::Arithmetic::narrow64`].
    pub fn narrow(&mut self, value: Value, shift: u32) -> Value {
        let value = self.rounded(value, shift);
        if self.word() == 32 && self.source.recipe.computes.modes.overflow == Overflow::Sat {
            // One comparison decides both ends.
            let low = self.b.ins().ireduce(I32, value);
            let back = self.b.ins().sextend(I64, low);
            let fits = self.b.ins().icmp(IntCC::Equal, back, value);
            let sign = self.b.ins().sshr_imm_s(value, 63);
            let sign = self.b.ins().ireduce(I32, sign);
            let end = self.b.ins().bxor_imm_s(sign, i64::from(i32::MAX));
            return self.b.ins().select(fits, low, end);
        }
        let value = self.fit(value, self.word());
        self.b.ins().ireduce(I32, value)
    }

    /// A number of 64 bits, which may have wrapped, as a wide number of twice the word. `overflowed` is not 0 where it has, and `sign` has the
    /// sign of the exact number then.
    pub fn widen_wrapped(&mut self, value: Value, overflowed: Value, sign: Value) -> Value {
        let overflow = self.source.recipe.computes.modes.overflow;
        let bits = 2 * self.word();
        // The nearest number of 64 bits, or the low ones, or none at all.
        let value = match overflow {
            Overflow::Sat | Overflow::SatSym => {
                let sign = self.b.ins().sshr_imm_s(sign, 63);
                let end = self.b.ins().bxor_imm_s(sign, i64::MAX);
                self.b.ins().select(overflowed, end, value)
            }
            Overflow::SatZero => {
                let zero = self.c64(0);
                self.b.ins().select(overflowed, zero, value)
            }
            _ => value,
        };
        self.widen(value, bits)
    }

    fn widen(&mut self, value: Value, bits: u32) -> Value {
        match bits {
            64 if self.source.recipe.computes.modes.overflow == Overflow::SatSym => {
                let least = self.c64(-i64::MAX);
                self.b.ins().smax(value, least)
            }
            64 => value,
            bits => self.fit(value, bits),
        }
    }

    /// A number of 64 bits as a wide number of twice the word: [`isa::number::Arithmetic::widen64`].
    pub fn widen64(&mut self, value: Value) -> Value {
        self.widen(value, 2 * self.word())
    }
}
