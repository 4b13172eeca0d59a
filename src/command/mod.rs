//! The commands, one a file. Each is a function from its arguments and the terminal to its exit code.

mod assemble;
mod completions;
mod disassemble;
mod machine;
mod render;
mod run;
mod run_arguments;
mod run_result;

use clap::{Parser, Subcommand};

use crate::failure::{Exit, Failure};
use crate::terminal::Terminal;

/// Emulator of a fixed-point ray-tracing coprocessor: kernels in assembly, several cores, one shared bus.
#[derive(Parser, Debug)]
#[command(name = "lancer", version, max_term_width = 100)]
pub struct Lancer {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand, Debug)]
enum Command {
    Render(Box<render::RenderArguments>),
    Run(run::RunArguments),
    Assemble(assemble::AssembleArguments),
    Disassemble(disassemble::DisassembleArguments),
    Machine(machine::MachineArguments),
    Completions(completions::CompletionsArguments),
}

/// Executes a command line.
///
/// # Errors
/// Whatever keeps the command from doing its work.
pub fn execute(arguments: &Lancer, terminal: &mut Terminal) -> Result<Exit, Failure> {
    match &arguments.command {
        None => Ok(Exit::Done),
        Some(Command::Render(arguments)) => render::execute(arguments, terminal),
        Some(Command::Run(arguments)) => run::execute(arguments, terminal),
        Some(Command::Assemble(arguments)) => assemble::execute(arguments, terminal),
        Some(Command::Disassemble(arguments)) => disassemble::execute(arguments, terminal),
        Some(Command::Machine(arguments)) => machine::execute(arguments, terminal),
        Some(Command::Completions(arguments)) => completions::execute(arguments, terminal),
    }
}
