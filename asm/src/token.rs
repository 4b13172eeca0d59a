//! A line as tokens. The lexer knows nothing of statements; numbers are checked for their shape only.

use nom::branch::alt;
use nom::bytes::complete::{tag, take_while, take_while_m_n, take_while1};
use nom::character::complete::{anychar, char, none_of, one_of};
use nom::combinator::{map, opt, recognize, value};
use nom::multi::many0_count;
use nom::{IResult, Parser};

use crate::explain;
use crate::foreign;

/// The kind of a token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TokenKind {
    /// `name` or `structure.field`.
    Name,
    /// `.name`.
    Directive,
    /// An integer in any base.
    Integer,
    /// A decimal number with a point or an exponent.
    Decimal,
    /// `1b` or `1f`.
    Local,
    /// `'a'`.
    Character,
    /// `"text"`.
    Text,
    /// Punctuation.
    Mark(&'static str),
}

/// A token and its octets in the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Token {
    pub kind: TokenKind,
    pub start: u32,
    pub end: u32,
}

/// The reason for which the rest of a line cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Unreadable {
    pub code: &'static str,
    pub message: String,
    pub label: &'static str,
    pub hint: Option<String>,
    pub start: usize,
    pub end: usize,
}

const MARKS: [&str; 26] = [
    "...", "&&", "||", "==", "!=", "<=", ">=", "<<", ">>", "(", ")", ",", ":", "=", "<", ">", "+", "-", "*", "/", "%",
    "&", "|", "^", "~", "!",
];

/// A name may start with this character.
pub(crate) fn starts_name(c: char) -> bool {
    c.is_ascii_alphabetic() || c == '_'
}

/// A name may go on with this character.
pub(crate) fn continues_name(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_' || c == '$'
}

fn word(input: &str) -> IResult<&str, &str> {
    recognize((take_while_m_n(1, 1, starts_name), take_while(continues_name))).parse(input)
}

fn name(input: &str) -> IResult<&str, TokenKind> {
    value(TokenKind::Name, (word, many0_count((char('.'), word)))).parse(input)
}

fn directive(input: &str) -> IResult<&str, TokenKind> {
    value(TokenKind::Directive, (char('.'), word)).parse(input)
}

fn digits(input: &str) -> IResult<&str, &str> {
    take_while1(|c: char| c.is_ascii_digit() || c == '_').parse(input)
}

fn decimal(input: &str) -> IResult<&str, TokenKind> {
    let exponent = |input| recognize((one_of("eE"), opt(one_of("+-")), digits)).parse(input);
    let fraction = |input| recognize((char('.'), digits)).parse(input);
    let (rest, _) = digits(input)?;
    let (rest, _) = alt((recognize((fraction, opt(exponent))), exponent)).parse(rest)?;
    Ok((rest, TokenKind::Decimal))
}

fn integer(input: &str) -> IResult<&str, TokenKind> {
    let (rest, text) = take_while1(continues_name).parse(input)?;
    let last = text.as_bytes()[text.len() - 1];
    let is_local = matches!(last, b'b' | b'f') && text[..text.len() - 1].bytes().all(|c| c.is_ascii_digit());
    Ok((rest, if is_local && text.len() > 1 { TokenKind::Local } else { TokenKind::Integer }))
}

fn number(input: &str) -> IResult<&str, TokenKind> {
    let (_, _) = one_of("0123456789").parse(input)?;
    alt((decimal, integer)).parse(input)
}

fn text(input: &str) -> IResult<&str, TokenKind> {
    let piece = alt((recognize((char('\\'), anychar)), recognize(none_of("\"\\"))));
    value(TokenKind::Text, (char('"'), many0_count(piece), char('"'))).parse(input)
}

fn character(input: &str) -> IResult<&str, TokenKind> {
    let hex = recognize((tag("\\x"), take_while_m_n(2, 2, |c: char| c.is_ascii_hexdigit())));
    let octal = recognize((char('\\'), take_while_m_n(1, 3, |c: char| c.is_digit(8))));
    let escape = recognize((char('\\'), anychar));
    value(TokenKind::Character, (char('\''), alt((hex, octal, escape, recognize(none_of("'\\")))), char('\'')))
        .parse(input)
}

