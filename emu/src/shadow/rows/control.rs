//! Decisions of branches on numbers, which the shadow may have taken otherwise. Unsigned comparisons are on integers.

use super::{ControlRoom, RealFormulas, RealResult, ShadowInput};
use RealResult::Integer;

impl ControlRoom for RealFormulas<'_> {
    fn beq(&mut self, a: ShadowInput, b: ShadowInput, _: i32) {
        self.compare(&a, &b, |order| order.is_eq());
    }

    fn bne(&mut self, a: ShadowInput, b: ShadowInput, _: i32) {
        self.compare(&a, &b, |order| order.is_ne());
    }

    fn blt(&mut self, a: ShadowInput, b: ShadowInput, _: i32) {
        self.compare(&a, &b, |order| order.is_lt());
    }

    fn bge(&mut self, a: ShadowInput, b: ShadowInput, _: i32) {
        self.compare(&a, &b, |order| order.is_ge());
    }

    fn bltu(&mut self, _: ShadowInput, _: ShadowInput, _: i32) {}

    fn bgeu(&mut self, _: ShadowInput, _: ShadowInput, _: i32) {}

    fn bweqz(&mut self, a: ShadowInput, _: i32) {
        self.compare(&a, &ShadowInput::ZERO, |order| order.is_eq());
    }

    fn bwnez(&mut self, a: ShadowInput, _: i32) {
        self.compare(&a, &ShadowInput::ZERO, |order| order.is_ne());
    }

    fn bwltz(&mut self, a: ShadowInput, _: i32) {
        self.compare(&a, &ShadowInput::ZERO, |order| order.is_lt());
    }

    fn bwgez(&mut self, a: ShadowInput, _: i32) {
        self.compare(&a, &ShadowInput::ZERO, |order| order.is_ge());
    }

    fn bwlt(&mut self, a: ShadowInput, b: ShadowInput, _: i32) {
        self.compare(&a, &b, |order| order.is_lt());
    }

    fn bweq(&mut self, a: ShadowInput, b: ShadowInput, _: i32) {
        self.compare(&a, &b, |order| order.is_eq());
    }

    fn jump(&mut self, _: i32) {}

    fn call(&mut self, _: i32) -> (RealResult,) {
        (Integer,)
    }

    fn callr(&mut self, _: u32) -> (RealResult,) {
        (Integer,)
    }

    fn ret(&mut self, _: u32) {}

    fn core(&mut self) -> (RealResult,) {
        (Integer,)
    }

    fn cores(&mut self) -> (RealResult,) {
        (Integer,)
    }

    fn halt(&mut self) {}

    fn trap(&mut self, _: i32) {}
}
