//! `lancer run`: a program on one core, with registers and memory that the user sets.

use std::path::{Path, PathBuf};

use clap::Args;
use emu::code::Code;
use emu::engine::{EngineKind, Wish};
use emu::machine::one_core::{self, OneCore};
use emu::octets::Memory;
use emu::profile::ProfileLevel;
use emu::stepper::{Lone, Stepper};
use isa::{Isa, Program};
use messages::{Diagnostic, Report};

use super::assemble::{self, SourceArguments};
use super::invocation::CommandSettings;
use super::run_arguments::{Dump, memory, memory_file, memory_size};
use super::run_result::RunResult;
use crate::arguments::{self, ArithmeticArguments, ExtensionArguments, MachineKeyArguments};
use crate::failure::{Exit, Failure};
use crate::files::program::{LoadedFile, ProgramFile};
use crate::registers::{RegisterList, ShowList, ShowRequest};
use crate::result::WithSettings;
use crate::shadow::ShadowResult;
use crate::terminal::Terminal;
use crate::trace::instruction::TraceClocks;
use crate::trace::output::{TraceForm, is_standard, write_instructions};
use crate::trace::window::{TraceWindow, TraceWindows};
use crate::{files, result, settings, shadow};

const EXAMPLES: &str = "\
Examples:
  lancer run first.s
  lancer run first.s --reg s1=5,v2=1:2:3 --max-steps 1000
  lancer run first.s --ext slab.isa                 # with instructions of your own
  lancer run copy.s --mem 0x100=data.bin --dump 0x100:64 --dump regs
  lancer run sqrt.s --reg s3=0x10000 --json
  lancer run dot.s --reg s5=1.5:pos,v1=0.6:0:0.8:dir --show s2:pos,v1:dir
  lancer run first.s --trace -                  # instruction by instruction
  lancer run first.s --trace first.jsonl --window function=square --window steps=0..1000
  lancer run first.s --flags                    # what lost bits or did not fit, line by line
  lancer run first.s --shadow                   # what exact arithmetic would have given, and where precision died
  lancer run first.o                            # as lancer assemble -o first.o has written it

