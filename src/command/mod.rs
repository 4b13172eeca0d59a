//! The commands, one a file. Each is a function from its arguments and the terminal to its exit code.

mod accuracy;
mod annex;
mod arithmetic;
mod assemble;
mod bench;
mod completions;
mod cores;
mod demo;
mod disassemble;
mod explain;
mod extension;
pub mod invocation;
mod machine;
mod manual;
mod profiles;
mod render;
mod run;
mod run_arguments;
mod run_result;
mod scene;
mod schema;
mod skips;
mod stress;
mod sweep;
mod trace;

use clap::{Parser, Subcommand};
use invocation::CommandSettings;

use crate::arguments::{self, Size};
use crate::failure::{Exit, Failure};
use crate::terminal::Terminal;

const EXAMPLES: &str = "\
Examples:
  lancer                                  the demo: a picture, maps, counts, clocks and errors
  lancer render cornell --size 160x120    a generated scene, a .dsc, or a mesh (.off, .obj, .ply, .stl)
  lancer run first.s --reg s1=5           a program of your own on one core

Exit codes: 0 done, 1 errors in the input, 2 usage, 3 trap in the guest, 4 a comparison out of
tolerance, 5 step limit. Results go to standard output, messages to standard error.";

/// Emulator of a fixed-point ray-tracing coprocessor: kernels in assembly, several cores, one shared bus.
///
/// Without a command, lancer runs the demo: it draws the Cornell box and writes pictures below out/.
#[derive(Parser, Debug)]
#[command(name = "lancer", version, after_help = EXAMPLES, args_conflicts_with_subcommands = true)]
pub struct Lancer {
    /// Size of the demo's picture, in pixels.
    #[arg(long, value_name = "WxH", value_parser = arguments::size, default_value = "320x240")]
    size: Size,
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand, Debug)]
enum Command {
    Render(Box<render::RenderArguments>),
    Run(run::RunArguments),
    Assemble(assemble::AssembleArguments),
    Disassemble(disassemble::DisassembleArguments),
    Annex(annex::AnnexArguments),
    Scene(scene::SceneArguments),
    Profiles(profiles::ProfilesArguments),
    Skips(Box<skips::SkipsArguments>),
    Machine(machine::PresetArguments),
    Cores(Box<cores::CoresArguments>),
    Sweep(sweep::SweepArguments),
    Trace(Box<trace::TraceArguments>),
    Accuracy(accuracy::AccuracyArguments),
    Stress(stress::StressArguments),
    Bench(bench::BenchArguments),
    Arithmetic(arithmetic::CheckedArithmeticArguments),
    Manual(manual::ManualArguments),
    Extension(extension::ExtensionsArguments),
    Explain(explain::ExplainArguments),
    Schema(schema::SchemaArguments),
    Completions(completions::CompletionsArguments),
}

/// Executes a command line, of which `given` are the settings.
///
/// # Errors
/// Whatever keeps the command from doing its work.
pub fn execute(arguments: &Lancer, given: &CommandSettings, terminal: &mut Terminal) -> Result<Exit, Failure> {
    match &arguments.command {
        None => demo::execute(arguments.size, terminal),
        Some(Command::Render(arguments)) => render::execute(arguments, terminal),
        Some(Command::Run(arguments)) => run::execute(arguments, given, terminal),
        Some(Command::Assemble(arguments)) => assemble::execute(arguments, terminal),
        Some(Command::Disassemble(arguments)) => disassemble::execute(arguments, terminal),
        Some(Command::Annex(arguments)) => annex::execute(arguments, given, terminal),
        Some(Command::Scene(arguments)) => scene::execute(arguments, given, terminal),
        Some(Command::Profiles(arguments)) => profiles::execute(arguments, given, terminal),
        Some(Command::Skips(arguments)) => skips::execute(arguments, terminal),
        Some(Command::Machine(arguments)) => machine::execute(arguments, terminal),
        Some(Command::Cores(arguments)) => cores::execute(arguments, terminal),
        Some(Command::Sweep(arguments)) => sweep::execute(arguments, terminal),
        Some(Command::Trace(arguments)) => trace::execute(arguments, terminal),
        Some(Command::Accuracy(arguments)) => accuracy::execute(arguments, given, terminal),
        Some(Command::Bench(arguments)) => bench::execute(arguments, given, terminal),
        Some(Command::Stress(arguments)) => stress::execute(arguments, given, terminal),
        Some(Command::Arithmetic(arguments)) => arithmetic::execute(arguments, given, terminal),
        Some(Command::Manual(arguments)) => manual::execute(arguments, terminal),
        Some(Command::Extension(arguments)) => extension::execute(arguments, terminal),
        Some(Command::Explain(arguments)) => explain::execute(arguments, terminal),
        Some(Command::Schema(arguments)) => schema::execute(arguments, terminal),
        Some(Command::Completions(arguments)) => completions::execute(arguments, terminal),
    }
}
