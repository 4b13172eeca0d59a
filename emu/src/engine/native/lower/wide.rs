//! Forms of the rows on wide accumulators.

use cranelift_codegen::ir::types::{I32, I64};
use cranelift_codegen::ir::{InstBuilder, Value};

use super::{Form, Lower, S, V, W, WideRoom};

impl Lower<'_, '_> {
    /// The exact product of two scalars.
    fn product(&mut self, a: S, b: S) -> Value {
        let (a, b) = (self.s64(a), self.s64(b));
        self.b.ins().imul(a, b)
    }

    fn wide_sum(&mut self, a: Value, b: Value) -> Form<(Value,)> {
        let (sum, overflowed) = self.b.ins().sadd_overflow(a, b);
        Form::Made((self.widen_wrapped(sum, overflowed, a),))
    }

    fn wide_difference(&mut self, a: Value, b: Value) -> Form<(Value,)> {
        let (difference, overflowed) = self.b.ins().ssub_overflow(a, b);
        Form::Made((self.widen_wrapped(difference, overflowed, a),))
    }

    /// The exact products of the components of two vectors.
    pub fn products(&mut self, a: V, b: V) -> [Value; 3] {
        [0, 1, 2].map(|at| {
            let (a, b) = (self.component64(a, at), self.component64(b, at));
            self.b.ins().imul(a, b)
        })
    }

    /// The components of the exact cross product. They fit 64 bits: the largest product is 2^62, the least -(2^62 - 2^31).
    pub fn minors(&mut self, a: V, b: V) -> [Value; 3] {
        let (a, b) = ([0, 1, 2].map(|at| self.component64(a, at)), [0, 1, 2].map(|at| self.component64(b, at)));
        [(1, 2), (2, 0), (0, 1)].map(|(j, k)| {
            let (first, second) = (self.b.ins().imul(a[j], b[k]), self.b.ins().imul(a[k], b[j]));
            self.b.ins().isub(first, second)
        })
    }
}

/// Leaves a row whose modes have no form to its meaning.
macro_rules! need_form {
    ($lower:ident) => {
        if !$lower.has_form() {
            return Form::Call;
        }
    };
}

impl WideRoom for Lower<'_, '_> {
    fn wmul(&mut self, a: S, b: S) -> Form<(Value,)> {
        need_form!(self);
        let product = self.product(a, b);
        Form::Made((self.widen64(product),))
    }

    fn wmac(&mut self, x: W, a: S, b: S) -> Form<(Value,)> {
        need_form!(self);
        let (x, product) = (self.w(x), self.product(a, b));
        self.wide_sum(x, product)
    }

    fn wmsub(&mut self, x: W, a: S, b: S) -> Form<(Value,)> {
        need_form!(self);
        let (x, product) = (self.w(x), self.product(a, b));
        self.wide_difference(x, product)
    }

    fn wdot(&mut self, a: V, b: V) -> Form<(Value,)> {
        need_form!(self);
        self.sum_of_products(a, b, I64, |lower, sum| lower.widen64(sum))
    }

    fn wadd(&mut self, a: W, b: W) -> Form<(Value,)> {
        need_form!(self);
        let (a, b) = (self.w(a), self.w(b));
        self.wide_sum(a, b)
    }

    fn wsub(&mut self, a: W, b: W) -> Form<(Value,)> {
        need_form!(self);
        let (a, b) = (self.w(a), self.w(b));
        self.wide_difference(a, b)
    }

    fn wmulw(&mut self, _: W, _: W) -> Form<(Value,)> {
        Form::Call
    }

    fn wneg(&mut self, a: W) -> Form<(Value,)> {
        need_form!(self);
        let (zero, a) = (self.c64(0), self.w(a));
        self.wide_difference(zero, a)
    }

    fn wmov(&mut self, a: W) -> Form<(Value,)> {
        Form::Made((self.w(a),))
    }

    fn wextend(&mut self, a: S, i: i32) -> Form<(Value,)> {
        need_form!(self);
        // Further on, the exact number takes more than 64 bits.
        if i >= 32 {
            return Form::Call;
        }
        let a = self.s64(a);
        let extended = self.b.ins().ishl_imm_s(a, i64::from(i));
        Form::Made((self.widen64(extended),))
    }

    fn wround(&mut self, a: W, i: i32) -> Form<(Value,)> {
        need_form!(self);
        let a = self.w(a);
        Form::Made((self.narrow(a, i as u32),))
    }

    fn wscale(&mut self, _: W, _: S) -> Form<(Value,)> {
        Form::Call
    }

    fn wdiv(&mut self, _: W, _: W, _: i32) -> Form<(Value,)> {
        Form::Call
    }

    fn wsqrt(&mut self, _: W, _: i32) -> Form<(Value,)> {
        Form::Call
    }

    fn wand(&mut self, a: W, b: W) -> Form<(Value,)> {
        let (a, b) = (self.w(a), self.w(b));
        Form::Made((self.b.ins().band(a, b),))
    }

    // The host's shifts take the low six bits of the distance, as these do.
    fn wsll(&mut self, a: W, b: S) -> Form<(Value,)> {
        let (a, b) = (self.w(a), self.s(b));
        Form::Made((self.b.ins().ishl(a, b),))
    }

    fn wsrl(&mut self, a: W, b: S) -> Form<(Value,)> {
        let (a, b) = (self.w(a), self.s(b));
        Form::Made((self.b.ins().ushr(a, b),))
    }

    fn wclz(&mut self, a: W) -> Form<(Value,)> {
        let a = self.w(a);
        let zeros = self.b.ins().clz(a);
        Form::Made((self.b.ins().ireduce(I32, zeros),))
    }

    fn wltz(&mut self, a: W) -> Form<(Value,)> {
        let a = self.w(a);
        Form::Made((self.b.ins().sshr_imm_s(a, 63),))
    }

    fn wlow(&mut self, a: W) -> Form<(Value,)> {
        let a = self.w(a);
        Form::Made((self.b.ins().ireduce(I32, a),))
    }

    fn whigh(&mut self, a: W) -> Form<(Value,)> {
        let a = self.w(a);
        let high = self.b.ins().ushr_imm_s(a, 32);
        Form::Made((self.b.ins().ireduce(I32, high),))
    }

    fn wjoin(&mut self, a: S, b: S) -> Form<(Value,)> {
        let (a, b) = (self.s(a), self.s(b));
        let high = self.b.ins().uextend(I64, a);
        let high = self.b.ins().ishl_imm_s(high, 32);
        let low = self.b.ins().uextend(I64, b);
        Form::Made((self.b.ins().bor(high, low),))
    }

    fn wcross(&mut self, a: V, b: V) -> Form<([Value; 3],)> {
        need_form!(self);
        let minors = self.minors(a, b);
        Form::Made((minors.map(|minor| self.widen64(minor)),))
    }

    fn wmixed(&mut self, _: W, _: V, _: i32) -> Form<(Value,)> {
        Form::Call
    }
}