Registers hold raw integers: s0 to s31 one word, v0 to v31 three components, w0 to w7 64 bits. A number with a
format behind it, such as 1.5:pos, is a real one; the formats are those of the program, or fraction bits: 1.5:16.
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
    /// Registers at the start, such as s1=5,v2=1:2:3,w0=-7 or s5=1.5:pos; may be repeated [default: 0].
    #[arg(long = "reg", value_name = "REGISTER=VALUE,..", allow_hyphen_values = true)]
    registers: Vec<RegisterList>,
    /// Registers to show at the end, each in a format of the program or in fraction bits, such as s2:pos,v1:dir.
    #[arg(long, value_name = "REGISTER:FORMAT,..")]
    show: Vec<ShowList>,
    /// File whose octets lie in global memory from an address on; may be repeated.
    #[arg(long = "mem", value_name = "ADDRESS=FILE", value_parser = memory_file)]
    files: Vec<(u32, PathBuf)>,
    /// Octets of global memory; files that reach beyond make it longer.
    #[arg(long, value_name = "OCTETS", value_parser = memory_size, default_value = "65536")]
    memory_size: u32,
    /// Shows registers that are not zero (regs) or all (regs:all), octets of global memory (ADDRESS:OCTETS) or of the local
    /// buffer (buffer:ADDRESS:OCTETS) at the end; may be repeated.
    #[arg(long = "dump", value_name = "regs|ADDRESS:OCTETS")]
    dumps: Vec<Dump>,
    /// Counts, instruction by instruction, results that lost bits below the last place or did not fit.
    #[arg(long)]
    flags: bool,
    /// Compares the results with exact arithmetic on the same inputs: errors by line and function, and where precision died.
    /// The registers of --show count as the results, else all that are no integers and what was written to global memory.
    #[arg(long)]
    shadow: bool,
    /// File for the trace of instructions, a line each with what it read and wrote; .jsonl: as JSON. - is standard
    /// output, which then has nothing else, and JSON lines with --json.
    #[arg(long, value_name = "FILE|-")]
    trace: Option<PathBuf>,
    /// Instructions that the trace has: steps=A..B, pc=A..B or function=NAME; may be repeated.
    #[arg(long = "window", value_name = "WHAT=WHICH", requires = "trace")]
    windows: Vec<TraceWindow>,
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
    let memory = memory(&arguments.files, arguments.memory_size)?;
    let program = program(arguments, &isa, terminal)?;
    let mut registers = emu::registers::Registers::default();
    for setting in arguments.registers.iter().flat_map(|list| &list.0) {
        setting.set(&program, &mut registers).map_err(|message| Failure::usage(Diagnostic::error(message)))?;
    }
    let shown: Vec<ShowRequest> = arguments.show.iter().flat_map(|list| list.0.clone()).collect();
    // Mistakes show before the program takes its time.
    for request in &shown {
        request
            .shown(&program, &registers, program.entry)
            .map_err(|message| Failure::usage(Diagnostic::error(message)))?;
    }
    let lone = || Lone {
        config,
        isa: &isa,
        program: &program,
        registers: registers.clone(),
        memory: Memory::new(memory.clone()),
        message: None,
        step_limit: arguments.max_steps.unwrap_or(config.step_limit),
    };
    if let Some(path) = &arguments.trace {
        trace(arguments, path, lone(), terminal)?;
    }
    let shadowed = arguments.shadow.then(&lone);
    let one_core = OneCore {
        registers,
        step_limit: arguments.max_steps.unwrap_or(config.step_limit),
        profile: ProfileLevel::Clocks,
        has_losses: arguments.flags,
        ..OneCore::new(config, &isa, &program)
    };
    let wish = Wish { kind: arguments.engine, ..Wish::default() };
    let run = one_core::run_with(&one_core, Memory::new(memory), wish)?;
    let file = arguments.file.display().to_string();
    let code = Code::new(&program, &isa, config.timing());
    let flags = arguments.flags.then(|| result::losses(&code, &run.tally));
    let shadow = match shadowed {
        Some(lone) => Some(compared(lone, &shown)?),
        None => None,
    };
    let mut shown = RunResult::new(file, machine.name.clone(), &program, &run, flags, &arguments.dumps, &shown)?;
    shown.shadow = shadow;
    // A trace on standard output has it for itself.
    match arguments.json {
        _ if arguments.trace.as_deref().is_some_and(is_standard) => {}
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

/// Runs the program with a shadow; `shown` are the registers that count as its results, where there are any.
fn compared(lone: Lone, shown: &[ShowRequest]) -> Result<ShadowResult, Failure> {
    let program = lone.program;
    let mut stepper = Stepper::new(lone)?.with_shadow(None);
    stepper.run_to(u64::MAX);
    let pc = stepper.code.word(stepper.state().pc);
    let chosen: Vec<_> = shown.iter().filter_map(|request| request.register(program, pc)).collect();
    let shadow = stepper.shadow().expect("it has one");
    Ok(shadow::program(&stepper, shadow, None, &chosen))
}

/// Writes the trace of a program.
fn trace(arguments: &RunArguments, path: &Path, lone: Lone, terminal: &mut Terminal) -> Result<(), Failure> {
    let read = arguments.files.iter().map(|(_, path)| path).chain([&arguments.file]);
    files::check_spared([path].into_iter().filter(|path| !is_standard(path)), read).map_err(Failure::usage)?;
    let windows = TraceWindows(arguments.windows.clone());
    windows.check(lone.program).map_err(|message| Failure::usage(Diagnostic::error(message)))?;
    let form = TraceForm::of(path, arguments.json);
    let mut stepper = Stepper::new(lone)?;
    write_instructions(&mut stepper, TraceClocks::Own, &windows, path, form, terminal)?;
    Ok(())
}

/// The program: assembled now, or some time before.
fn program(arguments: &RunArguments, isa: &Isa, terminal: &Terminal) -> Result<Program, Failure> {
    let RunArguments { file, source, .. } = arguments;
    let program = match files::program::load_any(file)? {
        LoadedFile::Program(program) => *program,
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
