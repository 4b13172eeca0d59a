//! Hints for what other assemblers write otherwise: the same as it is written here.

use crate::operand::looks_like_register;
use crate::token::{continues_name, starts_name};

/// Beginning of the text that belongs to a name or a number; empty where none is.
fn word(text: &str) -> &str {
    let end = text.find(|c| !continues_name(c) || c == '$').unwrap_or(text.len());
    &text[..end]
}

/// Hint for a register, name or number with a mark before it; `rest` begins with the mark, which is one octet.
fn marked(rest: &str) -> Option<String> {
    let (mark, word) = (&rest[..1], word(&rest[1..]));
    let what = match word.chars().next()? {
        _ if looks_like_register(word) => "registers",
        c if starts_name(c) => "names",
        _ => "numbers",
    };
    Some(format!("{what} are written without `{mark}`: `{word}`"))
}

/// Hint for an address in brackets: `[s2 + 4]` is `4(s2)`, `[s2]` is `(s2)`.
fn brackets(rest: &str) -> String {
    let inner = rest[1..].split(']').next().unwrap_or("");
    let register = word(inner.trim_start());
    let offset = inner.trim_start()[register.len()..].trim_start_matches([' ', '+', ',', '#', '$']).replace(' ', "");
    match looks_like_register(register) {
        true => format!("an address is written with its register in parentheses: `{offset}({register})`"),
        false => "an address is written with its register in parentheses: `4(s2)`".to_owned(),
    }
}

/// Hint for a character that means nothing here, at the beginning of `rest`.
pub(crate) fn character(rest: &str) -> Option<String> {
    match rest.chars().next()? {
        '$' => marked(rest),
        '[' => Some(brackets(rest)),
        _ => None,
    }
}

/// Hint for a `%`, at the beginning of `rest`, where a number is expected.
pub(crate) fn percent(rest: &str) -> Option<String> {
    let name = word(&rest[1..]);
    let function = match name {
        "hi" => "high",
        "lo" => "low",
        _ => return marked(rest),
    };
    let argument = rest[1 + name.len()..].trim_start().strip_prefix('(').and_then(|text| text.split(')').next());
    Some(format!("the halves of a number are `low` and `high`: `{function}({})`", argument.unwrap_or("x").trim()))
}

/// Hint for the name of a file, `literal` with its quotation marks, that has a backslash.
pub(crate) fn path(literal: &str) -> Option<String> {
    let name = literal.trim_matches('"').replace("\\\\", "/").replace('\\', "/");
    literal.contains('\\').then(|| format!("folders are separated by `/`: `{name}`"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hints_show_the_same_as_it_is_written_here() {
        for (rest, shown) in [
            ("$s1, $s2", "`s1`"),
            ("$loop", "names are written without `$`: `loop`"),
            ("$5", "numbers are written without `$`: `5`"),
            ("[s2+4]", "`4(s2)`"),
            ("[ s2 - 4 ]", "`-4(s2)`"),
            ("[s2, #node.left]", "`node.left(s2)`"),
            ("[s2]", "`(s2)`"),
            ("[4", "`4(s2)`"),
        ] {
            assert!(character(rest).unwrap().ends_with(shown), "{rest}");
        }
        for rest in ["$", "$ s1", "@", "?"] {
            assert_eq!(character(rest), None, "{rest}");
        }
        for (rest, shown) in
            [("%hi(x + 1)", "`high(x + 1)`"), ("%lo(x)", "`low(x)`"), ("%lo", "`low(x)`"), ("%s1", "`s1`")]
        {
            assert!(percent(rest).unwrap().ends_with(shown), "{rest}");
        }
        assert_eq!(path("\"lib\\x.s\"").unwrap(), "folders are separated by `/`: `lib/x.s`");
        assert_eq!(path("\"lib/x.s\""), None);
    }
}
