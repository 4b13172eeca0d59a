//! The program `lancer`: reads its command line and ends with the command's exit code.

use std::ffi::OsString;
use std::io::{self, ErrorKind, Write};
use std::process::ExitCode;
#[cfg(unix)]
use std::sync::{Arc, atomic::AtomicBool};

use lancer::command::invocation;
use lancer::command::{self, Lancer};
use lancer::failure::{Exit, Failure};
use lancer::terminal::{StreamArguments, Terminal};
use messages::{Diagnostic, Report};

fn main() -> ExitCode {
    // A file beyond the size that the system allows is an error of writing, with a message, and no end of the program. Where the signal cannot be
    // taken, all stays as it was.
    #[cfg(unix)]
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::new(AtomicBool::new(false)));
    let words: Vec<OsString> = std::env::args_os().collect();
    let streams = StreamArguments::sniffed(&words);
    let mut terminal = Terminal::new(streams);
    let words = match invocation::expanded(words) {
        Ok(words) => words,
        Err(report) => {
            terminal.show(&report);
            return ExitCode::from(Exit::Input as u8);
        }
    };
    let (arguments, given) = match Lancer::parsed(words, streams) {
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
        Err(message) => {
            terminal.show_usage(&message);
            return ExitCode::from(Exit::Usage as u8);
        }
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
