//! Counting in generated code: what it counts, where it looks at the sums, and how it leaves.

use cranelift_codegen::ir::types::{I32, I64};
use cranelift_codegen::ir::{Block, InstBuilder, Value};

use super::{Lower, aligned};
use crate::engine::cost::HALVES;
use crate::engine::native::Status;
use crate::engine::native::context::{DEPENDS_ON_CORE, DEPENDS_ON_CORES, PLACE, SUMS, TAINTED};

impl Lower<'_, '_> {
    /// Adds one to a number of 64 bits.
    fn bump_at(&mut self, base: Value, offset: i32) {
        let count = self.b.ins().load(I64, aligned(), base, offset);
        let count = self.b.ins().iadd_imm_s(count, 1);
        self.b.ins().store(aligned(), count, base, offset);
    }

    /// Adds to a number of 64 bits, and yields the sum.
    pub fn add_at(&mut self, base: Value, offset: i32, more: Value) -> Value {
        let sum = self.b.ins().load(I64, aligned(), base, offset);
        let sum = self.b.ins().iadd(sum, more);
        self.b.ins().store(aligned(), sum, base, offset);
        sum
    }

    /// A counter of the node: its base and its distance from there.
    pub fn counter(&mut self, offset: i32) -> (Value, i32) {
        match self.node {
            Some(node) => (self.b.use_var(node), offset),
            None => (self.context, self.source.layout.frame + offset),
        }
    }

    /// Adds one to a counter of the node.
    pub fn bump(&mut self, offset: i32) {
        let (base, offset) = self.counter(offset);
        self.bump_at(base, offset);
    }

    /// A pass through an exit.
    pub fn take_exit(&mut self, exit: usize) {
        self.bump(self.source.layout.exit(exit));
    }

    /// A pass through an exit of the current step, by its number among those.
    pub fn pass(&mut self, number: usize) {
        let step = &self.source.steps[self.place as usize];
        let exit = step.exit as usize + number;
        if step.exits > 1 {
            self.take_exit(exit);
        }
        self.add_extra(exit);
    }

    /// Adds what an exit takes beside its block.
    pub fn add_extra(&mut self, exit: usize) {
        self.add_to_sums(self.source.extras[exit]);
        self.pass_classes(exit);
    }

    /// A run is begun at a place to which no exit leads whose target is known; control comes from another place of the same call. Where that is one of
    /// another function, the way there begins the run: see [`Lower::change_function`].
    pub fn begin(&mut self, from: u32, place: u32) {
        if self.source.profiling.is_none_or(|profiling| profiling.change(from, place).is_none()) {
            self.count_begun(from, place);
        }
    }

    /// Counts a run that begins at a place, and the regions that are entered there from another one.
    pub fn count_begun(&mut self, from: u32, place: u32) {
        self.bump(self.source.layout.begun(place));
        if let Some(profiling) = self.source.profiling {
            for &region in profiling.entered(from, place) {
                self.bump(self.source.layout.entered(region));
            }
        }
    }

    /// A read was done inline at a site.
    pub fn count_read(&mut self, site: u32) {
        self.bump_at(self.context, self.source.layout.site(site) + 8);
    }

    pub fn add_to_sums(&mut self, more: u64) {
        if more != 0 {
            let sums = self.b.use_var(self.sums);
            let sums = self.b.ins().iadd_imm_s(sums, more as i64);
            self.b.def_var(self.sums, sums);
        }
    }

    /// Costs of the places of a block from one on.
    fn span(&self, place: u32) -> u64 {
        self.source.plan.cost(place, self.source.blocks.end[place as usize]).0
    }

    /// Adds what the block takes from a place on.
    pub fn spend(&mut self, place: u32) {
        self.add_to_sums(self.span(place));
        self.spend_classes(place);
    }

    /// Cost of the block from the current place on, added already.
    pub fn rest(&self) -> u64 {
        self.span(self.place)
    }

    /// Leaves at a place; `rest` was added for what is not executed.
    pub fn leave(&mut self, status: Status, place: u32, rest: u64) {
        let (status, place) = (self.c32(status as i32), self.c32(place as i32));
        self.leave_with(status, place, rest);
    }

    /// Leaves generated code, which way and where being known only then.
    pub fn leave_with(&mut self, status: Value, place: Value, rest: u64) {
        self.store_sums(rest);
        self.b.ins().store(aligned(), place, self.context, PLACE);
        self.b.ins().return_(&[status]);
    }

    /// Puts the sums where functions find them.
    pub fn store_sums(&mut self, rest: u64) {
        let sums = self.b.use_var(self.sums);
        let sums = if rest == 0 { sums } else { self.b.ins().iadd_imm_s(sums, (rest as i64).wrapping_neg()) };
        self.b.ins().store(aligned(), sums, self.context, SUMS);
    }

