//! A program on a lone core, instruction by instruction, on the interpreter: for traces and debuggers. The machine answers at once, so the
//! state after n instructions is a function of the settings and of n. What is done with the states is not said here.

mod link;
mod witness;

use std::sync::Arc;

use isa::{Counts, Isa, Program};
use messages::{Diagnostic, Report};

pub use link::{Transfer, TransferKind};
pub use witness::OpenCall;

use crate::code::octets::{Buffer, Memory};
use crate::code::quantity::Clocks;
use crate::code::registers::Registers;
use crate::code::tally::{Losses, Tally};
use crate::code::trap::{Fault, Trap};
use crate::code::{Code, check_bodies};
use crate::engine::{CoreId, Pause, State, interpreter};
use crate::machine::{Config, Setup, check_buffer};
use crate::profile::Observer;
use crate::semantics::{Message, Watching};
use crate::shadow::{Shadow, ShadowLetter, ShadowProgram, ShadowSites};
use link::{FirstMessage, LoneLink, TimedLone};
use witness::{ShadowWitness, Witness};

/// Program, machine and beginning of a lone core.
pub struct Lone<'a> {
    /// The machine.
    pub config: &'a Config,
    /// The rows of the program.
    pub isa: &'a Isa,
    /// The program.
    pub program: &'a Program,
    /// Registers at the start.
    pub registers: Registers,
    /// Global memory at the start.
    pub memory: Memory,
    /// Message that begins a work item; `None` for a program by itself, which is core 0 of 1.
    pub message: Option<Message>,
    /// Instructions that it may take.
    pub step_limit: u64,
}

impl<'a> Lone<'a> {
    /// The first work item that a machine's main processor hands out: of a load that is one pixel, that pixel.
    ///
    /// # Errors
    /// A machine out of its ranges, and a main processor that hands out nothing.
    pub fn first_item(setup: &Setup<'a>, memory: Memory) -> Result<Lone<'a>, Report> {
        Lone::first_item_by(setup, memory, &mut crate::profile::Unobserved)
    }

    /// The first work item, and the shadows of the message that begins it.
    ///
    /// # Errors
    /// As [`Lone::first_item`].
    pub fn first_item_with_shadows(setup: &Setup<'a>, memory: Memory) -> Result<(Lone<'a>, ShadowLetter), Report> {
        let config = setup.config;
        let code = Code::new(setup.main, setup.isa, config.timing());
        let sites = ShadowSites::new(setup.core).sites.len() as u32;
        let program = Arc::new(ShadowProgram::new(&code, config.arithmetic.modes(), sites));
        let mut shadow = Shadow::new(program.clone(), config.cores);
        let lone = Lone::first_item_by(setup, memory, &mut shadow)?;
        Ok((lone, shadow.into_letter()))
    }

    fn first_item_by<O: Observer>(setup: &Setup<'a>, memory: Memory, observer: &mut O) -> Result<Lone<'a>, Report> {
        let config = setup.config;
        config.check()?;
        check_buffer("the main processor", setup.main, config.main.buffer_octets)?;
        let code = Code::new(setup.main, setup.isa, config.timing());
        let mut state = State::new(&code, Buffer::new(&setup.main.buffer, config.main.buffer_octets));
        let mut memory = memory;
        let mut link = FirstMessage { memory: &mut memory, main: config.cores, message: None };
        let id = CoreId { core: config.cores, cores: config.cores, step_limit: config.main.step_limit };
        let (arithmetic, mut tally) = (arithmetic(config), Tally::new(&code));
        let pause = interpreter::run(&code, id, &mut state, &arithmetic, &mut link, &mut tally, observer);
        let Some(message) = link.message else {
            return Err(match pause {
                Pause::Fault(fault) => Trap::new(fault, config.cores, state.pc, &code).diagnostic().into(),
                _ => Diagnostic::error("the main processor hands out no work").into(),
            });
        };
        let registers = Registers::default();
        let (isa, program, step_limit) = (setup.isa, setup.core, config.step_limit);
        Ok(Lone { config, isa, program, registers, memory, message: Some(message), step_limit })
    }
}

fn arithmetic(config: &Config) -> Watching {
    let arithmetic = &config.arithmetic;
    Watching::new(arithmetic.modes(), arithmetic.trap_division_by_zero).with_losses()
}

/// End of a lone core's program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoneEnd {
    /// `halt`, which counts as executed.
    Halt,
    /// The instruction at the program counter went wrong, and nothing of it happened.
    Fault(Fault),
}

/// Everything that the core's past has made of it.
#[derive(Clone, Debug)]
pub struct Checkpoint {
    state: State,
    link: LoneLink,
    witness: Witness,
    shadow: Option<Box<Shadow>>,
    end: Option<LoneEnd>,
}

impl Checkpoint {
    /// Instructions executed before it.
    pub fn steps(&self) -> u64 {
        self.state.steps
    }
}

/// One executed instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Executed {
    /// Instructions executed before it.
    pub step: u64,
    /// Word of the instruction.
    pub pc: u32,
    /// Clocks before it, transfers included.
    pub clock: Clocks,
    /// Number of its exit among those of its row.
    pub exit: u8,
    /// Units of its cost for each.
    pub units: u32,
    /// Transfer that it asked for.
    pub transfer: Option<Transfer>,
    /// Losses of its results.
    pub losses: Losses,
}

