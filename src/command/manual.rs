//! `lancer manual`: the manual of the instruction set and of the assembler, and the man page of the command.

use std::path::PathBuf;

use clap::{Args, Command, ValueEnum};
use clap_mangen::Man;
use isa::Isa;
use messages::{Diagnostic, did_you_mean};

use super::invocation::COMMAND_LINE;
use crate::arguments::ExtensionArguments;
use crate::failure::{Exit, Failure};
use crate::terminal::Terminal;
use crate::{files, manual};

const EXAMPLES: &str = "\
Examples:
  lancer manual vdot                            # one instruction; also li, .holds and the like
  lancer manual | less
  lancer manual --as html -o manual.html
  lancer manual --as man -o lancer.1";

/// Forms of the manual.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum ManualForm {
    /// The instruction set and the assembler, as Markdown.
    Markdown,
    /// The manual as one HTML page.
    Html,
    /// The man page of the command.
    Man,
}

/// Prints the manual of the instruction set and of the assembler.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct ManualArguments {
    /// Instruction, pseudo-instruction, directive or function of expressions; without one, all of the manual.
    #[arg(value_name = "TOPIC")]
    topic: Option<String>,
    /// Form to write.
    #[arg(long = "as", value_name = "FORM", value_enum, default_value = "markdown")]
    form: ManualForm,
    #[command(flatten)]
    extensions: ExtensionArguments,
    /// File to write instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Prints or writes the manual.
pub(super) fn execute(arguments: &ManualArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let isa = arguments.extensions.isa()?;
    if let Some(topic) = &arguments.topic {
        if arguments.form != ManualForm::Markdown {
            let message = Diagnostic::error(format!("`{topic}` alone has no other form than text"));
            return Err(Failure::usage(message.hint("leave out `--as`, or the topic")));
        }
        let page = page_of(topic, &isa)?;
        match &arguments.output {
            Some(path) => files::write(path, page.as_bytes())?,
            None => terminal.print(&page)?,
        }
        return Ok(Exit::Done);
    }
    let octets = match arguments.form {
        ManualForm::Markdown => manual::markdown(&isa).into_bytes(),
        ManualForm::Html => manual::html(&isa).into_bytes(),
        ManualForm::Man => man_page().into_bytes(),
    };
    match &arguments.output {
        Some(path) => files::write(path, &octets)?,
        None => terminal.print_octets(&octets)?,
    }
    Ok(Exit::Done)
}

/// The page of a topic.
///
/// # Errors
/// A name that is none, with one that is near.
pub(super) fn page_of(topic: &str, isa: &Isa) -> Result<String, Failure> {
    manual::page(topic, isa).ok_or_else(|| {
        let names = manual::names(isa);
        let message = Diagnostic::error(format!("`{topic}` is no instruction, directive or function of the assembler"));
        match did_you_mean(topic, names.iter().map(String::as_str)) {
            Some(hint) => message.hint(hint).into(),
            None => message.hint("`lancer manual` has an index of all names").into(),
        }
    })
}

/// The man page of all commands in one: that of `lancer`, then a section for each command below it.
fn man_page() -> String {
    let mut command = COMMAND_LINE.clone();
    command.build();
    let page = rendered(|out| Man::new(command.clone()).render(out)).replace(".SH EXTRA", ".SH EXAMPLES");
    // There are no pages of their own for the commands: their sections follow.
    let mut page = with_values(&command, &page).replace("lancer\\-", "lancer ").replace("(1)\n", "\n");
    for command in command.get_subcommands() {
        add_section(command, &mut page);
    }
    page
}

fn add_section(command: &Command, page: &mut String) {
    if command.get_name() == "help" {
        return;
    }
    let name = command.get_bin_name().unwrap_or_else(|| command.get_name());
    let man = Man::new(command.clone());
    let text = rendered(|out| {
        man.render_synopsis_section(out)?;
        man.render_description_section(out)?;
        if command.get_opts().chain(command.get_positionals()).next().is_some() {
            man.render_options_section(out)?;
        }
        man.render_extra_section(out)
    });
    let text = with_values(command, &text);
    page.push_str(&format!(".SH \"{}\"\n", name.to_uppercase()));
    // Sections of a command are below its own, and each begins with the same definitions.
    let lines = text.lines().filter(|line| !line.starts_with(".ie") && !line.starts_with(".el"));
    page.extend(lines.map(|line| line.replace(".SH EXTRA", ".SS EXAMPLES").replace(".SH ", ".SS ") + "\n"));
    for command in command.get_subcommands() {
        add_section(command, page);
    }
}

/// The page with the names of the options' values in its synopsis, which has the bare options.
fn with_values(command: &Command, page: &str) -> String {
    let mut page = page.to_owned();
    for option in command.get_opts() {
        let (Some(name), Some([value, ..])) = (option.get_long(), option.get_value_names()) else { continue };
        let bare = format!("\\fB\\-\\-{}\\fR]", name.replace('-', "\\-"));
        let full = format!("{} \\fI{}\\fR]", bare.trim_end_matches(']'), value.replace('-', "\\-"));
        page = page.replacen(&bare, &full, 1);
    }
    page
}

fn rendered(render: impl FnOnce(&mut Vec<u8>) -> std::io::Result<()>) -> String {
    let mut octets = Vec::new();
    render(&mut octets).expect("writing to memory does not fail");
    String::from_utf8(octets).expect("help texts are UTF-8")
}
