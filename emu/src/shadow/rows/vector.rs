//! Exact formulas of the instructions on vectors, component by component.

use isa::number::normalizing_shift;

use super::{RealFormulas, RealResult, ShadowInput, VectorRoom, cross_component, dot, each, quotient, terms};
use RealResult::{Computed, Fitted, Integer};

impl VectorRoom for RealFormulas<'_> {
    fn vadd(&mut self, a: [ShadowInput; 3], b: [ShadowInput; 3]) -> ([RealResult; 3],) {
        (each(|k| Computed(a[k].term().plus(&b[k].term()))),)
    }

    fn vsub(&mut self, a: [ShadowInput; 3], b: [ShadowInput; 3]) -> ([RealResult; 3],) {
        (each(|k| Computed(a[k].term().minus(&b[k].term()))),)
    }

    fn vneg(&mut self, a: [ShadowInput; 3]) -> ([RealResult; 3],) {
        (each(|k| Computed(a[k].term().negated())),)
    }

    fn vabs(&mut self, a: [ShadowInput; 3]) -> ([RealResult; 3],) {
        (each(|k| self.magnitude(&a[k])),)
    }

    fn vmin(&mut self, a: [ShadowInput; 3], b: [ShadowInput; 3]) -> ([RealResult; 3],) {
        (each(|k| self.lesser(a[k], b[k])),)
    }

    fn vmax(&mut self, a: [ShadowInput; 3], b: [ShadowInput; 3]) -> ([RealResult; 3],) {
        (each(|k| self.greater(a[k], b[k])),)
    }

    fn vmul(&mut self, a: [ShadowInput; 3], b: [ShadowInput; 3], i: i32) -> ([RealResult; 3],) {
        (each(|k| Fitted(a[k].term().times(&b[k].term()).scaled(-i))),)
    }

    fn vscale(&mut self, a: [ShadowInput; 3], b: ShadowInput, i: i32) -> ([RealResult; 3],) {
        let factor = b.term();
        (each(|k| Fitted(a[k].term().times(&factor).scaled(-i))),)
    }

    fn vdiv(&mut self, a: [ShadowInput; 3], b: ShadowInput, i: i32) -> ([RealResult; 3],) {
        let divisor = b.term();
        (each(|k| quotient(&a[k].term(), &divisor, i)),)
    }

    fn vdot(&mut self, a: [ShadowInput; 3], b: [ShadowInput; 3], i: i32) -> (RealResult,) {
        (Fitted(dot(&terms(&a), &terms(&b)).scaled(-i)),)
    }

    fn vcross(&mut self, a: [ShadowInput; 3], b: [ShadowInput; 3], i: i32) -> ([RealResult; 3],) {
        let (a, b) = (terms(&a), terms(&b));
        (each(|k| Fitted(cross_component(&a, &b, k).scaled(-i))),)
    }

    fn vcrossn(&mut self, a: [ShadowInput; 3], b: [ShadowInput; 3]) -> ([RealResult; 3],) {
        // The shift is the machine's decision, by the product of its own numbers.
        let product = |j: usize, k: usize| i128::from(a[j].raw) * i128::from(b[k].raw);
        let exact = [(1, 2), (2, 0), (0, 1)].map(|(j, k)| product(j, k) - product(k, j));
        let shift = normalizing_shift(exact, self.modes.word);
        let (a, b) = (terms(&a), terms(&b));
        (each(|k| Computed(cross_component(&a, &b, k).scaled(-shift))),)
    }

    fn vnorm(&mut self, a: [ShadowInput; 3]) -> ([RealResult; 3], RealResult) {
        let shift = normalizing_shift(a.map(|a| a.raw.into()), self.modes.word);
        (each(|k| Computed(a[k].term().scaled(-shift))), Integer)
    }

    fn vmov(&mut self, a: [ShadowInput; 3]) -> ([RealResult; 3],) {
        (each(|k| a[k].moved()),)
    }

    fn vsplat(&mut self, a: ShadowInput) -> ([RealResult; 3],) {
        (each(|_| a.moved()),)
    }

    fn vget(&mut self, a: [ShadowInput; 3], i: i32) -> (RealResult,) {
        (component(&a, i.into()),)
    }

    fn vgetr(&mut self, a: [ShadowInput; 3], b: ShadowInput) -> (RealResult,) {
        (component(&a, b.raw),)
    }

    fn vput(&mut self, x: [ShadowInput; 3], a: ShadowInput, i: i32) -> ([RealResult; 3],) {
        (put(&x, a, i.into()),)
    }

    fn vputr(&mut self, x: [ShadowInput; 3], a: ShadowInput, b: ShadowInput) -> ([RealResult; 3],) {
        (put(&x, a, b.raw),)
    }

    fn vmajor(&mut self, a: [ShadowInput; 3]) -> (RealResult,) {
        self.decide_major(&a);
        (Integer,)
    }

    fn vlt(&mut self, a: [ShadowInput; 3], b: [ShadowInput; 3]) -> (RealResult,) {
        (0..3).for_each(|k| self.compare(&a[k], &b[k], |order| order.is_lt()));
        (Integer,)
    }

    fn vselect(&mut self, x: [ShadowInput; 3], a: [ShadowInput; 3], b: ShadowInput) -> ([RealResult; 3],) {
        (each(|k| if b.raw >> k & 1 == 1 { a[k].moved() } else { x[k].moved() }),)
    }
}

/// A component by its number modulo 4, of which the fourth is none.
fn component(a: &[ShadowInput; 3], number: i64) -> RealResult {
    a.get((number & 3) as usize).map_or(Integer, |component| component.moved())
}

/// The components with one in the place of that number modulo 4.
fn put(x: &[ShadowInput; 3], a: ShadowInput, number: i64) -> [RealResult; 3] {
    each(|k| if number & 3 == k as i64 { a.moved() } else { x[k].moved() })
}
