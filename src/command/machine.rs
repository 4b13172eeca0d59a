//! `lancer machine`: a machine as a file with every key.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::invocation::CommandSettings;
use crate::failure::{Exit, Failure};
use crate::result::{OperationTimes, WithSettings};
use crate::settings::MachineSettings;
use crate::terminal::Terminal;
use crate::{machine, result};

/// Version of [`MachineResult`].
pub(super) const SCHEMA: &str = "lancer-machine-1";

const EXAMPLES: &str = "\
Examples:
  lancer machine
  lancer machine report > mine.toml    # then change a key, and: lancer render cornell --machine mine.toml
  lancer machine wide32                # a 32-bit bus with bursts, three units a class
  lancer machine bit_serial --word 16  # clocks by the bits of a word, and what they come to
  lancer machine mine.toml             # keys that the file leaves out have the report's values

  lancer machine wide32 --json         # the same for a script";

/// Prints a machine as a TOML file with every key, its unit and what it means.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct PresetArguments {
    #[arg(value_name = "NAME|FILE", default_value = machine::DEFAULT, help = machine::named())]
    machine: String,
    /// Bits of a word for which laws are resolved, 8 to 32 [default: the machine's].
    #[arg(long, value_name = "BITS", value_parser = clap::value_parser!(u32).range(8..=32))]
    word: Option<u32>,
    /// Prints the machine as JSON.
    #[arg(long)]
    json: bool,
}

/// A machine by its name.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(super) struct MachineResult {
    /// Version of the result: a key that goes away or changes its meaning changes it, a new key does not.
    #[schemars(extend("const" = SCHEMA))]
    schema: &'static str,
    /// All keys of the machine, and its name.
    machine: MachineSettings,
    /// Clocks and units of each class as what their laws come to for the word.
    resolved: OperationTimes,
}

/// Prints the machine.
pub(super) fn execute(
    arguments: &PresetArguments,
    given: &CommandSettings,
    terminal: &mut Terminal,
) -> Result<Exit, Failure> {
    let mut machine = MachineSettings::find(&arguments.machine)?;
    let word = &mut machine.config.arithmetic.word;
    *word = arguments.word.unwrap_or(*word);
    match arguments.json {
        true => {
            let settings = given.clone().with_machine(&machine);
            let resolved = OperationTimes::new(&machine.config);
            let machine = MachineResult { schema: SCHEMA, machine, resolved };
            terminal.print(&result::json(&WithSettings::new(&machine, settings)))?;
        }
        false => terminal.print(&machine::commented(&machine.name, &machine.config))?,
    }
    Ok(Exit::Done)
}
