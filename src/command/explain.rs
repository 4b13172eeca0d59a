//! `lancer explain`: what a code of the assembler's messages means, with an example.

use asm::explain::{CODES, find};
use clap::Args;
use messages::{Diagnostic, did_you_mean};

use crate::failure::{Exit, Failure};
use crate::terminal::Terminal;

const EXAMPLES: &str = "\
Examples:
  lancer explain E003
  lancer explain              all codes, a line each";

/// Explains a code of the assembler's messages.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct ExplainArguments {
    /// The code, such as E003; without one, all codes are listed.
    #[arg(value_name = "CODE")]
    code: Option<String>,
}

/// Prints the explanation, or the list.
pub(super) fn execute(arguments: &ExplainArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let Some(name) = &arguments.code else {
        let lines: Vec<String> = CODES.iter().map(|code| format!("{}  {}\n", code.code, code.title)).collect();
        terminal.tell(&lines.concat())?;
        return Ok(Exit::Done);
    };
    let Some(code) = find(name) else {
        let message = Diagnostic::error(format!("`{name}` is no code of the assembler's messages"));
        return Err(match did_you_mean(name, CODES.iter().map(|code| code.code)) {
            Some(hint) => message.hint(format!("{hint} `lancer explain` lists all")),
            None => message.hint("`lancer explain` lists all"),
        }
        .into());
    };
    terminal.tell(&format!("{}: {}\n\n{}\n", code.code, code.title, code.text))?;
    Ok(Exit::Done)
}
