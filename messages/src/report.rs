//! All messages about one input.

use std::fmt;

use crate::Diagnostic;

/// All messages about one input, in the order of the text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Report(pub Vec<Diagnostic>);

impl Report {
    /// Some message is an error.
    pub fn has_errors(&self) -> bool {
        self.0.iter().any(|message| message.errors() > 0)
    }

    /// All messages, a blank line between them, and a closing count when there are several errors, with those that are
    /// not shown.
    pub fn render(&self, is_coloured: bool) -> String {
        let mut parts: Vec<String> = self.0.iter().map(|message| message.render(is_coloured)).collect();
        let errors: usize = self.0.iter().map(Diagnostic::errors).sum();
        if errors > 1 {
            parts.push(format!("{errors} errors"));
        }
        parts.join("\n\n")
    }
}

impl From<Diagnostic> for Report {
    fn from(message: Diagnostic) -> Report {
        Report(vec![message])
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for Report {}
