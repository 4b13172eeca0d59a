//! Options that choose the machine and its engine.

use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use emu::engine::EngineKind;
use emu::machine::arbiter::ArbiterKind;
use messages::{Diagnostic, Report};
use scenes::layout::Layout;

use super::ArithmeticArguments;
use crate::settings::{MachineSettings, Settings, key};

/// Options of the machine and of what is in its memory.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Machine")]
pub struct MachineArguments {
    #[command(flatten)]
    #[allow(missing_docs, reason = "the group has its own")]
    pub keys: MachineKeyArguments,
    /// Structures of global memory [default: report for the profile report, else wide].
    #[arg(long, value_name = "NAME", value_parser = layout())]
    pub layout: Option<Layout>,
    /// Engine that executes the programs; only the host's time depends on it. auto: the fastest that suits.
    #[arg(long, value_name = "NAME", value_parser = engine(), default_value = AUTO)]
    pub engine: EngineKind,
}

/// Options of every command that takes one machine.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Machine")]
pub struct MachineKeyArguments {
    /// Machine: a preset's name or a TOML file; `lancer machine` shows them.
    #[arg(long, value_name = "NAME|FILE", default_value = "report")]
    pub machine: String,
    /// Number of cores, 1 to 256 [default: the machine's, 4].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=256))]
    pub cores: Option<u32>,
    /// Arbiter of the bus [default: the machine's, round-robin].
    #[arg(long, value_name = "NAME", value_parser = arbiter())]
    pub arbiter: Option<ArbiterKind>,
    #[command(flatten)]
    #[allow(missing_docs, reason = "the group has its own")]
    pub sets: SetArguments,
}

/// Changes of single keys.
#[derive(Args, Clone, Debug, Default)]
pub struct SetArguments {
    /// Changes any key of the settings, after all other options, such as bus.octets_per_beat=4; may be repeated.
    #[arg(long = "set", value_name = "KEY=VALUE", help_heading = "Settings", allow_hyphen_values = true)]
    pub sets: Vec<String>,
    #[command(flatten)]
    #[allow(missing_docs, reason = "the group has its own")]
    pub settings: SettingsArguments,
}

/// A file of settings.
#[derive(Args, Clone, Debug, Default)]
pub struct SettingsArguments {
    /// Settings that the other options change: a TOML file, or any result as JSON (`-` for standard input).
    #[arg(long, value_name = "FILE", help_heading = "Settings")]
    pub settings: Option<PathBuf>,
}

impl MachineKeyArguments {
    /// The machine with what options say otherwise; changes of single keys are not made yet.
    ///
    /// # Errors
    /// See [`MachineSettings::find`].
    pub fn chosen(&self, arithmetic: &ArithmeticArguments) -> Result<MachineSettings, Report> {
        let mut machine = MachineSettings::find(&self.machine)?;
        let config = &mut machine.config;
        config.cores = self.cores.unwrap_or(config.cores);
        config.bus.arbiter = self.arbiter.unwrap_or(config.bus.arbiter);
        arithmetic.adjust(config);
        Ok(machine)
    }

    /// The machine alone, with all changes, for a command that has no other settings.
    ///
    /// # Errors
    /// See [`MachineSettings::find`]; changes of keys that are none of the machine's.
    pub fn machine(&self, arithmetic: &ArithmeticArguments) -> Result<MachineSettings, Report> {
        for set in &self.sets.sets {
            let name = set.split('=').next().unwrap_or_default();
            let key = key::resolve(name)?;
            if !key.starts_with("machine") {
                let message = format!("`{name}` is no key of the machine, and this command has no other keys");
                return Err(Diagnostic::error(message).into());
            }
        }
        let settings = Settings { machine: self.chosen(arithmetic)?, ..Settings::default() };
        Ok(settings.with(&self.sets.sets)?.machine)
    }
}

/// Machines between commas; a file or a machine in braces may have commas in it.
///
/// # Errors
/// None: a machine that does not exist is named when it is looked for.
pub fn machines(text: &str) -> Result<Vec<String>, String> {
    match text.starts_with('{') || Path::new(text).exists() {
        true => Ok(vec![text.to_owned()]),
        false => Ok(text.split(',').map(|name| name.trim().to_owned()).collect()),
    }
}

/// The engine is chosen.
const AUTO: &str = crate::settings::named::AUTO;

/// Names of engines that are no more: whoever asks for the first gets the fastest one, whoever asks for the second is told to.
const OTHERS: [&str; 2] = ["fast", "lockstep"];

/// Names of the engines.
pub fn engine() -> impl TypedValueParser<Value = EngineKind> {
    let names = [AUTO].into_iter().chain(EngineKind::ALL.map(EngineKind::name)).map(PossibleValue::new);
    let names = PossibleValuesParser::new(names.chain(OTHERS.map(|name| PossibleValue::new(name).hide(true))));
    names.try_map(|name| match name == OTHERS[1] {
        true => Err("lock-step was removed, because it was slower; use `--engine native`"),
        false => Ok(EngineKind::named(&name).unwrap_or_default()),
    })
}

/// Names of the layouts.
pub fn layout() -> impl TypedValueParser<Value = Layout> {
    let names = PossibleValuesParser::new(Layout::ALL.iter().map(|layout| layout.name()));
    names.map(|name| name.parse().expect("the parser lets only names pass"))
}

/// Names of the arbiters.
pub fn arbiter() -> impl TypedValueParser<Value = ArbiterKind> {
    let names = PossibleValuesParser::new(ArbiterKind::ALL.map(ArbiterKind::name));
    let find = |name: String| ArbiterKind::ALL.into_iter().find(|kind| kind.name() == name);
    names.map(move |name| find(name).expect("the parser lets only names pass"))
}
