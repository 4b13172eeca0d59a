//! A plan in Cranelift's language: one function for a whole program. Registers stand in memory and every write goes there, so that any way
//! out finds the state complete; what was read or written is known again up to the end of a block. Between blocks live only the
//! pointers and the packed sums.

mod arithmetic;
mod bus;
mod control;
mod counting;
mod forms;
mod integer;
mod local;
mod packet;
mod profile;
mod ray;
mod scalar;
mod vector;
mod walk;
mod wide;

use cranelift_codegen::ir::types::{I32, I32X4, I64};
use cranelift_codegen::ir::{
    AbiParam, Block, Function, InstBuilder, MemFlagsData, SigRef, Signature, SourceLoc, Value,
};
use cranelift_codegen::isa::TargetIsa;
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext, Switch, Variable};
use isa::{Kind, Op};

use super::blocks::Blocks;
use super::context::{CounterLayout, SUMS};
use super::profiling::Profiling;
use super::units::UnitExits;
use super::{Recipe, Status};
use crate::code::registers::Registers;
use crate::engine::plan::{Plan, Step};
use forms::{
    BusRoom, ControlRoom, IntegerRoom, LocalRoom, PacketRoom, RayRoom, ScalarRoom, VectorRoom, WalkRoom, WideRoom,
};

/// A scalar register, by its number.
#[derive(Clone, Copy)]
struct S(u8);

/// A vector register, or the first one of a group.
#[derive(Clone, Copy)]
struct V(u8);

/// A wide accumulator, or the first one of a group.
#[derive(Clone, Copy)]
struct W(u8);

/// Form of a row in generated code.
enum Form<R> {
    /// Instructions that make these values, to be written as the row says.
    Made(R),
    /// A call of the row's meaning.
    Call,
    /// Instructions that do everything, counting and leading on included.
    Left,
}

/// The code behind a row is reached from it.
enum Continuation {
    Goes,
    Left,
}

/// Everything that is known before code is generated.
pub(super) struct LowerSource<'a> {
    pub plan: &'a Plan<'a>,
    /// The plan's steps where they will be as long as the code.
    pub steps: &'a [Step],
    /// Additions of exits to the sums, where that will be as long as the code.
    pub extras: &'a [u64],
    pub recipe: &'a Recipe,
    pub layout: CounterLayout,
    pub blocks: &'a Blocks,
    /// Numbers of the reads, by place.
    pub sites: &'a [u32],
    /// The exits that may have units.
    pub unit_exits: &'a UnitExits,
    /// Functions and regions, where they are measured; its tables live as long as the code.
    pub profiling: Option<&'a Profiling>,
}

/// A function on its way.
struct Lower<'a, 'b> {
    b: FunctionBuilder<'b>,
    source: &'a LowerSource<'a>,
    /// The block that begins at each place at which one does.
    entries: Vec<Option<Block>>,
    context: Value,
    registers: Value,
    sums: Variable,
    /// Counters of the current calling context, where functions are measured.
    node: Option<Variable>,
    scalars: Vec<Option<Value>>,
    vectors: Vec<Option<Value>>,
    wides: Vec<Option<Value>>,
    /// The place whose row is on its way.
    place: u32,
    call: SigRef,
}

/// Accesses that cannot fail, at whatever alignment.
fn flags() -> MemFlagsData {
    MemFlagsData::new().with_notrap()
}

/// Flags for accesses to registers, which are aligned.
fn aligned() -> MemFlagsData {
    MemFlagsData::trusted()
}

/// Signature of generated code: context, registers and the place at which to begin; it yields a [`Status`].
fn entry_signature(isa: &dyn TargetIsa) -> Signature {
    let mut signature = Signature::new(isa.default_call_conv());
    signature.params.extend([AbiParam::new(I64), AbiParam::new(I64), AbiParam::new(I32)]);
    signature.returns.push(AbiParam::new(I32));
    signature
}

/// Signature of [`super::calls::RowCall`].
fn call_signature(isa: &dyn TargetIsa) -> Signature {
    let mut signature = Signature::new(isa.default_call_conv());
    signature.params.extend([AbiParam::new(I64); 3]);
    signature.returns.push(AbiParam::new(I64));
    signature
}

