//! Where results and messages go: results to standard output, progress and messages to standard error, colours only
//! where a terminal shows them.

use std::io::{self, ErrorKind, IsTerminal, Write};

use indicatif::{ProgressBar, ProgressStyle};
use isa::diagnostic::{Diagnostic, Report};

use crate::failure::Failure;

/// The two streams of a command.
pub struct Terminal {
    out: Box<dyn Write>,
    is_coloured: bool,
    is_watched: bool,
}

impl Terminal {
    /// The process's own streams.
    pub fn new() -> Terminal {
        let is_watched = io::stderr().is_terminal();
        // https://no-color.org: any value but an empty one switches colours off.
        let is_unwanted = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
        let is_dumb = std::env::var_os("TERM").is_some_and(|value| value == "dumb");
        let is_coloured = is_watched && !is_unwanted && !is_dumb;
        Terminal { out: Box::new(io::BufWriter::new(io::stdout())), is_coloured, is_watched: is_watched && !is_dumb }
    }

    /// Writes a result.
    ///
    /// # Errors
    /// A reader that went away, or a full disk.
    pub fn print(&mut self, text: &str) -> Result<(), Failure> {
        self.print_octets(text.as_bytes())
    }

    /// Writes a result that is no text.
    ///
    /// # Errors
    /// See [`Terminal::print`].
    pub fn print_octets(&mut self, octets: &[u8]) -> Result<(), Failure> {
        self.out.write_all(octets).and_then(|()| self.out.flush()).map_err(|error| match error.kind() {
            ErrorKind::BrokenPipe => Failure::ClosedPipe,
            _ => Diagnostic::error(format!("standard output cannot be written: {error}")).into(),
        })
    }

    /// Shows messages about an input; nothing when there are none.
    pub fn show(&self, report: &Report) {
        if !report.0.is_empty() {
            self.say(&report.render(self.is_coloured));
        }
    }

    /// Says something that is no result.
    pub fn say(&self, text: &str) {
        // Nobody is left to be told when standard error is closed.
        let _ = writeln!(io::stderr(), "{text}");
    }

    /// A bar that shows how far a work of `length` steps has come; it is invisible where standard error is no terminal,
    /// and vanishes when it is finished.
    pub fn progress(&self, what: &str, length: u64) -> ProgressBar {
        if !self.is_watched {
            return ProgressBar::hidden();
        }
        let style = ProgressStyle::with_template("{msg:<24} [{bar:40}] {percent:>3} %  {eta_precise} left")
            .expect("the template is valid")
            .progress_chars("=> ");
        ProgressBar::new(length).with_style(style).with_message(what.to_owned())
    }
}

impl Default for Terminal {
    fn default() -> Terminal {
        Terminal::new()
    }
}
