//! Standard input and output in the place of files, and files that come through pipes.

use std::io::Write;
use std::process::{Command, Stdio};

use super::session::Session;

const PROGRAM: &str = "    li s1, 7\n    halt\n";

/// Runs a command with a text on standard input; its code, output and messages.
fn fed(session: &Session, arguments: &str, input: &[u8]) -> (i32, Vec<u8>, String) {
    let mut command = session.command(arguments);
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // What is refused before it is read leaves nobody to write to.
    let _ = child.stdin.take().unwrap().write_all(input);
    let output = child.wait_with_output().unwrap();
    (output.status.code().unwrap(), output.stdout, String::from_utf8(output.stderr).unwrap())
}

/// Runs a line of the shell bash in the session's folder; `None` where there is no bash.
fn in_bash(session: &Session, line: &str) -> Option<(i32, String)> {
    let line = line.replace("lancer ", &format!("{} ", env!("CARGO_BIN_EXE_lancer")));
    let output = Command::new("bash").args(["-c", &line]).current_dir(session.path("")).output().ok()?;
    let text = String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned();
    Some((output.status.code().unwrap(), text))
}

#[test]
fn every_input_may_be_standard_input() {
    let session = Session::new();
    session.write("a.s", PROGRAM);
    session.succeed("scene generate triangle");
    session.succeed("assemble a.s -o a.o");
    session.write("own.isa", ".extension own\n.instr half (d: S, a: S) \"custom0 ddddd aaaaa ----------------\" [Done(body)]\n    srai d, a, 1\n.end\n");
    let triangle = std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/kernels/asm/vector/triangle.s")).unwrap();
    // Each input that is a file elsewhere, from standard input
    for (arguments, input, expected) in [
        ("run - --json", PROGRAM.as_bytes(), "\"s1\": 7"),
        ("run - --json", &session.read("a.o"), "\"s1\": 7"),
        ("assemble -", PROGRAM.as_bytes(), "<standard input>: 2 words"),
        ("disassemble -", &session.read("a.o"), "halt"),
        ("run a.s --mem 0x10=- --dump 0x10:3", b"abc", "616263"),
        ("run a.s --machine - --json", b"cores = 2\n", "\"machine\": \"stdin\""),
        ("run a.s --ext - --json", &session.read("own.isa"), "\"s1\": 7"),
        ("machine -", b"cores = 9\n", "cores = 9"),
        ("scene info -", &session.read("triangle.off"), "1 triangle"),
        ("scene info triangle.dsc --mesh -", &session.read("triangle.off"), "1 triangle"),
        ("scene info - --mesh triangle.off", &session.read("triangle.dsc"), "1 triangle"),
        ("scene convert - - --to off", &session.read("triangle.off"), "OFF"),
        ("render triangle --size 4x4 --json --kernel triangle=-", &triangle, "lancer-render-1"),
    ] {
        let (code, out, messages) = fed(&session, arguments, input);
        let out = String::from_utf8_lossy(&out);
        assert_eq!(code, 0, "{arguments}: {messages}");
        assert!(out.contains(expected), "{arguments}: {out}");
    }
    // Standard input is there once, standard output has room for one result, and some results need a name.
    for (arguments, code, message) in [
        ("scene info - --mesh -", 1, "named twice"),
        ("run a.s --mem 0=- --mem 4096=-", 1, "named twice"),
        ("render cornell -o - --json", 2, "two results would go to standard output"),
        ("render cornell -o - --heat -", 2, "two results would go to standard output"),
        ("scene generate cornell -o -", 2, "scene convert cornell - --to off"),
        ("scene convert cornell - --to obj", 2, "several files"),
        ("stress --resume -", 2, "choose a name"),
        ("assemble a.s --list --json", 2, "--list=FILE"),
        ("trace cornell --pixel 1,1 --fst - --perfetto -", 2, "two results"),
    ] {
        let (found, out, messages) = fed(&session, arguments, &session.read("triangle.dsc"));
        assert_eq!((found, out.len()), (code, 0), "{arguments}: {messages}");
        assert!(messages.contains(message), "{arguments}: {messages}");
    }
}

#[test]
fn a_result_on_standard_output_is_that_of_a_file() {
    let session = Session::new();
    session.write("a.s", PROGRAM);
    for (to_file, to_output, name) in [
        ("assemble a.s -o a.o", "assemble a.s -o -", "a.o"),
        ("disassemble a.o -o b.s", "disassemble a.o -o -", "b.s"),
        ("scene convert triangle t.off", "scene convert triangle - --to off", "t.off"),
        ("render triangle --size 4x4 -o t.png", "render triangle --size 4x4 -o -", "t.png"),
        ("render triangle --size 4x4 -q --heat h.png", "render triangle --size 4x4 --heat -", "h.png"),
        ("cores annex --cores 2 --csv c.csv", "cores annex --cores 2 --csv -", "c.csv"),
        (
            "accuracy triangle --size 4x3 --words 32 --csv a.csv",
            "accuracy triangle --size 4x3 --words 32 --csv -",
            "a.csv",
        ),
        ("manual -o m.md", "manual -o -", "m.md"),
        (
            "trace triangle --size 4x4 --pixel 1,1 --perfetto t.json",
            "trace triangle --size 4x4 --pixel 1,1 --perfetto -",
            "t.json",
        ),
    ] {
        assert_eq!(session.run(to_file).code, 0, "{to_file}");
        let (code, out, messages) = fed(&session, to_output, b"");
        assert!(code == 0 && !messages.contains("error"), "{to_output}: {messages}");
        assert!(out == session.read(name), "{to_output} is not {name}: {}", String::from_utf8_lossy(&out));
    }
}

#[test]
fn files_may_come_through_pipes() {
    let session = Session::new();
    session.write("a.s", PROGRAM);
    session.succeed("scene generate triangle");
    for (line, expected) in [
        ("lancer run <(cat a.s) --json", "\"s1\": 7"),
        ("cat a.s | lancer run /dev/stdin --json", "\"s1\": 7"),
        ("lancer assemble a.s -o - | lancer run - --json", "\"s1\": 7"),
        ("lancer run <(lancer assemble a.s -o -) --json", "\"s1\": 7"),
        ("lancer disassemble <(lancer assemble a.s -o -)", "halt"),
        ("lancer scene info <(cat triangle.off)", "1 triangle"),
        ("lancer scene info <(cat triangle.dsc) --mesh <(cat triangle.off)", "1 triangle"),
        ("lancer render <(lancer scene convert cornell - --to off) --size 4x4 --json", "\"triangles\": 676"),
        ("lancer render triangle --size 4x4 --json --machine <(lancer machine wide32)", "\"clock_hz\": 100000000"),
    ] {
        let Some((code, text)) = in_bash(&session, line) else { return };
        assert_eq!(code, 0, "{line}: {text}");
        assert!(text.contains(expected), "{line}: {text}");
    }
}
