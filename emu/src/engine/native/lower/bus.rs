//! Forms of the rows that ask the machine for something, and calls of everything that generated code does not do by itself.

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::types::{I32, I32X4, I64, Type};
use cranelift_codegen::ir::{BlockArg, InstBuilder, Value};
use isa::{Kind, Op};

use super::{BusRoom, Continuation, Form, Lower, S, V, aligned, flags};
use crate::code::Turns;
use crate::code::registers::Registers;
use crate::engine::cost::CLOCKS;
use crate::engine::native::NotedRead;
use crate::engine::native::calls::{self, RowCall, STOPPED};
use crate::engine::native::context::{
    BEFORE, MEMORY, NOTED_AT, NOTED_END, READS, SINCE, TOTAL_CLOCKS, TOTAL_ELEMENTARY,
};
use crate::engine::native::units::has_units;
use crate::engine::plan::Step;

impl Lower<'_, '_> {
    /// Calls a function for a step, and yields what it returns.
    fn call_function(&mut self, function: RowCall, step: &Step) -> Value {
        // The step that lives as long as the code, and not a copy.
        debug_assert!(self.source.steps.as_ptr_range().contains(&std::ptr::from_ref(step)));
        let function = self.c64(function as usize as i64);
        let step = self.c64(std::ptr::from_ref(step) as i64);
        let call = self.b.ins().call_indirect(self.call, function, &[self.context, self.registers, step]);
        self.b.inst_results(call)[0]
    }

    /// Calls the meaning of a row of values, which writes registers; nothing is counted here.
    pub fn call_row(&mut self, op: Op, step: &Step) -> Value {
        self.call_function(calls::pure(op, self.source.recipe), step)
    }

    /// A row by its meaning.
    pub fn call_meaning(&mut self, op: Op, step: &Step) {
        let exit = self.call_row(op, step);
        if self.source.recipe.computes.traps_division_by_zero {
            let has_trapped = self.b.ins().icmp_imm_s(IntCC::Equal, exit, STOPPED as i64);
            self.unless(has_trapped);
        }
        self.forget_written(step);
        self.ended(step, exit);
    }

    /// A row of values and the buffer, by its meaning; an access beyond the buffer is for the interpreter.
    pub fn call_in_buffer(&mut self, op: Op, step: &Step) {
        let exit = self.call_row(op, step);
        let has_stopped = self.b.ins().icmp_imm_s(IntCC::Equal, exit, STOPPED as i64);
        self.unless(has_stopped);
        self.forget_written(step);
        self.ended(step, exit);
    }

    /// Counts the exit, and its units, by which a function said that a row ended: the exit in the low half, the units in the high one.
    fn ended(&mut self, step: &Step, exit: Value) {
        if !has_units(self.source.plan, step) {
            return self.pass_dynamic(exit);
        }
        let units = self.b.ins().ushr_imm_s(exit, 32);
        let measures_calls = self.source.profiling.is_some_and(|profiling| profiling.classes.is_some());
        if let Some((first, turns)) = self.source.unit_exits.even_turns(step).filter(|_| !measures_calls) {
            let exit = self.b.ins().band_imm_s(exit, i64::from(u32::MAX));
            self.add_units(first, exit, units, turns);
            return self.pass_dynamic(exit);
        }
        let (some, on) = (self.cold_block(), self.b.create_block());
        self.b.ins().brif(units, some, &[], on, &[]);
        self.b.switch_to_block(some);
        let function = self.c64(calls::add_units as calls::UnitsCall as usize as i64);
        let step_at = self.c64(std::ptr::from_ref(step) as i64);
        self.b.ins().call_indirect(self.call, function, &[self.context, step_at, exit]);
        self.b.ins().jump(on, &[]);
        self.b.switch_to_block(on);
        let exit = self.b.ins().band_imm_s(exit, i64::from(u32::MAX));
        self.pass_dynamic(exit);
    }

