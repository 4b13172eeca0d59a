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

    /// A note on what is not shown, with that many errors in it.
    pub fn note(message: impl Into<String>, errors: usize) -> Diagnostic {
        Diagnostic { severity: Severity::Note { errors }, ..Diagnostic::error(message) }
    }

    /// How many errors it stands for.
    pub fn errors(&self) -> usize {
        match self.severity {
            Severity::Error => 1,
            Severity::Warning => 0,
            Severity::Note { errors } => errors,
        }
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
            Severity::Note { .. } => Level::NOTE,
        };
        let mut title = level.primary_title(self.message.as_str());
        if let Some(code) = self.code {
            title = title.id(code);
        }
        let mut group = Group::with_title(title);
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
            groups.push(Group::with_title(Level::HELP.secondary_title(hint.as_str())));
        }
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

/// All messages about one input, in the order of the text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Report(pub Vec<Diagnostic>);

impl Report {
    /// Whether any message is an error.
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

/// What stands where a line was cut.
const CUT: &str = "...";

/// Marks the name of a file whose line was cut; nobody's text has this character of the private area.
const STAND_IN: char = '\u{f8fd}';

/// The group with a part of a source, and what to replace in the text that is made of it by what.
fn with_snippet<'a>(
    group: Group<'a>,
    place: &'a Place,
    label: &'a str,
    kind: AnnotationKind,
) -> (Group<'a>, Option<(String, String)>) {
    let text = &place.source.text;
    let from = floor_boundary(text, place.span.start);
    let line_start = text[..from].rfind('\n').map_or(0, |at| at + 1);
    let line_end = text[from..].find('\n').map_or(text.len(), |at| from + at);
    let cut_start = if from - line_start > SHOWN / 2 { floor_boundary(text, from - SHOWN / 2) } else { line_start };
    let cut_end = floor_boundary(text, line_end.min(cut_start + SHOWN)).max(from);
    let to = floor_boundary(text, place.span.end.clamp(from, cut_end)).max(from);
    let line = text[..line_start].bytes().filter(|&octet| octet == b'\n').count() + 1;
    let shown = text[cut_start..cut_end].trim_end_matches('\r');
    let before = if cut_start > line_start { CUT } else { "" };
    let behind = if cut_end < line_end { CUT } else { "" };
    let clamp = |at: usize| before.len() + (at - cut_start).min(shown.len());
    let name = place.source.name.as_str();
    let snippet = Snippet::source(format!("{before}{shown}{behind}"))
        .line_start(line)
        .annotation(kind.span(clamp(from)..clamp(to)).label(label));
    if before.is_empty() {
        return (group.element(snippet.path(name)), None);
    }
    // The renderer knows the part alone: its column becomes that of the file afterwards.
    let column = |start: usize| text[start..from].chars().count() + 1;
    let wrong = format!("{name}{STAND_IN}:{line}:{}", before.len() + column(cut_start));
    let right = format!("{name}:{line}:{}", column(line_start));
    (group.element(snippet.path(format!("{name}{STAND_IN}"))), Some((wrong, right)))
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
    fn a_long_line_is_cut_around_the_place_and_keeps_its_column() {
        let source = Source::new("t", format!("a\n{}here{}\nb", "x ".repeat(500), " y".repeat(500)));
        let text = Diagnostic::error("m").at(Place::new(&source, 1002..1006), "label").to_string();
        assert!(text.contains("t:2:1001\n"), "{text}");
        assert!(text.contains("| ...x x") && text.contains("y...\n") && text.contains(" ^^^^ label"), "{text}");
        let (code, carets) = (text.lines().find(|line| line.contains("here")), text.lines().last());
        assert_eq!(code.and_then(|line| line.find("here")), carets.and_then(|line| line.find("^^^^")), "{text}");
    }

    #[test]
    fn errors_that_are_not_shown_are_counted() {
        let report = Report(vec![Diagnostic::warning("w"), Diagnostic::note("7 more messages are not shown", 5)]);
        assert!(
            report.has_errors() && report.render(false).ends_with("note: 7 more messages are not shown\n\n5 errors")
        );
        assert!(!Report(vec![Diagnostic::note("n", 0)]).has_errors());
    }

    #[test]
    fn near_names_are_suggested_and_far_ones_are_not() {
        assert_eq!(did_you_mean("vdto", ["vdot", "vadd"]), Some("vdot"));
        assert_eq!(did_you_mean("xyzzy", ["vdot", "vadd"]), None);
    }
}
