//! Messages to people as JSON: one object a line on standard error, as `--message-format json` asks for. What a message says
//! is the crate `messages`' business.

use messages::{Diagnostic, Place, Severity};
use schemars::JsonSchema;
use serde::Serialize;

/// Version of [`JsonMessage`].
pub const SCHEMA: &str = "lancer-message-1";

/// A message about an input, a command line or a result.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct JsonMessage {
    /// Version of the message: a key that goes away or changes its meaning changes it, a new key does not.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: &'static str,
    /// Weight: `error` (the input cannot be used), `warning` (likely a mistake) or `note` (neither).
    pub severity: &'static str,
    /// Stable code such as `E012`, which `lancer explain` explains; null for a message that has none.
    pub code: Option<&'static str>,
    /// The message in one sentence without a full stop.
    pub message: String,
    /// Places that it is about, the place of the mistake first; none of a message that has no place in a file.
    pub spans: Vec<JsonSpan>,
    /// Advice on what to try; null where there is none.
    pub help: Option<String>,
    /// Errors that the message stands for: 1 for an error, 0 for a warning; for a note on what is not shown, the errors among it.
    pub errors: usize,
    /// The message as people read it, lines between `\n`, without colours.
    pub rendered: String,
}

/// A place of a message.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct JsonSpan {
    /// Path of the file as the user gave it; `<standard input>` for that.
    pub file: String,
    /// Line of the first character, from 1.
    pub line: usize,
    /// Column of the first character, in characters from 1.
    pub column: usize,
    /// Line of the end, from 1.
    pub end_line: usize,
    /// Column behind the last character, in characters from 1.
    pub end_column: usize,
    /// Offset of the first octet in the text.
    pub start: usize,
    /// Offset behind the last octet.
    pub end: usize,
    /// True of the place of the mistake; others are a first definition, a macro's call and the like.
    pub is_primary: bool,
    /// Text beside the place; null where there is none.
    pub label: Option<String>,
}

impl JsonSpan {
    fn new(place: &Place, label: &str, is_primary: bool) -> JsonSpan {
        let length = place.source.text.len();
        let (start, end) = (place.span.start.min(length), place.span.end.min(length));
        let ((line, column), (end_line, end_column)) = (place.source.line_column(start), place.source.line_column(end));
        let label = (!label.is_empty()).then(|| label.to_owned());
        JsonSpan { file: place.source.name.clone(), line, column, end_line, end_column, start, end, is_primary, label }
    }
}

impl JsonMessage {
    /// The message of a reader of an input.
    pub fn new(message: &Diagnostic) -> JsonMessage {
        let primary = message.place.iter().map(|(place, label)| JsonSpan::new(place, label, true));
        let others = message.others.iter().map(|(place, label)| JsonSpan::new(place, label, false));
        JsonMessage {
            schema: SCHEMA,
            severity: match message.severity {
                Severity::Error => "error",
                Severity::Warning => "warning",
                Severity::Note { .. } => "note",
            },
            code: message.code,
            message: message.message.clone(),
            spans: primary.chain(others).collect(),
            help: message.hint.clone(),
            errors: message.errors(),
            rendered: message.render(false),
        }
    }

    /// The message in one line.
    pub fn line(&self) -> String {
        serde_json::to_string(self).expect("texts and numbers are JSON")
    }
}

#[cfg(test)]
mod tests {
    use messages::Source;

    use super::*;

    #[test]
    fn a_message_has_its_places_with_lines_columns_and_offsets() {
        let source = Source::new("a.s", "; é\n    vdto  s4, v1\n");
        let message = Diagnostic::error("`vdto` is not an instruction")
            .code("E003")
            .at(Place::new(&source, 9..13), "unknown")
            .also(Place::new(&source, 0..0), "")
            .hint("did you mean `vdot`?");
        let json = JsonMessage::new(&message);
        assert_eq!((json.severity, json.code, json.errors), ("error", Some("E003"), 1));
        assert_eq!(json.help.as_deref(), Some("did you mean `vdot`?"));
        let first = &json.spans[0];
        assert_eq!((first.line, first.column, first.end_line, first.end_column), (2, 5, 2, 9));
        assert_eq!((first.start, first.end, first.is_primary, first.label.as_deref()), (9, 13, true, Some("unknown")));
        assert_eq!((json.spans[1].is_primary, &json.spans[1].label), (false, &None));
        assert!(!json.line().contains('\n') && json.rendered.contains("a.s:2:5"));
    }

    #[test]
    fn places_beyond_the_end_of_a_text_are_its_end() {
        let source = Source::new("a.s", "x\n");
        let json = JsonMessage::new(&Diagnostic::warning("w").at(Place::new(&source, 7..9), ""));
        assert_eq!((json.severity, json.errors), ("warning", 0));
        assert_eq!((json.spans[0].start, json.spans[0].end, json.spans[0].line), (2, 2, 2));
    }
}
