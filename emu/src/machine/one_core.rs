//! One program on one core with a memory of its own: no main processor, no other cores, a bus without rivals.

use std::sync::Arc;

use isa::{Isa, Program};
use messages::{Diagnostic, Report};

use super::check_buffer;
use super::config::Config;
use super::finish::add_clocks;
use super::kinds::Kinds;
use super::port::Shared;
use super::processor::Processor;
use super::request::Request;
use super::worker::{Executor, Worker, WorkerCounts};
use crate::code::octets::{Buffer, Memory};
use crate::code::quantity::Clocks;
use crate::code::registers::Registers;
use crate::code::tally::Tally;
use crate::code::trap::{Fault, Trap};
use crate::code::{Code, check_bodies};
use crate::engine::{Choice, CoreId, Demand, Pause, State, Task, Wish, choose, dispatch};
use crate::profile::{Observer, Profile, ProfileLevel};
use crate::semantics::Watch;

/// Program that runs on one core, with its machine.
pub struct OneCore<'a> {
    /// The machine; its number of cores and main processor play no part.
    pub config: &'a Config,
    /// The rows of the program.
    pub isa: &'a Isa,
    /// The program.
    pub program: &'a Program,
    /// Registers at the start.
    pub registers: Registers,
    /// Instructions that it may take.
    pub step_limit: u64,
    /// Detail in which calls are measured.
    pub profile: ProfileLevel,
    /// Losses of results are counted: [`crate::code::tally::Losses`].
    pub has_losses: bool,
}

impl<'a> OneCore<'a> {
    /// A program from reset, with the machine's step limit; neither calls nor losses are measured.
    pub fn new(config: &'a Config, isa: &'a Isa, program: &'a Program) -> OneCore<'a> {
        OneCore {
            config,
            isa,
            program,
            registers: Registers::default(),
            step_limit: config.step_limit,
            profile: ProfileLevel::None,
            has_losses: false,
        }
    }
}

/// State in which a program left the core, whether it halted or trapped.
#[derive(Clone, Debug)]
pub struct OneCoreRun {
    /// Engine that executed it.
    pub engine: Choice,
    /// Registers, buffer, program counter, instructions.
    pub state: State,
    /// Global memory.
    pub memory: Memory,
    /// Clocks, transfers included.
    pub clocks: Clocks,
    /// Clocks of transfers.
    pub waiting: Clocks,
    /// Passes through the program's exits.
    pub tally: Tally,
    /// Functions and regions, where a profile was asked for.
    pub profile: Option<Profile>,
    /// Trap that stopped it before its `halt`.
    pub trap: Option<Trap>,
}

/// Runs a program to its `halt` or its trap. A message can only go to the core itself, which has number 0 of 1; waiting
/// for one that cannot come is a deadlock.
///
/// # Errors
/// A machine out of its ranges, or initial data that do not fit the buffer.
pub fn run(one_core: &OneCore, memory: Memory) -> Result<OneCoreRun, Report> {
    run_with(one_core, memory, Wish::default())
}

/// Run with an engine that is wanted. The results are the same.
///
/// # Errors
/// As [`run`].
pub fn run_with(one_core: &OneCore, memory: Memory, wish: Wish) -> Result<OneCoreRun, Report> {
    Ok(LoadedCore::new(one_core)?.run(&one_core.registers, memory, wish))
}

/// A program on one core that runs more than once: it is decoded once, and native code that one run generates serves the next ones.
pub struct LoadedCore<'a> {
    one_core: &'a OneCore<'a>,
    code: Code<'a>,
}

impl<'a> LoadedCore<'a> {
    /// A program that has not run yet.
    ///
    /// # Errors
    /// As [`run`].
    pub fn new(one_core: &'a OneCore<'a>) -> Result<LoadedCore<'a>, Report> {
        let OneCore { config, isa, program, .. } = *one_core;
        config.check()?;
        check_buffer("a core", program, config.buffer_octets)?;
        check_bodies(program, isa).map_err(Diagnostic::from)?;
        Ok(LoadedCore { one_core, code: Code::new(program, isa, config.timing()) })
    }

    /// Run from these registers and this memory, with an engine that is wanted; the registers of the [`OneCore`] play no part.
    pub fn run(&self, registers: &Registers, memory: Memory, wish: Wish) -> OneCoreRun {
        let OneCore { config, has_losses, profile, .. } = *self.one_core;
        dispatch(config.arithmetic.watching(has_losses), profile, OneCoreTask { core: self, registers, memory, wish })
    }
}

struct OneCoreTask<'a> {
    core: &'a LoadedCore<'a>,
    registers: &'a Registers,
    memory: Memory,
    wish: Wish,
}

impl Task for OneCoreTask<'_> {
    type Result = OneCoreRun;

    fn run<T: Watch + Clone + Send, O: Observer + Send>(self, arithmetic: &T) -> OneCoreRun {
        run_on::<T, O>(self, arithmetic)
    }
}

fn run_on<T: Watch, O: Observer>(task: OneCoreTask, arithmetic: &T) -> OneCoreRun {
    let OneCoreTask { core: &LoadedCore { one_core, ref code }, registers, memory, wish } = task;
    let core = CoreId { core: 0, cores: 1, step_limit: one_core.step_limit };
    let buffer_octets = one_core.config.buffer_octets;
    let demand = Demand::new(code, wish, arithmetic.computes(), buffer_octets);
    let runner = choose(&Demand { profile: one_core.profile, ..demand });
    let initial = Arc::new(Buffer::new(&one_core.program.buffer, buffer_octets));
    let mut worker: Executor<T, O> = Executor::new(code, core, initial, runner, arithmetic, one_core.profile);
    worker.restart();
    worker.state.registers = registers.clone();
    let mut processor = Processor::new(code, core, worker);
    let mut shared = Shared::new(memory, 1);
    let (kinds, mut is_permitted) = (Kinds::new(&[]), false);
    let fault = loop {
        match processor.advance(&mut shared, is_permitted).pause {
            Pause::Halt => break None,
            Pause::Fault(fault) => break Some(fault),
            Pause::Wait => {}
        }
        // Nobody else can send or receive, so waiting for either would last for ever.
        let is_stuck = match processor.request {
            Some(Request::Receive) => shared.mailboxes.next(0).is_none(),
            Some(Request::Send { .. }) => shared.mailboxes.is_full(0, 0),
            _ => false,
        };
        if is_stuck {
            break Some(Fault::Deadlock);
        }
        let octets = processor.asked_octets();
        if octets.0 != 0 {
            // All bursts follow each other at once: the bus has no other master.
            let start = processor.clock;
            processor.note_ask(&kinds);
            processor.wait_until(start + one_core.config.transfer_clocks(octets));
        }
        is_permitted = true;
    };
    let Processor { mut worker, clock, used, .. } = processor;
    worker.observer.end();
    let trap = fault.map(|fault| Trap::new(fault, 0, worker.state.pc, code));
    let (engine, state) = (worker.engine(), worker.state.clone());
    let WorkerCounts { tally, mut profile, clocks: log, keys, .. } = worker.into_counts();
    if let (Some(log), Some(keys)) = (log, keys) {
        add_clocks(&log, &[keys], code, &mut profile);
    }
    OneCoreRun { engine, profile, state, memory: shared.memory, clocks: clock, waiting: used.waiting, tally, trap }
}
