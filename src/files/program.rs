//! Files of assembled programs: words alone, as octets or as the text that `$readmemh` of Verilog reads, and the object
//! file, which holds the whole program. Its format is described in [`asm::object`].

use std::path::{Path, PathBuf};
use std::sync::Arc;

use asm::limits::WORDS;
use asm::object;
use isa::Program;
use messages::{Diagnostic, Place, Report, Source, refuse_packed};

use super::read;
use crate::numeral::grouped;

/// A file format for programs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProgramFile {
    /// Words, 32 bits each, little-endian.
    Binary,
    /// Words, eight hexadecimal digits a line.
    Hexadecimal,
    /// Everything: words, data, symbols, lines, regions.
    Object,
}

impl ProgramFile {
    /// The format that a file's name asks for.
    ///
    /// # Errors
    /// Another extension, or none.
    pub fn of(path: &Path) -> Result<ProgramFile, String> {
        let extension = path.extension().map(|text| text.to_string_lossy().to_ascii_lowercase());
        match extension.as_deref() {
            Some("bin") => Ok(ProgramFile::Binary),
            Some("hex") => Ok(ProgramFile::Hexadecimal),
            Some("o") => Ok(ProgramFile::Object),
            _ => Err(format!("`{}` ends in none of .o, .bin and .hex", path.display())),
        }
    }

    /// A path with such a name, for the command line.
    ///
    /// # Errors
    /// See [`ProgramFile::of`].
    pub fn check(text: &str) -> Result<PathBuf, String> {
        let path = PathBuf::from(text);
        ProgramFile::written(&path).map(|_| path)
    }

    /// The format in which a program is written to a place: standard output (`-`) gets an object file.
    ///
    /// # Errors
    /// See [`ProgramFile::of`].
    pub fn written(path: &Path) -> Result<ProgramFile, String> {
        if path == Path::new(super::STANDARD) { Ok(ProgramFile::Object) } else { ProgramFile::of(path) }
    }

    /// The octets of a program's file.
    pub fn encode(self, program: &Program) -> Vec<u8> {
        match self {
            ProgramFile::Binary => program.words.iter().flat_map(|word| word.to_le_bytes()).collect(),
            ProgramFile::Hexadecimal => asm::hex::words(&program.words).into_bytes(),
            ProgramFile::Object => object::write(program),
        }
    }

    /// The program of a file. Words alone come without data, lines, symbols and functions; they start at word 0.
    ///
    /// # Errors
    /// A file that cannot be read, or holds anything else.
    pub fn load(self, path: &Path) -> Result<Program, Report> {
        self.decode(path, read(path)?)
    }

    /// The program of octets that a file holds.
    ///
    /// # Errors
    /// Octets that are something else.
    pub fn decode(self, path: &Path, octets: Vec<u8>) -> Result<Program, Report> {
        let shown = super::shown(path);
        refuse_packed(&octets, &shown)?;
        let words = match self {
            ProgramFile::Object => {
                return object::read(&octets).map_err(|error| Diagnostic::error(format!("{shown}: {error}")).into());
            }
            ProgramFile::Binary => binary(&octets).ok_or_else(|| {
                let message = format!("{shown} has {} octets, which are no whole words", octets.len());
                Diagnostic::error(message).hint("a word has 4 octets")
            })?,
            ProgramFile::Hexadecimal => hexadecimal(&super::source_of(path, octets)?)?,
        };
        if words.len() > WORDS {
            let message = format!("{shown} has {} words", grouped(words.len() as u64));
            let hint = format!("a program has at most {}", grouped(WORDS as u64));
            return Err(Diagnostic::error(message).hint(hint).into());
        }
        Ok(Program { words, ..Program::default() })
    }
}

/// A file that may be a program or something else.
pub enum LoadedFile {
    /// The program of a file that is named or begins like one.
    Program(Box<Program>),
    /// The octets of any other, such as a source.
    Other(Vec<u8>),
}

/// Reads a file once, as what it is named, or as what it begins like.
///
/// # Errors
/// See [`ProgramFile::load`].
pub fn load_any(path: &Path) -> Result<LoadedFile, Report> {
    if let Ok(format) = ProgramFile::of(path) {
        return format.load(path).map(|program| LoadedFile::Program(Box::new(program)));
    }
    let octets = read(path)?;
    let format = match () {
        () if octets.starts_with(object::MAGIC) => ProgramFile::Object,
        () if begins_with_word(&octets) => ProgramFile::Hexadecimal,
        () => return Ok(LoadedFile::Other(octets)),
    };
    format.decode(path, octets).map(|program| LoadedFile::Program(Box::new(program)))
}

/// The first line behind comments is eight hexadecimal digits, as no line of assembly is.
fn begins_with_word(octets: &[u8]) -> bool {
    let lines = octets.split(|octet| *octet == b'\n').map(<[u8]>::trim_ascii);
    let first = lines.into_iter().find(|line| !line.is_empty() && !line.starts_with(b"//"));
    first.is_some_and(|line| line.len() == 8 && line.iter().all(u8::is_ascii_hexdigit))
}