fn mark(input: &str) -> IResult<&str, TokenKind> {
    for mark in MARKS {
        if let Some(rest) = input.strip_prefix(mark) {
            return Ok((rest, TokenKind::Mark(mark)));
        }
    }
    map(char('.'), |_| TokenKind::Mark(".")).parse(input)
}

/// A comment starts here.
pub(crate) fn starts_comment(rest: &str) -> bool {
    rest.starts_with(';') || rest.starts_with('#') || rest.starts_with("//")
}

/// The tokens of a line up to its comment, and why reading stopped before that.
pub(crate) fn tokens(line: &str) -> (Vec<Token>, Option<Unreadable>) {
    let mut found = Vec::with_capacity(12);
    let mut rest = line;
    loop {
        rest = rest.trim_start_matches([' ', '\t', '\r', '\u{b}', '\u{c}']);
        if rest.is_empty() || starts_comment(rest) {
            return (found, None);
        }
        let start = line.len() - rest.len();
        // The first octet tells the kind.
        let parsed = match rest.as_bytes()[0] {
            b'0'..=b'9' => number(rest),
            b'.' => alt((directive, mark)).parse(rest),
            b'"' => text(rest),
            b'\'' => character(rest),
            c if starts_name(c.into()) => name(rest),
            _ => mark(rest),
        };
        match parsed {
            Ok((after, kind)) => {
                found.push(Token { kind, start: start as u32, end: (line.len() - after.len()) as u32 });
                rest = after;
            }
            Err(_) => return (found, Some(unreadable(rest, start, line.len()))),
        }
    }
}

fn unreadable(rest: &str, start: usize, line_end: usize) -> Unreadable {
    let first = rest.chars().next().unwrap_or(' ');
    // A text is marked up to the end of its line, since nobody knows where it should have ended; all else where it begins.
    match first {
        '"' => Unreadable {
            code: explain::TEXT,
            message: "the text has no closing quotation mark".into(),
            label: "starts here",
            hint: None,
            start,
            end: line_end,
        },
        '\'' => Unreadable {
            code: explain::TEXT,
            message: "a character stands between two apostrophes".into(),
            label: "not a character",
            hint: None,
            start,
            end: start + 1,
        },
        _ => Unreadable {
            code: explain::CHARACTER,
            message: match first {
                '\\' => "a backslash means nothing here".into(),
                _ => format!("the character `{}` means nothing here", first.escape_debug()),
            },
            label: match first {
                '\\' => "only before a parameter of a macro",
                // Letters such as `é` look as if names could have them.
                _ if first.is_alphanumeric() => "names have the letters a to z",
                _ => "unexpected character",
            },
            hint: foreign::character(rest),
            start,
            end: start + first.len_utf8(),
        },
    }
}

/// The octets of a text literal, quotation marks included in `literal`.
///
/// # Errors
/// Octets of the literal that are no escape.
pub(crate) fn text_octets(literal: &str) -> Result<Vec<u8>, (usize, usize)> {
    let inner = &literal[1..literal.len() - 1];
    let mut octets = Vec::with_capacity(inner.len());
    let mut rest = inner;
    while let Some(c) = rest.chars().next() {
        let start = 1 + inner.len() - rest.len();
        // Anything but a backslash stands for itself.
        if c != '\\' {
            octets.extend_from_slice(&rest.as_bytes()[..c.len_utf8()]);
            rest = &rest[c.len_utf8()..];
            continue;
        }
        let escaped = rest[1..].chars().next().unwrap_or('\\');
        let mut length = 1 + escaped.len_utf8();
        octets.push(match escaped {
            'n' => b'\n',
            't' => b'\t',
            'r' => b'\r',
            'b' => 0x08,
            'f' => 0x0c,
            // Up to three octal digits: `\1019` is an `A` and a 9.
            '0'..='7' => {
                let digits: String = rest[1..].chars().take(3).take_while(|digit| digit.is_digit(8)).collect();
                length = 1 + digits.len();
                u8::from_str_radix(&digits, 8).map_err(|_| (start, start + length))?
            }
            '\\' | '"' | '\'' => escaped as u8,
            'x' => {
                let octet = rest.get(2..4).and_then(|hex| u8::from_str_radix(hex, 16).ok());
                length = 4;
                octet.ok_or((start, (start + 4).min(literal.len() - 1)))?
            }
            _ => return Err((start, start + length)),
        });
        rest = &rest[length..];
    }
    Ok(octets)
}

