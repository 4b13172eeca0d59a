//! `lancer scene`: scenes as files and as figures.

mod generate;
mod info;

use clap::{Args, Subcommand};

use crate::failure::{Exit, Failure};
use crate::terminal::Terminal;

const EXAMPLES: &str = "\
Examples:
  lancer scene generate cornell -o scenes
  lancer scene info scenes/cornell.dsc";

/// Generates scenes and says what is in them.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct SceneArguments {
    #[command(subcommand)]
    command: SceneCommand,
}

#[derive(Subcommand, Debug)]
enum SceneCommand {
    Generate(generate::GenerateArguments),
    Info(Box<info::InfoArguments>),
}

/// Executes one of the commands.
pub(super) fn execute(arguments: &SceneArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    match &arguments.command {
        SceneCommand::Generate(arguments) => generate::execute(arguments, terminal),
        SceneCommand::Info(arguments) => info::execute(arguments, terminal),
    }
}
