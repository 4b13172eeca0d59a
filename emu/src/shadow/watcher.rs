//! The shadow of one core: registers, buffer and messages, kept up with the machine's by the interpreter's observer.

use std::collections::VecDeque;
use std::ops::Range;
use std::sync::Arc;

use isa::naming::RegisterId;
use isa::number::Modes;
use isa::{Op, Program};

use super::ledger::{ShadowLedger, ShadowSites};
use super::memory::ShadowMemory;
use super::number::{ShadowNumber, ShadowTerm};
use super::rows::{
    BusRoom, ControlRoom, IntegerRoom, LocalRoom, PacketRoom, RayRoom, RealFormulas, RealResult, ScalarRoom,
    ShadowEffect, ShadowInput, VectorRoom, WalkRoom, WideRoom,
};
use super::settle::{ResultPlace, moved, settle};
use crate::code::octets::Buffer;
use crate::code::registers::Registers;
use crate::code::tally::Tally;
use crate::code::{Code, Slot};
use crate::profile::{Observer, Profile, ProfileLevel, UnitCount};
use crate::semantics::{Motion, split_operands};

/// Registers of a file, hidden ones of extensions' bodies among them.
const FILE: usize = 64;

/// Scalars, then the components of vectors, then wide accumulators.
const CELLS: usize = FILE + 3 * FILE + FILE;

/// Shadows of the components of a message's vector.
pub type MessageVector = [Option<ShadowNumber>; 3];

/// Everything about a program that its shadows need and that does not change.
#[derive(Clone, Debug)]
pub struct ShadowProgram {
    /// The sites of its errors.
    pub sites: ShadowSites,
    /// Number of the first site among those of all programs of a run.
    pub first_site: u32,
    /// Declared fraction bits of the two registers that a word writes, behind it.
    declared: Vec<[Option<i8>; 2]>,
    modes: Modes,
}

impl ShadowProgram {
    /// A decoded program on a machine of such words. Its sites are numbered from `first_site` on.
    pub fn new(code: &Code, modes: Modes, first_site: u32) -> ShadowProgram {
        let program = code.program;
        let declared = (0..code.words()).map(|word| {
            let mut formats = [None; 2];
            // What an instruction with a body writes is written by the steps of that.
            let row = code.row(word).filter(|_| code.slots()[word as usize].op == code.op(word));
            let written =
                row.iter().flat_map(|row| row.operands.iter()).filter(|operand| b"dexy".contains(&operand.letter));
            for (format, operand) in formats.iter_mut().zip(written) {
                let number = code.slots()[word as usize].fields.get(operand.letter) as u8;
                let register = operand.kind.register_file().map(|file| (file, number));
                *format = register.and_then(|register| declared_behind(program, register, word));
            }
            formats
        });
        ShadowProgram { sites: ShadowSites::new(program), first_site, declared: declared.collect(), modes }
    }
}

/// Fraction bits of what a register holds behind a word, as far as the program says.
fn declared_behind(program: &Program, register: RegisterId, word: u32) -> Option<i8> {
    // What stands behind the last word of a function says nothing about it.
    let (next, here) = (word + 1, program.function(word));
    let next = if program.function(next) == here && (next as usize) < program.words.len() { next } else { word };
    // Shifts speak of the bits of the arithmetic, whatever units people are shown.
    let (name, _) = program.format_of(register, next)?;
    program.formats.get(name).map(|bits| *bits as i8)
}

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
    declared: Option<i32>,
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
    effect: ShadowEffect,
    decisions: (u32, u32),
}

/// Place of a scalar among the cells.
fn scalar_cell(number: u8) -> usize {
    usize::from(number) % FILE
}

/// Place of a vector's component.
fn vector_cell(number: u8, component: usize) -> usize {
    FILE + 3 * (usize::from(number) % FILE) + component
}

/// Place of a wide accumulator.
fn wide_cell(number: u8) -> usize {
    4 * FILE + usize::from(number) % FILE
}

/// Places of a register: one, or three of a vector.
fn cells_of((file, number): RegisterId) -> Range<usize> {
    let (first, count) = match file {
        's' => (scalar_cell(number), 1),
        'v' => (vector_cell(number, 0), 3),
        _ => (wide_cell(number), 1),
    };
    first..first + count
}

impl Shadow {
    /// The shadow of a core that begins.
    pub fn new(program: Arc<ShadowProgram>, core: u32) -> Shadow {
        let sites = program.sites.sites.len();
        Shadow {
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
            decisions: (0, 0),
        }
    }

