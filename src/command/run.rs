//! `lancer run`: a program on one core, with registers and memory that the user sets.

use std::path::PathBuf;

use clap::Args;
use emu::code::Code;
use emu::engine::{EngineKind, Wish};
use emu::machine::one_core::{self, OneCore};
use emu::octets::Memory;
use emu::profile::ProfileLevel;
use isa::{Isa, Program};
use messages::{Diagnostic, Report};

use super::assemble::{self, SourceArguments};
use super::invocation::CommandSettings;
use super::run_arguments::{Dump, RegisterValue, memory_file, memory_size};
use super::run_result::RunResult;
use crate::arguments::{self, ArithmeticArguments, ExtensionArguments, MachineKeyArguments};
use crate::failure::{Exit, Failure};
use crate::files::program::{LoadedFile, ProgramFile};
use crate::result::WithSettings;
use crate::terminal::Terminal;
use crate::{files, result, settings};

const EXAMPLES: &str = "\
Examples:
  lancer run first.s
  lancer run first.s --reg s1=5,v2=1:2:3 --max-steps 1000
  lancer run first.s --ext slab.isa                 # with instructions of your own
  lancer run copy.s --mem 0x100=data.bin --dump 0x100:64 --dump regs
  lancer run sqrt.s --reg s3=0x10000 --json
  lancer run first.s --flags                    # what lost bits or did not fit, line by line
  lancer run first.o                            # as lancer assemble -o first.o has written it

Registers hold raw integers: s0 to s31 one word, v0 to v31 three components, w0 to w7 64 bits.
Exit codes: 0 the program halted, 1 errors in the source, 2 usage, 3 it trapped, 5 step limit.";

/// Assembles a program, or takes an assembled one, and runs it on one core of the machine.
///
/// Prints the registers that are not zero at the end, and what the program took, by class and by function.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct RunArguments {
    /// Assembly file, or an assembled program: .o, or its words alone (.bin, .hex), which start at word 0 without data.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    #[command(flatten)]
    source: SourceArguments,
    #[command(flatten)]
    extensions: ExtensionArguments,
    /// Registers at the start, such as s1=5,v2=1:2:3,w0=-7; may be repeated [default: 0].
    #[arg(long = "reg", value_name = "REGISTER=VALUE,..", value_delimiter = ',', allow_hyphen_values = true)]
    registers: Vec<RegisterValue>,
    /// File whose octets lie in global memory from an address on; may be repeated.
    #[arg(long = "mem", value_name = "ADDRESS=FILE", value_parser = memory_file)]
    files: Vec<(u32, PathBuf)>,
    /// Octets of global memory; files that reach beyond make it longer.
    #[arg(long, value_name = "OCTETS", value_parser = memory_size, default_value = "65536")]
    memory_size: u32,
    /// Shows all registers (regs), octets of global memory (ADDRESS:OCTETS) or of the local buffer
    /// (buffer:ADDRESS:OCTETS) at the end; may be repeated.
    #[arg(long = "dump", value_name = "regs|ADDRESS:OCTETS")]
    dumps: Vec<Dump>,
    /// Counts, instruction by instruction, results that lost bits below the last place or did not fit.
    #[arg(long)]
    flags: bool,
    /// Instructions that the program may take [default: the machine's, 100,000,000].
    #[arg(long, value_name = "N", value_parser = arguments::positive)]
    max_steps: Option<u64>,
    #[command(flatten)]
    machine: MachineKeyArguments,
    #[command(flatten)]
    arithmetic: ArithmeticArguments,
    /// Engine that executes the program; only the host's time depends on it. auto: the fastest that suits.
    #[arg(long, value_name = "NAME", value_parser = arguments::engine(), default_value = "auto")]
    engine: EngineKind,
    /// Prints the results as JSON instead of tables.
    #[arg(long)]
    json: bool,
}

/// Assembles, runs and prints.
pub(super) fn execute(
    arguments: &RunArguments,
    given: &CommandSettings,
    terminal: &mut Terminal,
) -> Result<Exit, Failure> {
    let machine = arguments.machine.machine(&arguments.arithmetic)?;
    let config = &machine.config;
    let isa = arguments.extensions.isa()?;
    let memory = memory(arguments)?;
    let program = program(arguments, &isa, terminal)?;
    let mut registers = emu::registers::Registers::default();
    for value in &arguments.registers {
        value.set(&mut registers);
    }
    let one_core = OneCore {
        registers,
        step_limit: arguments.max_steps.unwrap_or(config.step_limit),
        profile: ProfileLevel::Totals,
        has_losses: arguments.flags,
        ..OneCore::new(config, &isa, &program)
    };
    let wish = Wish { kind: arguments.engine, ..Wish::default() };
    let run = one_core::run_with(&one_core, Memory::new(memory), wish)?;
    let file = arguments.file.display().to_string();
    let code = Code::new(&program, &isa, config.timing());
    let flags = arguments.flags.then(|| result::losses(&code, &run.tally));
    let shown = RunResult::new(file, machine.name.clone(), &run, flags, &arguments.dumps)?;
    match arguments.json {
        true => {
            let settings = given.clone().with_machine(&machine).with_hash(hash(arguments, &program)?);
            terminal.print(&result::json(&WithSettings::new(&shown, settings)))?
        }
        false => terminal.tell(&shown.text())?,
    }
    match &run.trap {
        None => Ok(Exit::Done),
        Some(trap) => {
            let mut report = Report::from(trap.diagnostic());
            let exit = Exit::of_trap(trap);
            if exit == Exit::StepLimit {
                let hint = "a loop that does not end? --max-steps allows more";
                report.0 = report.0.into_iter().map(|message| message.hint(hint)).collect();
            }
            Err(Failure::Message { report, exit })
        }
    }
}

/// The program: assembled now, or some time before.
fn program(arguments: &RunArguments, isa: &Isa, terminal: &Terminal) -> Result<Program, Failure> {
    let RunArguments { file, source, .. } = arguments;
    let program = match files::program::load_any(file)? {
        LoadedFile::Program(program) => program,
        LoadedFile::Other(octets) => {
            return assemble::assembled(&files::source_of(file, octets)?, source, isa, terminal);
        }
    };
    if source.has_options() {
        let message = format!("{} is assembled already: -D, --format and -I come too late", file.display());
        return Err(Failure::usage(Diagnostic::error(message).hint("give them to `lancer assemble`")));
    }
    Ok(program)
}

/// SHA-256 of all that the run reads: the program's words, buffer and first word, and the files in memory.
fn hash(arguments: &RunArguments, program: &Program) -> Result<String, Failure> {
    let entry = program.entry.to_le_bytes().to_vec();
    let mut parts = vec![ProgramFile::Binary.encode(program), program.buffer.clone(), entry];
    for (_, path) in &arguments.files {
        parts.push(files::read(path)?);
    }
    Ok(settings::hash::parts(parts.iter().map(Vec::as_slice)))
}

/// Global memory at the start.
fn memory(arguments: &RunArguments) -> Result<Vec<u8>, Failure> {
    let mut memory = vec![0; arguments.memory_size as usize];
    for (address, path) in &arguments.files {
        let octets = files::read(path)?;
        let start = *address as usize;
        let end = start + octets.len();
        if end > 1 << 30 {
            let message = format!("{} at {address:#x} reaches beyond a memory of 1 GiB", path.display());
            return Err(Diagnostic::error(message).into());
        }
        memory.resize(memory.len().max(end), 0);
        memory[start..end].copy_from_slice(&octets);
    }
    Ok(memory)
}
