//! Messages of a reader of a file to a person: place, source line, carets, hint. All readers of the
//! project (assembly, extensions, scenes, machines) report through these types; no reader prints by itself.

mod diagnostic;
mod document;
mod packed;
mod report;
mod snippet;
mod source;
mod suggestion;
mod visible;

pub use diagnostic::{Diagnostic, Severity};
pub use document::{plain, read_toml};
pub use packed::{packed_by, refuse_packed, refuse_utf16, with_plain_ends};
pub use report::Report;
pub use source::{Place, Source};
pub use suggestion::{did_you_mean, nearest, question};
pub use visible::{is_invisible, visible};

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
    fn no_message_sends_what_steers_a_terminal() {
        let source = Source::new("a\u{1b}[2J\n.s", "  x\u{a0}\u{7}y = \u{1b}[31m4\n");
        let place = Place::new(&source, 10..16);
        let message = Diagnostic::error("found `\u{1b}[31m4`").at(place.clone(), "a\u{202e}b").also(place, "c\u{7}");
        let text = message.hint("d\r").to_string();
        assert!(!text.chars().any(|character| is_invisible(character) && character != '\n'), "{text:?}");
        assert!(text.contains("a␛[2J␊.s:1:10"), "{text}");
        let lines: Vec<&str> = text.lines().collect();
        let line = lines.iter().position(|line| line.contains("x<U+00A0>␇y = ␛[31m4")).unwrap();
        assert_eq!(lines[line].chars().position(|c| c == '␛'), lines[line + 1].find('^'), "{text}");
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
        assert_eq!(did_you_mean("vdto", ["vdot", "vadd"]).as_deref(), Some("did you mean `vdot`?"));
        assert_eq!(nearest("xyzzy", ["vdot", "vadd"]), None);
    }
}
