//! Small programs with what they should do beside the line, on every engine. A case is a file `cases/<room>/<name>.s`.
//!
//! A comment beside a statement holds claims about the machine right after the line was executed (the last time it was):
//!
//!     li    s1, 0x7fffffff      ; s1 = 0x7fffffff
//!     add   s2, s1, s1          ; s2 = 32767.99998:pos; count: add 1, move 2
//!     vsplat v1, s0             ; v1 = 0, 0, 0 -- prose stands behind two hyphens
//!     sw    s1, 8(s0)           ; buffer[8] = 0xff, 255, 255, 0x7f
//!     beqz  s1, start           ; exit Taken, Fall
//!     stw   s1, 0(s0)           ; memory[0] = 1, 0, 0, 0; clocks: 9
//!     lw    s1, -4(s0)          ; trap: octets 4294967292..4294967296 of the buffer, which has 18525
//!     mul   s1, s2, s3, 64      ; error E008: 64 does not fit operand `i` of `mul`
//!
//! Numbers are expressions of the assembler, raw or with a format (`0.5:pos`), and `exit` lists every pass. `count` and
//! `clocks` are totals up to there, at the `halt` those of the program. What goes wrong must be claimed, all of it and
//! word by word (or up to `...`): `error`, `warning` (of the assembler) and `trap` (of the machine). Where no statement
//! is beside it, a claim names its line, as in `error E012 line 3: text`, or has none, as in `trap: text`. A line
//! `machine: key = value` sets a key of the machine, a line `memory: 64` the octets of global memory. All other lines of
//! comments are prose.

use std::collections::BTreeSet;
use std::fmt::Write;

use crate::case::observation::{ENGINES, observe};
use crate::case::verdict::differences;
use crate::case::{self, Case, bless};
use isa::INSTRUCTIONS;

/// Set to rewrite the claims of the cases that fail, so that they say what happens now.
const BLESS: &str = "LANCER_BLESS";

#[test]
fn every_case_does_what_it_says_on_every_engine() {
    let is_blessing = std::env::var_os(BLESS).is_some_and(|value| value != "0");
    let cases = case::all();
    assert!(cases.len() > 50, "only {} cases were found", cases.len());
    let mut failures = String::new();
    for case in &cases {
        for engine in ENGINES {
            let found = differences(case, &observe(case, engine));
            for difference in &found {
                let (name, line, problem) = (&case.name, difference.line, &difference.problem);
                let _ = writeln!(failures, "tests/cases/{name}:{line}: {problem} ({})", engine.name);
            }
            if is_blessing && !found.is_empty() {
                std::fs::write(&case.path, bless::blessed(case, &found)).unwrap();
                break;
            }
        }
    }
    assert!(
        failures.is_empty(),
        "{failures}\nIf this is how it should be: {BLESS}=1 cargo test -p lancer cases, and read the diff."
    );
}

/// Each instruction has an example in the manual, which does what it says on every engine.
#[test]
fn examples_of_the_manual_do_what_they_say() {
    let mut failures = String::new();
    let mut named = BTreeSet::new();
    for (name, program) in lancer::manual::examples::all() {
        assert!(named.insert(name), "{name} has two examples");
        let case = Case::parse(format!("example of {name}"), Default::default(), program.to_owned());
        let case = case.unwrap_or_else(|problem| panic!("{problem}"));
        let is_about_it = program.lines().any(|line| {
            let claim = line.split_once(';').map_or("", |(_, claim)| claim);
            line.split_whitespace().any(|word| word == name) && !claim.trim().is_empty()
        });
        assert!(is_about_it || ["halt", "ret"].contains(&name), "the example of {name} says nothing of it");
        for engine in ENGINES {
            for difference in differences(&case, &observe(&case, engine)) {
                let (line, problem) = (difference.line, &difference.problem);
                let _ = writeln!(failures, "example of {name}, line {line}: {problem} ({})", engine.name);
            }
        }
    }
    assert!(failures.is_empty(), "{failures}");
    let missing: Vec<&str> = INSTRUCTIONS.iter().map(|row| &*row.name).filter(|name| !named.contains(name)).collect();
    assert!(missing.is_empty(), "src/manual/examples has no example of {missing:?}");
}

