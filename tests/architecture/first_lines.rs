//! First lines of documentation: each names its thing and is understood alone, so it begins with no question word and no bare pronoun.

use super::files;

/// Words with which a first line does not begin.
const WORDS: [&str; 18] = [
    "What", "Whether", "How", "Where", "Why", "When", "Who", "Whose", "Which", "It", "Its", "They", "This", "That",
    "These", "Those", "Nobody", "The same",
];

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
    let files = files();
    let mut unclear = Vec::new();
    for (name, text) in files.iter().filter(|(name, _)| name.ends_with(".rs")) {
        let found = first_lines(text).filter(|(_, line)| is_unclear(line));
        unclear.extend(found.map(|(number, line)| format!("{name}:{number}: {line}")));
    }
    assert!(
        unclear.is_empty(),
        "a first line names its thing (\"Place of the label.\", \"Counting is on.\"):\n{}",
        unclear.join("\n")
    );
}

#[test]
fn question_words_are_found_at_the_beginning_alone() {
    let text =
        "//! What is.\n//! Where.\n\n/// Its name.\n/// It is.\nfn f() {} // How\n/// Italic text, whatever it is.\n";
    let found: Vec<_> = first_lines(text).collect();
    assert_eq!(found, [(1, "What is."), (4, "Its name."), (7, "Italic text, whatever it is.")]);
    assert_eq!(found.iter().filter(|(_, line)| is_unclear(line)).count(), 2);
}
