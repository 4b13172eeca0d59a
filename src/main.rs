//! The program `lancer`: reads its command line and ends with the command's exit code.

use std::ffi::OsString;
use std::io::{self, ErrorKind, Write};
use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches};
use lancer::command::invocation::{self, CommandSettings};
use lancer::command::{self, Lancer};
use lancer::failure::{Exit, Failure};
use lancer::terminal::Terminal;
use messages::{Diagnostic, Report};

fn main() -> ExitCode {
    let mut terminal = Terminal::new();
    let line = match invocation::expanded(std::env::args_os().collect()) {
        Ok(line) => line,
        Err(report) => {
            terminal.show(&report);
            return ExitCode::from(Exit::Input as u8);
        }
    };
    let (arguments, given) = match parse(line) {
        Ok(parsed) => parsed,
        // Help and version are results: a full disk must not pass for success.
        Err(message) if !message.use_stderr() => match message.print().and_then(|()| io::stdout().flush()) {
            Err(error) if error.kind() != ErrorKind::BrokenPipe => {
                let message = format!("standard output cannot be written: {error}");
                terminal.show(&Report::from(Diagnostic::error(message)));
                return ExitCode::from(Exit::Input as u8);
            }
            _ => return ExitCode::SUCCESS,
        },
        Err(message) => message.exit(),
    };
    let exit = match command::execute(&arguments, &given, &mut terminal) {
        Ok(exit) => exit,
        Err(Failure::ClosedPipe) => Exit::Done,
        Err(Failure::Message { report, exit }) => {
            terminal.show(&report);
            exit
        }
    };
    ExitCode::from(exit as u8)
}

/// Reads a command line, and keeps its options as settings.
fn parse(line: Vec<OsString>) -> Result<(Lancer, CommandSettings), clap::Error> {
    let matches = Lancer::command().try_get_matches_from(line)?;
    let arguments = Lancer::from_arg_matches(&matches).map_err(|error| error.format(&mut Lancer::command()))?;
    Ok((arguments, CommandSettings::new(&matches)))
}