/// The function of a program.
pub(super) fn function(isa: &dyn TargetIsa, source: &LowerSource) -> Function {
    let mut function = Function::new();
    function.signature = entry_signature(isa);
    let mut context = FunctionBuilderContext::new();
    let mut b = FunctionBuilder::new(&mut function, &mut context);
    let call = b.import_signature(call_signature(isa));
    let entry = b.create_block();
    b.append_block_params_for_function_params(entry);
    b.switch_to_block(entry);
    let [context, registers, place] = *b.block_params(entry) else { unreachable!("it has three parameters") };
    let sums = b.declare_var(I64);
    let first = b.ins().load(I64, aligned(), context, SUMS);
    b.def_var(sums, first);
    let node = source.profiling.is_some().then(|| b.declare_var(I64));
    if let Some(node) = node {
        let current = profile::current_node(&mut b, context, source.layout);
        b.def_var(node, current);
    }
    let is_join = &source.blocks.is_join;
    let entries: Vec<Option<Block>> = is_join.iter().map(|&is_join| is_join.then(|| b.create_block())).collect();

    // Any join can be entered; what else is asked for is the interpreter's.
    let mut switch = Switch::new();
    for (place, block) in entries.iter().enumerate() {
        block.iter().for_each(|&block| switch.set_entry(place as u128, block));
    }
    let stray = b.create_block();
    b.set_cold_block(stray);
    switch.emit(&mut b, place, stray);
    b.switch_to_block(stray);
    let status = b.ins().iconst(I32, Status::Bailout as i64);
    b.ins().return_(&[status]);

    let none = || vec![None; 1 << 8];
    let (scalars, vectors, wides) = (none(), none(), none());
    let mut lower =
        Lower { b, source, entries, context, registers, sums, node, scalars, vectors, wides, place: 0, call };
    for place in (0..).take(source.blocks.is_join.len()) {
        lower.block(place);
    }
    lower.b.seal_all_blocks();
    lower.b.finalize(isa.frontend_config());
    function
}

impl Lower<'_, '_> {
    /// The block that begins at a place, if one does, up to where control has gone elsewhere on all ways.
    fn block(&mut self, start: u32) {
        let Some(block) = self.entries[start as usize] else { return };
        let end = self.source.plan.end();
        self.b.switch_to_block(block);
        self.forget();
        if start == end {
            return self.leave(Status::Bailout, end, 0);
        }
        self.spend(start);
        let mut place = start;
        loop {
            self.place = place;
            self.b.set_srcloc(SourceLoc::new(place));
            if let Continuation::Left = self.step() {
                return;
            }
            place += 1;
            if place == end || self.entries[place as usize].is_some() {
                return self.go(place - 1, place);
            }
            if self.source.plan.is_run_end(place - 1) {
                self.spend(place);
            }
        }
    }

    /// Step at the current place.
    fn step(&mut self) -> Continuation {
        let place = self.place;
        let step = &self.source.steps[place as usize];
        match step.row {
            Step::HOP => {
                self.take_exit(step.exit as usize);
                self.go(place, step.target);
                Continuation::Left
            }
            // A division by zero is known only when the registers are written, which the interpreter takes back.
            Step::UNIT if !self.source.recipe.computes.traps_division_by_zero => self.unit(step),
            Step::UNIT | Step::BAILOUT => {
                self.leave(Status::Bailout, place, self.rest());
                Continuation::Left
            }
            _ => match self.source.plan.slots()[step.slot as usize].op {
                Some(op) => self.row(op, step),
                None => {
                    self.leave(Status::Bailout, place, self.rest());
                    Continuation::Left
                }
            },
        }
    }

