//! State of one core as its program sees it, who the core is, and why an engine pauses.

use crate::code::Code;
use crate::code::octets::Buffer;
use crate::code::registers::Registers;
use crate::code::trap::Fault;
use crate::extension::Units;

/// Everything about one core that its program can see or change by itself, and how far it has come.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct State {
    /// Registers of the core.
    pub registers: Registers,
    /// Local buffer of the core.
    pub buffer: Buffer,
    /// Slot of the next instruction: its word, or a step of a body behind the words.
    pub pc: u32,
    /// Instructions executed since the last [`State::begin`].
    pub steps: u64,
    /// Steps of bodies beside those instructions.
    pub inner_steps: u64,
    /// Clocks of those instructions, transfers and waiting left out.
    pub clocks: u64,
    /// Elementary operations of those instructions.
    pub elementary: u64,
    /// Units that execute instructions with a meaning in Rust.
    pub(crate) units: Units,
}

impl State {
    /// A core after reset, about to execute the program's first instruction.
    pub fn new(code: &Code, buffer: Buffer) -> State {
        let pc = code.program.entry;
        let registers = Registers::default();
        let units = Units::new(code.isa);
        State { registers, buffer, pc, steps: 0, inner_steps: 0, clocks: 0, elementary: 0, units }
    }

    /// Reset of the same core.
    pub fn begin(&mut self, code: &Code, initial: &Buffer) {
        self.registers.reset();
        self.buffer.reset_to(initial);
        self.units.begin(code.isa);
        self.pc = code.program.entry;
        (self.steps, self.inner_steps, self.clocks, self.elementary) = (0, 0, 0, 0);
    }
}

/// Number of a core among all, and how long it may run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CoreId {
    /// Number of the core.
    pub core: u32,
    /// Number of cores, the main processor not counted.
    pub cores: u32,
    /// Instructions that a work item may take; steps of bodies count as such here, so that none goes on for ever.
    pub step_limit: u64,
}

/// Reason for which an engine stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pause {
    /// The program executed `halt`.
    Halt,
    /// The instruction at the program counter waits for the machine; running again tries it again.
    Wait,
    /// The instruction at the program counter went wrong; nothing of it happened.
    Fault(Fault),
}
