//! `lancer extension`: instructions of a user's own, and what they are worth.

mod check;
pub(super) mod compare;
pub(super) mod suggest;

use clap::{Args, Subcommand};

use crate::failure::{Exit, Failure};
use crate::terminal::Terminal;

const EXAMPLES: &str = "\
Examples:
  lancer extension check slab.isa
  lancer extension suggest cornell --size 40x30
  lancer extension compare slab.isa --scene cornell --kernel exit_face=slab.s --size 80x60

docs/extensions.md describes the files.";

/// Instructions that are loaded from files: checked, and compared with doing without them.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct ExtensionsArguments {
    #[command(subcommand)]
    command: ExtensionCommand,
}

#[derive(Subcommand, Clone, Debug)]
enum ExtensionCommand {
    Check(check::CheckArguments),
    Compare(Box<compare::CompareArguments>),
    Suggest(Box<suggest::SuggestArguments>),
}

/// Carries out what is asked for.
pub(super) fn execute(arguments: &ExtensionsArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    match &arguments.command {
        ExtensionCommand::Check(arguments) => check::execute(arguments, terminal),
        ExtensionCommand::Compare(arguments) => compare::execute(arguments, terminal),
        ExtensionCommand::Suggest(arguments) => suggest::execute(arguments, terminal),
    }
}