    /// A row of the table.
    fn row(&mut self, op: Op, step: &Step) -> Continuation {
        let fields = &step.fields;
        let plan = self.source.plan;
        let is_control = plan.code.slot_row(step.slot).is_some_and(|row| row.room == "control");
        if is_control {
            self.follow();
        }
        /// An operand as its form gets it.
        macro_rules! operand {
            ($letter:ident S) => {
                S(fields.$letter)
            };
            ($letter:ident A) => {
                S(fields.$letter)
            };
            ($letter:ident V) => {
                V(fields.$letter)
            };
            ($letter:ident V2) => {
                V(fields.$letter)
            };
            ($letter:ident V3) => {
                V(fields.$letter)
            };
            ($letter:ident V5) => {
                V(fields.$letter)
            };
            ($letter:ident W) => {
                W(fields.$letter)
            };
            ($letter:ident W3) => {
                W(fields.$letter)
            };
            ($letter:ident $immediate:ident) => {
                fields.$letter
            };
        }
        /// Writes what a form made.
        macro_rules! put {
            ($letter:ident S) => {
                self.set_s(S(fields.$letter), $letter)
            };
            ($letter:ident V) => {
                self.set_v(V(fields.$letter), $letter)
            };
            ($letter:ident W) => {
                self.set_w(W(fields.$letter), $letter)
            };
            ($letter:ident W3) => {
                (0..).zip($letter).for_each(|(at, value)| self.set_w(W(fields.$letter + at), value))
            };
            ($letter:ident $vectors:ident) => {
                (0..).zip($letter).for_each(|(at, value)| self.set_v(V(fields.$letter + at), value))
            };
        }
        macro_rules! lower {
            ({ $style:ident $trait:ident $name:ident } [$(($letter:ident $kind:ident))*] [$(($written:ident $made:ident))*]) => {{
                let form = match is_of_values!($style) && self.source.recipe.computes.counts_losses {
                    // A meaning knows what its results lose.
                    true => Form::Call,
                    false => $trait::$name(self, $(operand!($letter $kind)),*),
                };
                match form {
                    Form::Made(($($written,)*)) => {
                        $(put!($written $made);)*
                    }
                    Form::Call => called!($style op, step),
                    Form::Left => return Continuation::Left,
                }
            }};
        }
        macro_rules! is_of_values {
            (pure) => {
                true
            };
            ($style:ident) => {
                false
            };
        }
        macro_rules! called {
            (pure $op:expr, $step:expr) => {
                self.call_meaning($op, $step)
            };
            (buffered $op:expr, $step:expr) => {
                self.call_in_buffer($op, $step)
            };
            (bus $op:expr, $step:expr) => {
                self.ask_machine($op, $step)
            };
            ($style:ident $op:expr, $step:expr) => {
                unreachable!("rows of the buffer and of control have forms")
            };
        }
        macro_rules! dispatch {
            ($($style:ident $room:ident $trait:ident $room_doc:literal {
                $($(#[doc = $doc:expr])* $name:ident ($($operands:tt)*) $drawn:literal [$($exits:tt)*];)*
            })*) => {
                match op {
                    $($(Op::$name => crate::semantics::split_operands! { lower { $style $trait $name } [] [] ($($operands)*) },)*)*
                    Op::Ext(_) => unreachable!("what has a body stands here as its steps, what has a meaning in Rust as a unit"),
                }
            };
        }
        isa::instructions!(dispatch);
        match is_control {
            // It ended a run without a branch, so that nothing else says that the next one was begun.
            true if !plan.falls_through(self.place) => self.begin(self.place, self.place + 1),
            true => {}
            false => self.follow(),
        }
        Continuation::Goes
    }

    /// Nothing is known of registers any more.
    fn forget(&mut self) {
        for known in [&mut self.scalars, &mut self.vectors, &mut self.wides] {
            known.fill(None);
        }
    }

    /// Nothing is known of the registers that a step writes.
    fn forget_written(&mut self, step: &Step) {
        let Some(row) = self.source.plan.code.slot_row(step.slot) else { return self.forget() };
        for operand in row.operands.iter().filter(|operand| operand.is_written()) {
            let first = step.fields.get(operand.letter) as u8;
            let known = match operand.kind {
                Kind::S | Kind::A => &mut self.scalars,
                Kind::W | Kind::W3 => &mut self.wides,
                _ => &mut self.vectors,
            };
            (0..operand.kind.registers()).for_each(|at| known[usize::from(first.wrapping_add(at))] = None);
        }
    }

    fn c32(&mut self, value: i32) -> Value {
        self.b.ins().iconst(I32, i64::from(value as u32))
    }

    fn c64(&mut self, value: i64) -> Value {
        self.b.ins().iconst(I64, value)
    }

    /// A vector with one number in all four components.
    fn splat(&mut self, value: i32) -> Value {
        let value = self.c32(value);
        self.b.ins().splat(I32X4, value)
    }

    fn s(&mut self, S(number): S) -> Value {
        if number == 0 {
            return self.c32(0);
        }
        if let Some(known) = self.scalars[usize::from(number)] {
            return known;
        }
        let value = self.b.ins().load(I32, aligned(), self.registers, Registers::scalar_offset(number));
        self.scalars[usize::from(number)] = Some(value);
        value
    }

    fn set_s(&mut self, S(number): S, value: Value) {
        if number == Registers::NOWHERE {
            return;
        }
        self.b.ins().store(aligned(), value, self.registers, Registers::scalar_offset(number));
        self.scalars[usize::from(number)] = Some(value);
    }

    /// A scalar as 64 bits.
    fn s64(&mut self, S(number): S) -> Value {
        match self.scalars[usize::from(number)] {
            _ if number == 0 => self.c64(0),
            Some(known) => self.b.ins().sextend(I64, known),
            None => self.b.ins().sload32(aligned(), self.registers, Registers::scalar_offset(number)),
        }
    }

    fn v(&mut self, V(number): V) -> Value {
        if let Some(known) = self.vectors[usize::from(number)] {
            return known;
        }
        let value = self.b.ins().load(I32X4, aligned(), self.registers, Registers::vector_offset(number));
        self.vectors[usize::from(number)] = Some(value);
        value
    }

    fn set_v(&mut self, V(number): V, value: Value) {
        self.b.ins().store(aligned(), value, self.registers, Registers::vector_offset(number));
        self.vectors[usize::from(number)] = Some(value);
    }

    fn w(&mut self, W(number): W) -> Value {
        if let Some(known) = self.wides[usize::from(number)] {
            return known;
        }
        let value = self.b.ins().load(I64, aligned(), self.registers, Registers::wide_offset(number));
        self.wides[usize::from(number)] = Some(value);
        value
    }

    fn set_w(&mut self, W(number): W, value: Value) {
        self.b.ins().store(aligned(), value, self.registers, Registers::wide_offset(number));
        self.wides[usize::from(number)] = Some(value);
    }

    /// A vector of three components; the fourth one is 0.
    fn vector(&mut self, [x, y, z]: [Value; 3]) -> Value {
        let vector = self.b.ins().scalar_to_vector(I32X4, x);
        let vector = self.b.ins().insertlane(vector, y, 1u8);
        self.b.ins().insertlane(vector, z, 2u8)
    }

    /// A block that is seldom reached.
    fn cold_block(&mut self) -> Block {
        let block = self.b.create_block();
        self.b.set_cold_block(block);
        block
    }
}
