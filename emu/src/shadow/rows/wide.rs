//! Exact formulas of the instructions on wide accumulators. Rows on patterns of bits write integers.

use super::integer::kept;
use super::{RealFormulas, RealResult, ShadowInput, WideRoom, cross, dot, quotient, terms};
use RealResult::{Computed, Fitted, Integer};

impl WideRoom for RealFormulas<'_> {
    fn wmul(&mut self, a: ShadowInput, b: ShadowInput) -> (RealResult,) {
        (Computed(a.term().times(&b.term())),)
    }

    fn wmac(&mut self, x: ShadowInput, a: ShadowInput, b: ShadowInput) -> (RealResult,) {
        (Computed(x.term().plus(&a.term().times(&b.term()))),)
    }

    fn wmsub(&mut self, x: ShadowInput, a: ShadowInput, b: ShadowInput) -> (RealResult,) {
        (Computed(x.term().minus(&a.term().times(&b.term()))),)
    }

    fn wdot(&mut self, a: [ShadowInput; 3], b: [ShadowInput; 3]) -> (RealResult,) {
        (Computed(dot(&terms(&a), &terms(&b))),)
    }

    fn wadd(&mut self, a: ShadowInput, b: ShadowInput) -> (RealResult,) {
        (Computed(a.term().plus(&b.term())),)
    }

    fn wsub(&mut self, a: ShadowInput, b: ShadowInput) -> (RealResult,) {
        (Computed(a.term().minus(&b.term())),)
    }

    fn wmulw(&mut self, a: ShadowInput, b: ShadowInput) -> (RealResult,) {
        (Computed(a.term().times(&b.term())),)
    }

    fn wneg(&mut self, a: ShadowInput) -> (RealResult,) {
        (Computed(a.term().negated()),)
    }

    fn wmov(&mut self, a: ShadowInput) -> (RealResult,) {
        (a.moved(),)
    }

    fn wextend(&mut self, a: ShadowInput, i: i32) -> (RealResult,) {
        (Computed(a.term().scaled(i)),)
    }

    fn wround(&mut self, a: ShadowInput, i: i32) -> (RealResult,) {
        (Fitted(a.term().scaled(-i)),)
    }

    fn wscale(&mut self, a: ShadowInput, b: ShadowInput) -> (RealResult,) {
        (Computed(a.term().scaled(-b.raw.clamp(-63, 63) as i32)),)
    }

    fn wdiv(&mut self, a: ShadowInput, b: ShadowInput, i: i32) -> (RealResult,) {
        (quotient(&a.term(), &b.term(), i),)
    }

    fn wsqrt(&mut self, a: ShadowInput, i: i32) -> (RealResult,) {
        // The machine takes 0 for the root of a negative number; the shadow has none and begins anew.
        let root = if a.raw < 0 { None } else { a.term().scaled(i).root() };
        (root.map_or(Integer, Fitted),)
    }

    fn wand(&mut self, a: ShadowInput, b: ShadowInput) -> (RealResult,) {
        (kept(a.raw & b.raw, a, b),)
    }

    fn wsll(&mut self, _: ShadowInput, _: ShadowInput) -> (RealResult,) {
        (Integer,)
    }

    fn wsrl(&mut self, _: ShadowInput, _: ShadowInput) -> (RealResult,) {
        (Integer,)
    }

    fn wclz(&mut self, _: ShadowInput) -> (RealResult,) {
        (Integer,)
    }

    fn wltz(&mut self, a: ShadowInput) -> (RealResult,) {
        self.compare(&a, &ShadowInput::ZERO, |order| order.is_lt());
        (Integer,)
    }

    fn wlow(&mut self, _: ShadowInput) -> (RealResult,) {
        (Integer,)
    }

    fn whigh(&mut self, _: ShadowInput) -> (RealResult,) {
        (Integer,)
    }

    fn wjoin(&mut self, _: ShadowInput, _: ShadowInput) -> (RealResult,) {
        (Integer,)
    }

    fn wcross(&mut self, a: [ShadowInput; 3], b: [ShadowInput; 3]) -> ([RealResult; 3],) {
        (cross(&terms(&a), &terms(&b)).map(Computed),)
    }

    fn wmixed(&mut self, a: [ShadowInput; 3], b: [ShadowInput; 3], i: i32) -> (RealResult,) {
        (Fitted(dot(&terms(&a), &terms(&b)).scaled(-i)),)
    }
}
