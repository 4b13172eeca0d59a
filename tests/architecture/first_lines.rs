//! First lines of documentation: each names its thing and is understood alone, so it begins with no question word and no bare pronoun.

use std::collections::BTreeMap;

use super::{files, root};

/// Words with which a first line does not begin.
const WORDS: [&str; 12] =
    ["What", "Whether", "How", "Where", "Why", "When", "Who", "Whose", "It", "Its", "They", "The same"];

/// The lines that still begin so, in the order of their letters; the file may only become shorter.
const LEFT: &str = "tests/architecture/first_lines.txt";

/// The first lines of a source's documentation, with their numbers.
fn first_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut is_inside = false;
    let documentation = |line: &'_ str| -> Option<usize> {
        let is_it = ["///", "//!"].iter().any(|mark| line.starts_with(mark)) && !line.starts_with("////");
        is_it.then_some(3)
    };
    (1..).zip(text.lines()).filter_map(move |(number, line)| {
        let line = line.trim_start();
        let marks = documentation(line);
        let is_first = marks.is_some() && !is_inside;
        is_inside = marks.is_some();
        is_first.then(|| (number, line[3..].trim()))
    })
}

/// A first line is understood only by someone who reads on.
fn is_unclear(line: &str) -> bool {
    WORDS.iter().any(|word| {
        line.strip_prefix(word).is_some_and(|rest| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_'))
    })
}

#[test]
fn first_lines_of_documentation_are_understood_alone() {
    let path = root().join(LEFT);
    let listed = std::fs::read_to_string(&path).unwrap_or_default();
    let mut left: BTreeMap<&str, usize> = BTreeMap::new();
    listed.lines().for_each(|line| *left.entry(line).or_default() += 1);
    let (files, mut new, mut kept) = (files(), Vec::new(), Vec::new());
    for (name, text) in files.iter().filter(|(name, _)| name.ends_with(".rs")) {
        for (number, line) in first_lines(text).filter(|(_, line)| is_unclear(line)) {
            match left.get_mut(line).filter(|count| **count > 0) {
                Some(count) => {
                    *count -= 1;
                    kept.push(line);
                }
                None => new.push(format!("{name}:{number}: {line}")),
            }
        }
    }
    assert!(
        new.is_empty(),
        "a first line names its thing (\"Place of the label.\", \"Counting is on.\"):\n{}",
        new.join("\n")
    );
    kept.sort_unstable();
    if std::env::var_os("LANCER_BLESS").is_some() {
        std::fs::write(&path, kept.iter().map(|line| format!("{line}\n")).collect::<String>()).unwrap();
        return;
    }
    let gone: Vec<&str> = left.into_iter().filter(|(_, count)| *count > 0).map(|(line, _)| line).collect();
    assert!(gone.is_empty(), "listed in {LEFT} and gone; LANCER_BLESS=1 takes them out:\n{}", gone.join("\n"));
}

#[test]
fn question_words_are_found_at_the_beginning_alone() {
    let text =
        "//! What is.\n//! Where.\n\n/// Its name.\n/// It is.\nfn f() {} // How\n/// Italic text, whatever it is.\n";
    let found: Vec<_> = first_lines(text).collect();
    assert_eq!(found, [(1, "What is."), (4, "Its name."), (7, "Italic text, whatever it is.")]);
    assert_eq!(found.iter().filter(|(_, line)| is_unclear(line)).count(), 2);
}
