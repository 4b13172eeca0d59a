//! `lancer explain`: what a code of the assembler's messages means, or an instruction does, with an example.

use asm::explain::{CODES, find};
use clap::Args;
use isa::Isa;
use messages::{Diagnostic, did_you_mean};

use crate::failure::{Exit, Failure};
use crate::manual;
use crate::terminal::Terminal;

const EXAMPLES: &str = "\
Examples:
  lancer explain E003
  lancer explain vdot         as lancer manual vdot
  lancer explain              all codes, a line each";

/// Explains a code of the assembler's messages, or an instruction, a directive or a function.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct ExplainArguments {
    /// Code such as E003, or a name such as vdot; without one, all codes are listed.
    #[arg(value_name = "CODE|NAME")]
    code: Option<String>,
}

/// Prints the explanation, or the list.
pub(super) fn execute(arguments: &ExplainArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let Some(name) = &arguments.code else {
        let lines: Vec<String> = CODES.iter().map(|code| format!("{}  {}\n", code.code, code.title)).collect();
        terminal.tell(&lines.concat())?;
        return Ok(Exit::Done);
    };
    let isa = Isa::base();
    if let Some(page) = manual::page(name, &isa) {
        terminal.print(&page)?;
        return Ok(Exit::Done);
    }
    let Some(code) = find(name) else {
        let message = Diagnostic::error(format!("`{name}` is no code of the assembler's messages, and no instruction"));
        let names = manual::names(&isa);
        let known = CODES.iter().map(|code| code.code).chain(names.iter().map(String::as_str));
        return Err(match did_you_mean(name, known) {
            Some(hint) => message.hint(format!("{hint} `lancer explain` lists all")),
            None => message.hint("`lancer explain` lists all"),
        }
        .into());
    };
    terminal.tell(&format!("{}: {}\n\n{}\n", code.code, code.title, code.text))?;
    Ok(Exit::Done)
}
