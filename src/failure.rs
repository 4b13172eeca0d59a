//! The end of a command: its exit code, and its message when it could not do its work.

use messages::{Diagnostic, Report};

/// Exit codes of all commands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Exit {
    /// The command did what it was asked for.
    Done = 0,
    /// The input has errors, or cannot be read, or a result cannot be written.
    Input = 1,
    /// The command line is wrong.
    Usage = 2,
    /// A program on the emulated machine trapped.
    Trap = 3,
    /// A comparison is out of its tolerance.
    Tolerance = 4,
    /// A program took more instructions than it may.
    StepLimit = 5,
}

impl Exit {
    /// Exit code of a command that ends with a trap.
    pub fn of_trap(trap: &emu::trap::Trap) -> Exit {
        match trap.kind {
            emu::trap::Fault::StepLimit(_) => Exit::StepLimit,
            _ => Exit::Trap,
        }
    }
}

/// A reason for which a command did not do its work.
#[derive(Debug)]
pub enum Failure {
    /// Messages for the user.
    Message {
        /// The messages.
        report: Report,
        /// The exit code.
        exit: Exit,
    },
    /// Whoever read the results does not want more of them.
    ClosedPipe,
}

impl Failure {
    /// A wrong command line that the parser could not see.
    pub fn usage(message: impl Into<Report>) -> Failure {
        Failure::Message { report: message.into(), exit: Exit::Usage }
    }
}

impl From<Report> for Failure {
    fn from(report: Report) -> Failure {
        Failure::Message { report, exit: Exit::Input }
    }
}

impl From<Diagnostic> for Failure {
    fn from(message: Diagnostic) -> Failure {
        Report::from(message).into()
    }
}

impl From<emu::machine::RunFailure> for Failure {
    fn from(failure: emu::machine::RunFailure) -> Failure {
        let exit = match &failure {
            emu::machine::RunFailure::Setup(_) => Exit::Input,
            emu::machine::RunFailure::Trap(trap) => Exit::of_trap(trap),
        };
        Failure::Message { report: failure.report(), exit }
    }
}
