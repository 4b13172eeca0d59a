//! The text form of STL. The library that reads it wants lower case, says no places and stops at the first `endsolid`:
//! it is handed one statement at a time, so that the one it stumbles over is known.

use std::borrow::Cow;
use std::cell::Cell;
use std::io::{self, Read, Seek, SeekFrom};
use std::ops::Range;
use std::rc::Rc;

use messages::{Diagnostic, Report};

use super::super::mesh::Mesh;
use super::super::words::{self, Word, Words, counted, shortened};
use super::SharedCorners;

/// The statements of a triangle in their order, each with the number of words that it has.
const STEPS: [(&str, usize); 7] = [
    ("facet normal x y z", 5),
    ("outer loop", 2),
    ("vertex x y z", 4),
    ("vertex x y z", 4),
    ("vertex x y z", 4),
    ("endloop", 1),
    ("endfacet", 1),
];

/// The statement that was handed over last.
#[derive(Clone, Default)]
struct Last {
    /// Place of the word; empty at the end of the file.
    span: Range<usize>,
    /// The word that was expected, by number in [`STEPS`]; the first one may be `endsolid` too.
    step: usize,
}

/// Reads a text.
pub(super) fn parse(bytes: Cow<'_, [u8]>, name: &str) -> Result<Mesh, Report> {
    let start = words::start(&bytes);
    let source = words::source(name, bytes);
    let mut words = Words::new(&source, start);
    let Some(first) = words.next() else {
        words.complain(Diagnostic::error("the file is empty").at(words.end(), "expected `solid`"));
        return Err(words.into_report());
    };
    if !first.text.eq_ignore_ascii_case("solid") {
        let place = words.place(first.span());
        let error = Diagnostic::error("an STL text starts with `solid`").at(place, "not `solid`");
        words.complain(error.hint("a binary STL has 80 octets of anything, then the number of its triangles"));
        return Err(words.into_report());
    }
    words.seek(start);
    let last = Rc::new(Cell::new(Last::default()));
    let mut statements =
        Statements { words, start, last: last.clone(), step: None, rest: Vec::new(), text: Vec::new(), at: 0 };
    let mut corners = SharedCorners::default();
    let mut is_good = true;
    match stl_io::create_stl_reader(&mut statements) {
        Ok(triangles) => {
            for triangle in triangles {
                is_good = triangle.is_ok_and(|triangle| corners.push(&triangle));
                if !is_good {
                    break;
                }
            }
        }
        Err(_) => is_good = false,
    }
    let mut words = statements.words;
    let last = last.take();
    if !is_good {
        explain(&mut words, &last);
        // Whatever the library has against a statement that is as it should be.
        if !words.has_errors() {
            let place = words.place(last.span);
            words.complain(Diagnostic::error("this cannot be read as STL").at(place, "not understood"));
        }
    } else if let Some(word) = words.next() {
        let warning = Diagnostic::warning("the file goes on after `endsolid`");
        words.complain(warning.at(words.place(word.span()), "not read"));
    }
    let mesh = corners.into_mesh(name, Vec::new());
    words.finish(Some(mesh))
}

/// Hands over the statements of a text, one with each reading, in the form that the library wants.
struct Statements<'a> {
    words: Words<'a>,
    start: usize,
    last: Rc<Cell<Last>>,
    /// The next step, by number in [`STEPS`]; `None` before the first `solid`.
    step: Option<usize>,
    /// Words behind the first of a statement; kept for its memory.
    rest: Vec<Word<'a>>,
    text: Vec<u8>,
    /// Octets of `text` that are handed over.
    at: usize,
}

