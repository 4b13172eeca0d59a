//! Messages as JSON: every message of every kind of mistake keeps to its schema.

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::schema::{schema, wrong};
use super::session::Session;

/// The messages on standard error, each of which has to keep to the schema.
fn messages(schema: &Value, what: &str, text: &str) -> Vec<Value> {
    let parsed = |line: &str| {
        let message: Value = serde_json::from_str(line).unwrap_or_else(|error| panic!("{what}: {error}: {line}"));
        assert_eq!(wrong(schema, schema, &message, "message"), Vec::<String>::new(), "{what}");
        message
    };
    text.lines().map(parsed).collect()
}

/// Files of a folder and of those in it.
fn files(folder: &Path, out: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() { files(&path, out) } else { out.push(path) }
    }
}

#[test]
fn every_message_of_the_cases_keeps_to_the_schema() {
    let session = Session::new();
    let schema = schema(&session, "lancer-message-1");
    let mut cases = Vec::new();
    files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases"), &mut cases);
    let cases: Vec<&PathBuf> = cases.iter().filter(|path| path.extension().is_some_and(|end| end == "s")).collect();
    assert!(cases.len() > 100);
    let (mut with_places, mut with_help) = (0, 0);
    for case in cases {
        let arguments = format!("assemble {} --message-format json", case.display());
        let run = session.run(&arguments);
        let found = messages(&schema, &arguments, &run.messages);
        let errors: u64 = found.iter().map(|message| message["errors"].as_u64().unwrap()).sum();
        assert_eq!(run.code == 1, errors > 0, "{arguments}\n{}", run.messages);
        // The text is what people see.
        let plain = session.run(&format!("assemble {}", case.display())).messages;
        for message in &found {
            assert!(plain.contains(message["rendered"].as_str().unwrap()), "{arguments}: {message}\n{plain}");
            with_places += usize::from(message["spans"][0]["is_primary"] == true);
            with_help += usize::from(message["help"].is_string());
        }
    }
    assert!(with_places > 20 && with_help > 10, "{with_places} with places, {with_help} with help");
}

#[test]
fn messages_have_code_places_labels_and_help() {
    let session = Session::new();
    session.write("a.s", "    nop\n    vdto  s4, v1, v2\n");
    let run = session.run("assemble a.s --message-format=json");
    let found = messages(&schema(&session, "lancer-message-1"), "a.s", &run.messages);
    let [message] = &found[..] else { panic!("{}", run.messages) };
    assert_eq!((run.code, &message["severity"], &message["schema"]), (1, &"error".into(), &"lancer-message-1".into()));
    assert!(
        message["code"].as_str().unwrap().starts_with('E') && message["help"] == "did you mean `vdot`?",
        "{message}"
    );
    let span = &message["spans"][0];
    assert_eq!((&span["file"], &span["line"], &span["column"]), (&"a.s".into(), &2.into(), &5.into()));
    assert_eq!((&span["start"], &span["end"], &span["end_column"]), (&12.into(), &16.into(), &9.into()));
    assert!(span["label"].is_string(), "{span}");
}

#[test]
fn every_kind_of_mistake_has_its_object() {
    let session = Session::new();
    let schema = schema(&session, "lancer-message-1");
    session.write("m.toml", "core = 1\ncores = \"4\"\n[bus]\noverlap = 3\n");
    session.write("m.off", "OFF\n1 1 0\n0 0 x\n3 0 0 0\n");
    session.write("trap.s", "    trap 7\n");
    session.write("loop.s", "here: j here\n");
    for (arguments, code, count, text) in [
        ("render cornell --machine m.toml", 1, 3, "did you mean `cores`?"),
        ("scene info m.off", 1, 1, "m.off"),
        ("run trap.s", 3, 1, "trap 7"),
        ("run loop.s --max-steps 10", 5, 1, "--max-steps"),
        ("rendr", 2, 1, "`render`?"),
        ("render cornell --size 4", 2, 1, "such as 320x240"),
        ("render cornell --profile vektor", 2, 1, "did you mean `vector`?"),
        ("scene", 2, 1, "requires a subcommand"),
        ("render nowhere.off", 1, 1, "there is no file nowhere.off"),
        ("render cornell --size 8x6 --max-clocks 1 --no-error -q", 4, 1, "at most 1"),
        ("render triangle --size 4x4 --no-error", 0, 1, "picture: triangle.png"),
        ("--message-format xml", 2, 0, ""),
    ] {
        let run = session.run(&format!("{arguments} --message-format json"));
        let found = if count == 0 { Vec::new() } else { messages(&schema, arguments, &run.messages) };
        assert_eq!((run.code, found.len()), (code, count), "{arguments}: {}", run.messages);
        assert!(run.messages.contains(text), "{arguments}: {}", run.messages);
    }
    // A place in a file of TOML for each of its mistakes.
    let run = session.run("machine m.toml --message-format json");
    let lines: Vec<u64> = messages(&schema, "m.toml", &run.messages)
        .iter()
        .map(|message| message["spans"][0]["line"].as_u64().unwrap())
        .collect();
    assert_eq!(lines, [1, 2, 4]);
}

#[test]
fn colours_follow_the_option() {
    let session = Session::new();
    session.write("wrong.s", "    vdto s4, v1, v2\n");
    for arguments in ["assemble wrong.s", "rendr"] {
        let run = |colours: &str| session.run(&format!("{arguments} --color {colours}")).messages;
        assert!(run("always").contains('\u{1b}') && !run("never").contains('\u{1b}'), "{arguments}");
        assert_eq!(run("auto"), run("never"), "{arguments}");
    }
    assert!(session.run("--color always --help").out.contains('\u{1b}'));
    // An object has no colours.
    let run = session.run("assemble wrong.s --color always --message-format json");
    assert!(!run.messages.contains("\u{1b}") && !run.messages.contains("\\u001b"), "{}", run.messages);
}
