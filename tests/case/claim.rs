//! Comments as claims about the line beside which they stand.

use std::fmt;

/// Subject of a claim.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Subject {
    /// `s1 = 5`: a register after the line.
    Register(String),
    /// `buffer[8] = 1, 2`: octets of the buffer after the line.
    Buffer(String),
    /// `memory[8] = 1, 2`: octets of global memory after the line.
    Memory(String),
    /// `exit Taken, Fall`: how the line ended, each time.
    Exit,
    /// `count: add 3`: operations of the program up to the line.
    Count,
    /// `clocks: 12`: time up to the line.
    Clocks,
    /// `error E008: text`, `trap: text`: what goes wrong at the line; the head without the line.
    Said(String),
}

/// One claim.
#[derive(Clone, Debug)]
pub struct Claim {
    /// Subject of the claim.
    pub subject: Subject,
    /// Value that it claims.
    pub value: String,
    /// The line that it is about; 0 for none.
    pub line: usize,
    /// True where the claim names that line.
    pub names_line: bool,
}

/// A comment of claims.
#[derive(Clone, Debug)]
pub struct Comment {
    /// Line of the comment, from 1.
    pub line: usize,
    /// The statement before it, without blanks at the end.
    pub code: String,
    /// Characters before its semicolon.
    pub column: usize,
    /// Claims of the comment.
    pub claims: Vec<Claim>,
    /// Text behind ` -- `.
    pub prose: Option<String>,
}

/// A line's statement and its comment, without the semicolon.
pub fn split_comment(line: &str) -> (&str, Option<&str>) {
    let mut is_text = false;
    for (at, c) in line.char_indices() {
        match c {
            '"' => is_text = !is_text,
            ';' if !is_text => return (&line[..at], Some(&line[at + 1..])),
            _ => {}
        }
    }
    (line, None)
}

impl Comment {
    /// Reads a comment; `None` when it is only prose, which has a line for itself.
    ///
    /// # Errors
    /// The part that is no claim.
    pub fn parse(line: usize, code: &str, comment: &str) -> Result<Option<Comment>, String> {
        let is_alone = code.trim().is_empty();
        let (text, prose) = match comment.split_once(" -- ") {
            Some((text, prose)) => (text, Some(prose.trim().to_owned())),
            None => (comment, None),
        };
        let mut claims = Vec::new();
        for piece in text.split(';').map(str::trim) {
            match Claim::parse(piece, if is_alone { 0 } else { line }) {
                Some(claim) if !is_alone || matches!(claim.subject, Subject::Said(_)) => claims.push(claim),
                _ if is_alone => return Ok(None),
                _ => return Err(piece.to_owned()),
            }
        }
        let column = code.chars().count();
        Ok(Some(Comment { line, code: code.trim_end().to_owned(), column, claims, prose }))
    }
}

impl Claim {
    fn parse(piece: &str, line: usize) -> Option<Claim> {
        let claim = |subject, value: &str| Claim { subject, value: value.trim().to_owned(), line, names_line: false };
        if let Some(exits) = piece.strip_prefix("exit ") {
            return Some(claim(Subject::Exit, exits));
        }
        if let Some((head, value)) = piece.split_once('=')
            && let Some(subject) = place(head.trim())
        {
            return Some(claim(subject, value));
        }
        let (head, value) = piece.split_once(':')?;
        let mut words = head.split_whitespace();
        let subject = match words.next()? {
            "count" => Subject::Count,
            "clocks" => Subject::Clocks,
            "trap" => Subject::Said("trap".into()),
            kind @ ("error" | "warning") => {
                let mut words = words.clone().peekable();
                let code = words.next_if(|word| word.starts_with(['E', 'W', '?']));
                let subject = Subject::Said(code.map_or(kind.to_owned(), |code| format!("{kind} {code}")));
                let named = words.next_if_eq(&"line").and_then(|_| words.next()?.parse().ok());
                let mut claim = claim(subject, value);
                (claim.line, claim.names_line) = (named.unwrap_or(line), named.is_some());
                return words.next().is_none().then_some(claim);
            }
            _ => return None,
        };
        words.next().is_none().then(|| claim(subject, value))
    }

    /// True where it is about something that goes wrong.
    pub fn is_about_an_error(&self) -> bool {
        matches!(&self.subject, Subject::Said(head) if !head.starts_with("warning"))
    }

    /// The claim with another value.
    pub fn with_value(&self, value: String) -> Claim {
        Claim { value, ..self.clone() }
    }
}

/// The register or octets of `v3`, `buffer[8]`, `memory[8]`.
fn place(head: &str) -> Option<Subject> {
    if isa::parse_register(head).is_some() {
        return Some(Subject::Register(head.to_owned()));
    }
    let (space, address) = head.strip_suffix(']')?.split_once('[')?;
    match space {
        "buffer" => Some(Subject::Buffer(address.to_owned())),
        "memory" => Some(Subject::Memory(address.to_owned())),
        _ => None,
    }
}

impl fmt::Display for Claim {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = &self.value;
        match &self.subject {
            Subject::Register(name) => write!(f, "{name} = {value}"),
            Subject::Buffer(address) => write!(f, "buffer[{address}] = {value}"),
            Subject::Memory(address) => write!(f, "memory[{address}] = {value}"),
            Subject::Exit => write!(f, "exit {value}"),
            Subject::Count => write!(f, "count: {value}"),
            Subject::Clocks => write!(f, "clocks: {value}"),
            Subject::Said(head) if self.names_line => write!(f, "{head} line {}: {value}", self.line),
            Subject::Said(head) => write!(f, "{head}: {value}"),
        }
    }
}
