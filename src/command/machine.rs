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
  lancer machine bit_serial --word 16  # clocks by the bits of a word, and what they come to
  lancer machine mine.toml             # keys that the file leaves out have the report's values";

/// Prints a machine as a TOML file with every key, its unit and what it means.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct PresetArguments {
    #[arg(value_name = "NAME|FILE", default_value = machine::DEFAULT, help = machine::named())]
    machine: String,
    /// Bits of a word for which laws are resolved, 8 to 32 [default: the machine's].
    #[arg(long, value_name = "BITS", value_parser = clap::value_parser!(u32).range(8..=32))]
    word: Option<u32>,
}

/// Prints the machine.
pub(super) fn execute(arguments: &PresetArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let (name, mut config) = machine::find(&arguments.machine)?;
    config.arithmetic.word = arguments.word.unwrap_or(config.arithmetic.word);
    terminal.print(&machine::commented(&name, &config))?;
    Ok(Exit::Done)
}
