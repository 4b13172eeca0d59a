//! The project as a whole, read off its manifests and its files.

mod documents;
mod first_lines;
mod fuzzing;
mod type_names;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Crates that each crate may build on. The root package may build on all.
const MAY_USE: [(&str, &[&str]); 11] = [
    ("messages", &[]),
    ("isa", &["messages"]),
    ("conformance", &["messages", "isa"]),
    ("asm", &["messages", "isa"]),
    ("random", &[]),
    ("testing", &[]),
    ("programs", &["messages", "isa", "random"]),
    ("emu", &["messages", "isa", "random"]),
    ("scenes", &["messages"]),
    ("kernels", &["messages", "isa", "asm", "scenes"]),
    ("trials", &["isa", "conformance", "random", "emu", "scenes", "kernels"]),
];

/// Crates that only tests of a crate may use besides.
const TESTS_MAY_USE: [(&str, &[&str]); 4] =
    [("isa", &["random"]), ("asm", &["testing"]), ("emu", &["testing", "programs"]), ("kernels", &["emu", "random"])];

/// Most lines of a source file.
const MOST_LINES: usize = 450;

/// Files that are longer, each with the reason.
const LONGER: [(&str, &str); 0] = [];

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// The manifest of a crate's folder.
fn manifest(folder: &Path) -> toml::Table {
    let path = folder.join("Cargo.toml");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    text.parse().unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn members() -> Vec<String> {
    let members = manifest(&root())["workspace"]["members"].as_array().unwrap().clone();
    members.iter().map(|member| member.as_str().unwrap().to_owned()).collect()
}

/// Names that one of a manifest's sections depends on, whatever the target.
fn dependencies(manifest: &toml::Table, section: &str) -> BTreeSet<String> {
    let targets = manifest.get("target").and_then(|targets| targets.as_table());
    let tables = targets.into_iter().flatten().filter_map(|(_, target)| target.as_table()).chain([manifest]);
    tables.filter_map(|table| table.get(section)?.as_table()).flat_map(|names| names.keys().cloned()).collect()
}

fn allowed<'a>(list: &'a [(&str, &'a [&'a str])], name: &str) -> &'a [&'a str] {
    list.iter().find(|(crate_name, _)| *crate_name == name).map_or(&[], |(_, allowed)| allowed)
}

#[test]
fn crates_depend_in_one_direction() {
    let members = members();
    let named: BTreeSet<&str> = MAY_USE.iter().map(|(name, _)| *name).collect();
    assert_eq!(members.iter().map(String::as_str).collect::<BTreeSet<_>>(), named, "a crate without a place");
    for name in &members {
        let manifest = manifest(&root().join(name));
        for (section, for_tests) in [
            ("dependencies", &[][..]),
            ("build-dependencies", &[]),
            ("dev-dependencies", allowed(&TESTS_MAY_USE, name)),
        ] {
            for used in dependencies(&manifest, section).into_iter().filter(|used| members.contains(used)) {
                let is_allowed = allowed(&MAY_USE, name).contains(&&*used) || for_tests.contains(&&*used);
                assert!(is_allowed, "`{name}` must not build on `{used}` ([{section}])");
            }
        }
    }
}

#[test]
fn no_crate_comes_from_outside() {
    let root = root();
    let folders = members().into_iter().map(|member| root.join(member)).chain([root.clone()]);
    for folder in folders {
        for path in paths(&toml::Value::Table(manifest(&folder))) {
            let target = folder.join(&path);
            let target = target.canonicalize().unwrap_or_else(|error| panic!("{}: {error}", target.display()));
            assert!(target.starts_with(root.canonicalize().unwrap()), "{}: `{path}`", folder.display());
        }
    }
}

