//! Which machine runs.

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use emu::engine::EngineKind;
use scenes::layout::Layout;

/// Options of the machine.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Machine")]
pub struct MachineArguments {
    /// Machine: a preset's name or a TOML file; `lancer machine` shows them.
    #[arg(long, value_name = "NAME|FILE", default_value = "report")]
    pub machine: String,
    /// Number of cores, 1 to 256 [default: the machine's, 4].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=256))]
    pub cores: Option<u32>,
    /// Structures of global memory [default: report for the profile report, else wide].
    #[arg(long, value_name = "NAME", value_parser = layout())]
    pub layout: Option<Layout>,
    /// Engine that executes the programs; only the host's time depends on it. auto: the fastest that suits.
    #[arg(long, value_name = "NAME", value_parser = engine(), default_value = AUTO)]
    pub engine: EngineKind,
}

/// The engine is chosen.
const AUTO: &str = "auto";

/// Name of an engine that is no more; whoever asks for it is told which one to take.
const LOCKSTEP: &str = "lockstep";

/// Names of the engines.
pub fn engine() -> impl TypedValueParser<Value = EngineKind> {
    let names = [AUTO].into_iter().chain(EngineKind::ALL.map(EngineKind::name)).map(PossibleValue::new);
    let names = PossibleValuesParser::new(names.chain([PossibleValue::new(LOCKSTEP).hide(true)]));
    names.try_map(|name| match name == LOCKSTEP {
        true => Err("lock-step was removed, because it was slower than `fast`; use `--engine fast`"),
        false => Ok(EngineKind::ALL.into_iter().find(|engine| engine.name() == name).unwrap_or_default()),
    })
}

/// Names of the layouts.
pub fn layout() -> impl TypedValueParser<Value = Layout> {
    let names = PossibleValuesParser::new(Layout::ALL.iter().map(|layout| layout.name()));
    names.map(|name| name.parse().expect("the parser lets only names pass"))
}