/// The number of a character literal, apostrophes included in `literal`; `None` where the escape means nothing.
pub(crate) fn character_value(literal: &str) -> Option<i64> {
    let inner = &literal[1..literal.len() - 1];
    match inner.strip_prefix('\\') {
        None => inner.chars().next().map(|c| i64::from(u32::from(c))),
        Some(_) => text_octets(&format!("\"{inner}\"")).ok().and_then(|octets| octets.first().copied()).map(i64::from),
    }
}

/// The magnitude of an integer literal; `Err` says what is wrong with it.
pub(crate) fn integer_value(text: &str) -> Result<u64, String> {
    let lower = text.to_ascii_lowercase();
    let (digits, radix, base) = match lower.get(..2) {
        Some("0x") => (&lower[2..], 16, "hexadecimal"),
        Some("0b") => (&lower[2..], 2, "binary"),
        Some("0o") => (&lower[2..], 8, "octal"),
        _ => (&lower[..], 10, "decimal"),
    };
    let digits: String = digits.chars().filter(|&c| c != '_').collect();
    if digits.is_empty() {
        return Err("digits are missing".into());
    }
    if let Some(wrong) = digits.chars().find(|c| !c.is_digit(radix)) {
        return Err(format!("`{wrong}` is not a {base} digit"));
    }
    // C and other assemblers read `012` as ten.
    if radix == 10 && digits.len() > 1 && digits.starts_with('0') {
        return Err("a leading 0 could mean octal: write `0o` before octal digits, or leave it out".into());
    }
    u64::from_str_radix(&digits, radix).map_err(|_| "more than 64 bits".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds(line: &str) -> Vec<TokenKind> {
        tokens(line).0.iter().map(|token| token.kind).collect()
    }

    #[test]
    fn a_line_splits_into_tokens_up_to_its_comment() {
        use TokenKind::*;
        assert_eq!(
            kinds("1: lw s1, node.left(s2) ; text"),
            [Integer, Mark(":"), Name, Name, Mark(","), Name, Mark("("), Name, Mark(")")]
        );
        assert_eq!(
            kinds("-0.5:pos 1e3 1f 0x1f .+3 // c"),
            [Mark("-"), Decimal, Mark(":"), Name, Decimal, Local, Integer, Mark("."), Mark("+"), Integer]
        );
        assert_eq!(kinds(".ascii \"a;\\\"b\" # c"), [Directive, Text]);
        assert_eq!(kinds("';' 'a'"), [Character, Character]);
    }

    #[test]
    fn integers_of_all_bases() {
        for (text, value) in [("0", 0), ("1_000", 1000), ("0xFF", 255), ("0b1_01", 5), ("0o17", 15)] {
            assert_eq!(integer_value(text), Ok(value), "{text}");
        }
        for text in ["012", "0x", "0b2", "12a", "99999999999999999999"] {
            assert!(integer_value(text).is_err(), "{text}");
        }
    }

    #[test]
    fn escapes_of_texts() {
        assert_eq!(text_octets(r#""a\n\x41\0é""#).unwrap(), b"a\nA\0\xc3\xa9");
        assert_eq!(text_octets(r#""\012\1\0128\b\f\19""#).unwrap(), b"\n\x01\n8\x08\x0c\x019");
        assert_eq!(text_octets(r#""a\q""#), Err((2, 4)));
        assert_eq!(text_octets(r#""\400""#), Err((1, 5)));
        for (literal, value) in [("'\\n'", 10), ("'\\0'", 0), ("'\\033'", 27), ("'\\b'", 8)] {
            assert_eq!(character_value(literal), Some(value), "{literal}");
        }
        assert_eq!(tokens("'\\033' '\\7'").0.len(), 2);
    }
}