/// Property tests try the same values on every run: what fails on one host fails on all.
#[test]
fn seeds_of_property_tests_are_fixed() {
    let (mut blocks, mut unseeded) = (0, Vec::new());
    for (name, text) in files().iter().filter(|(name, _)| name.ends_with(".rs")) {
        let lines: Vec<&str> = text.lines().map(str::trim).collect();
        for pair in lines.windows(2).filter(|pair| pair[0] == "proptest! {") {
            blocks += 1;
            if !(pair[1].starts_with("#![proptest_config(") && pair[1].contains("RngSeed::Fixed(")) {
                unseeded.push(name.clone());
            }
        }
    }
    assert!(blocks > 20, "{blocks} blocks");
    assert_eq!(unseeded, [""; 0], "the first line of a block has `rng_seed: RngSeed::Fixed(...)`");
}

/// All `path = "..."` of a manifest.
fn paths(value: &toml::Value) -> Vec<String> {
    match value {
        toml::Value::Table(table) => table
            .iter()
            .flat_map(|(key, value)| match value.as_str() {
                Some(path) if key == "path" => vec![path.to_owned()],
                _ => paths(value),
            })
            .collect(),
        toml::Value::Array(values) => values.iter().flat_map(paths).collect(),
        _ => Vec::new(),
    }
}

/// All files of the project with their text, by their names from the root, in the order of the names.
fn files() -> Vec<(String, String)> {
    let (root, mut folders, mut found) = (root(), vec![root()], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.strip_prefix(&root).unwrap().to_string_lossy().replace('\\', "/");
            // What git and cargo keep, and what commands write.
            if [".git", "target", "out"].contains(&&*name) {
                continue;
            }
            if path.is_dir() {
                folders.push(path);
            } else if let Ok(octets) = std::fs::read(&path) {
                found.push((name, String::from_utf8_lossy(&octets).into_owned()));
            }
        }
    }
    found.sort();
    found
}

/// The lines of which a claim about their text holds, for a message.
fn lines<'a>(name: &'a str, text: &'a str, is_found: impl Fn(&str) -> bool + 'a) -> impl Iterator<Item = String> + 'a {
    let numbered = (1..).zip(text.lines()).filter(move |(_, line)| is_found(line));
    numbered.map(move |(number, line)| format!("{name}:{number}: {}", line.trim()))
}

#[test]
fn files_speak_of_the_project_alone() {
    // Put together here so that this file does not find itself.
    let folders = ["work", "tmp", "root", "home"].map(|folder| format!("/{folder}/"));
    let names_a_folder = |line: &str| {
        folders.iter().any(|folder| {
            let is_start = |at: usize| !line[..at].ends_with(|c: char| c.is_alphanumeric() || ".-_/".contains(c));
            line.match_indices(folder.as_str()).any(|(at, _)| is_start(at))
        })
    };
    let files = files();
    let found: Vec<String> = files.iter().flat_map(|(name, text)| lines(name, text, names_a_folder)).collect();
    assert!(found.is_empty(), "folders of one machine:\n{}", found.join("\n"));
}

