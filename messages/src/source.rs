//! Texts that were read, and places in them.

use std::ops::Range;
use std::sync::Arc;

/// The text of one file as it was read, with the name that messages show.
#[derive(Debug, PartialEq, Eq)]
pub struct Source {
    /// Path as the user gave it (or a name in angle brackets for text that is no file).
    pub name: String,
    /// The whole text; bytes that are not UTF-8 have been replaced.
    pub text: String,
}

impl Source {
    /// A shared source from its name and text.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Arc<Source> {
        Arc::new(Source { name: name.into(), text: text.into() })
    }

    /// Line and column of an octet offset, both from 1; columns count characters.
    pub fn line_column(&self, offset: usize) -> (usize, usize) {
        let offset = floor_boundary(&self.text, offset);
        let before = &self.text[..offset];
        let start = before.rfind('\n').map_or(0, |at| at + 1);
        let line = before.bytes().filter(|&octet| octet == b'\n').count() + 1;
        (line, self.text[start..offset].chars().count() + 1)
    }
}

/// A range of octets in a source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file.
    pub source: Arc<Source>,
    /// Octet offsets into its text; an empty range points at one character.
    pub span: Range<usize>,
}

impl Place {
    /// The place `span` of `source`.
    pub fn new(source: &Arc<Source>, span: Range<usize>) -> Place {
        Place { source: source.clone(), span }
    }
}

/// The nearest start of a character at or before an octet offset; the end of the text for one beyond it.
pub(crate) fn floor_boundary(text: &str, offset: usize) -> usize {
    let mut at = offset.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}