    /// On to a place at which a block begins.
    pub fn go(&mut self, from: u32, to: u32) {
        self.tell_border(from, to);
        self.change_function(from, to);
        self.go_silently(from, to);
    }

    /// On to a place where no profiler has to be told, or has been.
    pub fn go_silently(&mut self, from: u32, to: u32) {
        match self.entries[to as usize] {
            Some(block) if to <= from || self.source.blocks.is_watched[to as usize] => self.watch(to, block),
            Some(block) => {
                self.b.ins().jump(block, &[]);
            }
            // The end of the program, to which nothing leads but running on.
            None => self.leave(Status::Bailout, to, 0),
        }
    }

    /// Goes on with a look at the sums: where one of them has come to half of its room, they are emptied first.
    pub fn watch(&mut self, to: u32, block: Block) {
        let sums = self.b.use_var(self.sums);
        let halves = self.b.ins().band_imm_s(sums, HALVES as i64);
        let stop = self.cold_block();
        self.b.ins().brif(halves, stop, &[], block, &[]);
        self.b.switch_to_block(stop);
        self.leave(Status::Full, to, 0);
    }

    /// Leaves to the interpreter before the current place where something holds, a number other than 0.
    pub fn unless(&mut self, bailout: Value) {
        let (stop, on) = (self.cold_block(), self.b.create_block());
        self.b.ins().brif(bailout, stop, &[], on, &[]);
        self.b.switch_to_block(stop);
        self.leave(Status::Bailout, self.place, self.rest());
        self.b.switch_to_block(on);
    }

    /// Follows where the number of cores goes at the current place, as [`crate::engine::taint::Taint::step`].
    pub fn follow(&mut self) {
        let plan = self.source.plan;
        let effect = plan.effect(self.place);
        let Some(held) = self.source.recipe.held.filter(|&held| effect.asks() || effect.touches(held)) else { return };
        let (tells_core, is_fixed_unless, reads) = (effect.tells_core(), effect.fixed_unless(), effect.reads() & held);
        let tainted = self.b.ins().load(I64, aligned(), self.context, TAINTED);
        let mut depends: Option<Value> = (reads != 0).then(|| self.b.ins().band_imm_s(tainted, reads as i64));
        if let Some(target) = is_fixed_unless {
            // A message to a number that is not that of the main processor.
            let told = self.b.ins().band_imm_s(tainted, target as i64);
            let is_fixed = self.b.ins().icmp_imm_s(cranelift_codegen::ir::condcodes::IntCC::Equal, told, 0);
            let is_fixed = self.b.ins().uextend(I64, is_fixed);
            depends = Some(depends.map_or(is_fixed, |depends| self.b.ins().bor(depends, is_fixed)));
        }
        if let Some(depends) = depends {
            let known = self.b.ins().load(I64, aligned(), self.context, DEPENDS_ON_CORES);
            let known = self.b.ins().bor(known, depends);
            self.b.ins().store(aligned(), known, self.context, DEPENDS_ON_CORES);
        }
        if tells_core {
            let one = self.c64(1);
            self.b.ins().store(aligned(), one, self.context, DEPENDS_ON_CORE);
        }
        if effect.writes() & held != 0 || effect.counts() != 0 {
            let kept = self.b.ins().band_imm_s(tainted, !effect.writes() as i64);
            let after = self.b.ins().bor_imm_s(kept, effect.counts() as i64);
            self.b.ins().store(aligned(), after, self.context, TAINTED);
        }
    }

    /// Counts the exit by which a function said that the current step has ended, where there are several.
    pub fn pass_dynamic(&mut self, exit: Value) {
        let step = &self.source.steps[self.place as usize];
        if step.exits < 2 {
            return;
        }
        let offset = self.b.ins().ishl_imm_s(exit, 3);
        let (base, first) = self.counter(self.source.layout.exit(step.exit as usize));
        let at = self.b.ins().iadd(base, offset);
        let count = self.b.ins().load(I64, aligned(), at, first);
        let count = self.b.ins().iadd_imm_s(count, 1);
        self.b.ins().store(aligned(), count, at, first);
        self.pass_classes_dynamic(step.exit as usize, step.exits.into(), exit);
        if step.is_uneven {
            let extras = self.source.extras[step.exit as usize..].as_ptr();
            let extras = self.c64(extras as i64);
            let at = self.b.ins().iadd(extras, offset);
            let extra = self.b.ins().load(I64, aligned(), at, 0);
            let sums = self.b.use_var(self.sums);
            let sums = self.b.ins().iadd(sums, extra);
            self.b.def_var(self.sums, sums);
        }
    }

    /// The place as a number that generated code returns.
    pub fn here(&mut self) -> Value {
        self.b.ins().iconst(I32, i64::from(self.place))
    }
}
