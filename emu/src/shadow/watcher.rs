//! The shadow of one core: registers, buffer and messages, kept up with the machine's by the interpreter's observer.

use std::collections::VecDeque;
use std::sync::Arc;

use isa::naming::RegisterId;
use isa::number::Modes;
use isa::{Fields, Op};

use super::ledger::ShadowLedger;
use super::memory::ShadowMemory;
use super::number::{ShadowNumber, ShadowTerm};
use super::program::{CELLS, FILE, ShadowProgram, WordMark, cells, scalar_cell, vector_cell, wide_cell};
use super::rows::{
    BusRoom, ControlRoom, IntegerRoom, LocalRoom, PacketRoom, RayRoom, RealFormulas, RealResult, ScalarRoom,
    ShadowEffect, ShadowInput, VectorRoom, WalkRoom, WideRoom,
};
use super::settle::{ResultPlace, Settled, corrected, moved, settle};
use crate::code::octets::Buffer;
use crate::code::registers::Registers;
use crate::code::tally::Tally;
use crate::code::{Code, Slot};
use crate::profile::{Observer, Profile, ProfileLevel, UnitCount};
use crate::semantics::{Motion, split_operands};

/// Shadows of the components of a message's vector.
pub type MessageVector = [Option<ShadowNumber>; 3];

/// Shadows of a message, and what is known of the program that sent it.
#[derive(Clone, Debug)]
pub struct ShadowLetter {
    /// Shadows of the message's vectors.
    pub vectors: Vec<MessageVector>,
    /// The sender's program.
    pub program: Arc<ShadowProgram>,
}

/// A result that waits for the machine's.
#[derive(Clone, Debug)]
struct Expected {
    cell: usize,
    result: RealResult,
}

/// Decisions of an instruction on numbers with shadows.
#[derive(Clone, Debug, Default)]
struct NumberDecisions {
    all: u32,
    turned: u32,
    /// Sites whose errors turned comparisons.
    blamed: Vec<u32>,
}

/// The shadow of a core.
#[derive(Clone, Debug)]
pub struct Shadow {
    /// The program, with what is known about it.
    pub program: Arc<ShadowProgram>,
    cells: Vec<Option<ShadowNumber>>,
    /// Shadows of the local buffer.
    pub buffer: ShadowMemory,
    /// Shadows of global memory, which processors hand each other.
    pub global: ShadowMemory,
    /// Errors by line.
    pub ledger: ShadowLedger,
    /// Messages that wait for this core, in the order in which it takes them.
    pub inbox: VecDeque<Vec<MessageVector>>,
    /// Messages that have left, in their order, but for those to the core itself.
    pub outbox: Vec<Vec<MessageVector>>,
    /// Number of this core.
    core: u32,
    expected: Vec<Expected>,
    /// Results of the formulas that functions compute in many steps, which wait for their returns.
    computed: Vec<Vec<Expected>>,
    effect: ShadowEffect,
    decisions: NumberDecisions,
}

impl Shadow {
    /// The shadow of a core that begins.
    pub fn new(program: Arc<ShadowProgram>, core: u32) -> Shadow {
        let sites = program.sites.sites.len();
        Shadow {
            computed: vec![Vec::new(); program.computed.len()],
            program,
            cells: vec![None; CELLS],
            buffer: ShadowMemory::default(),
            global: ShadowMemory::default(),
            ledger: ShadowLedger::new(sites),
            inbox: VecDeque::new(),
            outbox: Vec::new(),
            core,
            expected: Vec::new(),
            effect: ShadowEffect::Nothing,
            decisions: NumberDecisions::default(),
        }
    }

    /// The core begins a work item: all is as after reset, and what it has learnt of the lines stays.
    pub fn begin(&mut self) {
        self.cells.fill(None);
        self.computed.iter_mut().for_each(Vec::clear);
        self.buffer.clear();
    }

    /// Shadows of a register: one, or three of a vector.
    pub fn of(&self, register: RegisterId) -> Vec<Option<&ShadowNumber>> {
        self.cells[cells(register)].iter().map(Option::as_ref).collect()
    }

    /// Numbers of a register that was written without a formula begin anew at the machine's.
    fn forget(&mut self, register: RegisterId) {
        self.cells[cells(register)].fill(None);
    }

