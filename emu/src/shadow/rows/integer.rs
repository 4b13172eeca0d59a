//! Exact formulas of the integer instructions: what they write is an integer, which has no shadow. A copy keeps it, and so does logic that changes
//! no bit of a number: that is how programs select one of two numbers by masks.

use super::{IntegerRoom, RealFormulas, RealResult, ShadowInput};
use RealResult::Integer;

/// The number among two of which a pattern has all bits, if there is one.
pub(super) fn kept(pattern: i64, a: ShadowInput, b: ShadowInput) -> RealResult {
    let number = [a, b].into_iter().find(|number| number.shadow.is_some() && number.raw == pattern);
    number.map_or(Integer, |number| number.moved())
}

/// The number itself where a pattern is its own.
fn kept_of(pattern: i64, a: ShadowInput) -> RealResult {
    kept(pattern, a, a)
}

impl IntegerRoom for RealFormulas<'_> {
    fn iadd(&mut self, _: ShadowInput, _: ShadowInput) -> (RealResult,) {
        (Integer,)
    }

    fn isub(&mut self, _: ShadowInput, _: ShadowInput) -> (RealResult,) {
        (Integer,)
    }

    fn imul(&mut self, _: ShadowInput, _: ShadowInput) -> (RealResult,) {
        (Integer,)
    }

    fn and(&mut self, a: ShadowInput, b: ShadowInput) -> (RealResult,) {
        (kept(a.raw & b.raw, a, b),)
    }

    fn or(&mut self, a: ShadowInput, b: ShadowInput) -> (RealResult,) {
        (kept(a.raw | b.raw, a, b),)
    }

    fn xor(&mut self, a: ShadowInput, b: ShadowInput) -> (RealResult,) {
        (kept(a.raw ^ b.raw, a, b),)
    }

    fn sll(&mut self, _: ShadowInput, _: ShadowInput) -> (RealResult,) {
        (Integer,)
    }

    fn srl(&mut self, _: ShadowInput, _: ShadowInput) -> (RealResult,) {
        (Integer,)
    }

    fn sra(&mut self, _: ShadowInput, _: ShadowInput) -> (RealResult,) {
        (Integer,)
    }

    fn slt(&mut self, a: ShadowInput, b: ShadowInput) -> (RealResult,) {
        self.compare(&a, &b, |order| order.is_lt());
        (Integer,)
    }

    fn clz(&mut self, _: ShadowInput) -> (RealResult,) {
        (Integer,)
    }

    fn mov(&mut self, a: ShadowInput) -> (RealResult,) {
        (a.moved(),)
    }

    fn addr(&mut self, _: u32, _: ShadowInput) -> (RealResult,) {
        (Integer,)
    }

    fn slli(&mut self, _: ShadowInput, _: i32) -> (RealResult,) {
        (Integer,)
    }

    fn srli(&mut self, _: ShadowInput, _: i32) -> (RealResult,) {
        (Integer,)
    }

    fn srai(&mut self, _: ShadowInput, _: i32) -> (RealResult,) {
        (Integer,)
    }

    fn iaddi(&mut self, _: ShadowInput, _: i32) -> (RealResult,) {
        (Integer,)
    }

    fn isubi(&mut self, _: ShadowInput, _: i32) -> (RealResult,) {
        (Integer,)
    }

    fn andi(&mut self, a: ShadowInput, i: i32) -> (RealResult,) {
        (kept_of(a.raw & i64::from(i), a),)
    }

    fn ori(&mut self, a: ShadowInput, i: i32) -> (RealResult,) {
        (kept_of(a.raw | i64::from(i), a),)
    }

    fn movi(&mut self, _: i32) -> (RealResult,) {
        (Integer,)
    }

    fn movhi(&mut self, _: ShadowInput, _: i32) -> (RealResult,) {
        (Integer,)
    }

    fn lea(&mut self, _: u32, _: i32) -> (RealResult,) {
        (Integer,)
    }

    fn element(&mut self, _: u32, _: ShadowInput, _: i32) -> (RealResult,) {
        (Integer,)
    }
}
