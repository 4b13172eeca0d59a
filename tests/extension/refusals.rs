//! Files that are refused: one message each, with its place and what to do.

use asm::extension::{load, source};
use isa::Isa;
use messages::{Report, Source};

/// A file with one instruction, the row given without its mnemonic `bad`, the body by its lines.
fn file(row: &str, body: &str) -> String {
    format!(".extension bad\n;; What it does.\n.instr bad {row}\n{body}\n.end\n")
}

const ROW: &str = "(d: S, a: S)  \"custom0 ddddd aaaaa ----------------\"  [Done(add 1)]";

fn refused(text: &str) -> Report {
    load(&mut Isa::base(), &Source::new("bad.isa", text), &|_, _| Err("there are no files here".into()))
        .expect_err(text)
}

/// One error that contains a text, at a line and column, with a hint that contains another.
#[track_caller]
fn refuses(text: &str, message: &str, place: &str, hint: &str) {
    let report = refused(text);
    assert_eq!(report.0.len(), 1, "{report}");
    let shown = report.to_string();
    assert!(shown.contains(message) && shown.contains(&format!("bad.isa:{place}")), "{message} {place}\n{shown}");
    assert!(report.0[0].hint.as_ref().is_some_and(|found| found.contains(hint)), "{hint}\n{shown}");
    assert!(report.0[0].code.is_some(), "{shown}");
}

#[test]
fn rows_that_cannot_be_read() {
    let with = |row: &str| file(row, "    mov d, a");
    // In line 3 `.instr bad ` has 11 characters, so the row's `d` is in column 13, its `a` in 19, and its pattern begins in 26.
    for (row, message, place, hint) in [
        ("(d: S, a: S) \"custom0 ddddd aaaaa ---------------\" [Done()]", "31 bits instead of 32", "3:26", "add 1 `-`"),
        ("(d: S, a: S) \"custom0 ddddd aaaaa -----------------\" [Done()]", "33 bits", "3:26", "leave out 1"),
        (
            "(d: S, a: S) \"000000 ddddd aaaaa ----------------\" [Done()]",
            "outside of the opcodes",
            "3:26",
            "custom3 (111111)",
        ),
        ("(d: S, a: S) \"custom0 ddddd aaaaa -------x--------\" [Done()]", "no such operand", "3:26", "x: S"),
        ("(d: S, a: S) \"custom0 ddddd aaaa -----------------\" [Done()]", "field `a` has 4 bits", "3:19", "aaaaa"),
        ("(d: S, a: S) \"custom0 ddd-- aaaaa dd--------------\" [Done()]", "several pieces", "3:47", "side by side"),
        ("(d: S, a: S) \"custom0 ddddd aaaaa ---------------?\" [Done()]", "character", "3:61", "0 and 1 are fixed"),
        ("(d: S, a: Q) \"custom0 ddddd aaaaa ----------------\" [Done()]", "`Q` is no kind", "3:22", "did you mean"),
        ("(d: S, q: S) \"custom0 ddddd qqqqq ----------------\" [Done()]", "`q` is no letter", "3:19", "immediate"),
        (
            "(d: S, a: S) \"custom0 ddddd aaaaa ----------------\" [Done(ad 1)]",
            "`ad` is no class",
            "3:70",
            "did you mean `add`?",
        ),
        (
            "(d: S, a: S) \"custom0 ddddd aaaaa ----------------\" [Done(add 1000000000000)]",
            "at most 1000000",
            "3:74",
            "elementary operations",
        ),
        (
            "(d: S, a: S) \"custom0 ddddd aaaaa ----------------\" [Done(add 99999999999999999999999)]",
            "at most 1000000",
            "3:74",
            "elementary",
        ),
        (
            "(d: S, a: S) \"custom0 ddddd aaaaa ----------------\" [A(body), B(cmp 1)]",
            "all outcomes",
            "3:74",
            "counted before",
        ),
        (
            "(d: S, a: S) \"custom0 ddddd aaaaa ----------------\" [A(), A()]",
            "two outcomes",
            "3:70",
            "tells outcomes apart",
        ),
        ("(d: S, a: S) \"custom0 ddddd aaaaa ----------------\"", "expected `[`", "4:5", "a row is written"),
    ] {
        refuses(&with(row), message, place, hint);
    }
}

#[test]
fn names_and_words_that_are_taken() {
    for (name, what) in [("vadd", "an instruction"), ("li", "a pseudo-instruction"), ("exit", "how a body ends")] {
        let text = file(ROW, "    mov d, a").replace("instr bad", &format!("instr {name}"));
        refuses(&text, &format!("`{name}` is {what} already"), "3:8", "another name");
    }
    let second =
        ".instr other (d: S, a: S) \"custom0 ddddd aaaaa -----i----------\" [Done(add 1)]\n    mov d, a\n.end\n";
    let text = file(ROW, "    mov d, a") + &second.replace('i', "1").replace(".1nstr", ".instr");
    assert!(load(&mut Isa::base(), &Source::new("t", text.as_str()), &|_, _| Err(String::new())).is_ok());
    let overlapping = text.replace("-----1----------", "----------------");
    refuses(&overlapping, "`other` and `bad` have words in common", "6:28", "`custom1` is free");
}

