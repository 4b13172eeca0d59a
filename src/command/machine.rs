//! `lancer machine`: a machine as a file with every key.

use clap::Args;

use crate::failure::{Exit, Failure};
use crate::machine;
use crate::terminal::Terminal;

const EXAMPLES: &str = "\
Examples:
  lancer machine
  lancer machine report > mine.toml    # then change a key, and: lancer render cornell --machine mine.toml
  lancer machine wide32                # a 32-bit bus with bursts, three units a class
  lancer machine mine.toml             # keys that the file leaves out have the report's values";

/// Prints a machine as a TOML file with every key, its unit and what it means.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct PresetArguments {
    #[arg(value_name = "NAME|FILE", default_value = machine::DEFAULT, help = machine::named())]
    machine: String,
}

/// Prints the machine.
pub(super) fn execute(arguments: &PresetArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let (name, config) = machine::find(&arguments.machine)?;
    terminal.print(&machine::commented(&name, &config))?;
    Ok(Exit::Done)
}
