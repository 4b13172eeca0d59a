//! Sources of lines: files, macro calls and repetitions, each inside another.

use std::borrow::Cow;
use std::rc::Rc;

use crate::assembler::Assembler;
use crate::conditional::Condition;
use crate::explain;
use crate::limits::{EXPANDED_LINE, EXPANSION_DEPTH, INCLUDE_DEPTH, LINE_OCTETS, SourceLimits, TEXT_OCTETS};
use crate::line::{OriginLine, Substitution};
use crate::message::{At, MacroCall, Problem, Via};
use crate::symbol::{Name, SymbolValue};
use crate::token::{continues_name, starts_comment, starts_name};

/// A frame's repetitions.
#[derive(Debug)]
pub(crate) enum Repeat {
    /// `.rept`: passes that follow, the counter and its number.
    Count { remaining: i64, counter: Option<Name>, index: i64, at: At },
    /// `.irp`: the parameter and the texts that follow, last one first.
    Texts { parameter: Rc<str>, remaining: Vec<Rc<str>>, at: At },
}

/// The kind of text that a frame reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Origin {
    /// A file, by its index.
    File(u16),
    /// A macro call.
    Macro,
    /// A repetition.
    Repetition,
}

/// Text that is being read.
#[derive(Debug)]
pub(crate) struct OpenText {
    pub lines: Rc<[OriginLine]>,
    pub next: usize,
    pub origin: Origin,
    pub substitution: Option<Rc<Substitution>>,
    /// Context of the lines of a macro call; `None` keeps their own.
    pub context: Option<u32>,
    pub conditions: Vec<Condition>,
    pub repeat: Option<Repeat>,
}

impl OpenText {
    /// A frame at its first line.
    pub fn new(lines: Rc<[OriginLine]>, origin: Origin) -> OpenText {
        OpenText { lines, next: 0, origin, substitution: None, context: None, conditions: Vec::new(), repeat: None }
    }
}

/// The text with blanks in the place of its `/* */` comments, octet by octet; the offset of one without end.
fn without_comments(text: &str) -> (Cow<'_, str>, Option<usize>) {
    if !text.contains("/*") {
        return (text.into(), None);
    }
    let mut new = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        // Blanks keep all offsets, so that places in messages stay true.
        let length = if rest.starts_with("/*") {
            let end = rest[2..].find("*/").map(|end| end + 4);
            new.extend(rest[..end.unwrap_or(rest.len())].bytes().map(|octet| if octet == b'\n' { '\n' } else { ' ' }));
            let Some(end) = end else { return (new.into(), Some(text.len() - rest.len())) };
            rest = &rest[end..];
            continue;
        // A line comment hides the beginning of a block comment.
        } else if starts_comment(rest) {
            rest.find('\n').unwrap_or(rest.len())
        } else if first == '"' {
            // Up to its end, or that of the line.
            let mut is_escaped = false;
            let end = rest[1..].find(|c| {
                let ends = c == '\n' || (c == '"' && !is_escaped);
                is_escaped = c == '\\' && !is_escaped;
                ends
            });
            end.map_or(rest.len(), |end| end + if rest[1 + end..].starts_with('"') { 2 } else { 1 })
        } else if rest.starts_with("'\"'") {
            3
        } else {
            first.len_utf8()
        };
        new.push_str(&rest[..length]);
        rest = &rest[length..];
    }
    (new.into(), None)
}

/// The lines of a file, and the place of a comment that is not closed.
pub(crate) fn file_lines(text: &str, source: u16) -> (Rc<[OriginLine]>, Option<At>) {
    let (text, unclosed) = without_comments(text);
    let unclosed = unclosed.map(|at| At { source, context: 0, start: at as u32, end: at as u32 + 2 });
    let mut start = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
    let mut lines = Vec::new();
    for (number, line) in text[start..].split_inclusive('\n').enumerate() {
        let shown = line.trim_end_matches(['\n', '\r']);
        lines.push(OriginLine::of_file(shown, source, number as u32 + 1, start, 0));
        start += line.len();
    }
    (lines.into(), unclosed)
}

/// The directive of a line behind its labels, without looking at the rest.
pub(crate) fn leading_directive(text: &str) -> Option<&str> {
    let mut rest = text.trim_start();
    loop {
        let length = rest.strip_prefix('.').unwrap_or(rest).find(|c| !continues_name(c));
        let dot = usize::from(rest.starts_with('.'));
        let word = &rest[..length.map_or(rest.len(), |length| length + dot)];
        let after = rest[word.len()..].trim_start();
        if word.is_empty() {
            return None;
        }
        match after.strip_prefix(':') {
            Some(after) => rest = after.trim_start(),
            None if dot == 1 && word[1..].starts_with(starts_name) => return Some(word),
            None => return None,
        }
    }
}

