//! Hostile sources: one clear error each, soon, whatever they ask for.

use std::sync::Arc;

use asm::{Options, assemble, limits};
use isa::Isa;
use messages::{Report, Source};

fn report(text: &str) -> Report {
    let include = |name: &str, _: &str| -> Result<Arc<Source>, String> {
        // Every file includes two others, without end and without coming back.
        Ok(Source::new(format!("{name}x"), format!(".include \"{name}l\"\n.include \"{name}r\"\n")))
    };
    let options = Options { include: &include, ..Options::default() };
    match assemble(&Source::new("t.s", text), &Isa::base(), &options) {
        Ok(_) => Report::default(),
        Err(report) => report,
    }
}

fn codes(text: &str) -> Vec<&'static str> {
    report(text).0.iter().map(|message| message.code.unwrap_or("")).collect()
}

#[test]
fn what_is_too_deep_is_one_error() {
    let many = 100_000;
    assert_eq!(codes(&format!(".equ a, {}1{}", "(".repeat(many), ")".repeat(many))), ["E032"]);
    assert_eq!(codes(&format!(".equ a, {}1{}", "abs(".repeat(many), ")".repeat(many))), ["E032"]);
    assert_eq!(codes(&".if 1\n".repeat(many)), ["E022"]);
    assert_eq!(codes(&".region a\n".repeat(many)), ["E021"]);
    assert_eq!(codes(&".macro m\n".repeat(many)), ["E022"]);
    assert_eq!(codes(".macro m\nm\n.endm\nm"), ["E021"]);
    assert_eq!(codes(".include \"a\""), ["E021"]);
    assert_eq!(codes(&format!("{}nop\n{}", ".rept 1\n".repeat(70), ".endr\n".repeat(70))), ["E021"]);
}

#[test]
fn what_is_long_but_possible_is_assembled() {
    let many = 100_000;
    assert_eq!(codes(&format!(".equ a, {}1", "-".repeat(many))), [""; 0]);
    assert_eq!(codes(&format!(".equ a, {}1", "1 + ".repeat(many))), [""; 0]);
    let chain: String = (0..many).map(|n| format!(".equ a{n}, a{}\n", n + 1)).collect();
    assert_eq!(codes(&format!("{chain}.equ a{many}, 1\nmovi s1, a0")), [""; 0]);
    assert_eq!(codes(&format!("{chain}.equ a{many}, a0")), ["E017"]);
    assert_eq!(codes(&format!(".rept {}\nnop\n.endr", limits::LINES - 3)), [""; 0]);
    assert_eq!(codes(".text\n.org 1 << 20\n.buffer\n.space 16 << 20"), [""; 0]);
}

#[test]
fn what_is_too_large_is_one_error() {
    for text in [
        ".rept 1000000000\nnop\n.endr",
        ".rept 1000\n.rept 1000\n.rept 1000\nnop\n.endr\n.endr\n.endr",
        ".macro m n\nm \\n\\n\n.endm\nm x",
        ".org 1 << 20\nnop",
        ".org 1 << 62",
        ".align 1 << 24\nnop\n.align 1 << 24",
        &"nop\n".repeat(limits::LINES + 1),
        &format!("; {}", "long ".repeat(limits::LINE_OCTETS / 5)),
    ] {
        let found = codes(text);
        assert!(matches!(found[..], ["E025"] | ["E021"]), "{found:?} from {}", &text[..text.len().min(60)]);
    }
    for text in [".space 1 << 40", ".org 1 << 40", ".space 16 << 20\n.byte 1", ".space 1\n.space 9223372036854775807"] {
        assert_eq!(codes(&format!(".buffer\n{text}")), ["E026"], "{text}");
    }
}

#[test]
fn limits_can_be_lowered() {
    let limits = limits::SourceLimits { words: 2, buffer: 3, lines: 60, expanded_octets: 100, compared_names: 0 };
    let options = Options { limits, ..Options::default() };
    let found = |text: &str| match assemble(&Source::new("t.s", text), &Isa::base(), &options) {
        Ok(_) => String::new(),
        Err(report) => report.render(false),
    };
    assert_eq!(found("nop\nnop\n.buffer\n.space 3\n.align 1\n"), "");
    for (text, says) in [
        ("nop\nnop\nnop\n", "more than 2 words"),
        (".org 3\n", "more than 2 words"),
        (".buffer\n.space 4\n", "more than 3 octets"),
        (&"\n".repeat(61), "more than 60 lines"),
        (".rept 61\n;\n.endr\n", "more than 60 lines"),
        (".rept 1\n.rept 50\n; 5 octets\n.endr\n.endr\n", "more than 100 octets"),
    ] {
        assert!(found(text).contains(says), "{text}: {}", found(text));
    }
    assert!(!found("label1: nop\nj label2\n").contains("did you mean"));
}

#[test]
fn similar_names_are_sought_among_so_many_only() {
    let hints = |labels: usize, name: &str| {
        let text: String = (0..labels).map(|n| format!("{name}{n}: nop\n")).collect();
        let found = report(&format!("{text}j {name}_1\n"));
        found.render(false).contains("did you mean")
    };
    assert!(hints(1000, "label"));
    assert!(!hints(limits::COMPARED_NAMES + 1, "label"));
    assert!(!hints(10, &"long".repeat(limits::COMPARED_OCTETS / 4)));
}

#[test]
fn macros_have_so_many_parameters_only() {
    let header = |count: usize| (0..count).map(|n| format!("p{n}")).collect::<Vec<_>>().join(",");
    assert_eq!(codes(&format!(".macro m {}\n.endm", header(limits::PARAMETERS))), [""; 0]);
    assert_eq!(codes(&format!(".macro m {}\n.endm", header(limits::PARAMETERS + 1))), ["E025"]);
}

#[test]
fn many_errors_are_cut_and_counted() {
    let found = report(&"frobnicate s1\n".repeat(250));
    assert_eq!(found.0.len(), limits::MESSAGES + 1);
    assert_eq!(found.0.last().unwrap().message, "150 more messages are not shown");
    let places: Vec<usize> =
        found.0.iter().filter_map(|m| m.place.as_ref().map(|(place, _)| place.span.start)).collect();
    assert!(places.is_sorted());
    let found = report(&"frobnicate s1\n".repeat(5_000)).render(false);
    assert!(found.ends_with("note: 4900 more messages are not shown\n\n5000 errors"), "{found}");
}

#[test]
fn the_same_error_of_a_macro_is_said_once() {
    assert_eq!(codes(".macro m\nmovi s1, 99999\n.endm\n.rept 50\nm\n.endr"), ["E008"]);
}
