//! Forms of the numeric rows on vectors. Where results saturate, all components are computed at once.

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::types::{I32, I32X4, I64, Type};
use cranelift_codegen::ir::{InstBuilder, Value};
use isa::number::Overflow;

use super::{Form, Lower, S, V, VectorRoom, aligned};
use crate::code::registers::Registers;

/// Components that a mask takes, bit by bit; of the fourth one there is never anything to take.
static MASKS: [[i32; 4]; 16] = {
    let mut masks = [[0; 4]; 16];
    let mut at = 0;
    while at < 16 * 3 {
        masks[at / 3][at % 3] = if (at / 3) >> (at % 3) & 1 == 1 { -1 } else { 0 };
        at += 1;
    }
    masks
};

impl Lower<'_, '_> {
    /// Place of a component among the registers.
    fn component_offset(V(number): V, component: usize) -> i32 {
        Registers::vector_offset(number) + 4 * component as i32
    }

    /// A component of a vector.
    pub fn component(&mut self, vector: V, component: usize) -> Value {
        match self.vectors[usize::from(vector.0)] {
            Some(known) => self.b.ins().extractlane(known, component as u8),
            None => self.b.ins().load(I32, aligned(), self.registers, Self::component_offset(vector, component)),
        }
    }

    /// A component of a vector as 64 bits.
    pub fn component64(&mut self, vector: V, component: usize) -> Value {
        match self.vectors[usize::from(vector.0)] {
            Some(known) => {
                let value = self.b.ins().extractlane(known, component as u8);
                self.b.ins().sextend(I64, value)
            }
            None => self.b.ins().sload32(aligned(), self.registers, Self::component_offset(vector, component)),
        }
    }

    /// The mask of which the low bits are known when code is generated.
    pub fn mask(&mut self, bits: usize) -> Value {
        let masks = self.c64(MASKS.as_ptr() as i64);
        self.b.ins().load(I32X4, super::flags().with_readonly(), masks, 16 * bits as i32)
    }

    /// The mask of a number below 16.
    fn mask_at(&mut self, bits: Value) -> Value {
        let bits = self.b.ins().uextend(I64, bits);
        let offset = self.b.ins().ishl_imm_s(bits, 4);
        let masks = self.c64(MASKS.as_ptr() as i64);
        let at = self.b.ins().iadd(masks, offset);
        self.b.ins().load(I32X4, super::flags().with_readonly(), at, 0)
    }

    /// Brings components that are right up to saturation of 32 bits into words.
    fn clamped(&mut self, vector: Value) -> Value {
        let (word, overflow) = (self.word(), self.source.recipe.computes.modes.overflow);
        let largest = i32::MAX >> (32 - word);
        let least = if overflow == Overflow::SatSym { -largest } else { -largest - 1 };
        let vector = match least {
            i32::MIN => vector,
            _ => {
                let least = self.splat(least);
                self.b.ins().smax(vector, least)
            }
        };
        match largest {
            i32::MAX => vector,
            _ => {
                let largest = self.splat(largest);
                self.b.ins().smin(vector, largest)
            }
        }
    }

    /// A vector whose components are words of exact numbers over 2^shift.
    fn words_of(&mut self, shift: i32, exact: impl Fn(&mut Self, usize) -> Value) -> Form<(Value,)> {
        if !self.has_form() {
            return Form::Call;
        }
        let components = [0, 1, 2].map(|at| {
            let exact = exact(self, at);
            self.narrow(exact, shift as u32)
        });
        Form::Made((self.vector(components),))
    }

    /// Saturation: where components have left 32 bits, the end on the side of `a`; `overflowed` has their signs set.
    fn saturated(&mut self, a: Value, wrapped: Value, overflowed: Value) -> Value {
        let mask = self.b.ins().sshr_imm_s(overflowed, 31);
        let sign = self.b.ins().sshr_imm_s(a, 31);
        let most = self.splat(i32::MAX);
        let end = self.b.ins().bxor(sign, most);
        self.b.ins().bitselect(mask, end, wrapped)
    }

