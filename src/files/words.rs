//! Files of instruction words: binary, and the text that `$readmemh` of Verilog reads.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use isa::diagnostic::{Diagnostic, Place, Report, Source};

use super::read;

/// A file format for words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WordFile {
    /// 32 bits each, little-endian.
    Binary,
    /// Eight hexadecimal digits a line.
    Hexadecimal,
}

/// Most words of a file, which keeps an address such as `@ffffffff` from filling the memory.
const MOST_WORDS: usize = 1 << 24;

impl WordFile {
    /// The format that a file's name asks for.
    ///
    /// # Errors
    /// Another extension, or none.
    pub fn of(path: &Path) -> Result<WordFile, String> {
        let extension = path.extension().map(|text| text.to_string_lossy().to_ascii_lowercase());
        match extension.as_deref() {
            Some("bin") => Ok(WordFile::Binary),
            Some("hex") => Ok(WordFile::Hexadecimal),
            _ => Err(format!("`{}` ends in neither .bin nor .hex", path.display())),
        }
    }

    /// A path with such a name, for the command line.
    ///
    /// # Errors
    /// See [`WordFile::of`].
    pub fn check(text: &str) -> Result<PathBuf, String> {
        let path = PathBuf::from(text);
        WordFile::of(&path).map(|_| path)
    }

    /// The octets of a file with these words.
    pub fn encode(self, words: &[u32]) -> Vec<u8> {
        match self {
            WordFile::Binary => words.iter().flat_map(|word| word.to_le_bytes()).collect(),
            WordFile::Hexadecimal => words.iter().map(|word| format!("{word:08x}\n")).collect::<String>().into_bytes(),
        }
    }

    /// The words of a file.
    ///
    /// # Errors
    /// A file that cannot be read, or holds anything but words.
    pub fn load(self, path: &Path) -> Result<Vec<u32>, Report> {
        let octets = read(path)?;
        match self {
            WordFile::Binary => binary(&octets).ok_or_else(|| {
                let message = format!("{} has {} octets, which are no whole words", path.display(), octets.len());
                Diagnostic::error(message).hint("a word has 4 octets").into()
            }),
            WordFile::Hexadecimal => {
                hexadecimal(&Source::new(path.display().to_string(), String::from_utf8_lossy(&octets)))
            }
        }
    }
}

fn binary(octets: &[u8]) -> Option<Vec<u32>> {
    let (words, rest) = octets.as_chunks::<4>();
    rest.is_empty().then(|| words.iter().map(|&word| u32::from_le_bytes(word)).collect())
}

/// Words between blanks, `@address` (in words; what it skips is 0), `//` and `/* */` comments, `_` between digits.
fn hexadecimal(source: &Arc<Source>) -> Result<Vec<u32>, Report> {
    let text = &source.text;
    let mut words: Vec<u32> = Vec::new();
    let mut messages = Report::default();
    let mut refuse = |span: std::ops::Range<usize>, message: String, label: &str| {
        // A file of another kind would otherwise be refused word by word.
        if messages.0.len() < 5 {
            messages.0.push(Diagnostic::error(message).at(Place::new(source, span), label));
        }
    };
    let mut at = 0;
    while let Some(first) = text[at..].find(|letter: char| !letter.is_whitespace()).map(|skipped| at + skipped) {
        let rest = &text[first..];
        if let Some(end) = rest.strip_prefix("//").map(|_| rest.find('\n').unwrap_or(rest.len())) {
            at = first + end;
            continue;
        }
        if rest.starts_with("/*") {
            match rest.find("*/") {
                Some(end) => at = first + end + 2,
                None => {
                    refuse(first..first + 2, "the comment is not closed".into(), "opened here");
                    break;
                }
            }
            continue;
        }
        let end = first + rest.find(|letter: char| letter.is_whitespace() || letter == '/').unwrap_or(rest.len());
        let end = end.max(first + 1);
        at = end;
        let token = text.get(first..end).unwrap_or_default();
        let digits = token.strip_prefix('@').unwrap_or(token).replace('_', "");
        let number =
            digits.chars().all(|digit| digit.is_ascii_hexdigit()).then(|| u32::from_str_radix(&digits, 16).ok());
        match number.flatten() {
            Some(address) if token.starts_with('@') => match address as usize {
                address if address < words.len() || address > MOST_WORDS => {
                    refuse(
                        first..end,
                        format!("the address {address:#x} is not possible here"),
                        "goes back or too far",
                    );
                }
                address => words.resize(address, 0),
            },
            Some(word) => words.push(word),
            None => refuse(first..end, format!("`{token}` is no word"), "up to eight hexadecimal digits are expected"),
        }
    }
    if messages.has_errors() { Err(messages) } else { Ok(words) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Result<Vec<u32>, String> {
        hexadecimal(&Source::new("a.hex", text)).map_err(|report| report.render(false))
    }

    #[test]
    fn both_formats_hold_words() {
        let words = [0, 0x1234_5678, u32::MAX];
        assert_eq!(WordFile::Binary.encode(&words), [0, 0, 0, 0, 0x78, 0x56, 0x34, 0x12, 255, 255, 255, 255]);
        assert_eq!(binary(&WordFile::Binary.encode(&words)), Some(words.to_vec()));
        assert_eq!(WordFile::Hexadecimal.encode(&words), b"00000000\n12345678\nffffffff\n");
        assert_eq!(parsed("00000000\n12345678\nffffffff\n"), Ok(words.to_vec()));
        assert_eq!((binary(&[1, 2, 3]), binary(&[])), (None, Some(vec![])));
    }

    #[test]
    fn text_has_comments_addresses_and_underscores() {
        assert_eq!(parsed("// a\n@2 dead_beef/* b\n*/1 2// c"), Ok(vec![0, 0, 0xdead_beef, 1, 2]));
        assert_eq!((parsed(""), parsed(" \n")), (Ok(vec![]), Ok(vec![])));
    }

    #[test]
    fn what_is_no_word_is_shown_at_its_place() {
        for (text, message) in [
            ("1\n  xyz\n", "a.hex:2:3"),
            ("123456789", "`123456789` is no word"),
            ("1 2 @1", "not possible here"),
            ("@ffffffff", "not possible here"),
            ("/* 1", "not closed"),
            ("1 /2", "`/` is no word"),
            ("\u{e9}", "is no word"),
            ("@", "is no word"),
        ] {
            let error = parsed(text).unwrap_err();
            assert!(error.contains(message), "{text:?}: {error}");
        }
    }
}
