//! Names of types: none stands for two types of one crate, private ones among them.

use std::collections::{BTreeMap, BTreeSet};

use super::{files, members};

/// Names that still stand for two types of a crate: crate and name. The list may only become shorter.
const TWICE: [(&str, &str); 0] = [];

/// The name that a line of a source defines as a type, if it does.
///
/// Names that macros put in are none; neither are associated types, which are indented and have no visibility.
fn defined(line: &str) -> Option<&str> {
    let code = line.trim_start();
    let (public, rest) = match code.strip_prefix("pub") {
        Some(rest) if rest.starts_with('(') => (true, rest.split_once(')')?.1.trim_start()),
        Some(rest) if rest.starts_with(' ') => (true, rest.trim_start()),
        _ => (false, code),
    };
    let (keyword, rest) = rest.split_once(' ')?;
    let is_associated = keyword == "type" && !public && line.starts_with(' ');
    if is_associated || !["struct", "enum", "union", "trait", "type"].contains(&keyword) {
        return None;
    }
    let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
    Some(&rest[..end]).filter(|name| name.starts_with(|c: char| c.is_ascii_uppercase()))
}

/// The crate whose library or program a file is part of.
fn crate_of<'a>(path: &str, members: &'a [String]) -> Option<&'a str> {
    if path.starts_with("src/") {
        return Some("lancer");
    }
    members.iter().map(String::as_str).find(|member| path.starts_with(&format!("{member}/src/")))
}

#[test]
fn a_name_of_a_type_stands_for_one_type_of_a_crate() {
    let (members, files) = (members(), files());
    let mut places: BTreeMap<(&str, &str), Vec<String>> = BTreeMap::new();
    for (path, text) in files.iter().filter(|(path, _)| path.ends_with(".rs")) {
        let Some(of) = crate_of(path, &members) else { continue };
        for (number, line) in (1..).zip(text.lines()) {
            if let Some(name) = defined(line) {
                places.entry((of, name)).or_default().push(format!("{path}:{number}"));
            }
        }
    }
    let twice: BTreeMap<_, _> = places.into_iter().filter(|(_, places)| places.len() > 1).collect();
    let allowed: BTreeSet<(&str, &str)> = TWICE.into_iter().collect();
    let mut found: Vec<String> = Vec::new();
    for ((of, name), places) in twice.iter().filter(|(key, _)| !allowed.contains(*key)) {
        found.push(format!("`{name}` of {of}: {}", places.join(", ")));
    }
    found.extend(
        allowed.iter().filter(|key| !twice.contains_key(*key)).map(|key| format!("{key:?} is listed for nothing")),
    );
    assert!(found.is_empty(), "types of one name:\n{}", found.join("\n"));
}

#[test]
fn definitions_are_told_from_what_only_looks_like_one() {
    assert_eq!(defined("pub(super) struct Frame<'a> {"), Some("Frame"));
    assert_eq!(defined("    enum State { A }"), Some("State"));
    assert_eq!(defined("type Read<T> = Result<T, ()>;"), Some("Read"));
    assert_eq!(defined("    type Err = String;"), None);
    assert_eq!(defined("        pub enum $type {"), None);
    assert_eq!(defined("/// struct Frame"), None);
}