#[test]
fn a_third_of_the_cases_are_about_errors() {
    let cases = case::all();
    let about_errors = cases.iter().filter(|case| case.is_about_an_error()).count();
    assert!(3 * about_errors >= cases.len(), "{about_errors} of {}", cases.len());
}

#[test]
fn every_exit_of_every_row_is_taken_in_a_case_of_its_room() {
    let mut taken = BTreeSet::new();
    for case in case::all() {
        let exits = observe(&case, &ENGINES[0]).run.map_or(Vec::new(), |run| run.exits());
        taken.extend(exits.into_iter().map(|(row, exit)| (case.room().to_owned(), row, exit)));
    }
    let exits = INSTRUCTIONS.iter().flat_map(|row| row.outcomes.iter().map(move |exit| (row, exit)));
    let missing: Vec<String> = exits
        .filter(|(row, exit)| !taken.contains(&(row.room.to_string(), row.name.to_string(), exit.name.to_string())))
        .map(|(row, exit)| format!("{} of `{}` in tests/cases/{}", exit.name, row.name, row.room))
        .collect();
    assert!(missing.is_empty(), "no case takes\n    {}", missing.join("\n    "));
}

/// Differences of a text as a case, with the text that blessing makes of it.
fn judge(text: &str) -> (Vec<String>, String) {
    let case = Case::parse("room/name.s".into(), "name.s".into(), text.into()).unwrap();
    let found = differences(&case, &observe(&case, &ENGINES[0]));
    (
        found.iter().map(|difference| format!("{}: {}", difference.line, difference.problem)).collect(),
        bless::blessed(&case, &found),
    )
}

#[test]
fn wrong_claims_are_found_and_blessed() {
    let wrong = "        .format pos, 16
        li s1, 0x8000             ; s1 = 1.5:pos; count: none -- half
        beqz s1, .+2              ; exit Taken
        lw s2, -1(s0)             ; s2 = ?
        halt                      ; s1 = 0x8000
";
    let (problems, blessed) = judge(wrong);
    assert_eq!(
        problems,
        [
            "2: `s1 = 1.5:pos`, but `s1 = 0.5:pos`",
            "2: `count: none`, but `count: move 2`",
            "3: `exit Taken`, but `exit Fall`",
            "4: `s2 = ?`, but `s2 = 0`",
            "4: `trap: octets 4294967295..4294967299 of the buffer, which has 18525` is not expected",
            "5: `s1 = 0x8000`: the line is never executed",
        ]
    );
    let right = "        .format pos, 16
        li s1, 0x8000             ; s1 = 0.5:pos; count: move 2 -- half
        beqz s1, .+2              ; exit Fall
        lw s2, -1(s0)             ; s2 = 0; trap: octets 4294967295..4294967299 of the buffer, which has 18525
        halt                      ; s1 = 0x8000
";
    assert_eq!(blessed, right);
    assert_eq!(judge(right).0.len(), 1);
}

#[test]
fn messages_are_claimed_one_by_one() {
    let (problems, blessed) = judge("        mul s1, s2, s3, 64        ; error E001: nonsense\n        nop x\n");
    assert_eq!(problems.len(), 2, "{problems:#?}");
    assert_eq!(
        blessed,
        "        mul s1, s2, s3, 64        ; error E008: 64 does not fit operand `i` of `mul`
        nop x                           ; error E005: `nop` takes no operands, not 1
"
    );
    assert!(judge(&blessed).0.is_empty());
    let (problems, blessed) = judge("        halt ; error E001: nonsense\n");
    assert_eq!((problems.len(), blessed.as_str()), (1, "        halt\n"));
}

#[test]
fn a_comment_beside_a_statement_has_to_be_a_claim() {
    for text in ["halt ; counts: add 1", "halt ; done", "halt ; error E001 lien 3: text", "halt ; s1 = 1; s32 = 1"] {
        assert!(Case::parse("n".into(), "n".into(), text.into()).is_err(), "{text}");
    }
    let case = Case::parse("n".into(), "n".into(), "; done: this is prose\nhalt ; s1 = 1 -- and this".into()).unwrap();
    assert_eq!(case.claims().count(), 1);
}