    /// The sum of three products of components: where it takes more than 64 bits, the meaning is called instead.
    pub fn sum_of_products(
        &mut self,
        a: V,
        b: V,
        kind: Type,
        result: impl FnOnce(&mut Self, Value) -> Value,
    ) -> Form<(Value,)> {
        let step = &self.source.steps[self.place as usize];
        let [x, y, z] = self.products(a, b);
        let (sum, first) = self.b.ins().sadd_overflow(x, y);
        let (sum, second) = self.b.ins().sadd_overflow(sum, z);
        let overflowed = self.b.ins().bor(first, second);
        let (long, on) = (self.cold_block(), self.b.create_block());
        let found = self.b.append_block_param(on, kind);
        let result = result(self, sum);
        self.b.ins().brif(overflowed, long, &[], on, &[result.into()]);
        self.b.switch_to_block(long);
        self.call_row(self.op(step), step);
        let offset = match kind {
            I32 => Registers::scalar_offset(step.fields.d),
            _ => Registers::wide_offset(step.fields.d),
        };
        let result = self.b.ins().load(kind, aligned(), self.registers, offset);
        self.b.ins().jump(on, &[result.into()]);
        self.b.switch_to_block(on);
        Form::Made((found,))
    }
}

impl VectorRoom for Lower<'_, '_> {
    fn vadd(&mut self, a: V, b: V) -> Form<(Value,)> {
        if !self.saturates() {
            return self.words_of(0, |lower, at| {
                let (a, b) = (lower.component64(a, at), lower.component64(b, at));
                lower.b.ins().iadd(a, b)
            });
        }
        let (a, b) = (self.v(a), self.v(b));
        let sum = self.b.ins().iadd(a, b);
        let (of_a, of_b) = (self.b.ins().bxor(a, sum), self.b.ins().bxor(b, sum));
        let overflowed = self.b.ins().band(of_a, of_b);
        let sum = self.saturated(a, sum, overflowed);
        Form::Made((self.clamped(sum),))
    }

    fn vsub(&mut self, a: V, b: V) -> Form<(Value,)> {
        if !self.saturates() {
            return self.words_of(0, |lower, at| {
                let (a, b) = (lower.component64(a, at), lower.component64(b, at));
                lower.b.ins().isub(a, b)
            });
        }
        let (a, b) = (self.v(a), self.v(b));
        let difference = self.b.ins().isub(a, b);
        let (signs, of_a) = (self.b.ins().bxor(a, b), self.b.ins().bxor(a, difference));
        let overflowed = self.b.ins().band(signs, of_a);
        let difference = self.saturated(a, difference, overflowed);
        Form::Made((self.clamped(difference),))
    }

    fn vneg(&mut self, a: V) -> Form<(Value,)> {
        if !self.saturates() {
            return self.words_of(0, |lower, at| {
                let a = lower.component64(a, at);
                lower.b.ins().ineg(a)
            });
        }
        let a = self.v(a);
        let (negated, least) = (self.b.ins().ineg(a), self.splat(i32::MIN));
        // Only the least number is its own negation and not 0; all its bits turned are the largest one.
        let is_least = self.b.ins().icmp(IntCC::Equal, a, least);
        let negated = self.b.ins().bxor(negated, is_least);
        Form::Made((self.clamped(negated),))
    }

    fn vabs(&mut self, a: V) -> Form<(Value,)> {
        if !self.saturates() {
            return self.words_of(0, |lower, at| {
                let a = lower.component64(a, at);
                lower.b.ins().iabs(a)
            });
        }
        let a = self.v(a);
        let (magnitude, least) = (self.b.ins().iabs(a), self.splat(i32::MIN));
        let is_least = self.b.ins().icmp(IntCC::Equal, magnitude, least);
        let magnitude = self.b.ins().bxor(magnitude, is_least);
        Form::Made((self.clamped(magnitude),))
    }

    fn vmin(&mut self, a: V, b: V) -> Form<(Value,)> {
        if !self.saturates() {
            return self.words_of(0, |lower, at| {
                let (a, b) = (lower.component64(a, at), lower.component64(b, at));
                lower.b.ins().smin(a, b)
            });
        }
        let (a, b) = (self.v(a), self.v(b));
        let least = self.b.ins().smin(a, b);
        Form::Made((self.clamped(least),))
    }