    /// Counts units of an exit, with what they cost beside the sums: as `NativeHost::add_units`, for a step whose first exit has that number.
    fn add_units(&mut self, first: usize, exit: Value, units: Value, turns: Turns) {
        // Five triangles on lanes of four are (5 + 3) >> 2 = 2 turns.
        let at_once = i64::from(turns.at_once);
        let rounded = self.b.ins().iadd_imm_s(units, at_once - 1);
        let worked_off = match turns.at_once {
            1 => units,
            _ if turns.at_once.is_power_of_two() => {
                self.b.ins().ushr_imm_s(rounded, i64::from(turns.at_once.trailing_zeros()))
            }
            _ => {
                let at_once = self.c64(at_once);
                self.b.ins().udiv(rounded, at_once)
            }
        };
        let clocks = self.b.ins().imul_imm_s(worked_off, turns.clocks as i64);
        let elementary = self.b.ins().imul_imm_s(units, turns.elementary as i64);
        let (base, offset) = self.counter(self.source.layout.unit(first));
        let exit = self.b.ins().ishl_imm_s(exit, 4);
        let at = self.b.ins().iadd(base, exit);
        self.add_at(at, offset, units);
        self.add_at(self.context, TOTAL_ELEMENTARY, elementary);
        if turns.clocks == 0 {
            return;
        }
        self.add_at(at, offset + 8, clocks);
        self.add_at(self.context, TOTAL_CLOCKS, clocks);
        // What is counted from where the sums were empty moves with that.
        let less = self.b.ins().ineg(clocks);
        if self.clocked().is_some() {
            self.add_at(self.context, SINCE, less);
        }
        if !self.source.recipe.keeps_time() {
            return;
        }
        let before = self.add_at(self.context, BEFORE, less);
        let is_long_ago = self.b.ins().icmp_imm_s(IntCC::SignedLessThan, before, -(1 << 31));
        let (full, on) = (self.cold_block(), self.b.create_block());
        self.b.ins().brif(is_long_ago, full, &[], on, &[]);
        self.b.switch_to_block(full);
        let noted = self.b.ins().load(I64, aligned(), self.context, NOTED_AT);
        self.b.ins().store(aligned(), noted, self.context, NOTED_END);
        self.b.ins().jump(on, &[]);
        self.b.switch_to_block(on);
    }

    /// Leaves where a function says that it has stopped, and how.
    fn unless_stopped(&mut self, status: Value) {
        let (stop, on) = (self.cold_block(), self.b.create_block());
        self.b.ins().brif(status, stop, &[], on, &[]);
        self.b.switch_to_block(stop);
        let (status, place) = (self.b.ins().ireduce(I32, status), self.here());
        self.leave_with(status, place, self.rest());
        self.b.switch_to_block(on);
    }

    /// A row that asks the machine, by its meaning.
    pub fn ask_machine(&mut self, op: Op, step: &Step) {
        self.store_sums(self.rest());
        let status = self.call_function(calls::bus(op), step);
        self.unless_stopped(status);
        self.forget_written(step);
    }

    /// An instruction with a meaning in Rust.
    pub fn unit(&mut self, step: &Step) -> Continuation {
        self.store_sums(self.rest());
        let ended = self.call_function(calls::unit, step);
        let stopped = self.b.ins().ushr_imm_s(ended, 32);
        let has_stopped = self.b.ins().icmp_imm_s(IntCC::NotEqual, stopped, 0);
        let (stop, on) = (self.cold_block(), self.b.create_block());
        self.b.ins().brif(has_stopped, stop, &[], on, &[]);
        self.b.switch_to_block(stop);
        let (status, place) = (self.b.ins().ireduce(I32, stopped), self.here());
        self.leave_with(status, place, self.rest());
        self.b.switch_to_block(on);
        self.forget_written(step);
        let exit = self.b.ins().band_imm_s(ended, 0xff);
        self.pass_dynamic(exit);
        self.follow();
        if step.target <= self.source.plan.end() {
            // A branch; where it leads to is known.
            let taken = self.b.ins().band_imm_s(ended, i64::from(calls::TAKEN));
            let (away, fall) = (self.b.create_block(), self.b.create_block());
            self.b.ins().brif(taken, away, &[], fall, &[]);
            self.b.switch_to_block(away);
            self.begin(self.place, step.target);
            self.go(self.place, step.target);
            self.b.switch_to_block(fall);
        }
        if self.source.plan.is_run_end(self.place) {
            self.begin(self.place, self.place + 1);
        }
        Continuation::Goes
    }

