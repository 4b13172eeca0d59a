//! One message about an input: severity, code, places, hint.

use std::fmt;

use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{AnnotationKind, Group, Level, Renderer};

use crate::Place;
use crate::snippet::with_snippet;
use crate::visible::sentence;

/// Weight of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The input cannot be used.
    Error,
    /// The input is used, but something in it is likely a mistake.
    Warning,
    /// Says how many messages were left out, that many errors among them.
    Note {
        /// Errors that no message of the report shows.
        errors: usize,
    },
}

/// One message about an input.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Error or warning.
    pub severity: Severity,
    /// Stable code such as `E012`, where the message has one.
    pub code: Option<&'static str>,
    /// One sentence without a full stop: what is wrong.
    pub message: String,
    /// Place of the mistake, and the text beside the carets.
    pub place: Option<(Place, String)>,
    /// Further places (a first definition, a macro's call), each with its label.
    pub others: Vec<(Place, String)>,
    /// Advice on what to try.
    pub hint: Option<String>,
}

impl Diagnostic {
    /// An error without a place.
    pub fn error(message: impl Into<String>) -> Diagnostic {
        Diagnostic {
            severity: Severity::Error,
            code: None,
            message: message.into(),
            place: None,
            others: Vec::new(),
            hint: None,
        }
    }

    /// A warning without a place.
    pub fn warning(message: impl Into<String>) -> Diagnostic {
        Diagnostic { severity: Severity::Warning, ..Diagnostic::error(message) }
    }

    /// A note on what is not shown, with that many errors in it.
    pub fn note(message: impl Into<String>, errors: usize) -> Diagnostic {
        Diagnostic { severity: Severity::Note { errors }, ..Diagnostic::error(message) }
    }

    /// Number of errors that the message stands for.
    pub fn errors(&self) -> usize {
        match self.severity {
            Severity::Error => 1,
            Severity::Warning => 0,
            Severity::Note { errors } => errors,
        }
    }

    /// Adds a stable code.
    pub fn code(mut self, code: &'static str) -> Diagnostic {
        self.code = Some(code);
        self
    }

    /// Sets the place, with the text beside its carets.
    pub fn at(mut self, place: Place, label: impl Into<String>) -> Diagnostic {
        self.place = Some((place, label.into()));
        self
    }

    /// Adds one more place.
    pub fn also(mut self, place: Place, label: impl Into<String>) -> Diagnostic {
        self.others.push((place, label.into()));
        self
    }

    /// Adds a hint.
    pub fn hint(mut self, hint: impl Into<String>) -> Diagnostic {
        self.hint = Some(hint.into());
        self
    }

    /// The message as a person reads it, with or without terminal colours.
    pub fn render(&self, is_coloured: bool) -> String {
        let level = match self.severity {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
            Severity::Note { .. } => Level::NOTE,
        };
        // The first line, with the code in brackets.
        let mut title = level.primary_title(sentence(&self.message));
        if let Some(code) = self.code {
            title = title.id(code);
        }
        let mut group = Group::with_title(title);
        // One snippet a place; where its line was cut, the renderer's column is mended below.
        let mut columns = Vec::new();
        if let Some((place, label)) = &self.place {
            let (with, cut) = with_snippet(group, place, label, AnnotationKind::Primary);
            group = with;
            columns.extend(cut);
        }
        for (place, label) in &self.others {
            let (with, cut) = with_snippet(group, place, label, AnnotationKind::Context);
            group = with;
            columns.extend(cut);
        }
        let mut groups = vec![group];
        if let Some(hint) = &self.hint {
            groups.push(Group::with_title(Level::HELP.secondary_title(sentence(hint))));
        }
        // Plain characters draw the margin, so that files and terminals of all kinds show it.
        let renderer = if is_coloured { Renderer::styled() } else { Renderer::plain() };
        let text = renderer.decor_style(DecorStyle::Ascii).render(&groups);
        columns.into_iter().fold(text, |text, (wrong, right)| text.replacen(&wrong, &right, 1))
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}
