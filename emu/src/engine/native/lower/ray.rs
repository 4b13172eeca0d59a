//! Forms of the rows of the ray unit: steps down a tree and planes by instructions, which leave as soon as the way is known; the rest by
//! their meanings.

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::types::{I32, I64};
use cranelift_codegen::ir::{Block, InstBuilder, Value};
use isa::Op;

use super::{Form, Lower, RayRoom, S, V, W, aligned};
use crate::code::registers::Registers;

/// The number that stands for time among the axes.
const TIME: i64 = 3;

/// A plane as the ray meets it, at t = run / slope.
#[derive(Clone, Copy)]
struct PlaneMeeting {
    /// The axis, as four times its number.
    axis: Value,
    run: Value,
    slope: Value,
}

impl Lower<'_, '_> {
    /// Comparison of a ray with the plane in a pattern.
    fn meet(&mut self, pattern: Value, ray: V) -> PlaneMeeting {
        let axis = self.b.ins().ushr_imm_s(pattern, 32);
        let axis = self.b.ins().band_imm_s(axis, 3);
        let offset = self.b.ins().ishl_imm_s(axis, 2);
        let at = self.b.ins().iadd(self.registers, offset);
        let origin = self.b.ins().sload32(aligned(), at, Registers::vector_offset(ray.0));
        let slope = self.b.ins().sload32(aligned(), at, Registers::vector_offset(ray.0.wrapping_add(1)));
        // Along time, the fourth component, the origin is 0 and the direction 1.
        let is_time = self.b.ins().icmp_imm_s(IntCC::Equal, axis, TIME);
        let is_time = self.b.ins().uextend(I64, is_time);
        let slope = self.b.ins().bor(slope, is_time);
        let place = self.b.ins().ireduce(I32, pattern);
        let place = self.b.ins().sextend(I64, place);
        PlaneMeeting { axis: offset, run: self.b.ins().isub(place, origin), slope }
    }

    /// Goes one way where a ray, its direction moved, meets the first plane before the other one, else the other way; see
    /// [`isa::number::ray`]. A run has 33 bits with its sign and is never the least of them, so a product fits.
    fn before(&mut self, first: PlaneMeeting, second: PlaneMeeting, yes: Block, no: Block) {
        let (here, there) = (self.b.ins().imul(first.run, second.slope), self.b.ins().imul(second.run, first.slope));
        let (tie, clear) = (self.cold_block(), self.b.create_block());
        let is_tie = self.b.ins().icmp(IntCC::Equal, here, there);
        self.b.ins().brif(is_tie, tie, &[], clear, &[]);

        self.b.switch_to_block(clear);
        let is_less = self.b.ins().icmp(IntCC::SignedLessThan, here, there);
        let signs = self.b.ins().bxor(first.slope, second.slope);
        let is_turned = self.b.ins().icmp_imm_s(IntCC::SignedLessThan, signs, 0);
        let is_before = self.b.ins().bxor(is_less, is_turned);
        self.b.ins().brif(is_before, yes, &[], no, &[]);

        self.b.switch_to_block(tie);
        let is_lower = self.b.ins().icmp(IntCC::UnsignedLessThan, first.axis, second.axis);
        let is_higher = self.b.ins().icmp(IntCC::UnsignedGreaterThan, first.axis, second.axis);
        let is_forward = self.b.ins().icmp_imm_s(IntCC::SignedGreaterThanOrEqual, first.slope, 0);
        let is_backward = self.b.ins().icmp_imm_s(IntCC::SignedLessThan, second.slope, 0);
        let (lower, higher) = (self.b.ins().band(is_lower, is_forward), self.b.ins().band(is_higher, is_backward));
        let is_before = self.b.ins().bor(lower, higher);
        self.b.ins().brif(is_before, yes, &[], no, &[]);
    }

    /// The value turned where the sign of another one is set.
    fn turned(&mut self, value: Value, sign: Value) -> Value {
        let sign = self.b.ins().sshr_imm_s(sign, 63);
        let value = self.b.ins().bxor(value, sign);
        self.b.ins().isub(value, sign)
    }

    /// From a step down the tree on to what follows. Where its `e` is known, so is where branches behind it lead that compare it with 0.
    fn go_from_step(&mut self, e: S, known: Option<i32>) {
        let source = self.source;
        let (start, mut from) = (self.place, self.place);
        let mut next = self.place + 1;
        while let Some(known) = known
            && let Some(taken) = decides(self, next, e, known)
        {
            self.place = next;
            self.spend(next);
            from = next;
            if taken {
                self.pass(1);
                next = source.steps[next as usize].target;
                break;
            }
            next += 1;
        }
        self.go(from, next);
        self.place = start;
    }
}