/// A lone core on its way.
pub struct Stepper<'a> {
    /// The program, decoded.
    pub code: Code<'a>,
    config: &'a Config,
    arithmetic: Watching,
    id: CoreId,
    state: State,
    link: LoneLink,
    tally: Tally,
    witness: Witness,
    shadow: Option<Box<Shadow>>,
    end: Option<LoneEnd>,
}

impl<'a> Stepper<'a> {
    /// A core before its first instruction.
    ///
    /// # Errors
    /// A machine out of its ranges, or initial data that do not fit the buffer.
    pub fn new(lone: Lone<'a>) -> Result<Stepper<'a>, Report> {
        let Lone { config, isa, program, registers, memory, message, step_limit } = lone;
        config.check()?;
        check_buffer("a core", program, config.buffer_octets)?;
        check_bodies(program, isa).map_err(Diagnostic::from)?;
        let code = Code::new(program, isa, config.timing());
        // A program by itself is the only processor; a work item has the main processor behind the cores.
        let (cores, largest) = if message.is_some() { (config.cores, config.cores) } else { (1, 0) };
        let mut state = State::new(&code, Buffer::new(&program.buffer, config.buffer_octets));
        state.registers = registers;
        Ok(Stepper {
            tally: Tally::new(&code),
            code,
            config,
            arithmetic: arithmetic(config),
            id: CoreId { core: 0, cores, step_limit },
            state,
            link: LoneLink::new(memory, 0, largest, message),
            witness: Witness::default(),
            shadow: None,
            end: None,
        })
    }

    /// Gives a core before its first instruction a shadow, with those of the message that waits for it.
    #[must_use]
    pub fn with_shadow(mut self, letter: Option<&ShadowLetter>) -> Stepper<'a> {
        let program = Arc::new(ShadowProgram::new(&self.code, self.config.arithmetic.modes(), 0));
        let mut shadow = Shadow::new(program, self.id.core);
        shadow.inbox.extend(letter.map(|letter| letter.vectors.clone()));
        self.shadow = Some(Box::new(shadow));
        self
    }

    /// The shadow of the core, where it has one.
    pub fn shadow(&self) -> Option<&Shadow> {
        self.shadow.as_deref()
    }

    /// Registers, buffer, program counter and instructions of the core.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Changes registers: the core's past is then another one, and shadows of what has changed begin anew.
    pub fn change_registers(&mut self, change: impl FnOnce(&mut Registers)) {
        let before = self.state.registers.clone();
        change(&mut self.state.registers);
        if let Some(shadow) = &mut self.shadow {
            shadow.forget_changed(&before, &self.state.registers);
        }
    }

    /// Global memory as the core sees it.
    pub fn memory(&self) -> &Memory {
        &self.link.memory
    }

    /// Instructions executed.
    pub fn steps(&self) -> u64 {
        self.state.steps
    }

    /// Clocks so far, transfers included, each of which has the bus for itself.
    pub fn clock(&self) -> Clocks {
        Clocks(self.state.clocks) + self.link.waited
    }

    /// Clocks of computing, without those of transfers.
    pub fn busy(&self) -> Clocks {
        Clocks(self.state.clocks)
    }

    /// End of the program, once it has come.
    pub fn end(&self) -> Option<LoneEnd> {
        self.end
    }

