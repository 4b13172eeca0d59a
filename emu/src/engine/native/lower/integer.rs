//! Forms of the integer rows: 32 bits, modulo 2^32, whatever the machine's word and modes.

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::types::I32;
use cranelift_codegen::ir::{InstBuilder, Value};

use super::{Form, IntegerRoom, Lower, S};

/// A row of two scalars that one instruction computes.
macro_rules! binary {
    ($($name:ident $instruction:ident)*) => {
        $(fn $name(&mut self, a: S, b: S) -> Form<(Value,)> {
            let (a, b) = (self.s(a), self.s(b));
            Form::Made((self.b.ins().$instruction(a, b),))
        })*
    };
}

/// Emits the operation on a scalar and a constant.
macro_rules! with_constant {
    ($($name:ident $instruction:ident)*) => {
        $(fn $name(&mut self, a: S, i: i32) -> Form<(Value,)> {
            let (a, i) = (self.s(a), self.c32(i));
            Form::Made((self.b.ins().$instruction(a, i),))
        })*
    };
}

impl IntegerRoom for Lower<'_, '_> {
    // The host's shifts take the low five bits of the distance, as these do.
    binary! {
        iadd iadd
        isub isub
        imul imul
        and band
        or bor
        xor bxor
        sll ishl
        srl ushr
        sra sshr
        addr iadd
    }

    with_constant! {
        slli ishl
        srli ushr
        srai sshr
        iaddi iadd
        isubi isub
        andi band
        ori bor
        lea iadd
    }

    fn slt(&mut self, a: S, b: S) -> Form<(Value,)> {
        let (a, b) = (self.s(a), self.s(b));
        let is_less = self.b.ins().icmp(IntCC::SignedLessThan, a, b);
        Form::Made((self.b.ins().uextend(I32, is_less),))
    }

    fn clz(&mut self, a: S) -> Form<(Value,)> {
        let a = self.s(a);
        Form::Made((self.b.ins().clz(a),))
    }

    fn mov(&mut self, a: S) -> Form<(Value,)> {
        Form::Made((self.s(a),))
    }

    fn movi(&mut self, i: i32) -> Form<(Value,)> {
        Form::Made((self.c32(i),))
    }

    fn movhi(&mut self, x: S, i: i32) -> Form<(Value,)> {
        let (x, low, high) = (self.s(x), self.c32(0xffff), self.c32(i << 16));
        let kept = self.b.ins().band(x, low);
        Form::Made((self.b.ins().bor(kept, high),))
    }

    fn element(&mut self, a: S, b: S, i: i32) -> Form<(Value,)> {
        let (a, b, i) = (self.s(a), self.s(b), self.c32(i));
        let offset = self.b.ins().imul(b, i);
        Form::Made((self.b.ins().iadd(a, offset),))
    }
}