impl Assembler<'_> {
    /// Starts reading a file of the program's sources.
    pub(crate) fn enter_file(&mut self, index: u16, at: At) {
        let text = self.program.sources[usize::from(index)].clone();
        let (lines, unclosed) = file_lines(&text.text, index);
        if let Some(opened) = unclosed {
            self.is_incomplete = true;
            self.messages.add(Problem::new(explain::UNCLOSED, "`*/` is missing", opened, "opened here"));
        }
        self.enter(OpenText::new(lines, Origin::File(index)), at);
    }

    /// The next line to assemble.
    pub(crate) fn fetch(&mut self) -> Option<OriginLine> {
        loop {
            if let Some(line) = self.fetch_in_frame() {
                return Some(line);
            }
            let frame = self.frames.last_mut()?;
            if let Some(problem) = frame.conditions.drain(..).next_back().map(|condition| condition.unclosed()) {
                self.messages.add(problem);
            }
            if !self.repeat_again() {
                self.frames.pop();
            }
        }
    }

    /// The next line of the innermost frame.
    pub(crate) fn fetch_in_frame(&mut self) -> Option<OriginLine> {
        let is_nested = self.expansion_depth() > 1;
        let frame = self.frames.last_mut()?;
        let line = frame.lines.get(frame.next)?;
        frame.next += 1;
        // Lines of a macro are read in the context of the call, so that messages can name it.
        let context = frame.context.unwrap_or(line.context);
        let written = line.text.len();
        let line = match &frame.substitution {
            Some(substitution) => line.substituted(substitution, context),
            None => {
                let mut line = line.clone();
                line.context = context;
                line
            }
        };
        self.lines_read += 1;
        self.octets_read += line.text.len();
        self.octets_expanded += match is_nested {
            true => line.text.len() + EXPANDED_LINE,
            false => line.text.len().saturating_sub(written),
        };
        // Count what was read, expansions included: a short text can ask for endless lines.
        let SourceLimits { lines, expanded_octets, .. } = self.options.limits;
        let excess = if self.lines_read > lines {
            Some(format!("the program has more than {lines} lines with all its expansions"))
        } else if self.octets_read > TEXT_OCTETS {
            Some(format!("the program has more than {TEXT_OCTETS} octets of text with all its expansions"))
        } else if self.octets_expanded > expanded_octets {
            Some(format!("macro calls and repetitions inside others make more than {expanded_octets} octets of text"))
        } else if line.text.len() > LINE_OCTETS {
            Some(format!("the line is longer than {LINE_OCTETS} octets"))
        } else {
            None
        };
        if let Some(message) = excess {
            self.give_up(Problem::new(
                explain::SIZE,
                message,
                line.at(0, line.text.len().min(1)),
                "reading stops here",
            ));
            return None;
        }
        Some(line)
    }

    /// Reports what makes going on pointless and drops the rest of the text.
    pub(crate) fn give_up(&mut self, problem: Box<Problem>) {
        self.messages.add(problem);
        self.frames.clear();
        self.is_incomplete = true;
    }

    /// Starts the next pass of the innermost frame; `false` when it was the last one.
    fn repeat_again(&mut self) -> bool {
        let Some(frame) = self.frames.last_mut() else { return false };
        match &mut frame.repeat {
            None => return false,
            Some(Repeat::Count { remaining: 0, .. }) => return false,
            Some(Repeat::Count { remaining, counter, index, at: header }) => {
                *remaining -= 1;
                *index += 1;
                if let Some(name) = *counter {
                    let (index, at) = (*index, self.names.get(name).and_then(|symbol| symbol.at));
                    self.names.set(name, SymbolValue::Variable(index, 2), at);
                    let via = Via::Pass(self.names.text(name).clone(), index.to_string().into());
                    frame.context = Some(self.messages.enter(MacroCall { at: *header, via }));
                }
            }
            Some(Repeat::Texts { parameter, remaining, at: header }) => {
                let Some(text) = remaining.pop() else { return false };
                let via = Via::Pass(parameter.clone(), text.clone());
                frame.context = Some(self.messages.enter(MacroCall { at: *header, via }));
                let arguments = [(parameter.clone(), text)].into();
                frame.substitution = Some(Rc::new(Substitution { arguments, ..Substitution::default() }));
            }
        }
        let frame = self.frames.last_mut().expect("looked at above");
        frame.next = 0;
        true
    }

    /// Reads a block of the innermost frame up to its end, which is taken and left out. Blocks inside begin with words
    /// that begin like `openings`.
    pub(crate) fn capture(&mut self, openings: &[&str], closing: &str, at: At) -> Option<Rc<[OriginLine]>> {
        let mut depth = 0;
        let mut lines = Vec::new();
        while let Some(line) = self.fetch_in_frame() {
            match leading_directive(&line.text) {
                Some(word) if word == closing && depth == 0 => {
                    self.record(&line);
                    return Some(lines.into());
                }
                Some(word) if word == closing => depth -= 1,
                Some(word) if openings.iter().any(|opening| word.starts_with(opening)) => depth += 1,
                _ => {}
            }
            self.record(&line);
            lines.push(line);
        }
        if self.frames.is_empty() {
            return None;
        }
        let message = format!("`{closing}` is missing");
        self.messages.add(Problem::new(explain::UNCLOSED, message, at, "opened here"));
        None
    }

    /// Number of macro calls and repetitions around this place.
    pub(crate) fn expansion_depth(&self) -> usize {
        self.frames.iter().filter(|frame| !matches!(frame.origin, Origin::File(_))).count()
    }

    /// Enters a frame, unless there are too many inside each other.
    pub(crate) fn enter(&mut self, frame: OpenText, at: At) {
        let depth = self.expansion_depth();
        let (is_file, depth, most) = match frame.origin {
            Origin::File(_) => (true, self.frames.len() - depth, INCLUDE_DEPTH),
            _ => (false, depth, EXPANSION_DEPTH),
        };
        if depth >= most {
            let what = if is_file {
                "files include each other"
            } else {
                "macro calls and repetitions stand inside each other"
            };
            let message = format!("more than {most} {what}");
            self.give_up(Problem::new(explain::DEPTH, message, at, "one too many"));
            return;
        }
        self.frames.push(frame);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::{EXPANDED_OCTETS, EXPANDED_TOKEN};

    #[test]
    fn a_short_text_can_ask_for_so_much_work_only() {
        let tenfold: String =
            (1..12).map(|n| format!(".macro m{n}\n{}.endm\n", format!("m{}\n", n - 1).repeat(10))).collect();
        let parameters: Vec<String> = (0..256).map(|n| format!("p{n}=1")).collect();
        let names: Vec<String> = (0..5000).map(|n| format!("l{n}")).collect();
        for text in [
            format!(".macro m0\n.endm\n{tenfold}m11\n"),
            ".rept 1000\n.rept 1000\n.rept 1000\nnop\n.endr\n.endr\n.endr\n".to_owned(),
            format!(".macro m {}\n.endm\n.rept 100000\nm\n.endr\n", parameters.join(",")),
            format!(".macro m\n.local {}\n.endm\n.rept 100000\nm\n.endr\n", names.join(",")),
            format!(".macro m r:vararg\n{}.endm\nm {}\n", ".word \\r\n".repeat(1000), "1+".repeat(400_000) + "1"),
            ".macro m n\nm (\\n + \\n)\n.endm\nm 1\n".to_owned(),
        ] {
            let (isa, options) = (isa::Isa::base(), crate::Options::default());
            let mut assembler = crate::assembler::new(&isa, &options);
            assembler.take_options(&messages::Source::new("t.s", text.as_str()));
            assembler.enter_file(0, At::default());
            assembler.read_frames();
            let (calls, lines, octets) = (assembler.expansions, assembler.lines_read, assembler.octets_read);
            assert!(assembler.is_incomplete, "it is given up: {text:.60}");
            let most = EXPANDED_OCTETS / EXPANDED_LINE + 1000;
            assert!(
                calls <= most && lines <= most && octets <= 3 * EXPANDED_OCTETS,
                "{calls} {lines} {octets}: {text:.60}"
            );
            assert!(assembler.octets_expanded <= EXPANDED_OCTETS + EXPANDED_TOKEN * LINE_OCTETS, "{text:.60}");
        }
    }

    #[test]
    fn directives_are_found_behind_labels() {
        for (text, word) in [
            ("  .if x", Some(".if")),
            ("a: 1: .endm", Some(".endm")),
            (".L1: add", None),
            ("add s1, s2", None),
            (".", None),
            ("", None),
            (". = 3", None),
            ("\\a: .rept 3", None),
        ] {
            assert_eq!(leading_directive(text), word, "{text}");
        }
    }

    #[test]
    fn comments_become_blanks_outside_of_texts_and_other_comments() {
        for (text, expected) in [
            ("a /* b\n c */ d", "a     \n      d"),
            ("\"/*\" /*\"*/ 1", "\"/*\"       1"),
            ("# /* a\nb // /*\n; /*", "# /* a\nb // /*\n; /*"),
            ("'\"' /*é*/ x", "'\"'        x"),
            ("\"a\\\"/*\" y", "\"a\\\"/*\" y"),
            ("\"open /* \nz/**/", "\"open /* \nz    "),
        ] {
            assert_eq!(without_comments(text), (expected.into(), None), "{text}");
        }
        assert_eq!(without_comments("ab /* c").1, Some(3));
    }

    #[test]
    fn lines_keep_their_places() {
        let (lines, _) = file_lines("\u{feff}a\r\nbc", 0);
        let places: Vec<_> = lines.iter().map(|line| (&*line.text, line.number, line.at(0, 1).start)).collect();
        assert_eq!(places, [("a", 1, 3), ("bc", 2, 6)]);
    }
}
