//! Finding the materials that the faces of an OBJ file name, in the libraries that it names.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};

use messages::{Diagnostic, Report};

use super::super::words::{self, Word, Words, shortened};
use super::{Libraries, ObjContents, material};
use crate::model::Material;

/// The material of each name that is used, where a library defines it.
pub(super) fn find(
    words: &mut Words<'_>,
    contents: &ObjContents<'_>,
    is_used: &[bool],
    libraries: &mut Libraries<'_>,
    others: &mut Report,
) -> Vec<Option<Material>> {
    let mut defined = HashMap::new();
    let mut is_missing = false;
    let mut names = HashSet::new();
    for &library in contents.libraries.iter().filter(|library| names.insert(library.text)) {
        for opened in open(library.text, libraries) {
            match opened {
                Ok((name, bytes)) => {
                    let source = words::source(&name, Cow::Owned(bytes));
                    let (materials, mut report) = material::parse(&source);
                    // As in a list of libraries, what comes first is meant.
                    for (name, material) in materials {
                        defined.entry(name).or_insert(material);
                    }
                    others.0.append(&mut report.0);
                }
                Err(report) => {
                    is_missing = true;
                    words.complain(missing(words, library, &report));
                }
            }
        }
    }
    let used = contents.names.iter().zip(is_used);
    used.map(|(&name, &is_used)| {
        let uncommented = name.text.split('#').next().unwrap_or_default().trim_end();
        let found = defined.get(name.text).or_else(|| defined.get(uncommented)).copied();
        // A library that is not there has been complained about, and nobody knows what it defines.
        if found.is_none() && is_used && !is_missing {
            let message = format!("material `{}` is not defined; its faces are grey", shortened(name.text));
            let place = words.place(name.span());
            let warning = Diagnostic::warning(message).at(place, "no `newmtl` of this name");
            words.complain(match contents.libraries.is_empty() {
                true => warning.hint("the file names no library: a `mtllib` is missing"),
                false => warning,
            });
        }
        found
    })
    .collect()
}

/// The libraries of one statement: a name with blanks in it, or several names.
fn open(names: &str, libraries: &mut Libraries<'_>) -> Vec<Result<(String, Vec<u8>), Report>> {
    let whole = libraries(names);
    if whole.is_ok() || !names.contains(char::is_whitespace) {
        return vec![whole];
    }
    names.split_whitespace().map(libraries).collect()
}

fn missing(words: &Words<'_>, library: Word<'_>, report: &Report) -> Diagnostic {
    let reason = report.0.first().map_or_else(String::new, |first| first.message.clone());
    let warning = Diagnostic::warning(format!("{reason}; faces with its materials are grey"));
    let warning = warning.at(words.place(library.span()), "material library");
    match report.0.first().and_then(|first| first.hint.clone()) {
        Some(hint) => warning.hint(hint),
        None => warning,
    }
}