#[test]
fn bodies_that_cannot_be_executed() {
    for (body, message, place, hint) in [
        ("    bad d, a", "contains `bad` itself", "4:5", "a label and a branch"),
        ("    mov a, s0\n    mov d, a", "writes `a`, which `bad` only reads", "4:9", "`x` or `y`"),
        ("    mov s5, a\n    mov d, a", "does not own `s5`", "4:9", "temporaries t0"),
        ("    mov d, s5", "does not own `s5`", "4:12", "`d` `a`"),
        ("    mov d, t0", "`t0` is read", "4:5", "write `t0`"),
        ("    add d, d, a", "`d` is read", "4:5", "`x` or `y`"),
        ("    beqz a, 1f\n    mov d, a\n1:", "`d` is not written on every way", "5:5", "may stay as it was"),
        ("1:  jump 1b", "never ends", "3:8", "`exit NAME`"),
        ("    call t0, 1f\n1:  mov d, a", "`call` does not stand in a body", "4:5", "stay inside"),
        ("    mov d, a\n    exit Over", "has no outcome `Over`", "5:10", "`Done`"),
        ("    mov d, t99", "no temporary `t99`", "4:12", "t0 to t31"),
        ("    beqz a, .+9\n    mov d, a", "leads out of the body", "4:13", "`exit NAME`"),
        ("    .word 1\n    mov d, a", "`.word` does not stand in an extension", "4:5", "data belong to the program"),
        ("", "the body of `bad` is empty", "3:8", "between the row and `.end`"),
        ("    mov d, a+1", "`a` is one register", "4:12", ""),
    ] {
        match hint {
            "" => assert!(refused(&file(ROW, body)).to_string().contains(message)),
            hint => refuses(&file(ROW, body), message, place, hint),
        }
    }
    let row = "(d: S, a: S)  \"custom0 ddddd aaaaa ----------------\"  [A(), B()]";
    refuses(&file(row, "    mov d, a"), "runs off its end, but it has 2 outcomes", "4:5", "`exit A` or `exit B`");
    let row = "(d: S, i: Un)  \"custom0 ddddd iiiiiiiiiiiiiiii -----\"  [Done()]";
    let report = refused(&file(row, "    movi d, i + 1"));
    assert!(report.to_string().contains("with i = 65535 this is 65536"), "{report}");
}

#[test]
fn what_a_meaning_in_rust_does_not_go_with() {
    let declared = "(d: S, a: S)  \"custom0 ddddd aaaaa ----------------\"  [Done(mem 1; each octet 1)]";
    let load = |text: &str| load(&mut Isa::base(), &Source::new("t", text), &|_, _| Err(String::new()));
    assert!(load(&file(declared, "    .meaning rust")).is_ok_and(|loaded| loaded[0].is_rust));
    for (row, body, message, place, hint) in [
        (ROW, "    .meaning c\n    mov d, a", "`.meaning` names where the meaning is", "4:5", "`.meaning rust`"),
        (declared, "    .meaning rust\n    mov d, a", "have no cost for each unit", "3:77", "without a body beside it"),
        (declared, "    mov d, a", "have no cost for each unit", "3:77", "without a body beside it"),
        (
            "(d: S, a: S)  \"custom0 ddddd aaaaa ----------------\"  [Done(body)]",
            "    .meaning rust\n    mov d, a",
            "its outcomes say what they cost",
            "3:67",
            "such as `add 3`",
        ),
    ] {
        refuses(&file(row, body), message, place, hint);
    }
}

/// Bodies share lines by macros: an instruction of an extension would have two prices.
#[test]
fn bodies_that_use_instructions_of_extensions() {
    let second =
        ".instr other (d: S, a: S) \"custom1 ddddd aaaaa ----------------\" [Done(add 1)]\n    bad d, a\n.end\n";
    let text = file(ROW, "    mov d, a") + second;
    refuses(&text, "`bad` is an instruction of an extension", "7:5", "with a macro");
}

#[test]
fn files_that_are_none() {
    for (text, message, place, hint) in [
        (
            ".instr bad () \"custom0 --------------------------\" [Done()]\n.end",
            "no name yet",
            "1:1",
            ".extension NAME",
        ),
        (".extension\n", "names the extension", "1:1", "write `.extension NAME`"),
        (".extension a\n", "has no instruction", "2:1", "`.instr`"),
        (".extension a\n.extension b\n", "stands once", "2:1", "one file for each"),
    ] {
        refuses(text, message, place, hint);
    }
    let open = refused(".extension a\n.instr bad () \"custom0 --------------------------\" [Done()]\n    nop\n");
    assert!(open.to_string().contains("`.end` is missing"), "{open}");
    let outside =
        refused(&format!(".extension a\n    nop\n{}", file(ROW, "    mov d, a").replace(".extension bad\n", "")));
    assert!(outside.to_string().contains("outside of `.instr`"), "{outside}");
    let octets = source("bad.isa", b".extension a\n;; caf\xe9\n".to_vec()).expect_err("no UTF-8");
    let shown = octets.to_string();
    assert!(shown.contains("octet 20 of the file is not UTF-8") && shown.contains("bad.isa:2:7"), "{shown}");
    assert!(octets.0[0].hint.is_some());
}

#[test]
fn all_errors_of_a_file_are_told_at_once() {
    let text = file(ROW, "    mov s5, a\n    mov d, zz\n    foo");
    let report = refused(&text);
    assert!(report.0.len() >= 3, "{report}");
}

/// Whatever a file contains, reading it ends with a result or with messages.
#[test]
fn damaged_files_never_panic() {
    let good = include_str!("bodies.isa");
    let mut state = 1u64;
    for _ in 0..400 {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let (at, kind) = ((state >> 33) as usize % good.len(), state >> 61);
        let mut text = good.to_owned();
        match kind {
            0..=2 => drop(text.remove(at)),
            3 => text.truncate(at),
            4 => text.insert(at, '\n'),
            5 => text.insert(at, ')'),
            6 => text.replace_range(at..=at, "9"),
            _ => text.insert_str(at, "\nexit "),
        }
        let report = load(&mut Isa::base(), &Source::new("t", text), &|_, _| Err("no".into()));
        if let Err(report) = report {
            assert!(report.has_errors());
            let _ = report.render(false);
        }
    }
}
