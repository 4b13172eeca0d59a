//! Names of types: none stands for two types, private ones and those of other crates among them.

use std::collections::BTreeMap;

use super::{files, members};

/// Names that still stand for two types. The list may only become shorter.
const TWICE: [&str; 0] = [];

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

/// The file is part of a library or program, not of tests or benchmarks.
fn is_product(path: &str, members: &[String]) -> bool {
    path.starts_with("src/") || members.iter().any(|member| path.starts_with(&format!("{member}/src/")))
}

#[test]
fn a_name_of_a_type_stands_for_one_type() {
    let (members, files) = (members(), files());
    let mut places: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for (path, text) in files.iter().filter(|(path, _)| path.ends_with(".rs") && is_product(path, &members)) {
        for (number, line) in (1..).zip(text.lines()) {
            if let Some(name) = defined(line) {
                places.entry(name).or_default().push(format!("{path}:{number}"));
            }
        }
    }
    assert!(places.len() > 400, "only {} types found", places.len());
    let twice: BTreeMap<_, _> = places.into_iter().filter(|(_, places)| places.len() > 1).collect();
    let mut found: Vec<String> = Vec::new();
    for (name, places) in twice.iter().filter(|(name, _)| !TWICE.contains(name)) {
        found.push(format!("`{name}`: {}", places.join(", ")));
    }
    found.extend(
        TWICE.iter().filter(|name| !twice.contains_key(*name)).map(|name| format!("{name} is listed for nothing")),
    );
    assert!(found.is_empty(), "types of one name:\n{}", found.join("\n"));
}