    /// The row's instruction.
    pub fn op(&self, step: &Step) -> Op {
        self.source.plan.slots()[step.slot as usize].op.expect("it is a row's")
    }

    /// A read of global memory: where its site knows the address, from where it lies, else by the meaning, which tells the site.
    ///
    /// A site has met data of one kind in the 200 octets from address 400 on, and knows start and length of that range. One unsigned comparison
    /// decides both ends:
    ///
    /// | address | address - start | below 200 | way |
    /// | --- | --- | --- | --- |
    /// | 396 | -4, which is 2^32 - 4 | no | the meaning |
    /// | 400 | 0 | yes | inline |
    /// | 599 | 199 | yes | inline |
    /// | 600 | 200 | no | the meaning |
    ///
    /// A site that has met nothing has length 0, so its first read goes by the meaning.
    fn read<const N: usize>(
        &mut self,
        a: S,
        i: i32,
        kind: Type,
        value: impl Fn(&mut Self, Value, usize) -> Value,
    ) -> Option<[Value; N]> {
        let recipe = self.source.recipe;
        if recipe.is_stepped() {
            return None;
        }
        // Find out if the address lies in the range that the site knows
        let step = &self.source.steps[self.place as usize];
        let site = self.source.sites[self.place as usize];
        let at = self.source.layout.site(site);
        let (a, i) = (self.s(a), self.c32(i));
        let address = self.b.ins().iadd(a, i);
        let start = self.b.ins().load(I32, aligned(), self.context, at);
        let length = self.b.ins().load(I32, aligned(), self.context, at + 4);
        let inside = self.b.ins().isub(address, start);
        let is_known = self.b.ins().icmp(IntCC::UnsignedLessThan, inside, length);
        let (slow, quick, on) = (self.cold_block(), self.b.create_block(), self.b.create_block());
        let found: [Value; N] = std::array::from_fn(|_| self.b.append_block_param(on, kind));
        self.b.ins().brif(is_known, quick, &[], slow, &[]);

        // Read inline: note the read where time is kept, as long as there is room for notes, count it, and load
        self.b.switch_to_block(quick);
        if recipe.keeps_time() {
            let noted = self.b.ins().load(I64, aligned(), self.context, NOTED_AT);
            let end = self.b.ins().load(I64, aligned(), self.context, NOTED_END);
            let has_room = self.b.ins().icmp(IntCC::NotEqual, noted, end);
            let room = self.b.create_block();
            self.b.ins().brif(has_room, room, &[], slow, &[]);
            self.b.switch_to_block(room);
            self.note(step, address, noted);
        }
        self.count_read(site);
        let memory = self.b.ins().load(I64, aligned().with_readonly(), self.context, MEMORY);
        let offset = self.b.ins().uextend(I64, address);
        let memory = self.b.ins().iadd(memory, offset);
        let values: Vec<BlockArg> = (0..N).map(|at| value(self, memory, at).into()).collect();
        self.b.ins().jump(on, &values);

        // Read by the meaning, which has the sums of everything before it, and take what it wrote from the registers
        self.b.switch_to_block(slow);
        self.store_sums(self.rest());
        let status = self.call_function(calls::bus(self.op(step)), step);
        self.unless_stopped(status);
        let row = self.source.plan.code.slot_row(step.slot).expect("it is a row's");
        let first = row.operands.iter().find(|operand| operand.is_written()).expect("a read writes");
        let number = step.fields.get(first.letter) as u8;
        let values: Vec<BlockArg> = (0..N as u8)
            .map(|at| {
                let offset = match first.kind {
                    Kind::S => Registers::scalar_offset(number),
                    Kind::W => Registers::wide_offset(number + at),
                    _ => Registers::vector_offset(number + at),
                };
                self.b.ins().load(kind, aligned(), self.registers, offset).into()
            })
            .collect();
        self.b.ins().jump(on, &values);
        // Go on with the values of whichever way was taken
        self.b.switch_to_block(on);
        Some(found)
    }

