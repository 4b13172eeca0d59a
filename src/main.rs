//! The program `lancer`: reads its command line and ends with the command's exit code.

use std::io::{self, ErrorKind, Write};
use std::process::ExitCode;

use clap::Parser;
use lancer::command::{self, Lancer};
use lancer::failure::{Exit, Failure};
use lancer::terminal::Terminal;
use messages::{Diagnostic, Report};

fn main() -> ExitCode {
    let mut terminal = Terminal::new();
    let arguments = match Lancer::try_parse() {
        Ok(arguments) => arguments,
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
    let exit = match command::execute(&arguments, &mut terminal) {
        Ok(exit) => exit,
        Err(Failure::ClosedPipe) => Exit::Done,
        Err(Failure::Message { report, exit }) => {
            terminal.show(&report);
            exit
        }
    };
    ExitCode::from(exit as u8)
}
