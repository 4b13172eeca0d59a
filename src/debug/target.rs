//! Target of a session: a program with its machine, its memory and how it begins.

use emu::machine::{Config, RunOptions};
use emu::octets::Memory;
use emu::registers::Registers;
use emu::shadow::ShadowLetter;
use emu::stepper::{Lone, Stepper};
use isa::{Isa, Program};
use messages::Report;

use crate::failure::Failure;
use crate::load::Load;
use crate::trace::instruction::TraceClocks;

/// A program on a lone core, before its first instruction.
pub struct DebugTarget {
    /// Name for messages: the file, or scene and pixel.
    pub name: String,
    /// The machine.
    pub config: Config,
    /// The rows of the program.
    pub isa: Isa,
    /// The program.
    pub program: Program,
    /// Registers at the start.
    pub registers: Registers,
    /// Global memory at the start.
    pub memory: Memory,
    /// Instructions that it may take.
    pub step_limit: u64,
    /// Clocks are those of a run, or left out for a work item.
    pub clocks: TraceClocks,
    /// The message that begins a work item.
    message: Option<emu::semantics::Message>,
    /// Numbers have shadows.
    pub has_shadow: bool,
    /// The main processor's program, and the shadows of the message that it sent.
    pub sender: Option<(Program, ShadowLetter)>,
}

impl DebugTarget {
    /// A program by itself.
    pub fn program(name: String, config: Config, isa: Isa, program: Program) -> DebugTarget {
        DebugTarget {
            name,
            step_limit: config.step_limit,
            config,
            isa,
            program,
            registers: Registers::default(),
            memory: Memory::new(Vec::new()),
            clocks: TraceClocks::Own,
            message: None,
            has_shadow: false,
            sender: None,
        }
    }

    /// The work item of a load that is one pixel.
    ///
    /// # Errors
    /// A main processor that hands out nothing.
    pub fn pixel(name: String, load: Load, config: Config) -> Result<DebugTarget, Failure> {
        let (message, memory, letter) = {
            let setup = load.setup(&config, RunOptions::default());
            let (lone, letter) = Lone::first_item_with_shadows(&setup, load.memory.clone())?;
            (lone.message, lone.memory, letter)
        };
        let step_limit = config.step_limit;
        Ok(DebugTarget {
            name,
            config,
            isa: load.isa,
            program: load.build.cores,
            registers: Registers::default(),
            memory,
            step_limit,
            clocks: TraceClocks::None,
            message,
            has_shadow: false,
            sender: Some((load.build.main, letter)),
        })
    }

    /// The core before its first instruction.
    ///
    /// # Errors
    /// A machine out of its ranges, or initial data that do not fit the buffer.
    pub fn stepper(&self) -> Result<Stepper<'_>, Report> {
        let stepper = Stepper::new(Lone {
            config: &self.config,
            isa: &self.isa,
            program: &self.program,
            registers: self.registers.clone(),
            memory: self.memory.clone(),
            message: self.message,
            step_limit: self.step_limit,
        })?;
        let letter = self.sender.as_ref().map(|(_, letter)| letter);
        Ok(if self.has_shadow { stepper.with_shadow(letter) } else { stepper })
    }
}
