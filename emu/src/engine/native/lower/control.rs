//! Forms of the rows that choose the next instruction.

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::types::I32;
use cranelift_codegen::ir::{Block, InstBuilder, Value};
use cranelift_frontend::Switch;

use super::{ControlRoom, Form, Lower, S, W, aligned};
use crate::engine::native::Status;
use crate::engine::native::context::{CORE, CORES};
use crate::semantics::Motion;

/// Places that a return compares one after the other with where it leads; more are found by a search.
const COMPARED: usize = 4;

impl Lower<'_, '_> {
    fn branch(&mut self, claim: Value) -> Form<()> {
        let (place, target) = (self.place, self.source.steps[self.place as usize].target);
        let (taken, fall) = (self.b.create_block(), self.b.create_block());
        self.b.ins().brif(claim, taken, &[], fall, &[]);
        self.b.switch_to_block(taken);
        self.pass(1);
        self.go(place, target);
        self.b.switch_to_block(fall);
        let first = self.source.steps[place as usize].exit as usize;
        self.add_extra(first);
        self.lead_on()
    }

    /// On to the next place, of which the run begins.
    fn lead_on(&mut self) -> Form<()> {
        let next = self.place + 1;
        if next == self.source.plan.end() || self.entries[next as usize].is_some() {
            self.go(self.place, next);
            return Form::Left;
        }
        Form::Made(())
    }

    fn compare(&mut self, how: IntCC, a: S, b: S) -> Form<()> {
        let (a, b) = (self.s(a), self.s(b));
        let claim = self.b.ins().icmp(how, a, b);
        self.branch(claim)
    }

    fn compare_wide(&mut self, how: IntCC, a: W, b: W) -> Form<()> {
        let (a, b) = (self.w(a), self.w(b));
        let claim = self.b.ins().icmp(how, a, b);
        self.branch(claim)
    }

    fn compare_with_zero(&mut self, how: IntCC, a: W) -> Form<()> {
        let a = self.w(a);
        let claim = self.b.ins().icmp_imm_s(how, a, 0);
        self.branch(claim)
    }

    /// Address of the word behind the current one.
    fn link(&mut self) -> Value {
        let slot = self.source.steps[self.place as usize].slot;
        self.c32(slot.wrapping_add(1) as i32)
    }

    /// Leaves to where a register says, through whatever knows the places of words.
    fn go_to_word(&mut self, word: Value) {
        let status = self.c32(Status::Elsewhere as i32);
        self.leave_with(status, word, 0);
    }

    /// Rows that lead out of the program, or are executed in a body, are for the interpreter.
    fn unless_in_words(&mut self, word: Value) {
        let words = self.source.plan.words;
        let is_in_body = self.source.steps[self.place as usize].slot >= words;
        let out = match is_in_body {
            true => self.c32(1),
            false => self.b.ins().icmp_imm_s(IntCC::UnsignedGreaterThanOrEqual, word, i64::from(words)),
        };
        self.unless(out);
    }
}

impl ControlRoom for Lower<'_, '_> {
    fn beq(&mut self, a: S, b: S, _: i32) -> Form<()> {
        self.compare(IntCC::Equal, a, b)
    }

    fn bne(&mut self, a: S, b: S, _: i32) -> Form<()> {
        self.compare(IntCC::NotEqual, a, b)
    }

    fn blt(&mut self, a: S, b: S, _: i32) -> Form<()> {
        self.compare(IntCC::SignedLessThan, a, b)
    }

    fn bge(&mut self, a: S, b: S, _: i32) -> Form<()> {
        self.compare(IntCC::SignedGreaterThanOrEqual, a, b)
    }

    fn bltu(&mut self, a: S, b: S, _: i32) -> Form<()> {
        self.compare(IntCC::UnsignedLessThan, a, b)
    }

    fn bgeu(&mut self, a: S, b: S, _: i32) -> Form<()> {
        self.compare(IntCC::UnsignedGreaterThanOrEqual, a, b)
    }

    fn bweqz(&mut self, a: W, _: i32) -> Form<()> {
        self.compare_with_zero(IntCC::Equal, a)
    }