/// The branch at a place is taken where `e` is `known`; `None` for anything else than a branch that compares it with 0.
fn decides(lower: &Lower, place: u32, e: S, known: i32) -> Option<bool> {
    let step = lower.source.steps.get(place as usize)?;
    let is_border = lower.source.profiling.is_some_and(|profiling| profiling.ends_block(lower.place, place));
    let is_plain = !lower.source.blocks.is_watched[place as usize] && !step.is_uneven && !is_border;
    if !is_plain || !crate::engine::native::blocks::compares_with_zero(lower.source.plan, step, e.0) {
        return None;
    }
    match lower.op(step) {
        Op::beq => Some(known == 0),
        Op::bne => Some(known != 0),
        Op::blt => Some(known < 0),
        Op::bge => Some(known >= 0),
        _ => None,
    }
}

impl RayRoom for Lower<'_, '_> {
    fn rtri(&mut self, _: V, _: V, _: i32) -> Form<(Value, Value)> {
        Form::Call
    }

    fn rbox(&mut self, _: V, _: V) -> Form<(Value, Value)> {
        Form::Call
    }

    fn rexit(&mut self, _: V, _: V) -> Form<(Value,)> {
        Form::Call
    }

    fn rstep(&mut self, a: V, b: W, i: i32) -> Form<(Value, Value)> {
        let fields = self.source.steps[self.place as usize].fields;
        let (node, entry, exit) = (self.w(b), self.w(W(b.0 + 1)), self.w(W(b.0 + 2)));
        // All ways know only what was known in front of the first branch.
        let known = (self.scalars.clone(), self.vectors.clone(), self.wides.clone());
        let ways: [Block; 5] = std::array::from_fn(|_| self.b.create_block());
        let [leaf, behind, passed, near, both] = ways;

        // Find the children, and leave at a leaf.
        let high = self.b.ins().ushr_imm_s(node, 32);
        let high = self.b.ins().ireduce(I32, high);
        let axis = self.b.ins().band_imm_s(high, 3);
        let left = self.b.ins().bxor(high, axis);
        let is_leaf = self.b.ins().icmp_imm_s(IntCC::Equal, axis, TIME);
        let inner = self.b.create_block();
        self.b.ins().brif(is_leaf, leaf, &[], inner, &[]);

        // Leave where the split is behind the origin.
        self.b.switch_to_block(inner);
        let split = self.meet(node, a);
        let distance = self.c32(i);
        let right = self.b.ins().iadd(left, distance);
        let is_backwards = self.b.ins().icmp_imm_s(IntCC::SignedLessThan, split.slope, 0);
        let first = self.b.ins().select(is_backwards, right, left);
        let second = self.b.ins().select(is_backwards, left, right);
        let run = self.turned(split.run, split.slope);
        let is_behind = self.b.ins().icmp_imm_s(IntCC::SignedLessThanOrEqual, run, 0);
        let ahead = self.b.create_block();
        self.b.ins().brif(is_behind, behind, &[], ahead, &[]);

        // Leave where it is met before the ray enters, or after it leaves.
        self.b.switch_to_block(ahead);
        let entry = self.meet(entry, a);
        let entered = self.b.create_block();
        self.before(entry, split, entered, passed);
        self.b.switch_to_block(entered);
        let exit = self.meet(exit, a);
        self.before(split, exit, both, near);

        // Each way writes, counts and goes on by itself.
        for (number, way) in ways.into_iter().enumerate() {
            self.b.switch_to_block(way);
            (self.scalars, self.vectors, self.wides) = known.clone();
            let (d, e, is_known) = match number {
                0 => (left, -1, true),
                1 | 2 => (second, 0, true),
                3 => (first, 0, true),
                _ => (first, 0, false),
            };
            let e_value = if is_known { self.c32(e) } else { second };
            self.set_s(S(fields.d), d);
            self.set_s(S(fields.e), e_value);
            self.pass(number);
            self.follow();
            self.go_from_step(S(fields.e), is_known.then_some(e));
        }
        Form::Left
    }

    fn rbefore(&mut self, a: V, b: W, c: S, i: i32) -> Form<(Value,)> {
        let pattern = self.w(b);
        let plane = self.meet(pattern, a);
        let run = self.turned(plane.run, plane.slope);
        let slope = self.b.ins().iabs(plane.slope);
        let t = self.s64(c);
        let t = self.b.ins().iadd_imm_s(t, 1);
        // At most 2^31 by 2^31. Below a whole number is what has its floor below it.
        let product = self.b.ins().imul(t, slope);
        let floor = self.b.ins().sshr_imm_s(product, i64::from(i));
        let is_before = self.b.ins().icmp(IntCC::SignedLessThan, floor, run);
        Form::Made((self.b.ins().uextend(I32, is_before),))
    }
}
