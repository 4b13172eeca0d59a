//! `lancer completions`: scripts by which shells complete command lines.

use clap::Args;
use clap_complete::Shell;

use super::invocation::COMMAND_LINE;
use crate::failure::{Exit, Failure};
use crate::terminal::Terminal;

const EXAMPLES: &str = "\
Examples:
  lancer completions bash > ~/.local/share/bash-completion/completions/lancer
  lancer completions zsh > ~/.zfunc/_lancer
  lancer completions fish > ~/.config/fish/completions/lancer.fish";

/// Prints the script by which a shell completes lancer's commands and options.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct CompletionsArguments {
    /// The shell.
    #[arg(value_name = "SHELL")]
    shell: Shell,
}

/// Prints the script.
pub(super) fn execute(arguments: &CompletionsArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut COMMAND_LINE.clone(), "lancer", &mut script);
    terminal.print_octets(&script)?;
    Ok(Exit::Done)
}
