//! Finding the materials that the faces of an OBJ file name, in the libraries that it names. A comment may stand behind
//! a name, and `#` may be part of one: the whole line is looked for first.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};

use messages::{Diagnostic, Report};

use super::super::words::{self, Word, Words, shortened};
use super::statement::{listed, uncommented, unescaped};
use super::{Libraries, ObjContents, material};
use crate::model::Material;

/// The materials that libraries define.
#[derive(Default)]
pub(super) struct Definitions {
    /// Names and materials, in the order of the libraries.
    pub list: Vec<(String, Material)>,
    /// Numbers in the list by the whole text behind `newmtl`.
    whole: HashMap<String, usize>,
    /// Numbers in the list by the text before a `#`; `None` where several definitions differ only behind it.
    plain: HashMap<String, Option<usize>>,
}

impl Definitions {
    /// Takes a definition; as in a list of libraries, the first one of a name is meant.
    fn push(&mut self, name: String, material: Material) {
        let name = unescaped(&name).into_owned();
        if self.whole.contains_key(&name) {
            return;
        }
        let (number, plain) = (self.list.len(), uncommented(&name).to_owned());
        self.plain.entry(plain).and_modify(|known| *known = None).or_insert(Some(number));
        self.whole.insert(name.clone(), number);
        self.list.push((name, material));
    }

    /// Number of the definition that a name means.
    fn find(&self, name: &str) -> Option<usize> {
        let name = unescaped(name);
        let plain = uncommented(&name);
        let whole = || self.whole.get(name.as_ref()).or_else(|| self.whole.get(plain)).copied();
        whole().or_else(|| self.plain.get(plain).copied().flatten())
    }
}

/// The definitions of all libraries, and for each name that is used the number of its own.
pub(super) fn find(
    words: &mut Words<'_>,
    contents: &ObjContents<'_>,
    is_used: &[bool],
    libraries: &mut Libraries<'_>,
    others: &mut Report,
) -> (Definitions, Vec<Option<usize>>) {
    let mut defined = Definitions::default();
    let mut is_missing = false;
    let mut names = HashSet::new();
    for &library in contents.libraries.iter().filter(|library| names.insert(library.text)) {
        for opened in open(library.text, libraries) {
            match opened {
                Ok((name, bytes)) => {
                    if let Err(mut report) = messages::refuse_utf16(&bytes, &name) {
                        others.0.append(&mut report.0);
                        continue;
                    }
                    let source = words::source(&name, Cow::Owned(bytes));
                    let (materials, mut report) = material::parse(&source);
                    materials.into_iter().for_each(|(name, material)| defined.push(name, material));
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
    let find = |(&name, &is_used): (&Word<'_>, &bool)| {
        let found = defined.find(name.text);
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
    };
    let of_names = used.map(find).collect();
    (defined, of_names)
}

/// The libraries of one statement: a name with blanks in it, or several names.
fn open(names: &str, libraries: &mut Libraries<'_>) -> Vec<Result<(String, Vec<u8>), Report>> {
    let plain = uncommented(names);
    let mut whole = libraries(plain);
    for other in [names, unescaped(plain).as_ref()] {
        if whole.is_err() && other != plain {
            whole = libraries(other).or(whole);
        }
    }
    match listed(plain) {
        list if whole.is_err() && list.len() > 1 => list.iter().map(|name| libraries(name)).collect(),
        _ => vec![whole],
    }
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
