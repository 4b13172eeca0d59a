//! Warnings of `lancer extension check`, each with its wording.

use lancer::extension::findings;

use super::isa_of;

/// The warnings about a file with one instruction, given its row without the mnemonic `odd`, and its body.
fn warnings(row: &str, body: &str) -> Vec<(String, String, String)> {
    let (isa, loaded) = isa_of(&format!(".extension t\n;; What it does.\n.instr odd {row}\n{body}\n.end\n"));
    let found = findings(&isa, &loaded[0]);
    let shown = found.iter().map(|found| {
        let text = found.to_string();
        let place =
            text.split("t.isa:").nth(1).and_then(|rest| rest.split([' ', '\n']).next()).unwrap_or("").to_owned();
        (found.message.clone(), place.trim_end_matches(':').to_owned(), found.hint.clone().unwrap_or_default())
    });
    shown.collect()
}

const TWO: &str = "(d: S, a: S)  \"custom0 ddddd aaaaa ----------------\"";
const THREE: &str = "(d: S, a: S, b: S)  \"custom0 ddddd aaaaa bbbbb -----------\"";

#[test]
fn each_suspicion_has_its_words() {
    let (body, free) = ("[Done(body)]", "[Done()]");
    // The row is line 3 with `odd` in column 8, the body begins in line 4; an empty place or hint holds for any.
    for (row, lines, message, place, hint) in [
        (format!("{THREE} {body}"), "    mov d, a", "operand `b` of `odd` is not used", "3:8", "its bits are free"),
        (
            format!("{THREE} {body}"),
            "    mov d, a\n    add d, d, b",
            "`odd` writes `d` before it has read `b` for the last time",
            "3:8",
            "it still reads what `b` was",
        ),
        (
            format!("{TWO} [Small(body), Large(body)]"),
            "    mov d, a\n    exit Small",
            "the outcome `Large` of `odd` is never taken",
            "",
            "",
        ),
        (
            format!("{TWO} {body}"),
            "    mov d, a\n    jump 1f\n    mov d, s0\n1:",
            "a line of the body of `odd` is never reached",
            "6:5",
            "",
        ),
        (
            format!("{TWO} {body}"),
            "    mov d, a\n1:  bnez d, 1b",
            "the body of `odd` has a loop: it takes as long as its operands say",
            "5:1",
            "step limit",
        ),
        (format!("{TWO} {body}"), "    lw d, 0(a)", "the body of `odd` may trap", "4:5", ""),
        (format!("{TWO} {body}"), "    beqz a, 1f\n    trap 3\n1:  mov d, a", "the body of `odd` may trap", "5:5", ""),
        (
            format!("{THREE} {body}"),
            "    div d, a, b, 0",
            "the body of `odd` divides: by zero, that traps where the machine says so",
            "4:5",
            "",
        ),
        (
            format!("{THREE} [Done(add 1)]"),
            "    mul t0, a, b, 0\n    add d, t0, a\n    add d, d, b",
            "`Done` of `odd` costs less than its body spends: add 1 instead of 2, mul 0 instead of 1",
            "",
            "a unit may be cheaper",
        ),
    ] {
        let row = row.as_str();
        let found = warnings(row, lines);
        let one = found.iter().find(|(found, ..)| found == message);
        let (_, found_place, found_hint) = one.unwrap_or_else(|| panic!("{message}\n{found:?}"));
        assert!(found_place.starts_with(place), "{message} at {found_place}");
        assert!(found_hint.contains(hint), "{message}: {found_hint}");
    }
    // Only arithmetic, requests and octets must be declared, so a body of `xor` alone may cost nothing.
    assert_eq!(warnings(&format!("{THREE} {free}"), "    xor d, a, b"), []);
    let (isa, loaded) = isa_of(&format!(".extension t\n.instr odd {TWO} {free}\n    mov d, a\n.end\n"));
    assert_eq!(findings(&isa, &loaded[0])[0].message, "`odd` has no description");
}

#[test]
fn nothing_is_said_of_what_is_right() {
    let right = "    sub t0, a, b\n    mov d, t0";
    assert_eq!(warnings(&format!("{THREE} [Done(sub 1)]"), right), []);
    // Written first, but no source is read after that; and a source that is written too is nobody else's.
    assert_eq!(warnings("(x: S, a: S)  \"custom0 xxxxx aaaaa ----------------\" [Done(body)]", "    add x, x, a"), []);
}