impl Statements<'_> {
    /// The next statement into `text`; nothing at the end.
    fn fill(&mut self) {
        self.text.clear();
        self.at = 0;
        while self.text.is_empty() {
            let Some(first) = self.words.next() else {
                let end = self.words.position();
                self.last.set(Last { span: end..end, step: self.step.unwrap_or(0) });
                return;
            };
            let mut rest = std::mem::take(&mut self.rest);
            rest.clear();
            while let Some(word) = self.words.next_in_line() {
                rest.push(word);
            }
            let end = rest.last().unwrap_or(&first).span().end;
            let keyword = lower(first.text);
            let step = self.step.unwrap_or(0);
            // Some programs write `end solid`, and `end loop` and `end facet` with it.
            let is_end = keyword == "endsolid" || keyword == "end" && is_word(&rest, "solid");
            self.last.set(Last { span: first.start..end, step });
            match keyword.as_ref() {
                // A name may follow, with anything in it.
                "solid" if self.step.is_none() || step == 0 => {
                    if self.step.is_none() {
                        self.text.extend(b"solid \n");
                    }
                    self.step = Some(0);
                }
                _ if is_end && step == 0 => {
                    if !self.goes_on() {
                        self.text.extend(b"endsolid\n");
                    }
                }
                // Normals are not used, and often enough are no numbers.
                "facet" if step == 0 => self.hand_over("facet normal 0 0 0", &[]),
                "end" if !rest.is_empty() => {
                    let joined = format!("end{}", lower(rest[0].text));
                    self.hand_over(&joined, &rest[1..]);
                }
                "vertex" => self.hand_over(&keyword, &rest),
                _ => {
                    let lower: Vec<Cow<'_, str>> = rest.iter().map(|word| lower(word.text)).collect();
                    let lower: Vec<Word<'_>> = lower.iter().map(|text| Word { text, start: 0 }).collect();
                    self.hand_over(&keyword, &lower);
                }
            }
            self.rest = rest;
        }
    }

    fn hand_over(&mut self, keyword: &str, rest: &[Word<'_>]) {
        self.text.extend(keyword.as_bytes());
        for word in rest {
            self.text.push(b' ');
            self.text.extend(word.text.as_bytes());
        }
        self.text.push(b'\n');
        self.step = Some((self.step.unwrap_or(0) + 1) % STEPS.len());
    }

    /// Another solid, or another triangle, follows an `endsolid`.
    fn goes_on(&mut self) -> bool {
        let at = self.words.position();
        let next = self.words.next().map(|word| word.text.to_ascii_lowercase());
        self.words.seek(at);
        next.is_some_and(|next| next == "solid" || next == "facet")
    }
}

/// A word in lower case, as it nearly always is already.
fn lower(text: &str) -> Cow<'_, str> {
    match text.bytes().any(|octet| octet.is_ascii_uppercase()) {
        true => Cow::Owned(text.to_ascii_lowercase()),
        false => Cow::Borrowed(text),
    }
}

fn is_word(words: &[Word<'_>], text: &str) -> bool {
    words.first().is_some_and(|word| word.text.eq_ignore_ascii_case(text))
}

impl Read for Statements<'_> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        if self.at == self.text.len() {
            self.fill();
        }
        let count = out.len().min(self.text.len() - self.at);
        out[..count].copy_from_slice(&self.text[self.at..self.at + count]);
        self.at += count;
        Ok(count)
    }
}

impl Seek for Statements<'_> {
    /// Back to the start, wherever the library wants to go: it goes nowhere else.
    fn seek(&mut self, _: SeekFrom) -> io::Result<u64> {
        self.words.seek(self.start);
        self.text.clear();
        self.at = 0;
        self.step = None;
        Ok(0)
    }
}

/// Says what is wrong with the statement that the library did not take.
fn explain(words: &mut Words<'_>, last: &Last) {
    let (expected, count) = STEPS[last.step];
    let also = if last.step == 0 { " or `endsolid`" } else { "" };
    if last.span.is_empty() {
        let message = match last.step {
            0 => "the file ends without `endsolid`".to_string(),
            _ => format!("the file ends within a triangle, before `{expected}`"),
        };
        words.complain(Diagnostic::error(message).at(words.end(), "the end"));
        return;
    }
    words.seek(last.span.start);
    let mut found = Vec::new();
    while let Some(word) = words.next_in_line() {
        found.push(word);
    }
    let Some(&first) = found.first() else { return };
    let keyword = expected.split(' ').next().unwrap_or_default();
    if !first.text.eq_ignore_ascii_case(keyword) {
        let message = format!("expected `{expected}`{also}, found `{}`", shortened(first.text));
        let error = Diagnostic::error(message).at(words.place(first.span()), "out of place");
        words.complain(match keyword == "endloop" {
            true => error.hint("a facet has exactly 3 vertices"),
            false => error,
        });
        return;
    }
    if found.len() != count {
        let message = format!("expected `{expected}`, which is {}", counted(count, "word", "words"));
        let place = words.place(last.span.clone());
        words.complain(Diagnostic::error(message).at(place, format!("{} here", found.len())));
        return;
    }
    if keyword != "vertex" {
        let place = words.place(last.span.clone());
        words.complain(Diagnostic::error(format!("expected `{expected}`")).at(place, "not this"));
        return;
    }
    // Keyword and number of words are right, so it must be one of the coordinates.
    for (word, name) in found[1..].iter().zip(["x", "y", "z"]) {
        let value = words.number(*word, || format!("{name} of a vertex"));
        if !(value as f32).is_finite() {
            words.refuse(*word, format!("{name} of a vertex does not fit single precision"), "too large");
        }
    }
}
