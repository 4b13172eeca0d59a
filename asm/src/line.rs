//! One line to assemble, straight from a file or with a macro's arguments put in, and the way back from its octets to
//! the octets of the file.

use std::collections::HashMap;
use std::rc::Rc;

use crate::message::At;
use crate::token::{continues_name, starts_comment, starts_name};

/// A stretch of a substituted line and where in the file it comes from.
#[derive(Clone, Copy, Debug)]
struct OriginSegment {
    end: u32,
    from: u32,
    to: u32,
    is_verbatim: bool,
}

/// A line with its origin.
#[derive(Clone, Debug)]
pub(crate) struct OriginLine {
    /// The text, without its end of line.
    pub text: Rc<str>,
    segments: Option<Rc<[OriginSegment]>>,
    /// Index of the file.
    pub source: u16,
    /// Line of the file, from 1.
    pub number: u32,
    start: u32,
    /// The chain of macro calls that it comes from; 0 for none.
    pub context: u32,
}

impl OriginLine {
    /// Line `number` of a file, starting at octet `start`.
    pub fn of_file(text: &str, source: u16, number: u32, start: usize, context: u32) -> OriginLine {
        OriginLine { text: text.into(), segments: None, source, number, start: start as u32, context }
    }

    /// The place in the file of octets of this line.
    pub fn at(&self, start: usize, end: usize) -> At {
        let (source, context) = (self.source, self.context);
        let Some(segments) = &self.segments else {
            return At { source, context, start: self.start + start as u32, end: self.start + end as u32 };
        };
        let find = |offset: u32| {
            let place = segments.partition_point(|segment| segment.end <= offset).min(segments.len().saturating_sub(1));
            let before = if place == 0 { 0 } else { segments[place - 1].end };
            segments.get(place).map(|segment| (*segment, offset.saturating_sub(before)))
        };
        let from = find(start as u32).map_or(self.start, |(segment, distance)| {
            if segment.is_verbatim { segment.from + distance } else { segment.from }
        });
        let to = find(end.saturating_sub(1) as u32).map_or(self.start, |(segment, distance)| {
            if segment.is_verbatim { (segment.from + distance + 1).min(segment.to) } else { segment.to }
        });
        At { source, context, start: from, end: if end > start { to.max(from) } else { from } }
    }

    /// The whole line without blanks at its ends.
    pub fn at_all(&self) -> At {
        let start = self.text.len() - self.text.trim_start().len();
        self.at(start, self.text.trim_end().len().max(start))
    }

    /// Macro arguments were put in.
    pub fn is_substituted(&self) -> bool {
        self.segments.is_some()
    }

    /// The line with arguments put in.
    pub fn substituted(&self, substitution: &Substitution, context: u32) -> OriginLine {
        let text = &self.text;
        if substitution.locals.is_empty() && !text.contains('\\') {
            return OriginLine { context, ..self.clone() };
        }
        // Copy the line and note for each piece where it comes from: `add \a` with a = s12 is "add " from the file and "s12" for `\a`.
        let mut new = String::with_capacity(text.len() + 16);
        let mut segments = Vec::new();
        let mut copied = 0;
        let mut at = 0;
        let mut is_quoted = false;
        while let Some(&octet) = text.as_bytes().get(at) {
            // Octets of longer characters are passed by one at a time: only ASCII matters here.
            if !octet.is_ascii() {
                at += 1;
                continue;
            }
            let (c, rest) = (char::from(octet), &text[at..]);
            // What stands here: an argument, a text, a comment, a local name, or anything else, an octet long.
            let (replacement, length) = if c == '\\' {
                match substitution.backslash(&rest[1..]) {
                    Some((replacement, length)) => (Some(replacement), length + 1),
                    None => (None, if is_quoted { 1 + rest[1..].chars().next().map_or(0, char::len_utf8) } else { 1 }),
                }
            } else if c == '"' {
                is_quoted = !is_quoted;
                (None, 1)
            } else if is_quoted {
                (None, 1)
            } else if starts_comment(rest) {
                break;
            } else if c == '\'' {
                (None, if rest[1..].starts_with("\"'") { 3 } else { 1 })
            } else if starts_name(c) || c.is_ascii_digit() {
                let length = name_length(rest);
                let has_locals = !substitution.locals.is_empty();
                (if has_locals { substitution.locals.get(&rest[..length]).cloned() } else { None }, length)
            } else {
                (None, 1)
            };
            if let Some(replacement) = replacement {
                self.copy(copied..at, &mut new, &mut segments);
                new.push_str(&replacement);
                let origin = self.at(at, at + length);
                segments.push(OriginSegment {
                    end: new.len() as u32,
                    from: origin.start,
                    to: origin.end,
                    is_verbatim: false,
                });
                copied = at + length;
            }
            at += length;
        }
        self.copy(copied..text.len(), &mut new, &mut segments);
        OriginLine { text: new.into(), segments: Some(segments.into()), context, ..*self }
    }