    /// Registers were changed by hand: shadows of those that differ begin anew.
    pub fn forget_changed(&mut self, before: &Registers, after: &Registers) {
        for (cell, number) in self.cells.iter_mut().enumerate() {
            if raw_of(before, cell) != raw_of(after, cell) {
                *number = None;
            }
        }
    }

    /// Shadows of the first message that has left, with the program that sent it.
    pub fn into_letter(self) -> ShadowLetter {
        let vectors = match self.outbox.into_iter().next() {
            Some(vectors) => vectors,
            // The message was refused because its receiver is still to come.
            None => match self.effect {
                ShadowEffect::Send(_, vectors) => vectors,
                _ => Vec::new(),
            },
        };
        ShadowLetter { vectors, program: self.program }
    }

    /// Sees the operands of an instruction that is about to be executed.
    fn expect_results(&mut self, pc: u32, slot: &Slot, registers: &Registers, buffer: &Buffer) {
        for read in self.program.declared_reads(pc) {
            self.declare(read, registers);
        }
        if let WordMark::Reads(number) = self.program.mark(pc) {
            let formula = self.program.computed[usize::from(number)];
            let mut results = std::mem::take(&mut self.computed[usize::from(number)]);
            self.evaluate(Some(formula.op), &formula.fields, registers, buffer, &mut results);
            self.computed[usize::from(number)] = results;
        }
        let mut expected = std::mem::take(&mut self.expected);
        (self.decisions, self.effect) = self.evaluate(slot.op, &slot.fields, registers, buffer, &mut expected);
        self.expected = expected;
    }

    /// A cell is read where the program declares its format: from here on it holds a number of that.
    fn declare(&mut self, read: usize, registers: &Registers) {
        let read = self.program.declared_read(read);
        let (cell, declared) = (usize::from(read.cell), i32::from(read.scale));
        let number = self.cells[cell].get_or_insert_default();
        match number.scale {
            Some(scale) if scale == declared => number.fitted = None,
            None => number.scale = Some(declared),
            Some(_) => {
                let gap = corrected(number, raw_of(registers, cell), declared);
                if let Some((site, gap, brought)) = gap {
                    self.ledger.note_gap(site.wrapping_sub(self.program.first_site), gap, brought);
                }
            }
        }
    }

