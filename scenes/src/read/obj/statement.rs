//! The statements of `.obj` and `.mtl` texts: a keyword and its arguments on one line, or on several where each but the
//! last ends in a backslash. Names end with their line, since paths of some systems end in a backslash.

use std::borrow::Cow;

use messages::Diagnostic;

use super::super::words::{Word, Words};

/// Statements whose argument is a name, or a path behind options.
const NAMING: [&str; 16] = [
    "o",
    "g",
    "usemtl",
    "newmtl",
    "mtllib",
    "usemap",
    "maplib",
    "shadow_obj",
    "trace_obj",
    "call",
    "csh",
    "bump",
    "disp",
    "decal",
    "refl",
    "norm",
];

/// The keyword of the next statement; its arguments replace those in `arguments`.
pub(super) fn next<'a>(words: &mut Words<'a>, arguments: &mut Vec<Word<'a>>) -> Option<Word<'a>> {
    let keyword = words.next()?;
    let argument = match NAMING.contains(&keyword.text) || keyword.text.starts_with("map_") {
        true => Words::next_in_line,
        false => argument,
    };
    arguments.clear();
    while let Some(argument) = argument(words) {
        arguments.push(argument);
    }
    Some(keyword)
}

/// The next word of the statement.
fn argument<'a>(words: &mut Words<'a>) -> Option<Word<'a>> {
    loop {
        let word = words.next_in_line()?;
        let Some(text) = word.text.strip_suffix('\\') else { return Some(word) };
        let end = words.position();
        if words.next_in_line().is_some() {
            words.seek(end);
            return Some(word);
        }
        if words.is_at_end() {
            let error = Diagnostic::error("the file ends where a backslash says that the line goes on");
            words.complain(error.at(words.place(end - 1..end), "nothing follows"));
        }
        words.pass_line_end();
        if !text.is_empty() {
            return Some(Word { text, start: word.start });
        }
    }
}

/// From the keyword to the last of the arguments.
pub(super) fn span(keyword: Word<'_>, arguments: &[Word<'_>]) -> std::ops::Range<usize> {
    keyword.start..arguments.last().unwrap_or(&keyword).span().end
}

/// A name without the comment behind it. A `#` within a word belongs to the name.
pub(super) fn uncommented(name: &str) -> &str {
    let starts_comment = |&(at, _): &(usize, &str)| at == 0 || name[..at].ends_with(|c: char| c.is_ascii_whitespace());
    let end = name.match_indices('#').find(starts_comment).map_or(name.len(), |(at, _)| at);
    name[..end].trim_end()
}

/// A name with plain blanks where some programs write a backslash before them.
pub(super) fn unescaped(name: &str) -> Cow<'_, str> {
    match name.contains("\\ ") {
        true => Cow::Owned(name.replace("\\ ", " ")),
        false => Cow::Borrowed(name),
    }
}

/// The names of a list: separated by blanks, except by those behind a backslash.
pub(super) fn listed(names: &str) -> Vec<String> {
    let mut list: Vec<String> = Vec::new();
    let mut is_continued = false;
    for word in names.split_whitespace() {
        match list.last_mut() {
            Some(last) if is_continued => *last = format!("{} {word}", &last[..last.len() - 1]),
            _ => list.push(word.to_owned()),
        }
        is_continued = word.ends_with('\\');
    }
    list
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_escapes_are_told_from_names() {
        for (name, plain) in [("red # c", "red"), ("red#2", "red#2"), ("# c", ""), ("a\t#1 #2", "a"), ("a b", "a b")] {
            assert_eq!(uncommented(name), plain);
        }
        assert_eq!(unescaped("a\\ b\\c"), "a b\\c");
        assert_eq!(listed("a\\ b.mtl  c\\d.mtl e"), ["a b.mtl", "c\\d.mtl", "e"]);
        assert_eq!(listed("a\\"), ["a\\"]);
    }
}
