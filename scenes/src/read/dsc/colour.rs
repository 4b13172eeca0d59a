//! The colours of a `.dsc` file: in 0..1, or all of them in 0..255 when any component exceeds 1.

use messages::Diagnostic;

use super::super::words::{Word, Words};

/// The colours of a file so far.
#[derive(Default)]
pub(super) struct ColourScale<'a> {
    above_one: Option<Word<'a>>,
    fraction: Option<Word<'a>>,
    above_octet: Option<Word<'a>>,
}

impl<'a> ColourScale<'a> {
    /// Looks at one colour's components.
    pub(super) fn note(&mut self, words: &mut Words<'a>, components: [(f64, Word<'a>); 3]) {
        for (value, word) in components {
            if value < 0.0 {
                words.refuse(word, "a colour must not be negative", "negative");
            } else if value > 0.0 && value < 1.0 {
                self.fraction.get_or_insert(word);
            } else if value > 255.0 {
                self.above_octet.get_or_insert(word);
            }
            if value > 1.0 {
                self.above_one.get_or_insert(word);
            }
        }
    }

    /// The value that stands for full strength, 1 or 255, after a complaint where that is doubtful.
    pub(super) fn largest(&self, words: &mut Words<'a>) -> f64 {
        let Some(above) = self.above_one else { return 1.0 };
        if let Some(word) = self.above_octet {
            words.refuse(word, "a colour must be 0 to 1, or 0 to 255 throughout the file", "above 255");
        } else if let Some(fraction) = self.fraction {
            let warning = Diagnostic::warning("all colours of this file are read as 0 to 255")
                .at(words.place(above.span()), "because this one exceeds 1")
                .also(words.place(fraction.span()), "this is nearly black then");
            words.complain(warning);
        }
        255.0
    }
}
