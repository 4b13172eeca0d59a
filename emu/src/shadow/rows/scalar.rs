//! Exact formulas of the numeric instructions on scalars.

use super::{RealFormulas, RealResult, ScalarRoom, ShadowInput, quotient};
use RealResult::{Computed, Fitted};

impl ScalarRoom for RealFormulas<'_> {
    fn add(&mut self, a: ShadowInput, b: ShadowInput) -> (RealResult,) {
        (Computed(a.term().plus(&b.term())),)
    }

    fn sub(&mut self, a: ShadowInput, b: ShadowInput) -> (RealResult,) {
        (Computed(a.term().minus(&b.term())),)
    }

    fn neg(&mut self, a: ShadowInput) -> (RealResult,) {
        (Computed(a.term().negated()),)
    }

    fn abs(&mut self, a: ShadowInput) -> (RealResult,) {
        (self.magnitude(&a),)
    }

    fn mul(&mut self, a: ShadowInput, b: ShadowInput, i: i32) -> (RealResult,) {
        (Fitted(a.term().times(&b.term()).scaled(-i)),)
    }

    fn div(&mut self, a: ShadowInput, b: ShadowInput, i: i32) -> (RealResult,) {
        (quotient(&a.term(), &b.term(), i),)
    }

    fn min(&mut self, a: ShadowInput, b: ShadowInput) -> (RealResult,) {
        (self.lesser(a, b),)
    }

    fn max(&mut self, a: ShadowInput, b: ShadowInput) -> (RealResult,) {
        (self.greater(a, b),)
    }

    fn rshift(&mut self, a: ShadowInput, i: i32) -> (RealResult,) {
        (Computed(a.term().scaled(-i)),)
    }

    fn lshift(&mut self, a: ShadowInput, i: i32) -> (RealResult,) {
        (Computed(a.term().scaled(i)),)
    }

    fn scale(&mut self, a: ShadowInput, b: ShadowInput) -> (RealResult,) {
        (Computed(a.term().scaled(-b.raw.clamp(-63, 63) as i32)),)
    }
}

/// Choices that scalars and components of vectors share. They are the machine's; the shadow goes along.
impl RealFormulas<'_> {
    /// The magnitude by the sign that the machine sees.
    pub(super) fn magnitude(&mut self, a: &ShadowInput) -> RealResult {
        self.compare(a, &ShadowInput::ZERO, |order| order.is_lt());
        Computed(if a.raw < 0 { a.term().negated() } else { a.term() })
    }

    /// The number that the machine finds the smaller one.
    pub(super) fn lesser(&mut self, a: ShadowInput, b: ShadowInput) -> RealResult {
        self.compare(&a, &b, |order| order.is_lt());
        Computed(if b.raw < a.raw { b.term() } else { a.term() })
    }

    /// The number that the machine finds the larger one.
    pub(super) fn greater(&mut self, a: ShadowInput, b: ShadowInput) -> RealResult {
        self.compare(&a, &b, |order| order.is_gt());
        Computed(if b.raw > a.raw { b.term() } else { a.term() })
    }
}
