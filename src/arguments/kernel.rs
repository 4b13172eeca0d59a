//! Options that choose the kernels.

use std::path::PathBuf;

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use kernels::{Function, KernelSet};
use messages::Diagnostic;

use super::ExtensionArguments;

/// Options of the kernels.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Kernels")]
pub struct KernelArguments {
    /// Set of kernels.
    #[arg(long, value_name = "NAME", value_parser = profile(), default_value = KernelSet::default().name())]
    pub profile: KernelSet,
    #[command(flatten)]
    #[allow(missing_docs, reason = "the group has its own")]
    pub files: KernelFileArguments,
}

/// Files of the user's own.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Kernels")]
pub struct KernelFileArguments {
    /// Assembly file that serves one function instead of the profile's own; may be repeated.
    #[arg(long = "kernel", value_name = "FUNCTION=FILE", value_parser = replacement)]
    pub replaced: Vec<(Function, PathBuf)>,
    #[command(flatten)]
    #[allow(missing_docs, reason = "the group has its own")]
    pub extensions: ExtensionArguments,
}

fn profile() -> impl TypedValueParser<Value = KernelSet> {
    let names = PossibleValuesParser::new(KernelSet::ALL.iter().map(|profile| profile.name()));
    names.map(|name| name.parse().expect("the parser lets only names pass"))
}

fn replacement(text: &str) -> Result<(Function, PathBuf), String> {
    let (function, path) = text.split_once('=').ok_or("a function, `=` and a file are expected")?;
    let function = function.trim().parse().map_err(|message: Box<Diagnostic>| plain(&message))?;
    if path.is_empty() { Err("there is no file after `=`".into()) } else { Ok((function, path.into())) }
}

/// A message in one line, for errors of usage.
pub fn plain(message: &Diagnostic) -> String {
    match &message.hint {
        Some(hint) => format!("{}; {hint}", message.message),
        None => message.message.clone(),
    }
}
