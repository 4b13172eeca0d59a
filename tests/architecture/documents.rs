//! Names of files and constants in pages and in the documentation of sources: each is there.

use std::collections::BTreeSet;
use std::path::Path;

use super::{files, root};

/// Endings of the files that a bare name means somewhere in the project; programs and machines are also names of a reader's own files.
const SOURCES: [&str; 1] = [".rs"];

/// Files that pages still name though they are not there. The list may only become shorter.
const MISSING: [&str; 0] = [];

/// Lines of text for people, with their numbers: of a page those outside of listings, of a source its documentation.
fn prose<'a>(name: &str, text: &'a str) -> Vec<(usize, &'a str)> {
    let mut is_listing = false;
    let numbered = (1..).zip(text.lines());
    if name.ends_with(".md") {
        let outside = numbered.filter(|(_, line)| {
            let is_fence = line.trim_start().starts_with("```");
            is_listing ^= is_fence;
            !is_listing && !is_fence
        });
        return outside.collect();
    }
    numbered.filter(|(_, line)| ["///", "//!"].iter().any(|mark| line.trim_start().starts_with(mark))).collect()
}

/// Texts in back ticks.
fn quoted(line: &str) -> impl Iterator<Item = &str> {
    let pieces: Vec<&str> = line.split('`').collect();
    let closed = if pieces.len() % 2 == 1 { pieces.len() } else { pieces.len() - 1 };
    (1..closed).step_by(2).map(move |at| pieces[at]).collect::<Vec<_>>().into_iter()
}

/// Targets of links to files.
fn links(line: &str) -> impl Iterator<Item = &str> {
    let targets = line.split("](").skip(1).filter_map(|rest| rest.split([')', '#']).next());
    targets.filter(|target| !target.is_empty() && !target.contains([':', ' ', '<', '`']))
}

#[test]
fn files_that_are_named_are_there() {
    let (root, files) = (root(), files());
    let tops: BTreeSet<&str> = files.iter().filter_map(|(name, _)| name.split_once('/')).map(|(top, _)| top).collect();
    let is_name =
        |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_alphanumeric() || "._/-".contains(c));
    let is_there = |of: &str, text: &str| {
        let ends = |name: &str| name == text || name.ends_with(&format!("/{text}"));
        match text.split_once('/') {
            Some((top, _)) if tops.contains(top) => root.join(text).exists() || root.join(of).join(text).exists(),
            _ => !SOURCES.iter().any(|end| text.ends_with(end)) || files.iter().any(|(name, _)| ends(name)),
        }
    };
    let mut missing = Vec::new();
    for (name, text) in files.iter().filter(|(name, _)| name.ends_with(".md") || name.ends_with(".rs")) {
        let folder = root.join(Path::new(name).parent().unwrap());
        // A source names files from its crate's folder, too.
        let of = name.split('/').next().unwrap_or_default();
        for (number, line) in prose(name, text) {
            let paths = quoted(line).filter(|text| is_name(text) && !is_there(of, text)).map(str::to_owned);
            let is_page = name.ends_with(".md");
            let targets = links(line).filter(|target| is_page && !folder.join(target).exists()).map(str::to_owned);
            missing.extend(paths.chain(targets).map(|path| format!("{name}:{number}: {path}")));
        }
    }
    let listed = |line: &String| MISSING.iter().find(|file| line.ends_with(&format!(": {file}")));
    let found: BTreeSet<&str> = missing.iter().filter_map(listed).copied().collect();
    missing.retain(|line| listed(line).is_none());
    missing.extend(
        MISSING.iter().filter(|file| !found.contains(*file)).map(|file| format!("{file} is listed for nothing")),
    );
    assert!(missing.is_empty(), "files that are not there:\n{}", missing.join("\n"));
}

#[test]
fn constants_that_are_named_are_there() {
    let is_constant = |text: &str| {
        let is_upper = |c: char| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_';
        text.contains('_') && text.starts_with(|c: char| c.is_ascii_uppercase()) && text.chars().all(is_upper)
    };
    let files = files();
    let code = files.iter().filter(|(name, _)| [".rs", ".s", ".inc", ".toml"].iter().any(|end| name.ends_with(end)));
    let words: BTreeSet<&str> = code
        .flat_map(|(_, text)| text.lines())
        .filter(|line| !line.trim_start().starts_with("//"))
        .flat_map(|line| line.split(|c: char| !c.is_ascii_alphanumeric() && c != '_'))
        .filter(|word| is_constant(word))
        .collect();
    let mut missing = Vec::new();
    for (name, text) in files.iter().filter(|(name, _)| name.ends_with(".md") || name.ends_with(".rs")) {
        for (number, line) in prose(name, text) {
            let named =
                quoted(line).map(|text| text.rsplit("::").next().unwrap_or(text)).filter(|text| is_constant(text));
            missing.extend(named.filter(|text| !words.contains(text)).map(|text| format!("{name}:{number}: {text}")));
        }
    }
    assert!(missing.is_empty(), "constants that are not there:\n{}", missing.join("\n"));
}

#[test]
fn messages_of_a_forgotten_step_are_what_the_sources_say() {
    let files = files();
    let text_of = |folder: &str| -> String {
        let sources = files.iter().filter(|(name, _)| name.starts_with(folder) && name.ends_with(".rs"));
        sources.map(|(_, text)| text.as_str()).collect()
    };
    let sources = text_of("isa/src/") + &text_of("emu/src/");
    let (_, page) = files.iter().find(|(name, _)| name == "CONTRIBUTING.md").expect("the page is there");
    let section = page
        .split("\n## ")
        .find(|section| section.starts_with("What a forgotten step says"))
        .expect("it has the table");
    let mut pieces = 0;
    for message in section.lines().filter(|line| line.starts_with('|')).filter_map(|line| line.split('|').nth(2)) {
        // Messages of rustc itself have a number.
        for piece in message
            .split("error[E")
            .next()
            .unwrap_or_default()
            .split('`')
            .map(|piece| piece.trim_matches([' ', ',', '.']))
        {
            let own = piece.trim_start_matches("evaluation panicked:").trim_start_matches("error:").trim();
            if own.len() > 12 && !message.contains("the test that") {
                assert!(sources.contains(own), "no source says `{own}`");
                pieces += 1;
            }
        }
    }
    assert!(pieces > 8, "{pieces} pieces of messages");
}