    fn bwnez(&mut self, a: W, _: i32) -> Form<()> {
        self.compare_with_zero(IntCC::NotEqual, a)
    }

    fn bwltz(&mut self, a: W, _: i32) -> Form<()> {
        self.compare_with_zero(IntCC::SignedLessThan, a)
    }

    fn bwgez(&mut self, a: W, _: i32) -> Form<()> {
        self.compare_with_zero(IntCC::SignedGreaterThanOrEqual, a)
    }

    fn bwlt(&mut self, a: W, b: W, _: i32) -> Form<()> {
        self.compare_wide(IntCC::SignedLessThan, a, b)
    }

    fn bweq(&mut self, a: W, b: W, _: i32) -> Form<()> {
        self.compare_wide(IntCC::Equal, a, b)
    }

    fn jump(&mut self, _: i32) -> Form<()> {
        let step = &self.source.steps[self.place as usize];
        self.take_exit(step.exit as usize);
        self.go(self.place, step.target);
        Form::Left
    }

    fn call(&mut self, _: i32) -> Form<(Value,)> {
        let step = &self.source.steps[self.place as usize];
        let callee = self.find_callee();
        let link = self.link();
        self.set_s(S(step.fields.d), link);
        self.take_exit(step.exit as usize);
        self.tell_motion_to(step.target, Motion::Call);
        if let Some(callee) = callee {
            self.open_call(callee);
        }
        self.go_silently(self.place, step.target);
        Form::Left
    }

    fn callr(&mut self, a: S) -> Form<(Value,)> {
        let word = self.s(a);
        self.unless_in_words(word);
        let link = self.link();
        self.set_s(S(self.source.steps[self.place as usize].fields.d), link);
        self.tell_motion(word, Motion::Call);
        self.go_to_word(word);
        Form::Left
    }

    /// Compares the address with those behind the calls that keep theirs in the same register; anything else is looked up.
    fn ret(&mut self, a: S) -> Form<()> {
        let word = self.s(a);
        let source = self.source;
        let other = self.cold_block();
        // A call stands in front of each of these places.
        let returns = source.blocks.returns[usize::from(a.0)].iter();
        let ways: Vec<(u32, u32, Block)> =
            returns.map(|&place| (source.steps[place as usize - 1].slot + 1, place, self.b.create_block())).collect();
        if ways.len() <= COMPARED {
            for &(link, _, way) in &ways {
                let is_here = self.b.ins().icmp_imm_s(IntCC::Equal, word, i64::from(link));
                let next = self.b.create_block();
                self.b.ins().brif(is_here, way, &[], next, &[]);
                self.b.switch_to_block(next);
            }
            self.b.ins().jump(other, &[]);
        } else {
            let mut switch = Switch::new();
            ways.iter().for_each(|&(link, _, way)| switch.set_entry(link.into(), way));
            switch.emit(&mut self.b, word, other);
        }
        for (_, place, way) in ways {
            self.b.switch_to_block(way);
            self.tell_motion_to(place, Motion::Return);
            match self.source.profiling {
                Some(_) => self.close_call(place),
                None => self.begin(place - 1, place),
            }
            let block = self.entries[place as usize].expect("what stands behind a call is a join");
            self.watch(place, block);
        }
        self.b.switch_to_block(other);
        self.unless_in_words(word);
        self.tell_motion(word, Motion::Return);
        self.go_to_word(word);
        Form::Left
    }

    fn core(&mut self) -> Form<(Value,)> {
        Form::Made((self.b.ins().load(I32, aligned(), self.context, CORE),))
    }

    fn cores(&mut self) -> Form<(Value,)> {
        Form::Made((self.b.ins().load(I32, aligned(), self.context, CORES),))
    }

    fn halt(&mut self) -> Form<()> {
        self.leave(Status::Halt, self.place, 0);
        Form::Left
    }

    fn trap(&mut self, _: i32) -> Form<()> {
        self.leave(Status::Bailout, self.place, self.rest());
        Form::Left
    }
}
