//! Characters that nobody sees: what messages show in their place, so that a name cannot steer a terminal and an odd
//! blank in a file is found.

use std::borrow::Cow;

/// True of a control character, and of one that looks like a blank or like nothing but is none.
///
/// Spaces are seen; tabs and line ends are control characters here.
pub fn is_invisible(character: char) -> bool {
    character.is_control()
        || matches!(character,
            '\u{a0}' | '\u{ad}' | '\u{61c}' | '\u{1680}' | '\u{180e}' | '\u{2000}'..='\u{200f}'
            | '\u{2028}'..='\u{202f}' | '\u{205f}'..='\u{206f}' | '\u{3000}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}')
}

/// A character by its code, such as `<U+00A0>`; the control characters of ASCII by their pictures, such as `␛`.
fn shown(character: char) -> String {
    match u32::from(character) {
        code @ 0..32 => char::from_u32(0x2400 + code).map_or_else(String::new, String::from),
        0x7f => "\u{2421}".to_owned(),
        code => format!("<U+{code:04X}>"),
    }
}

/// The text of a name with every invisible character by its code, such as `<U+00A0>`, or its picture, such as `␛`.
pub fn visible(text: &str) -> Cow<'_, str> {
    replaced(text, is_invisible)
}

/// The text of a sentence: as [`visible`], but lines may end and have tabs.
pub(crate) fn sentence(text: &str) -> Cow<'_, str> {
    replaced(text, |character| is_invisible(character) && !matches!(character, '\n' | '\t'))
}

/// Text with some characters by their codes.
fn replaced(text: &str, is_replaced: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.chars().any(&is_replaced) {
        return Cow::Borrowed(text);
    }
    let replacement = |character| if is_replaced(character) { shown(character) } else { character.to_string() };
    Cow::Owned(text.chars().map(replacement).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invisible_characters_are_shown_by_their_codes() {
        assert_eq!(visible("4\u{a0} a\u{1b}[2Jb\n\u{202e}c é\u{7f}"), "4<U+00A0> a␛[2Jb␊<U+202E>c é␡");
        assert_eq!(sentence("a\n\tb\r"), "a\n\tb␍");
        assert!(matches!(visible("plain text"), Cow::Borrowed(_)));
    }
}
