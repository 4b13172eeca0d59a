//! Profiling in generated code: calls and returns change the calling context, whose node has the counters. Where each call is measured,
//! operations are added up by class as well, and calls, returns and borders of regions are told.

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::types::{I32, I32X4, I64};
use cranelift_codegen::ir::{ConstantData, InstBuilder, Value};
use cranelift_frontend::FunctionBuilder;
use isa::Counts;

use super::{Lower, aligned, flags};
use crate::engine::cost::CLOCKS;
use crate::engine::native::Profiling;
use crate::engine::native::Status;
use crate::engine::native::calls::{self, Callee, Follow, Went};
use crate::engine::native::classes::{Classes, LANES, Lanes, lanes};
use crate::engine::native::context::{
    CALLS, CALLS_END, CELLS, CLASSES, CURRENT, CounterLayout, NODES, OWN_CELLS, SINCE,
};
use crate::profile::FunctionChange;
use crate::semantics::Motion;

/// Address of the current calling context's node.
pub(super) fn current_node(b: &mut FunctionBuilder, context: Value, layout: CounterLayout) -> Value {
    let current = b.ins().load(I32, aligned(), context, CURRENT);
    node(b, context, layout, current)
}

/// Address of a calling context's node.
fn node(b: &mut FunctionBuilder, context: Value, layout: CounterLayout, number: Value) -> Value {
    let number = b.ins().uextend(I64, number);
    let offset = b.ins().imul_imm_s(number, i64::from(layout.node));
    let nodes = b.ins().load(I64, aligned(), context, NODES);
    b.ins().iadd(nodes, offset)
}