fn binary(octets: &[u8]) -> Option<Vec<u32>> {
    let (words, rest) = octets.as_chunks::<4>();
    rest.is_empty().then(|| words.iter().map(|&word| u32::from_le_bytes(word)).collect())
}

/// Words between blanks, `@address` (in words; what it skips is 0), `//` and `/* */` comments, `_` between digits.
fn hexadecimal(source: &Arc<Source>) -> Result<Vec<u32>, Report> {
    let text = &source.text;
    let mut words: Vec<u32> = Vec::new();
    let mut place = 0;
    let mut messages = Report::default();
    let mut refuse = |span: std::ops::Range<usize>, message: String, label: &str| {
        messages.0.push(Diagnostic::error(message).at(Place::new(source, span), label));
        // A file of another kind would otherwise be refused word by word.
        messages.0.len() < 5
    };
    // Walk from token to token; `@4 0000000c` puts the word 12 at word 4, over zeros behind the last word before.
    let mut at = 0;
    while let Some(first) = text[at..].find(|letter: char| !letter.is_whitespace()).map(|skipped| at + skipped) {
        let rest = &text[first..];
        // Skip comments of a line, then comments between marks.
        if rest.starts_with("//") {
            at = first + rest.find('\n').unwrap_or(rest.len());
            continue;
        }
        if rest.starts_with("/*") {
            let Some(end) = rest.find("*/") else {
                refuse(first..first + 2, "the comment is not closed".into(), "opened here");
                break;
            };
            at = first + end + 2;
            continue;
        }
        // A token ends at white space or where a comment begins.
        let end = first + rest.find(|letter: char| letter.is_whitespace() || letter == '/').unwrap_or(rest.len());
        let end = end.max(first + 1);
        at = end;
        let token = text.get(first..end).unwrap_or_default();
        // Read an address behind `@` or a word; `_` between digits says nothing.
        let digits = token.strip_prefix('@').unwrap_or(token).replace('_', "");
        let is_plain = digits.chars().all(|digit| digit.is_ascii_hexdigit());
        let goes_on = match is_plain.then(|| u32::from_str_radix(&digits, 16).ok()).flatten() {
            Some(address) if token.starts_with('@') => {
                // Addresses come in any order (IEEE 1364); a word that is written twice has its last value.
                let is_possible = address as usize <= WORDS;
                if is_possible {
                    place = address as usize;
                }
                let message = || format!("the address {address:#x} is not possible here");
                is_possible || refuse(first..end, message(), "beyond the largest program")
            }
            Some(word) => {
                if place >= words.len() {
                    words.resize(place + 1, 0);
                }
                words[place] = word;
                place += 1;
                true
            }
            None => {
                let shown: String = token.chars().take(40).collect();
                refuse(first..end, format!("`{shown}` is no word"), "up to eight hexadecimal digits are expected")
            }
        };
        if !goes_on {
            break;
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
    fn all_formats_hold_words() {
        let words = vec![0, 0x1234_5678, u32::MAX];
        let empty = Program { words: words.clone(), ..Program::default() };
        assert_eq!(ProgramFile::Binary.encode(&empty), [0, 0, 0, 0, 0x78, 0x56, 0x34, 0x12, 255, 255, 255, 255]);
        for format in [ProgramFile::Binary, ProgramFile::Hexadecimal] {
            let back = format.decode(Path::new("a"), format.encode(&empty)).unwrap();
            assert_eq!(back, empty, "{format:?}");
        }
        assert_eq!(parsed("00000000\n12345678\nffffffff\n"), Ok(words));
        assert_eq!((binary(&[1, 2, 3]), binary(&[])), (None, Some(vec![])));
    }

    #[test]
    fn more_words_than_a_program_may_have_are_refused() {
        let octets = vec![0; 4 * (WORDS + 1)];
        let error = ProgramFile::Binary.decode(Path::new("a.bin"), octets.clone()).unwrap_err().render(false);
        assert!(error.contains("1,048,577 words"), "{error}");
        assert!(ProgramFile::Binary.decode(Path::new("a.bin"), octets[4..].to_vec()).is_ok());
    }

    #[test]
    fn text_has_comments_addresses_and_underscores() {
        assert_eq!(parsed("// a\n@2 dead_beef/* b\n*/1 2// c"), Ok(vec![0, 0, 0xdead_beef, 1, 2]));
        assert_eq!((parsed(""), parsed(" \n")), (Ok(vec![]), Ok(vec![])));
        assert_eq!(parsed("@3 4 @0 1 2\n3 @1 5"), Ok(vec![1, 5, 3, 4]), "any order, the last value counts");
    }

    #[test]
    fn what_is_no_word_is_shown_at_its_place() {
        for (text, message) in [
            ("1\n  xyz\n", "a.hex:2:3"),
            ("123456789", "`123456789` is no word"),
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
