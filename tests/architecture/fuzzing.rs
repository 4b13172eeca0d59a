//! The fuzzers' package, which the gate does not build: what it names is there, and every place that opens a user's file has a surface.

use std::collections::{BTreeMap, BTreeSet};

use super::{files, root};

/// Files below `src` that open what a user names, each with the surfaces that try what is read there.
const DOORS: [(&str, &[&str]); 21] = [
    ("src/command/arithmetic.rs", &["arithmetic"]),
    ("src/command/assemble.rs", &["assembler"]),
    ("src/command/debug.rs", &["assembler", "debugger", "dap"]),
    ("src/command/diff.rs", &["result"]),
    ("src/command/run.rs", &["assembler", "object", "words", "hex"]),
    // Octets as they are: a memory has no form.
    ("src/command/run_arguments.rs", &[]),
    ("src/command/stress.rs", &["stress"]),
    ("src/command/sweep/mod.rs", &["study"]),
    ("src/extension/file.rs", &["extension"]),
    ("src/files/program.rs", &["object", "words", "hex"]),
    ("src/inject/part.rs", &["injections"]),
    ("src/input.rs", &["off", "stl", "dsc", "obj", "mtl", "ply"]),
    ("src/machine.rs", &["machine", "protections"]),
    ("src/settings/job.rs", &["kernel"]),
    ("src/settings/read.rs", &["settings"]),
    ("src/sweep/contents.rs", &["kernel"]),
    ("src/sweep/dataset.rs", &["table"]),
    ("src/sweep/part.rs", &["part"]),
    ("src/sweep/plan.rs", &["plan"]),
    ("src/sweep/recordings.rs", &["recordings"]),
    ("src/main.rs", &["arguments"]),
];

/// Calls that open a file, or read a command line.
const OPENING: [&str; 9] = [
    "files::source(",
    "files::source_of(",
    "files::open(",
    "files::read(",
    "files::read_up_to(",
    "read::load(",
    "super::source_of(",
    "invocation::expanded(",
    "Recorded::decode(",
];

/// Texts between quotation marks, and those between one text and the next.
fn literals(text: &str) -> impl Iterator<Item = &str> {
    text.split('"')
}

fn fuzzers() -> String {
    let texts = files().into_iter().filter(|(name, _)| name.starts_with("fuzz/src/surfaces/"));
    texts.map(|(_, text)| text).collect()
}

#[test]
fn every_file_that_opens_what_a_user_names_has_a_surface() {
    let fuzzers = fuzzers();
    let known: BTreeMap<&str, &[&str]> = DOORS.into_iter().collect();
    let opens = |text: &str| {
        let text = text.split("#[cfg(test)]").next().unwrap_or_default();
        OPENING.iter().any(|call| text.contains(call))
    };
    let found: BTreeSet<String> = files()
        .into_iter()
        .filter(|(name, text)| name.starts_with("src/") && name.ends_with(".rs") && opens(text))
        .map(|(name, _)| name)
        .collect();
    let names: BTreeSet<&str> = literals(&fuzzers).collect();
    for name in &found {
        assert!(known.contains_key(name.as_str()), "{name} opens a file: which surface of `fuzz` tries what it reads?");
    }
    for (name, surfaces) in known {
        assert!(found.contains(name), "{name} opens no file any more");
        surfaces.iter().for_each(|surface| assert!(names.contains(surface), "`fuzz` has no surface `{surface}`"));
    }
}

#[test]
fn every_mesh_format_has_a_surface() {
    let fuzzers = fuzzers();
    let formats = std::fs::read_to_string(root().join("scenes/src/read/format.rs")).unwrap();
    let names: Vec<&str> = formats.split("&").filter_map(|part| Some(part.split_once("::READER")?.0)).collect();
    assert!(names.len() > 3, "the readers of meshes are found: {names:?}");
    for name in names {
        assert!(literals(&fuzzers).any(|text| text == name), "`fuzz` has no surface `{name}`");
    }
}

#[test]
fn files_that_the_fuzzers_name_are_there() {
    let fuzzers = fuzzers();
    let is_path = |text: &&str| {
        text.contains('/') && text.bytes().all(|octet| octet.is_ascii_alphanumeric() || b"/_.".contains(&octet))
    };
    let tops: BTreeSet<String> =
        files().into_iter().filter_map(|(name, _)| Some(name.split_once('/')?.0.to_owned())).collect();
    let named =
        literals(&fuzzers).filter(is_path).filter(|path| tops.contains(path.split('/').next().unwrap_or_default()));
    let mut count = 0;
    for path in named.filter(|path| !path.starts_with("target/")) {
        assert!(root().join(path).exists(), "`fuzz` names {path}, which is not there");
        count += 1;
    }
    assert!(count > 60, "the files of the readers are named: {count}");
}
