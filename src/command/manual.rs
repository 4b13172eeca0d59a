//! `lancer manual`: the manual of the instruction set and of the assembler, and the man page of the command.

use std::path::PathBuf;

use clap::{Args, CommandFactory, ValueEnum};
use isa::Isa;

use super::Lancer;
use crate::failure::{Exit, Failure};
use crate::terminal::Terminal;
use crate::{files, manual};

const EXAMPLES: &str = "\
Examples:
  lancer manual | less
  lancer manual --as html -o manual.html
  lancer manual --as man -o lancer.1";

/// What is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Form {
    /// The instruction set and the assembler, as Markdown.
    Markdown,
    /// The same as one HTML page.
    Html,
    /// The man page of the command.
    Man,
}

/// Prints the manual of the instruction set and of the assembler.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct ManualArguments {
    /// What to write.
    #[arg(long = "as", value_name = "FORM", value_enum, default_value = "markdown")]
    form: Form,
    /// File to write instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Prints or writes the manual.
pub(super) fn execute(arguments: &ManualArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let octets = match arguments.form {
        Form::Markdown => manual::markdown(&Isa::base()).into_bytes(),
        Form::Html => manual::html(&Isa::base()).into_bytes(),
        Form::Man => {
            let mut page = Vec::new();
            clap_mangen::Man::new(Lancer::command()).render(&mut page).expect("writing to memory does not fail");
            page
        }
    };
    match &arguments.output {
        Some(path) => files::write(path, &octets)?,
        None => terminal.print_octets(&octets)?,
    }
    Ok(Exit::Done)
}
