//! The part of a source line that a message shows, with carets below the place.

use annotate_snippets::{AnnotationKind, Group, Snippet};

use crate::Place;
use crate::source::floor_boundary;
use crate::visible::{sentence, visible};

/// Longest part of a source line that a message shows, in octets; longer lines are cut around the place.
const SHOWN: usize = 160;

/// A stand-in where a line was cut.
const CUT: &str = "...";

/// Marks the name of a file whose line was cut; nobody's text has this character of the private area.
const STAND_IN: char = '\u{f8fd}';

/// Adds a part of a source to the group; also returns what to replace in the text that is made of it, and by what.
pub(crate) fn with_snippet<'a>(
    group: Group<'a>,
    place: &'a Place,
    label: &'a str,
    kind: AnnotationKind,
) -> (Group<'a>, Option<(String, String)>) {
    let text = &place.source.text;
    let from = floor_boundary(text, place.span.start);
    // Find the line, and cut it around the place when it is long.
    let line_start = text[..from].rfind('\n').map_or(0, |at| at + 1);
    let line_end = text[from..].find('\n').map_or(text.len(), |at| from + at);
    let cut_start = if from - line_start > SHOWN / 2 { floor_boundary(text, from - SHOWN / 2) } else { line_start };
    let cut_end = floor_boundary(text, line_end.min(cut_start + SHOWN)).max(from);
    let to = floor_boundary(text, place.span.end.clamp(from, cut_end)).max(from);
    let line = text[..line_start].bytes().filter(|&octet| octet == b'\n').count() + 1;
    let shown = text[cut_start..cut_end].trim_end_matches('\r');
    let before = if cut_start > line_start { CUT } else { "" };
    let behind = if cut_end < line_end { CUT } else { "" };
    // Places in the part that is shown: dots in front of it and codes of invisible characters move what follows them.
    let clamp = |at: usize| before.len() + sentence(&shown[..(at - cut_start).min(shown.len())]).len();
    let name = visible(&place.source.name);
    let snippet = Snippet::source(format!("{before}{}{behind}", sentence(shown)))
        .line_start(line)
        .annotation(kind.span(clamp(from)..clamp(to)).label(sentence(label)));
    let column = |start: usize| text[start..from].chars().count() + 1;
    let shown_column = before.len() + sentence(&text[cut_start..from]).chars().count() + 1;
    if shown_column == column(line_start) {
        return (group.element(snippet.path(name)), None);
    }
    // The renderer knows the part as it is shown: its column becomes that of the file afterwards.
    let wrong = format!("{name}{STAND_IN}:{line}:{shown_column}");
    let right = format!("{name}:{line}:{}", column(line_start));
    (group.element(snippet.path(format!("{name}{STAND_IN}"))), Some((wrong, right)))
}
