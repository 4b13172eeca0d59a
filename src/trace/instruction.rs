//! A trace of instructions: a record each, with what it read and wrote, raw and real, as a line of text or of JSON.

use std::fmt::Write;

use emu::code::Code;
use emu::stepper::{Executed, Stepper};
use isa::naming::RegisterId;
use isa::{Instruction, Program};
use schemars::JsonSchema;
use serde::Serialize;

use crate::registers::{RegisterContents, ShownRegister};

/// Version of [`TracedInstruction`].
pub const SCHEMA: &str = "lancer-instruction-1";

/// One executed instruction, or at the end of a trace the one that went wrong.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct TracedInstruction {
    /// Version of the record: a key that goes away or changes its meaning changes it, a new key does not.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: &'static str,
    /// Instructions executed before it.
    pub step: u64,
    /// Clocks before it, transfers included; null for a work item, whose clocks depend on the rest of the machine.
    pub clock: Option<u64>,
    /// Number of the core.
    pub core: u32,
    /// Word of the instruction, counted from 0.
    pub pc: u32,
    /// Function around it.
    pub function: Option<String>,
    /// `file:line` of its source.
    pub line: Option<String>,
    /// The instruction as assembly text.
    pub text: String,
    /// Registers that it read, with what they held.
    pub reads: Vec<ShownRegister>,
    /// Registers that it wrote, with what they hold now.
    pub writes: Vec<ShownRegister>,
    /// Exit by which it ended; null for the one that went wrong.
    pub exit: Option<String>,
    /// Transfer that it asked the bus for.
    pub transfer: Option<TracedTransfer>,
    /// Results that lost bits below the last place.
    pub quantized: u64,
    /// Results that did not fit.
    pub overflowed: u64,
    /// Fault of the one that went wrong: nothing of it happened, unless it has an exit.
    pub fault: Option<String>,
}

/// A transfer of an instruction.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct TracedTransfer {
    /// First octet in global memory; of a message the number of the other processor.
    pub address: u32,
    /// Octets that go over the bus.
    pub octets: u32,
    /// `load`, `store`, `read`, `write`, `add`, `send` or `receive`.
    pub kind: &'static str,
}

/// Choice of whether a trace has clocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TraceClocks {
    /// A program by itself: its clocks are those of `lancer run`.
    Own,
    /// A work item, whose clocks depend on the rest of the machine.
    None,
}

/// The registers of the operands that are read, or written, without `s0`.
pub fn registers(code: &Code, pc: u32, is_written: bool) -> Vec<RegisterId> {
    let Some(instruction) = instruction(code, pc) else { return Vec::new() };
    let mut found = Vec::new();
    for operand in code.isa.definition(instruction.op).operands.iter() {
        let Some(file) = operand.kind.register_file() else { continue };
        if if is_written { operand.is_written() } else { operand.is_read() } {
            let first = instruction.fields.get(operand.letter) as u8;
            found.extend((first..first + operand.kind.registers()).map(|number| (file, number)));
        }
    }
    found.retain(|register| *register != ('s', 0));
    found.dedup();
    found
}

/// The instruction of a word of the program as it is written, extensions included.
pub fn instruction(code: &Code, pc: u32) -> Option<Instruction> {
    code.isa.decode(*code.program.words.get(pc as usize)?)
}

/// The instruction at a word as text, with the names of functions where it leads.
pub fn text(code: &Code, pc: u32) -> String {
    let program = code.program;
    let target = |distance: i32| {
        let to = i64::from(pc) + i64::from(distance);
        let named = u32::try_from(to).ok().and_then(|to| function_at(program, to));
        named.map_or_else(|| format!(".{distance:+}"), str::to_owned)
    };
    match instruction(code, pc) {
        Some(instruction) => instruction.text(code.isa, target),
        None => program.words.get(pc as usize).map_or_else(String::new, |word| format!(".word {word:#010x}")),
    }
}

/// The function that begins at a word.
fn function_at(program: &Program, pc: u32) -> Option<&str> {
    let name = program.function(pc)?;
    (program.symbols.get(name) == Some(&i64::from(pc))).then_some(name)
}

