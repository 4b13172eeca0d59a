//! Forms of the numeric rows on scalars.

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{InstBuilder, Value};

use super::{Form, Lower, S, ScalarRoom};

impl Lower<'_, '_> {
    /// A word of an exact number over 2^shift, where the modes have a form.
    fn word_of(&mut self, shift: i32, exact: impl FnOnce(&mut Self) -> Value) -> Form<(Value,)> {
        if !self.has_form() {
            return Form::Call;
        }
        let exact = exact(self);
        Form::Made((self.narrow(exact, shift as u32),))
    }

    fn chosen(&mut self, how: IntCC, a: S, b: S) -> Form<(Value,)> {
        self.word_of(0, |lower| {
            let (a, b) = (lower.s64(a), lower.s64(b));
            let is_first = lower.b.ins().icmp(how, a, b);
            lower.b.ins().select(is_first, a, b)
        })
    }
}

impl ScalarRoom for Lower<'_, '_> {
    fn add(&mut self, a: S, b: S) -> Form<(Value,)> {
        self.word_of(0, |lower| {
            let (a, b) = (lower.s64(a), lower.s64(b));
            lower.b.ins().iadd(a, b)
        })
    }

    fn sub(&mut self, a: S, b: S) -> Form<(Value,)> {
        self.word_of(0, |lower| {
            let (a, b) = (lower.s64(a), lower.s64(b));
            lower.b.ins().isub(a, b)
        })
    }

    fn neg(&mut self, a: S) -> Form<(Value,)> {
        self.word_of(0, |lower| {
            let a = lower.s64(a);
            lower.b.ins().ineg(a)
        })
    }

    fn abs(&mut self, a: S) -> Form<(Value,)> {
        self.word_of(0, |lower| {
            let a = lower.s64(a);
            lower.b.ins().iabs(a)
        })
    }

    fn mul(&mut self, a: S, b: S, i: i32) -> Form<(Value,)> {
        self.word_of(i, |lower| {
            let (a, b) = (lower.s64(a), lower.s64(b));
            lower.b.ins().imul(a, b)
        })
    }

    fn div(&mut self, _: S, _: S, _: i32) -> Form<(Value,)> {
        Form::Call
    }

    fn min(&mut self, a: S, b: S) -> Form<(Value,)> {
        self.chosen(IntCC::SignedLessThan, a, b)
    }

    fn max(&mut self, a: S, b: S) -> Form<(Value,)> {
        self.chosen(IntCC::SignedGreaterThan, a, b)
    }

    fn rshift(&mut self, a: S, i: i32) -> Form<(Value,)> {
        self.word_of(i, |lower| lower.s64(a))
    }

    fn lshift(&mut self, a: S, i: i32) -> Form<(Value,)> {
        // Further on, the exact number takes more than 64 bits.
        if i >= 32 {
            return Form::Call;
        }
        self.word_of(0, |lower| {
            let a = lower.s64(a);
            lower.b.ins().ishl_imm_s(a, i64::from(i))
        })
    }

    fn scale(&mut self, _: S, _: S) -> Form<(Value,)> {
        Form::Call
    }
}