    /// Evaluates the exact formula of an instruction on the numbers of the registers.
    fn evaluate(
        &self,
        op: Option<Op>,
        fields: &Fields,
        registers: &Registers,
        buffer: &Buffer,
        expected: &mut Vec<Expected>,
    ) -> (NumberDecisions, ShadowEffect) {
        expected.clear();
        let mut formulas = RealFormulas {
            buffer,
            local: &self.buffer,
            global: &self.global,
            modes: self.program.modes,
            decisions: 0,
            turned: 0,
            blamed: Vec::new(),
            effect: ShadowEffect::Nothing,
            note_register: fields.y,
            message_register: fields.d,
        };
        let cells = &self.cells;
        let scalar = |number: u8| ShadowInput {
            raw: registers.scalar(number).into(),
            shadow: cells[scalar_cell(number)].as_ref(),
        };
        let vector = |number: u8| -> [ShadowInput; 3] {
            let raw = registers.vector(number);
            std::array::from_fn(|k| ShadowInput { raw: raw[k].into(), shadow: cells[vector_cell(number, k)].as_ref() })
        };
        let wide = |number: u8| ShadowInput { raw: registers.wide(number), shadow: cells[wide_cell(number)].as_ref() };

        /// Operand of a formula.
        macro_rules! operand {
            ($letter:ident S) => {
                scalar(fields.$letter)
            };
            ($letter:ident A) => {
                registers.scalar(fields.$letter) as u32
            };
            ($letter:ident V) => {
                vector(fields.$letter)
            };
            ($letter:ident W) => {
                wide(fields.$letter)
            };
            ($letter:ident V2) => {
                [vector(fields.$letter), vector(fields.$letter.wrapping_add(1))]
            };
            ($letter:ident V3) => {
                std::array::from_fn::<_, 3, _>(|at| vector(fields.$letter.wrapping_add(at as u8)))
            };
            ($letter:ident V5) => {
                std::array::from_fn::<_, 5, _>(|at| vector(fields.$letter.wrapping_add(at as u8)))
            };
            ($letter:ident W3) => {
                std::array::from_fn::<_, 3, _>(|at| wide(fields.$letter.wrapping_add(at as u8)))
            };
            ($letter:ident $immediate:ident) => {
                fields.$letter
            };
        }
        /// Notes what a formula says of a written operand.
        macro_rules! expect {
            ($letter:ident S) => {
                // What is written to `s0` is gone.
                if fields.$letter != 0 {
                    expected.push(Expected { cell: scalar_cell(fields.$letter), result: $letter });
                }
            };
            ($letter:ident W) => {
                expected.push(Expected { cell: wide_cell(fields.$letter), result: $letter });
            };
            ($letter:ident V) => {
                for (k, result) in $letter.into_iter().enumerate() {
                    expected.push(Expected { cell: vector_cell(fields.$letter, k), result });
                }
            };
            ($letter:ident W3) => {
                for (at, result) in $letter.into_iter().enumerate() {
                    expected.push(Expected { cell: wide_cell(fields.$letter.wrapping_add(at as u8)), result });
                }
            };
            // Groups of vectors.
            ($letter:ident $group:ident) => {
                for (at, vector) in $letter.into_iter().enumerate() {
                    for (k, result) in vector.into_iter().enumerate() {
                        let cell = vector_cell(fields.$letter.wrapping_add(at as u8), k);
                        expected.push(Expected { cell, result });
                    }
                }
            };
        }
        macro_rules! evaluate {
            ({ $trait:ident $name:ident } [$(($letter:ident $kind:ident))*] []) => {
                $trait::$name(&mut formulas $(, operand!($letter $kind))*)
            };
            ({ $trait:ident $name:ident } [$(($letter:ident $kind:ident))*] [$(($written:ident $to:ident))*]) => {{
                let ($($written,)*) = $trait::$name(&mut formulas $(, operand!($letter $kind))*);
                $(expect!($written $to);)*
            }};
        }
        macro_rules! dispatch {
            ($($style:ident $room:ident $trait:ident $room_doc:literal {
                $($(#[doc = $doc:expr])* $name:ident ($($operands:tt)*) $drawn:literal [$($exits:tt)*];)*
            })*) => {
                match op {
                    $($(Some(Op::$name) => {
                        split_operands! { evaluate { $trait $name } [] [] ($($operands)*) }
                    })*)*
                    // Semantics in Rust have no formula: what they write is the machine's own.
                    Some(Op::Ext(_)) | None => {}
                }
            };
        }
        isa::instructions!(dispatch);
        let decisions = NumberDecisions { all: formulas.decisions, turned: formulas.turned, blamed: formulas.blamed };
        (decisions, formulas.effect)
    }

    /// Sees the results of the instruction at `pc`, which belongs to a word.
    fn take_results(&mut self, pc: u32, word: u32, slot: &Slot, code: &Code, registers: &Registers) {
        let site = self.program.sites.of(word);
        let mut expected = std::mem::take(&mut self.expected);
        self.settle_all(&mut expected, site, pc, registers);
        self.expected = expected;
        if self.decisions.all != 0 {
            let NumberDecisions { all, turned, blamed } = std::mem::take(&mut self.decisions);
            self.ledger.decide(site, all, turned);
            blamed.into_iter().for_each(|site| self.ledger.blame(site.wrapping_sub(self.program.first_site)));
        }
        if let WordMark::Returns(number) = self.program.mark(pc) {
            let site = self.program.computed[usize::from(number)].site;
            let mut results = std::mem::take(&mut self.computed[usize::from(number)]);
            self.settle_all(&mut results, site, pc, registers);
            self.computed[usize::from(number)] = results;
        }
        if let Some(Op::Ext(_)) = slot.op {
            self.forget_written(slot, code);
        }
        match std::mem::take(&mut self.effect) {
            ShadowEffect::Nothing => {}
            effect => self.take_effect(effect, registers),
        }
    }

    /// Puts the machine's results beside the exact ones.
    fn settle_all(&mut self, expected: &mut Vec<Expected>, site: u32, pc: u32, registers: &Registers) {
        for Expected { cell, result } in expected.drain(..) {
            let declared = self.program.declared_behind(pc, cell);
            let mut settled = |term: ShadowTerm, is_fitted: bool| {
                let first = self.program.first_site;
                let place = ResultPlace { site: first + site, raw: raw_of(registers, cell), declared };
                let Settled { number, entry, elsewhere } = settle(term, is_fitted, place);
                self.ledger.note(site, &entry);
                if let Some((site, gap, brought)) = elsewhere {
                    self.ledger.note_gap(site.wrapping_sub(first), gap, brought);
                }
                Some(number)
            };
            self.cells[cell] = match result {
                // Where a number of a format is said to be, it is one from here on.
                RealResult::Integer => {
                    declared.map(|scale| ShadowNumber { scale: Some(scale), ..ShadowNumber::default() })
                }
                RealResult::Moved(number) => Some(moved(number, declared)),
                RealResult::Computed(term) => settled(term, false),
                RealResult::Fitted(term) => settled(term, true),
            };
        }
    }

    /// Results of an instruction in Rust begin anew.
    fn forget_written(&mut self, slot: &Slot, code: &Code) {
        let Some(op) = slot.op else { return };
        for operand in code.isa.definition(op).operands.iter().filter(|operand| b"dexy".contains(&operand.letter)) {
            let (Some(file), first) = (operand.kind.register_file(), slot.fields.get(operand.letter) as u8) else {
                continue;
            };
            (0..operand.kind.registers()).for_each(|at| self.forget((file, first.wrapping_add(at))));
        }
    }

    fn take_effect(&mut self, effect: ShadowEffect, registers: &Registers) {
        match effect {
            ShadowEffect::Nothing => {}
            ShadowEffect::Buffer(address, octets, numbers) => {
                for (at, number) in (0u32..).zip(numbers) {
                    self.buffer.put(address.wrapping_add(octets * at), octets, number);
                }
            }
            ShadowEffect::Global(address, numbers) => {
                for (at, number) in (0u32..).zip(numbers) {
                    self.global.put(address.wrapping_add(4 * at), 4, number);
                }
            }
            ShadowEffect::Forget(address, octets) => self.buffer.forget(address, octets),
            ShadowEffect::Load(to, from, octets) => self.buffer.copy(&self.global, to, from, octets),
            ShadowEffect::Store(to, from, octets) => self.global.copy(&self.buffer, to, from, octets),
            ShadowEffect::Add(address) => self.global.forget(address, 4),
            ShadowEffect::Send(to, message) if to == i64::from(self.core) => self.inbox.push_back(message),
            ShadowEffect::Send(_, message) => self.outbox.push(message),
            ShadowEffect::Receive(first) => {
                let message = self.inbox.pop_front().unwrap_or_default();
                for (at, vector) in (0u8..).zip(message) {
                    for (k, number) in vector.into_iter().enumerate() {
                        self.cells[vector_cell(first.wrapping_add(at), k)] = number;
                    }
                }
            }
            // The last note is as long as the others: 12 octets.
            ShadowEffect::Notes(from, register) => {
                let end = (registers.scalar(register) as u32).wrapping_add(12);
                self.buffer.forget(from, end.saturating_sub(from));
            }
        }
    }
}

impl Observer for Shadow {
    const IS_ACTIVE: bool = true;
    const SEES_VALUES: bool = true;

    fn new(code: &Code, _: ProfileLevel) -> Shadow {
        Shadow::new(Arc::new(ShadowProgram::new(code, Modes::default(), 0)), 0)
    }

    fn begin(&mut self, _: u32) {}

    #[inline]
    fn before(&mut self, pc: u32, slot: &Slot, registers: &Registers, buffer: &Buffer) {
        self.expect_results(pc, slot, registers, buffer);
    }

    #[inline]
    fn after(&mut self, pc: u32, code: &Code, registers: &Registers) {
        self.take_results(pc, code.word(pc), &code.slots()[pc as usize], code, registers);
    }

    fn step(&mut self, _: u32, _: usize, _: UnitCount, _: u32, _: Motion) {}

    fn end(&mut self) {}

    fn into_profile(self, _: &Code, _: &Tally) -> Option<Profile> {
        None
    }
}

/// The machine's number in a cell.
fn raw_of(registers: &Registers, cell: usize) -> i64 {
    let number = |cell: usize| cell as u8;
    match cell {
        cell if cell < FILE => registers.scalar(number(cell)).into(),
        cell if cell < 4 * FILE => {
            let at = cell - FILE;
            registers.vector(number(at / 3))[at % 3].into()
        }
        cell => registers.wide(number(cell - 4 * FILE)),
    }
}
