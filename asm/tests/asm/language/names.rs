//! Names and formats of registers: two names that meet, and what `.holds` takes.

use asm::{Options, assemble};
use isa::Isa;
use messages::Source;

use super::program;

/// Codes and texts of the warnings of a source.
fn warnings(text: &str) -> Vec<String> {
    let assembled = assemble(&Source::new("t.s", text), &Isa::base(), &Options::default()).expect(text);
    assembled.warnings.0.iter().map(|message| format!("{}: {}", message.code.unwrap_or(""), message.message)).collect()
}

#[test]
fn names_of_one_register_that_meet_are_told() {
    let names = ".reg count, s5\n.reg total, s5\n";
    for (text, found) in [
        // One after the other is no meeting, a write in between is.
        ("movi count, 3\nmov s1, count\nmovi total, 0\nmov s1, total\nhalt", 0),
        ("movi count, 3\nmovi total, 0\nmov s1, count\nhalt", 1),
        // Two names in one statement that only reads.
        ("movi count, 3\nmovi total, 0\nadd s1, count, total\nhalt", 1),
        ("movi count, 3\nmovi total, 0\nadd count, count, total\nhalt", 0),
        // Without a name nothing is said.
        ("movi count, 3\nmovi s5, 0\nmov s1, count\nhalt", 0),
        // On every way, not on one of two.
        ("beqz s1, 2f\nmovi total, 2\njump 1f\n2: movi total, 1\n1: mov s1, count\nhalt", 1),
        ("movi count, 3\n1: mov s1, count\nmovi total, 1\nbnez s1, 1b\nhalt", 0),
        ("movi count, 3\nbeqz s1, 1f\nmovi total, 1\n1: mov s1, count\nhalt", 0),
        ("movi count, 3\nbeqz s1, 1f\nmovi total, 1\nhalt\n1: mov s1, count\nhalt", 0),
        // Through a call, whose function keeps or changes it.
        ("movi count, 3\ncall s31, f\nmov s1, count\nhalt\n.func f\nmovi total, 1\nret s31\n.endfunc", 1),
        ("movi count, 3\ncall s31, f\nmov s1, count\nhalt\n.func f\nmovi s6, 1\nret s31\n.endfunc", 0),
        (
            "movi count, 3\ncall s31, f\nmov s1, count\nhalt\n.func f\nmovi total, 1\nmovi count, 2\nret s31\n.endfunc",
            0,
        ),
        ("movi count, 3\ncall s31, f\nhalt\n.func f\nmov s1, total\nret s31\n.endfunc", 1),
    ] {
        let found_here = warnings(&format!("{names}{text}"));
        assert_eq!(found_here.len(), found, "{text}: {found_here:?}");
        assert!(found_here.iter().all(|warning| warning.starts_with("W002: `")), "{found_here:?}");
    }
    // A name that is not known any more does not meet.
    assert_eq!(warnings(".reg a, s5\nmovi a, 1\n.unreg a\n.reg b, s5\nmov s1, b\nhalt"), [""; 0]);
    assert_eq!(warnings(".func f\n.reg a, s5\nmovi a, 1\n.endfunc\n.func g\n.reg b, s5\nmov s1, b\n.endfunc"), [""; 0]);
    let text = &warnings(&format!("{names}movi count, 3\nmovi total, 0\nmov s1, count\nhalt"))[0];
    assert_eq!(text, "W002: `count` is read where s5 holds `total`");
}

#[test]
fn what_registers_hold_needs_a_register_and_a_format() {
    for (text, message) in [
        (".holds s2, pso", "`pso` is not a format"),
        (".holds sx, pos", "`sx` is not a register"),
        (".holds", "a register"),
        (".holds s2 pos", "`,`"),
    ] {
        let source = Source::new("t.s", format!(".format pos, 16\n{text}\nhalt"));
        let report = assemble(&source, &Isa::base(), &Options::default()).expect_err(text).render(false);
        assert!(report.contains(message), "{text}: {report}");
    }
    assert!(program(".format pos, 16\n.holds s2, pos\nhalt").words.len() == 1);
}