    /// Notes a read for those who replay it: the clocks since the last transfer, the slot, the address and the octets.
    fn note(&mut self, step: &Step, address: Value, noted: Value) {
        let (start, bits) = CLOCKS;
        let (sums, rest) = (self.b.use_var(self.sums), self.rest());
        let sums = self.b.ins().iadd_imm_s(sums, (rest as i64).wrapping_neg());
        let clocks = self.b.ins().ushr_imm_s(sums, i64::from(start));
        let clocks = self.b.ins().band_imm_s(clocks, (1 << bits) - 1);
        let before = self.b.ins().load(I64, aligned(), self.context, BEFORE);
        self.b.ins().store(aligned(), clocks, self.context, BEFORE);
        let clocks = self.b.ins().isub(clocks, before);
        let clocks = self.b.ins().ireduce(I32, clocks);
        let row = self.source.plan.code.slot_row(step.slot).expect("it is a row's");
        let octets = row.outcomes[0].cost[isa::Class::Octet];
        let (slot, octets) = (self.c32(step.slot as i32), self.c32(octets as i32));
        let at = self.b.ins().iadd(self.context, noted);
        // Where clocks of functions are not measured, the last field stays 0.
        let current = self.clocked_context();
        let fields = [clocks, slot, address, octets].into_iter().chain(current);
        for (offset, field) in NotedRead::OFFSETS.into_iter().zip(fields) {
            self.b.ins().store(aligned(), field, at, READS + offset);
        }
        let noted = self.b.ins().iadd_imm_s(noted, size_of::<NotedRead>() as i64);
        self.b.ins().store(aligned(), noted, self.context, NOTED_AT);
    }
}

/// Rows that always call their meanings.
macro_rules! called {
    ($($name:ident($($operand:ident),*) -> ($($made:ty),*);)*) => {
        $(fn $name(&mut self, $(_: $operand),*) -> Form<($($made,)*)> {
            Form::Call
        })*
    };
}

impl BusRoom for Lower<'_, '_> {
    called! {
        load(S, S, S) -> ();
        store(S, S, S) -> ();
        loadf(S, S, S, i32) -> ();
        loadfu(S, S, S, i32) -> ();
        ldv3f(S, i32, i32) -> ([Value; 3]);
        ldnode(S, i32, i32) -> (Value);
        loadnode(S, S, S, i32, i32) -> ();
        stw(S, S, i32) -> ();
        stv(V, S, i32) -> ();
        fetchadd(S, S) -> (Value);
        send2(S, V) -> ();
        send5(S, V) -> ();
        recv2() -> ([Value; 2], Value);
        recv5() -> ([Value; 5], Value);
        barrier() -> ();
    }

    fn ldw(&mut self, a: S, i: i32) -> Form<(Value,)> {
        let word = |lower: &mut Self, memory, _| lower.b.ins().load(I32, flags(), memory, 0);
        self.read(a, i, I32, word).map_or(Form::Call, |[word]| Form::Made((word,)))
    }

    fn ldwide(&mut self, a: S, i: i32) -> Form<(Value,)> {
        let wide = |lower: &mut Self, memory, _| lower.b.ins().load(I64, flags(), memory, 0);
        self.read(a, i, I64, wide).map_or(Form::Call, |[wide]| Form::Made((wide,)))
    }

    fn ldv3(&mut self, a: S, i: i32) -> Form<([Value; 3],)> {
        // Sixteen octets at the last vector might lie behind the memory.
        let vector = |lower: &mut Self, memory, at: usize| match at {
            0 | 1 => {
                let (vector, mask) = (lower.b.ins().load(I32X4, flags(), memory, 12 * at as i32), lower.mask(7));
                lower.b.ins().band(vector, mask)
            }
            _ => {
                let components = [24, 28, 32].map(|offset| lower.b.ins().load(I32, flags(), memory, offset));
                lower.vector(components)
            }
        };
        self.read(a, i, I32X4, vector).map_or(Form::Call, |vectors| Form::Made((vectors,)))
    }
}
