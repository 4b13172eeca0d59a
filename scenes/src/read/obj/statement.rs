//! The statements of `.obj` and `.mtl` texts: a keyword and its arguments on one line, or on several where each but the
//! last ends in a backslash.

use messages::Diagnostic;

use super::super::words::{Word, Words};

/// The keyword of the next statement; its arguments replace those in `arguments`.
pub(super) fn next<'a>(words: &mut Words<'a>, arguments: &mut Vec<Word<'a>>) -> Option<Word<'a>> {
    let keyword = words.next()?;
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