    fn vmax(&mut self, a: V, b: V) -> Form<(Value,)> {
        if !self.saturates() {
            return self.words_of(0, |lower, at| {
                let (a, b) = (lower.component64(a, at), lower.component64(b, at));
                lower.b.ins().smax(a, b)
            });
        }
        let (a, b) = (self.v(a), self.v(b));
        let most = self.b.ins().smax(a, b);
        Form::Made((self.clamped(most),))
    }

    fn vmul(&mut self, a: V, b: V, i: i32) -> Form<(Value,)> {
        self.words_of(i, |lower, at| {
            let (a, b) = (lower.component64(a, at), lower.component64(b, at));
            lower.b.ins().imul(a, b)
        })
    }

    fn vscale(&mut self, a: V, b: S, i: i32) -> Form<(Value,)> {
        self.words_of(i, |lower, at| {
            let (a, b) = (lower.component64(a, at), lower.s64(b));
            lower.b.ins().imul(a, b)
        })
    }

    fn vdiv(&mut self, _: V, _: S, _: i32) -> Form<(Value,)> {
        Form::Call
    }

    fn vdot(&mut self, a: V, b: V, i: i32) -> Form<(Value,)> {
        if !self.has_form() {
            return Form::Call;
        }
        self.sum_of_products(a, b, I32, |lower, sum| lower.narrow(sum, i as u32))
    }

    fn vcross(&mut self, a: V, b: V, i: i32) -> Form<(Value,)> {
        if !self.has_form() {
            return Form::Call;
        }
        let minors = self.minors(a, b);
        let components = minors.map(|minor| self.narrow(minor, i as u32));
        Form::Made((self.vector(components),))
    }

    fn vcrossn(&mut self, _: V, _: V) -> Form<(Value,)> {
        Form::Call
    }

    fn vnorm(&mut self, _: V) -> Form<(Value, Value)> {
        Form::Call
    }

    fn vmov(&mut self, a: V) -> Form<(Value,)> {
        Form::Made((self.v(a),))
    }

    fn vsplat(&mut self, a: S) -> Form<(Value,)> {
        let a = self.s(a);
        Form::Made((self.vector([a; 3]),))
    }

    fn vget(&mut self, a: V, i: i32) -> Form<(Value,)> {
        Form::Made((self.component(a, i as usize & 3),))
    }

    fn vgetr(&mut self, a: V, b: S) -> Form<(Value,)> {
        let b = self.s(b);
        let b = self.b.ins().band_imm_s(b, 3);
        let b = self.b.ins().uextend(I64, b);
        let offset = self.b.ins().ishl_imm_s(b, 2);
        let at = self.b.ins().iadd(self.registers, offset);
        Form::Made((self.b.ins().load(I32, aligned(), at, Registers::vector_offset(a.0)),))
    }

    fn vput(&mut self, x: V, a: S, i: i32) -> Form<(Value,)> {
        let (x, a) = (self.v(x), self.s(a));
        // The fourth component is nowhere.
        let put = if i & 3 == 3 { x } else { self.b.ins().insertlane(x, a, i as u8 & 3) };
        Form::Made((put,))
    }

    fn vputr(&mut self, x: V, a: S, b: S) -> Form<(Value,)> {
        let (x, a, b, one) = (self.v(x), self.s(a), self.s(b), self.c32(1));
        let b = self.b.ins().band_imm_s(b, 3);
        let bit = self.b.ins().ishl(one, b);
        let mask = self.mask_at(bit);
        let a = self.b.ins().splat(I32X4, a);
        Form::Made((self.b.ins().bitselect(mask, a, x),))
    }

    fn vmajor(&mut self, _: V) -> Form<(Value,)> {
        Form::Call
    }

    fn vlt(&mut self, a: V, b: V) -> Form<(Value,)> {
        let (a, b) = (self.v(a), self.v(b));
        let is_less = self.b.ins().icmp(IntCC::SignedLessThan, a, b);
        Form::Made((self.b.ins().vhigh_bits(I32, is_less),))
    }

    fn vselect(&mut self, x: V, a: V, b: S) -> Form<(Value,)> {
        let (x, a, b) = (self.v(x), self.v(a), self.s(b));
        let bits = self.b.ins().band_imm_s(b, 7);
        let mask = self.mask_at(bits);
        Form::Made((self.b.ins().bitselect(mask, a, x),))
    }
}