    /// The trap in which the program ended.
    pub fn trap(&self) -> Option<Trap> {
        match self.end? {
            LoneEnd::Halt => None,
            LoneEnd::Fault(fault) => Some(Trap::new(fault, self.id.core, self.state.pc, &self.code)),
        }
    }

    /// Messages that left for other processors.
    pub fn sent(&self) -> &[Message] {
        &self.link.sent
    }

    /// Open calls, the innermost last; of very deep ones the outermost.
    pub fn calls(&self) -> &[OpenCall] {
        &self.witness.calls
    }

    /// Operations executed since the last [`Stepper::forget_counts`], by class.
    pub fn counts(&self) -> Counts {
        self.tally.counts(&self.code)
    }

    /// Begins to count anew.
    pub fn forget_counts(&mut self) {
        self.tally = Tally::new(&self.code);
    }

    /// The state, to come back to it.
    pub fn checkpoint(&self) -> Checkpoint {
        let Stepper { state, link, witness, shadow, end, .. } = self;
        let (witness, shadow) = (witness.clone(), shadow.clone());
        Checkpoint { state: state.clone(), link: link.clone(), witness, shadow, end: *end }
    }

    /// Back, or on, to a state.
    pub fn restore(&mut self, checkpoint: &Checkpoint) {
        let Checkpoint { state, link, witness, shadow, end } = checkpoint.clone();
        (self.state, self.link, self.witness, self.end) = (state, link, witness, end);
        self.shadow = shadow;
    }

    /// Runs until so many instructions have been executed in all, or the program ends.
    pub fn run_to(&mut self, steps: u64) {
        while self.end.is_none() && self.state.steps < steps {
            let more = (steps - self.state.steps).max(1);
            self.ticks(more);
        }
    }

    /// Runs so many slots, steps of bodies counted.
    fn ticks(&mut self, more: u64) {
        let before = self.state.steps + self.state.inner_steps;
        let limit = before.saturating_add(more).min(self.id.step_limit);
        let id = CoreId { step_limit: limit, ..self.id };
        let mut link = TimedLone { link: &mut self.link, config: self.config };
        let Stepper { code, state, arithmetic, tally, witness, .. } = self;
        let pause = match self.shadow.take() {
            None => interpreter::run(code, id, state, &*arithmetic, &mut link, tally, witness),
            Some(shadow) => {
                let mut both = ShadowWitness { witness: std::mem::take(witness), shadow };
                let pause = interpreter::run(code, id, state, &*arithmetic, &mut link, tally, &mut both);
                (*witness, self.shadow) = (both.witness, Some(both.shadow));
                pause
            }
        };
        self.end = match pause {
            Pause::Halt => Some(LoneEnd::Halt),
            Pause::Wait => Some(LoneEnd::Fault(Fault::Deadlock)),
            Pause::Fault(Fault::StepLimit(met)) if met == limit && limit < self.id.step_limit => None,
            Pause::Fault(fault) => Some(LoneEnd::Fault(fault)),
        };
    }

    /// Executes one instruction; `None` when the program has ended, or ends with it in a fault.
    pub fn step(&mut self) -> Option<Executed> {
        if self.end.is_some() {
            return None;
        }
        let (step, clock) = (self.state.steps, self.clock());
        let pc = self.code.word(self.state.pc);
        self.link.last = None;
        let mut losses = Losses::default();
        // An instruction with a body takes several slots.
        while self.state.steps == step {
            let slot = self.state.pc as usize;
            let before = self.slot_losses(slot);
            self.ticks(1);
            // A `trap`, and what leads out of the program, are executed before that is found out.
            if self.state.steps == step && self.end.is_some_and(|end| end != LoneEnd::Halt) {
                return None;
            }
            let after = self.slot_losses(slot);
            losses.add(Losses {
                quantized: after.quantized - before.quantized,
                overflowed: after.overflowed - before.overflowed,
            });
        }
        let (exit, units) = self.witness.exit;
        let exit = self.code.passes().get(exit).and_then(|pass| pass.exit).unwrap_or(0);
        Some(Executed { step, pc, clock, exit, units, transfer: self.link.last, losses })
    }

    /// Losses of a slot's results so far.
    fn slot_losses(&mut self, slot: usize) -> Losses {
        self.tally.parts_mut().1.get(slot).copied().unwrap_or_default()
    }
}