    fn copy(&self, range: std::ops::Range<usize>, new: &mut String, segments: &mut Vec<OriginSegment>) {
        if range.is_empty() {
            return;
        }
        // A line of the file is one piece; a line with pieces of its own hands on those in the range, cut at its ends.
        let base = new.len() as u32;
        new.push_str(&self.text[range.clone()]);
        let Some(own) = &self.segments else {
            let from = self.start + range.start as u32;
            segments.push(OriginSegment {
                end: new.len() as u32,
                from,
                to: from + range.len() as u32,
                is_verbatim: true,
            });
            return;
        };
        let mut before = 0;
        for segment in own.iter() {
            let (start, end) = (before.max(range.start as u32), segment.end.min(range.end as u32));
            if start < end {
                let end_in_new = base + end - range.start as u32;
                let cut = if segment.is_verbatim {
                    let from = segment.from + start - before;
                    OriginSegment { end: end_in_new, from, to: from + end - start, is_verbatim: true }
                } else {
                    OriginSegment { end: end_in_new, ..*segment }
                };
                segments.push(cut);
            }
            before = segment.end;
        }
    }
}

fn name_length(text: &str) -> usize {
    text.bytes().position(|octet| !continues_name(octet.into())).unwrap_or(text.len())
}

/// Replacements in the lines of one expansion: names and their texts.
#[derive(Debug, Default)]
pub(crate) struct Substitution {
    /// Arguments by parameter.
    pub arguments: HashMap<Rc<str>, Rc<str>>,
    /// Names that are this expansion's own, with what they are called outside.
    pub locals: HashMap<Rc<str>, Rc<str>>,
    /// The number that `\@` stands for; `None` where it stands for nothing.
    pub number: Option<usize>,
}

impl Substitution {
    /// Octets of all names and texts.
    pub fn octets(&self) -> usize {
        self.arguments.iter().chain(&self.locals).map(|(name, text)| name.len() + text.len()).sum()
    }

    /// The replacement of a backslash and the first octets of `rest`, and the number of those octets.
    fn backslash(&self, rest: &str) -> Option<(Rc<str>, usize)> {
        if let (true, Some(number)) = (rest.starts_with('@'), self.number) {
            return Some((number.to_string().into(), 1));
        }
        if rest.starts_with("()") {
            return Some(("".into(), 2));
        }
        // The longest name counts: `\ab` is no `\a` before a b.
        let length = name_length(rest);
        self.arguments.get(&rest[..length]).map(|argument| (argument.clone(), length))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn substitution(pairs: &[(&str, &str)]) -> Substitution {
        let arguments = pairs.iter().map(|&(name, text)| (name.into(), text.into())).collect();
        Substitution { arguments, number: Some(7), ..Substitution::default() }
    }

    #[test]
    fn arguments_numbers_and_local_names_are_put_in() {
        let mut with = substitution(&[("a", "s12"), ("text", "hi")]);
        with.locals.insert("loop".into(), "loop$7".into());
        let line = OriginLine::of_file("loop: add \\a, \\a\\().x, loops \"\\text\\n loop\" ; \\a", 0, 1, 100, 0);
        let new = line.substituted(&with, 3);
        assert_eq!(&*new.text, "loop$7: add s12, s12.x, loops \"hi\\n loop\" ; \\a");
        assert_eq!(new.context, 3);
    }

    #[test]
    fn places_lead_back_to_the_file() {
        let line = OriginLine::of_file("add \\a, \\b!", 0, 1, 100, 0);
        let once = line.substituted(&substitution(&[("a", "long_name")]), 1);
        let twice = once.substituted(&substitution(&[("b", "x")]), 2);
        assert_eq!(&*twice.text, "add long_name, x!");
        let place = |start, end| {
            let at = twice.at(start, end);
            (at.start, at.end)
        };
        assert_eq!(place(0, 3), (100, 103));
        assert_eq!(place(4, 13), (104, 106));
        assert_eq!(place(6, 8), (104, 106));
        assert_eq!(place(15, 16), (108, 110));
        assert_eq!(place(16, 17), (110, 111));
        assert_eq!(place(17, 17), (111, 111));
    }
}
