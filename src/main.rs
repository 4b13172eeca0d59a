//! The program `lancer`: reads its command line and ends with the command's exit code.

use std::process::ExitCode;

use clap::Parser;
use lancer::command::{self, Lancer};
use lancer::failure::{Exit, Failure};
use lancer::terminal::Terminal;

fn main() -> ExitCode {
    let arguments = Lancer::parse();
    let mut terminal = Terminal::new();
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
