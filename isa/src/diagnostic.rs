//! What a reader of a file has to say to a person: place, source line, carets, hint. All readers of the
//! project (assembly, extensions, scenes, machines) report through these types; no reader prints by itself.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};

/// The text of one file as it was read, with the name that messages show.
#[derive(Debug, PartialEq, Eq)]
pub struct Source {
    /// Path as the user gave it (or a name in angle brackets for text that is no file).
    pub name: String,
    /// The whole text; bytes that are not UTF-8 have been replaced.
    pub text: String,
}

impl Source {
    /// A shared source from its name and text.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Arc<Source> {
        Arc::new(Source { name: name.into(), text: text.into() })
    }

    /// Line and column of an octet offset, both from 1; columns count characters.
    pub fn line_column(&self, offset: usize) -> (usize, usize) {
        let offset = floor_boundary(&self.text, offset);
        let before = &self.text[..offset];
        let start = before.rfind('\n').map_or(0, |at| at + 1);
        let line = before.bytes().filter(|&octet| octet == b'\n').count() + 1;
        (line, self.text[start..offset].chars().count() + 1)
    }
}

/// A range of octets in a source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file.
    pub source: Arc<Source>,
    /// Octet offsets into its text; an empty range points at one character.
    pub span: Range<usize>,
}

impl Place {
    /// The place `span` of `source`.
    pub fn new(source: &Arc<Source>, span: Range<usize>) -> Place {
        Place { source: source.clone(), span }
    }
}

/// How much a message weighs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The input cannot be used.
    Error,
    /// The input is used, but something in it is likely a mistake.
    Warning,
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
    /// Where, and what the carets say.
    pub place: Option<(Place, String)>,
    /// Further places (a first definition, a macro's call), each with its label.
    pub others: Vec<(Place, String)>,
    /// What to try.
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

    /// The same with a stable code.
    pub fn code(mut self, code: &'static str) -> Diagnostic {
        self.code = Some(code);
        self
    }

    /// The same with a place and the text beside its carets.
    pub fn at(mut self, place: Place, label: impl Into<String>) -> Diagnostic {
        self.place = Some((place, label.into()));
        self
    }

    /// The same with one more place.
    pub fn also(mut self, place: Place, label: impl Into<String>) -> Diagnostic {
        self.others.push((place, label.into()));
        self
    }

    /// The same with a hint.
    pub fn hint(mut self, hint: impl Into<String>) -> Diagnostic {
        self.hint = Some(hint.into());
        self
    }

    /// The message as a person reads it, with or without terminal colours.
    pub fn render(&self, is_coloured: bool) -> String {
        let level = match self.severity {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
        };
        let mut title = level.primary_title(self.message.as_str());
        if let Some(code) = self.code {
            title = title.id(code);
        }
        let mut group = Group::with_title(title);
        if let Some((place, label)) = &self.place {
            group = group.element(snippet(place, label, AnnotationKind::Primary));
        }
        for (place, label) in &self.others {
            group = group.element(snippet(place, label, AnnotationKind::Context));
        }
        let mut groups = vec![group];
        if let Some(hint) = &self.hint {
            groups.push(Group::with_title(Level::HELP.secondary_title(hint.as_str())));
        }
        let renderer = if is_coloured { Renderer::styled() } else { Renderer::plain() };
        renderer.decor_style(DecorStyle::Ascii).render(&groups)
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

/// All messages about one input, in the order of the text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Report(pub Vec<Diagnostic>);

impl Report {
    /// Whether any message is an error.
    pub fn has_errors(&self) -> bool {
        self.0.iter().any(|message| message.severity == Severity::Error)
    }

    /// All messages, a blank line between them, and a closing count when there are several errors.
    pub fn render(&self, is_coloured: bool) -> String {
        let mut parts: Vec<String> = self.0.iter().map(|message| message.render(is_coloured)).collect();
        let errors = self.0.iter().filter(|message| message.severity == Severity::Error).count();
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

/// The name of `known` nearest to `name`, when near enough to be what was meant.
pub fn did_you_mean<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let allowed = (name.chars().count() / 3).max(1);
    known
        .into_iter()
        .map(|word| (strsim::damerau_levenshtein(&name.to_lowercase(), &word.to_lowercase()), word))
        .filter(|&(distance, _)| distance <= allowed)
        .min_by_key(|&(distance, word)| (distance, word.len(), word))
        .map(|(_, word)| word)
}

/// Longest part of a source line that a message shows, in octets; longer lines are cut around the place.
const SHOWN: usize = 160;

fn snippet<'a>(
    place: &'a Place,
    label: &'a str,
    kind: AnnotationKind,
) -> Snippet<'a, annotate_snippets::Annotation<'a>> {
    let text = &place.source.text;
    let from = floor_boundary(text, place.span.start);
    let line_start = text[..from].rfind('\n').map_or(0, |at| at + 1);
    let line_end = text[from..].find('\n').map_or(text.len(), |at| from + at);
    let cut_start = if from - line_start > SHOWN / 2 { floor_boundary(text, from - SHOWN / 2) } else { line_start };
    let cut_end = floor_boundary(text, line_end.min(cut_start + SHOWN)).max(from);
    let to = floor_boundary(text, place.span.end.clamp(from, cut_end)).max(from);
    let line = text[..line_start].bytes().filter(|&octet| octet == b'\n').count() + 1;
    let shown = text[cut_start..cut_end].trim_end_matches('\r');
    let clamp = |at: usize| (at - cut_start).min(shown.len());
    Snippet::source(shown)
        .path(place.source.name.as_str())
        .line_start(line)
        .annotation(kind.span(clamp(from)..clamp(to)).label(label))
}

fn floor_boundary(text: &str, offset: usize) -> usize {
    let mut at = offset.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_shows_place_line_carets_and_hint() {
        let source = Source::new("a.s", "    nop\n    vdto  s4, v1, v2\n");
        let message = Diagnostic::error("`vdto` is not an instruction")
            .code("E001")
            .at(Place::new(&source, 12..16), "unknown mnemonic")
            .hint("did you mean `vdot`?");
        let text = message.to_string();
        assert!(text.contains("a.s:2:5"), "{text}");
        assert!(text.contains("^^^^ unknown mnemonic"), "{text}");
        assert!(text.contains("help: did you mean `vdot`?"), "{text}");
    }

    #[test]
    fn places_at_the_ends_of_odd_texts_render() {
        for text in ["", "\n", "é", "a\r\nb\r\n", "x"] {
            let source = Source::new("t", text);
            for at in 0..=text.len() + 1 {
                let shown = Diagnostic::error("m").at(Place::new(&source, at..at + 3), "l").to_string();
                assert!(shown.contains("error: m"), "{text:?} {at}");
            }
        }
    }

    #[test]
    fn near_names_are_suggested_and_far_ones_are_not() {
        assert_eq!(did_you_mean("vdto", ["vdot", "vadd"]), Some("vdot"));
        assert_eq!(did_you_mean("xyzzy", ["vdot", "vadd"]), None);
    }
}
