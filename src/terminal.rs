//! Streams of a command: results to standard output, progress and messages to standard error, colours only
//! where a terminal shows them.

use std::ffi::OsStr;
use std::io::{self, ErrorKind, IsTerminal, Write};

use indicatif::{ProgressBar, ProgressStyle};
use messages::{Diagnostic, Report};

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
        let variable = |name| std::env::var_os(name);
        let is_dumb = variable("TERM").is_some_and(|value| value == "dumb");
        let is_coloured = is_coloured(is_watched && !is_dumb, variable("NO_COLOR").as_deref());
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

/// True where messages have colours, given whether a terminal would show them and the value of `NO_COLOR`, which switches
/// them off by any value but an empty one (<https://no-color.org>).
fn is_coloured(is_shown: bool, no_color: Option<&OsStr>) -> bool {
    is_shown && no_color.is_none_or(OsStr::is_empty)
}

impl Default for Terminal {
    fn default() -> Terminal {
        Terminal::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_need_a_terminal_and_no_veto() {
        let cases = [
            (false, None, false),
            (true, None, true),
            (true, Some(""), true),
            (true, Some("1"), false),
            (true, Some("0"), false),
            (false, Some(""), false),
        ];
        for (is_shown, no_color, expected) in cases {
            assert_eq!(is_coloured(is_shown, no_color.map(OsStr::new)), expected, "{is_shown} {no_color:?}");
        }
    }
}