impl<'a> Lower<'a, '_> {
    /// Costs by class, where each call is measured.
    fn classes(&self) -> Option<&'a Classes> {
        self.source.profiling?.classes.as_ref()
    }

    /// Adds to four classes.
    fn add_four(&mut self, group: usize, more: Value) {
        let offset = CLASSES + 16 * group as i32;
        let sum = self.b.ins().load(I32X4, flags(), self.context, offset);
        let sum = self.b.ins().iadd(sum, more);
        self.b.ins().store(flags(), sum, self.context, offset);
    }

    fn add_lanes(&mut self, more: Lanes) {
        for (group, four) in more.chunks_exact(4).enumerate().filter(|(_, four)| **four != [0; 4]) {
            let octets: Vec<u8> = four.iter().flat_map(|lane| lane.to_le_bytes()).collect();
            let constant = self.b.func.dfg.constants.insert(ConstantData::from(octets));
            let more = self.b.ins().vconst(I32X4, constant);
            self.add_four(group, more);
        }
    }

    /// Adds what a block costs from a place on.
    pub fn spend_classes(&mut self, place: u32) {
        if let Some(classes) = self.classes() {
            let span: Counts = classes.span(place, self.source.blocks.end[place as usize]);
            self.add_lanes(lanes(&span));
        }
    }

    /// Adds what an exit costs beside its block.
    pub fn pass_classes(&mut self, exit: usize) {
        if let Some(classes) = self.classes() {
            self.add_lanes(classes.exits[exit]);
        }
    }

    /// Adds the cost of one of several exits that only the running program knows, by its number from `first` on.
    pub fn pass_classes_dynamic(&mut self, first: usize, exits: usize, number: Value) {
        let Some(classes) = self.classes() else { return };
        let exits = &classes.exits[first..first + exits];
        let size = self.c64(size_of::<Lanes>() as i64);
        let offset = self.b.ins().imul(number, size);
        let table = self.c64(exits.as_ptr() as i64);
        let at = self.b.ins().iadd(table, offset);
        for group in (0..LANES / 4).filter(|group| exits.iter().any(|exit| exit[4 * group..4 * group + 4] != [0; 4])) {
            let more = self.b.ins().load(I32X4, flags(), at, 16 * group as i32);
            self.add_four(group, more);
        }
    }

    /// Calls a function of two numbers.
    fn call_host(&mut self, function: usize, first: Value, second: i64) -> Value {
        let (function, second) = (self.c64(function as i64), self.c64(second));
        let call = self.b.ins().call_indirect(self.call, function, &[self.context, first, second]);
        self.b.inst_results(call)[0]
    }

    /// The current slot in the low half, another one in the high half.
    fn ways(&mut self, to: Value) -> Value {
        self.ways_from(self.place, to)
    }

    /// The slot of a place in the low half, another one in the high half.
    fn ways_from(&mut self, from: u32, to: Value) -> Value {
        let steps = self.source.steps;
        let from = self.source.profiling.map_or(steps[from as usize].slot, |profiling| profiling.slot(from));
        let to = self.b.ins().uextend(I64, to);
        let to = self.b.ins().ishl_imm_s(to, 32);
        self.b.ins().bor_imm_s(to, i64::from(from))
    }

    /// Tells who measures each call that control goes from the current slot to another one.
    fn tell(&mut self, to: Value, motion: Motion) {
        if self.classes().is_some() {
            let ways = self.ways(to);
            self.call_host(calls::went as Went as usize, ways, motion as i64);
        }
    }

    /// Tells of a call or a return to a word, if anybody measures functions.
    pub fn tell_motion(&mut self, to: Value, motion: Motion) {
        if self.source.profiling.is_some() {
            self.store_sums(0);
            let ways = self.ways(to);
            self.call_host(calls::follow as Follow as usize, ways, motion as i64);
            self.tell(to, motion);
        }
    }

    /// Tells of a call or a return that leads to a place, if anybody measures each call.
    pub fn tell_motion_to(&mut self, to: u32, motion: Motion) {
        if self.classes().is_some() {
            let slot = self.slot(to);
            self.tell(slot, motion);
        }
    }

    /// The current calling context, where clocks are measured.
    pub fn clocked_context(&mut self) -> Option<Value> {
        self.clocked()?;
        Some(self.b.ins().load(I32, aligned(), self.context, CURRENT))
    }

    /// Facts about functions and regions, where clocks are measured.
    pub fn clocked(&self) -> Option<&'a Profiling> {
        self.source.profiling.filter(|profiling| profiling.has_clocks)
    }

    /// Gives the clocks since that was done last to the current calling context and the regions around a place, where clocks are measured. The
    /// sums have nothing in them that is not executed yet.
    fn spend_clocks(&mut self, place: u32) {
        let Some(profiling) = self.clocked() else { return };
        let (start, bits) = CLOCKS;
        let sums = self.b.use_var(self.sums);
        let now = self.b.ins().ushr_imm_s(sums, i64::from(start));
        let now = self.b.ins().band_imm_s(now, (1 << bits) - 1);
        let since = self.b.ins().load(I64, aligned(), self.context, SINCE);
        self.b.ins().store(aligned(), now, self.context, SINCE);
        let clocks = self.b.ins().isub(now, since);
        // The cells of a context stand together: one for no region, then one a region.
        let cells = self.b.ins().load(I64, aligned(), self.context, OWN_CELLS);
        let own = 8 * profiling.caller(place) as i32;
        let sum = self.b.ins().load(I64, aligned(), cells, own);
        let sum = self.b.ins().iadd(sum, clocks);
        self.b.ins().store(aligned(), sum, cells, own);
    }

    /// Tells that control goes on at a place, where that belongs to another region and anybody measures each call.
    pub fn tell_border(&mut self, from: u32, to: u32) {
        if self.source.profiling.is_some_and(|profiling| profiling.is_border(from, to)) {
            self.spend_clocks(from);
            let slot = self.slot(to);
            self.tell(slot, Motion::Jump);
        }
    }

    fn slot(&mut self, place: u32) -> Value {
        let slot = self.source.steps[place as usize].slot;
        self.c32(slot as i32)
    }

    /// Goes over to the node of a calling context.
    fn switch_to_context(&mut self, number: Value) {
        let Some(variable) = self.node else { return };
        self.b.ins().store(aligned(), number, self.context, CURRENT);
        if let Some(profiling) = self.clocked() {
            let number = self.b.ins().uextend(I64, number);
            let offset = self.b.ins().imul_imm_s(number, 8 * (profiling.regions() as i64 + 1));
            let cells = self.b.ins().load(I64, aligned(), self.context, CELLS);
            let cells = self.b.ins().iadd(cells, offset);
            self.b.ins().store(aligned(), cells, self.context, OWN_CELLS);
        }
        let node = node(&mut self.b, self.context, self.source.layout, number);
        self.b.def_var(variable, node);
    }

    /// Goes over to the node of the calling context that a function has changed.
    fn reload_node(&mut self) {
        if let Some(variable) = self.node {
            let node = current_node(&mut self.b, self.context, self.source.layout);
            self.b.def_var(variable, node);
        }
    }

    /// Finds the calling context of what the current row calls, before it is executed; what has none is left to the interpreter.
    pub fn find_callee(&mut self) -> Option<Value> {
        let caller = self.source.profiling?.caller(self.place);
        let step = &self.source.steps[self.place as usize];
        // Where there is no room for the call, the interpreter says what becomes of it.
        let calls = self.b.ins().load(I64, aligned(), self.context, CALLS);
        let end = self.b.ins().load(I64, aligned(), self.context, CALLS_END);
        let is_full = self.b.ins().icmp(IntCC::Equal, calls, end);
        self.unless(is_full);
        let (place, rest) = (self.place, self.rest());
        Some(self.context_behind(step.slot, caller, |lower| lower.leave(Status::Bailout, place, rest)))
    }

    /// The calling context of what a slot calls, or jumps to in another function; `leave` says how to leave where it has none.
    fn context_behind(&mut self, slot: u32, caller: usize, leave: impl FnOnce(&mut Self)) -> Value {
        let (base, offset) = self.counter(self.source.layout.callee(caller));
        let known = self.b.ins().load(I32, aligned(), base, offset);
        let (seek, found, stop, on) = (self.cold_block(), self.cold_block(), self.cold_block(), self.b.create_block());
        let number = self.b.append_block_param(on, I32);
        self.b.ins().brif(known, on, &[known.into()], seek, &[]);
        self.b.switch_to_block(seek);
        let slot = self.c64(slot.into());
        let sought = self.call_host(calls::callee as Callee as usize, slot, caller as i64);
        self.b.ins().brif(sought, found, &[], stop, &[]);
        self.b.switch_to_block(stop);
        leave(self);
        self.b.switch_to_block(found);
        self.reload_node();
        let sought = self.b.ins().ireduce(I32, sought);
        self.b.ins().jump(on, &[sought.into()]);
        self.b.switch_to_block(on);
        number
    }

    /// Goes over to the calling context of a place outside of the function where control comes from, and begins a run there.
    pub fn change_function(&mut self, from: u32, to: u32) {
        let Some(profiling) = self.source.profiling else { return };
        match profiling.change(from, to) {
            None => {}
            Some(FunctionChange::TailCall) => {
                let follow = |lower: &mut Self| {
                    lower.follow_to(from, to, Motion::Jump);
                    lower.go_to_slot(to);
                };
                let callee = self.context_behind(profiling.slot(from), profiling.caller(from), follow);
                self.switch_to_context(callee);
                self.count_begun(from, to);
            }
            Some(FunctionChange::Outside) => {
                self.follow_to(from, to, Motion::Jump);
                self.reload_node();
                self.bump(self.source.layout.begun(to));
            }
        }
    }

    /// Lets the profiler find the calling context behind a jump or a return to a place.
    fn follow_to(&mut self, from: u32, to: u32, motion: Motion) {
        self.store_sums(0);
        let slot = self.slot(to);
        let ways = self.ways_from(from, slot);
        self.call_host(calls::follow as Follow as usize, ways, motion as i64);
    }

    /// Leaves to where a place is entered anew, by generated code or by the interpreter.
    fn go_to_slot(&mut self, place: u32) {
        let (status, slot) = (self.c32(Status::Elsewhere as i32), self.slot(place));
        self.leave_with(status, slot, 0);
    }

    /// Opens a call from the current row to a calling context that [`Lower::find_callee`] has found.
    pub fn open_call(&mut self, callee: Value) {
        self.spend_clocks(self.place);
        let slot = self.source.steps[self.place as usize].slot;
        let calls = self.b.ins().load(I64, aligned(), self.context, CALLS);
        let (current, back) = (self.b.ins().load(I32, aligned(), self.context, CURRENT), self.c32(slot as i32 + 1));
        self.b.ins().store(aligned(), current, calls, 0);
        self.b.ins().store(aligned(), back, calls, 4);
        let calls = self.b.ins().iadd_imm_s(calls, 8);
        self.b.ins().store(aligned(), calls, self.context, CALLS);
        self.switch_to_context(callee);
    }

    /// Ends the newest call with a return to the place behind it, or whatever else that return ends.
    pub fn close_call(&mut self, place: u32) {
        if self.node.is_none() {
            return;
        }
        let back = self.source.steps[place as usize - 1].slot + 1;
        let calls = self.b.ins().load(I64, aligned(), self.context, CALLS);
        let returns_to = self.b.ins().load(I32, aligned(), calls, -4);
        let is_newest = self.b.ins().icmp_imm_s(IntCC::Equal, returns_to, i64::from(back));
        let (newest, other, on) = (self.b.create_block(), self.cold_block(), self.b.create_block());
        self.b.ins().brif(is_newest, newest, &[], other, &[]);

        self.b.switch_to_block(newest);
        self.spend_clocks(self.place);
        let calls = self.b.ins().iadd_imm_s(calls, -8);
        self.b.ins().store(aligned(), calls, self.context, CALLS);
        let caller = self.b.ins().load(I32, aligned(), calls, 0);
        self.switch_to_context(caller);
        self.begin(place - 1, place);
        self.change_function(place - 1, place);
        self.b.ins().jump(on, &[]);

        self.b.switch_to_block(other);
        self.follow_to(self.place, place, Motion::Return);
        // A return that no call belongs to is a jump, and that may lead to where there is no room for a context.
        let (plain, stop) = (self.b.create_block(), self.cold_block());
        let current = self.b.ins().load(I32, aligned(), self.context, CURRENT);
        self.b.ins().brif(current, plain, &[], stop, &[]);
        self.b.switch_to_block(stop);
        self.go_to_slot(place);
        self.b.switch_to_block(plain);
        self.reload_node();
        self.bump(self.source.layout.begun(place));
        self.b.ins().jump(on, &[]);
        self.b.switch_to_block(on);
    }
}