#[test]
fn no_source_is_unsafe_but_the_engines() {
    let word = concat!("un", "safe");
    let is_there = |line: &str| {
        let code = line.split("//").next().unwrap_or_default();
        code.split(|c: char| !c.is_alphanumeric() && c != '_').any(|found| found == word)
    };
    let files = files();
    let sources = files.iter().filter(|(name, _)| name.ends_with(".rs") && !name.starts_with("emu/src/engine/"));
    let found: Vec<String> = sources.flat_map(|(name, text)| lines(name, text, is_there)).collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn sources_stay_short() {
    let files = files();
    let mut found = Vec::new();
    for (name, text) in files.iter().filter(|(name, _)| [".rs", ".s", ".inc"].iter().any(|end| name.ends_with(end))) {
        let (count, is_listed) = (text.lines().count(), LONGER.iter().any(|(longer, _)| longer == name));
        if (count > MOST_LINES) != is_listed {
            found.push(format!(
                "{name} has {count} lines and {}",
                if is_listed { "is listed" } else { "is not listed" }
            ));
        }
    }
    found.extend(
        LONGER
            .iter()
            .filter(|(longer, _)| files.iter().all(|(name, _)| name != longer))
            .map(|(longer, _)| format!("{longer} is listed and does not exist")),
    );
    assert!(
        found.is_empty(),
        "sources have at most {MOST_LINES} lines; more are two ideas, or listed with a reason:\n{}",
        found.join("\n")
    );
}

/// Wings of the emulator, each of which uses only itself and those before it.
const WINGS: [&str; 12] = [
    "code",
    "semantics",
    "extension",
    "profile",
    "engine",
    "machine",
    "replay",
    "run",
    "inject",
    "shadow",
    "stepper",
    "conformance",
];

/// A source without its comments.
fn without_comments(text: &str) -> String {
    text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

/// First names of the paths that begin at the crate, also those in braces, and those that climb out of their wing: `crate::code::Slot`,
/// `crate::{code, engine::Plan}`, `super::super::engine::Plan` in a file that lies two modules deep (`depth`).
fn roots(text: &str, depth: usize) -> Vec<String> {
    let name = |text: &str| text.trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
    let mut found = Vec::new();
    for (at, _) in text.match_indices("crate::").filter(|(at, _)| !text[..*at].ends_with('$')) {
        let rest = &text[at + "crate::".len()..];
        match rest.strip_prefix('{') {
            // A name stands behind the brace and behind each comma that is in no other braces.
            Some(list) => {
                let mut depth = 0;
                found.push(name(list));
                for (at, c) in list.char_indices() {
                    match c {
                        '{' => depth += 1,
                        '}' if depth == 0 => break,
                        '}' => depth -= 1,
                        ',' if depth == 0 => found.push(name(&list[at + 1..])),
                        _ => {}
                    }
                }
            }
            None => found.push(name(rest)),
        }
    }
    for (at, _) in text.match_indices("super::") {
        let rest = &text[at + "super::".len()..];
        let next: String = name(rest);
        let steps = text[..at].rsplit("super::").take_while(|between| between.is_empty()).count() + 1;
        if steps >= depth && WINGS.contains(&&*next) && rest[next.len()..].starts_with("::") {
            found.push(next);
        }
    }
    found.retain(|name| !name.is_empty());
    found
}

#[test]
fn wings_of_the_emulator_use_those_before_them() {
    const SOURCES: &str = "emu/src/";
    let (files, mut seen) = (files(), BTreeSet::new());
    for (name, text) in files.iter().filter(|(name, _)| name.starts_with(SOURCES) && name.ends_with(".rs")) {
        let place = &name[SOURCES.len()..];
        let wing = place.split('/').next().unwrap_or_default().trim_end_matches(".rs");
        if wing == "lib" {
            continue;
        }
        let own =
            WINGS.iter().position(|other| *other == wing).unwrap_or_else(|| panic!("{name}: a wing without a place"));
        seen.insert(wing);
        let depth = place.trim_end_matches("/mod.rs").split('/').count();
        for used in roots(&without_comments(text), depth) {
            let other = WINGS.iter().position(|other| *other == used);
            let other =
                other.unwrap_or_else(|| panic!("{name}: `crate::{used}` is no wing; name the wing that it is in"));
            assert!(other <= own, "{name}: `{wing}` stands before `{used}` and must not use it");
        }
    }
    assert_eq!(seen.len(), WINGS.len(), "wings without a file");
}

#[test]
fn imports_are_found_wherever_they_stand() {
    let text = "use crate::code::Slot;\nuse crate::{engine::{Plan, native}, run};\nlet a = crate::machine::Bus; // crate::comment\n\
                use super::super::replay::Feed; $crate::semantics";
    assert_eq!(roots(&without_comments(text), 2), ["code", "engine", "run", "machine", "replay"]);
    assert_eq!(roots("use super::run::Host;", 3), [""; 0]);
}