    /// The core begins a work item: all is as after reset, and what it has learnt of the lines stays.
    pub fn begin(&mut self) {
        self.cells.fill(None);
        self.buffer.clear();
    }

    /// Shadows of a register: one, or three of a vector.
    pub fn of(&self, register: RegisterId) -> Vec<Option<&ShadowNumber>> {
        self.cells[cells_of(register)].iter().map(Option::as_ref).collect()
    }

    /// Numbers of a register that was written without a formula begin anew at the machine's.
    fn forget(&mut self, register: RegisterId) {
        self.cells[cells_of(register)].fill(None);
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
        let fields = &slot.fields;
        let mut expected = std::mem::take(&mut self.expected);
        expected.clear();
        let declared = self.program.declared.get(pc as usize).copied().unwrap_or_default();
        let mut formulas = RealFormulas {
            buffer,
            local: &self.buffer,
            global: &self.global,
            modes: self.program.modes,
            decisions: 0,
            turned: 0,
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
        let mut place = 0;
        /// Notes what a formula says of a written operand.
        macro_rules! expect {
            ($letter:ident S) => {
                let declared = declared.get(place).copied().flatten().map(i32::from);
                place += 1;
                // What is written to `s0` is gone.
                if fields.$letter != 0 {
                    expected.push(Expected { cell: scalar_cell(fields.$letter), result: $letter, declared });
                }
            };
            ($letter:ident W) => {
                let declared = declared.get(place).copied().flatten().map(i32::from);
                place += 1;
                expected.push(Expected { cell: wide_cell(fields.$letter), result: $letter, declared });
            };
            ($letter:ident V) => {
                let declared = declared.get(place).copied().flatten().map(i32::from);
                place += 1;
                for (k, result) in $letter.into_iter().enumerate() {
                    expected.push(Expected { cell: vector_cell(fields.$letter, k), result, declared });
                }
            };
            ($letter:ident W3) => {
                place += 1;
                for (at, result) in $letter.into_iter().enumerate() {
                    let cell = wide_cell(fields.$letter.wrapping_add(at as u8));
                    expected.push(Expected { cell, result, declared: None });
                }
            };
            // Groups of vectors.
            ($letter:ident $group:ident) => {
                place += 1;
                for (at, vector) in $letter.into_iter().enumerate() {
                    for (k, result) in vector.into_iter().enumerate() {
                        let cell = vector_cell(fields.$letter.wrapping_add(at as u8), k);
                        expected.push(Expected { cell, result, declared: None });
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
                match slot.op {
                    $($(Some(Op::$name) => {
                        split_operands! { evaluate { $trait $name } [] [] ($($operands)*) }
                    })*)*
                    // Semantics in Rust have no formula: what they write is the machine's own.
                    Some(Op::Ext(_)) | None => {}
                }
            };
        }
        isa::instructions!(dispatch);
        let _ = place;
        self.decisions = (formulas.decisions, formulas.turned);
        self.effect = formulas.effect;
        self.expected = expected;
    }

    /// Sees the results of the instruction. `site` is that of its word.
    fn take_results(&mut self, word: u32, slot: &Slot, code: &Code, registers: &Registers) {
        let site = self.program.sites.of(word);
        let mut expected = std::mem::take(&mut self.expected);
        for Expected { cell, result, declared } in expected.drain(..) {
            let mut settled = |term: ShadowTerm, is_fitted: bool| {
                let place =
                    ResultPlace { site: self.program.first_site + site, raw: raw_of(registers, cell), declared };
                let (number, result) = settle(term, is_fitted, place);
                self.ledger.note(site, &result);
                Some(number)
            };
            self.cells[cell] = match result {
                // Where a number of a format is said to be, it is one from here on.
                RealResult::Integer => declared.map(|scale| ShadowNumber { deviation: None, scale: Some(scale) }),
                RealResult::Moved(number) => Some(moved(number, declared)),
                RealResult::Computed(term) => settled(term, false),
                RealResult::Fitted(term) => settled(term, true),
            };
        }
        self.expected = expected;
        if self.decisions.0 != 0 {
            self.ledger.decide(site, self.decisions.0, self.decisions.1);
            self.decisions = (0, 0);
        }
        if let Some(Op::Ext(_)) = slot.op {
            self.forget_written(slot, code);
        }
        match std::mem::take(&mut self.effect) {
            ShadowEffect::Nothing => {}
            effect => self.take_effect(effect, registers),
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
        self.take_results(code.word(pc), &code.slots()[pc as usize], code, registers);
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