/// Takes the next instruction and records it; `None` when the program has ended. One that goes wrong is recorded with its fault.
pub fn next(stepper: &mut Stepper, clocks: TraceClocks) -> Option<TracedInstruction> {
    if stepper.end().is_some() {
        return None;
    }
    let program = stepper.code.program;
    let pc = stepper.code.word(stepper.state().pc);
    let (step, clock) = (stepper.steps(), stepper.clock().0);
    // Registers are read before the step, which may write the same ones.
    let before = &stepper.state().registers;
    let reads: Vec<ShownRegister> = registers(&stepper.code, pc, false)
        .into_iter()
        .map(|register| ShownRegister::at(program, before, register, pc))
        .collect();
    let executed = stepper.step();
    let mut record = TracedInstruction {
        schema: SCHEMA,
        step,
        clock: (clocks == TraceClocks::Own).then_some(clock),
        core: 0,
        pc,
        function: program.function(pc).map(str::to_owned),
        line: program.place(pc),
        text: text(&stepper.code, pc),
        reads,
        writes: Vec::new(),
        exit: None,
        transfer: None,
        quantized: 0,
        overflowed: 0,
        fault: None,
    };
    // What trapped before its end wrote nothing.
    match executed {
        Some(executed) => record.finish(stepper, executed),
        None => record.fault = stepper.trap().map(|trap| trap.kind.to_string()),
    }
    Some(record)
}

impl TracedInstruction {
    fn finish(&mut self, stepper: &Stepper, executed: Executed) {
        let (code, after) = (&stepper.code, &stepper.state().registers);
        let shown = |register: RegisterId| {
            // What is written has the format and the name that the text says behind the instruction.
            let raw = RegisterContents::of(after, register);
            let format = code.program.format_of(register, self.pc + 1);
            ShownRegister::new(register, raw, code.program.name_of(register, self.pc), format)
        };
        self.writes = registers(code, self.pc, true).into_iter().map(shown).collect();
        self.exit = code.row(self.pc).and_then(|row| Some(row.outcomes.get(executed.exit as usize)?.name.to_string()));
        let transfer = executed.transfer;
        self.transfer = transfer.map(|transfer| TracedTransfer {
            address: transfer.address,
            octets: transfer.octets,
            kind: transfer.kind.name(),
        });
        (self.quantized, self.overflowed) = (executed.losses.quantized, executed.losses.overflowed);
        self.fault = stepper.trap().map(|trap| trap.kind.to_string());
    }

    /// The record as a line of text, without its end.
    pub fn line(&self) -> String {
        let clock = self.clock.map_or_else(|| "-".to_owned(), |clock| clock.to_string());
        // Columns are as wide as those of the head
        let mut text = format!(
            "{:>8} {clock:>9} {:>2} {:#06x} {:<14} {:<32} {:<32}",
            self.step,
            self.core,
            self.pc,
            self.function.as_deref().unwrap_or("-"),
            self.line.as_deref().unwrap_or("-"),
            self.text
        );
        // Add what not every instruction has, behind marks
        let list = |shown: &[ShownRegister]| shown.iter().map(ShownRegister::short).collect::<Vec<_>>().join(" ");
        for (mark, part) in [("", list(&self.reads)), ("-> ", list(&self.writes))] {
            if !part.is_empty() {
                let _ = write!(text, " {mark}{part}");
            }
        }
        if let Some(exit) = &self.exit {
            let _ = write!(text, " | {exit}");
        }
        if let Some(TracedTransfer { address, octets, kind }) = &self.transfer {
            let _ = write!(text, " | {kind} {address:#x} {octets}");
        }
        for (count, what) in [(self.quantized, "quantized"), (self.overflowed, "overflowed")] {
            if count != 0 {
                let _ = write!(text, " | {count} {what}");
            }
        }
        if let Some(fault) = &self.fault {
            let _ = write!(text, " | {fault}");
        }
        text
    }

    /// The record as a line of JSON, without its end.
    pub fn json(&self) -> String {
        serde_json::to_string(self).expect("records are plain data")
    }
}

/// The head of a trace as text, without its end.
pub fn head() -> String {
    format!(
        "{:>8} {:>9} {:>2} {:<6} {:<14} {:<32} {:<32} reads -> writes | exit | transfer",
        "step", "clock", "co", "pc", "function", "line", "text"
    )
}
