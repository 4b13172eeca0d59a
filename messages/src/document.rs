//! TOML documents read as values of a type, with all their mistakes at once. What the keys mean is the reader's, who also
//! says which values are out of their ranges.

use std::ops::Range;
use std::sync::Arc;

use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue, Deserializer, Error};

use crate::{Diagnostic, Place, Report, Source, did_you_mean};

/// Most mistakes of a document that are shown.
const SHOWN: usize = 50;

/// Reads a TOML document. `refused` names the keys of a value that are out of their ranges, such as `bus.weights[2]`, with
/// what to say about each.
///
/// # Errors
/// All mistakes in the order of the text: those of syntax where there are any; else keys that do not exist, values of the
/// wrong type, and what `refused` says about the rest.
pub fn read_toml<T: DeserializeOwned>(
    source: &Arc<Source>,
    refused: impl Fn(&T) -> Vec<(String, Diagnostic)>,
) -> Result<T, Report> {
    let (table, errors) = DeTable::parse_recoverable(&source.text);
    if !errors.is_empty() {
        return Err(report(errors.iter().map(|error| described(source, error)).collect()));
    }
    let whole = Spanned::new(table.span(), DeValue::Table(table.into_inner()));
    let (errors, right) = sift::<T>(&whole, &|value| value);
    let mut messages: Vec<Diagnostic> = errors.iter().map(|error| described(source, error)).collect();
    // What is right by itself may still be out of its range.
    let value = right.map(|right| value::<T>(right));
    let value = match value {
        Some(Ok(value)) => value,
        Some(Err(error)) if messages.is_empty() => return Err(described(source, &error).into()),
        Some(Err(_)) | None => return Err(report(messages)),
    };
    messages.extend(refused(&value).into_iter().map(|(key, message)| match span(&whole, &key) {
        Some(span) => message.at(Place::new(source, span), "out of its range"),
        None => message,
    }));
    if messages.is_empty() { Ok(value) } else { Err(report(messages)) }
}

/// Messages in the order of the text, the first ones of many.
fn report(mut messages: Vec<Diagnostic>) -> Report {
    messages.sort_by_key(|message| message.place.as_ref().map_or(0, |(place, _)| place.span.start));
    let more = messages.len().saturating_sub(SHOWN);
    messages.truncate(SHOWN);
    if more != 0 {
        messages.push(Diagnostic::note(format!("{more} more mistakes are not shown"), more));
    }
    Report(messages)
}

type TomlPart<'s> = Spanned<DeValue<'s>>;

fn value<T: DeserializeOwned>(document: TomlPart<'_>) -> Result<T, Error> {
    let span = document.span();
    match document.into_inner() {
        DeValue::Table(table) => T::deserialize(Deserializer::from(Spanned::new(span, table))),
        _ => unreachable!("a document is a table"),
    }
}

/// Tells the wrong parts of a document from the right ones. `around` puts a part into a document that has nothing beside it,
/// so that a mistake does not hide the next one. Returns the mistakes, and the part without them.
///
/// For example `cores = "4"`, `[bus]`, `overlap = 1`, `arbiter = "tdma"`: the whole is wrong, so its two keys are tried alone. `cores`
/// is wrong, and has no parts; `bus` is wrong, so its keys are tried, of which `overlap` is. What is left is `[bus]` with
/// `arbiter = "tdma"`.
fn sift<'s, T: DeserializeOwned>(
    part: &TomlPart<'s>,
    around: &dyn Fn(TomlPart<'s>) -> TomlPart<'s>,
) -> (Vec<Error>, Option<TomlPart<'s>>) {
    let Err(error) = value::<T>(around(part.clone())) else { return (Vec::new(), Some(part.clone())) };
    let span = part.span();
    let mut errors = Vec::new();
    let rest = match part.get_ref() {
        DeValue::Table(table) => {
            let mut rest = DeTable::new();
            for (key, inner) in table {
                let alone = |inner: TomlPart<'s>| {
                    let mut table = DeTable::new();
                    table.insert(key.clone(), inner);
                    around(Spanned::new(span.clone(), DeValue::Table(table)))
                };
                let (wrong, right) = sift::<T>(inner, &alone);
                errors.extend(wrong);
                rest.extend(right.map(|right| (key.clone(), right)));
            }
            DeValue::Table(rest)
        }
        DeValue::Array(items) => {
            let wrong = items.iter().filter(|item| matches!(item.get_ref(), DeValue::Table(_))).flat_map(|item| {
                let alone = |inner: TomlPart<'s>| {
                    let mut list = DeArray::new();
                    list.push(inner);
                    around(Spanned::new(span.clone(), DeValue::Array(list)))
                };
                sift::<T>(item, &alone).0
            });
            errors.extend(wrong);
            return match errors.is_empty() {
                true => (own(error, &span), None),
                false => (errors, None),
            };
        }
        _ => return (own(error, &span), None),
    };
    // A table whose parts are right one by one lacks something, or they do not go together.
    if errors.is_empty() {
        errors = own(error, &span);
    }
    (errors, Some(Spanned::new(span, rest)))
}

/// The mistake, unless something is missing in a table around the part, which is said there.
fn own(error: Error, part: &Range<usize>) -> Vec<Error> {
    let is_outside = error.span().is_none_or(|span| span.start < part.start || span.end > part.end);
    if is_outside && error.message().starts_with("missing field") { Vec::new() } else { vec![error] }
}

fn described(source: &Arc<Source>, error: &Error) -> Diagnostic {
    let first_line = error.message().lines().next().unwrap_or_default();
    let mut message = Diagnostic::error(plain(first_line));
    if let Some(span) = error.span() {
        message = message.at(Place::new(source, span), "");
    }
    // The parser's message quotes the wrong word first and then all that would be right.
    let mut quoted = first_line.split('`').skip(1).step_by(2);
    if first_line.contains("unknown")
        && let Some(wrong) = quoted.next()
        && let Some(hint) = did_you_mean(wrong, quoted)
    {
        message = message.hint(hint);
    }
    message
}

/// Place of the value of a key such as `bus.weights[2]` in a document.
fn span(document: &TomlPart<'_>, key: &str) -> Option<Range<usize>> {
    let mut part = document;
    for name in key.split('.') {
        // `weights[1]` and `weights' length` both point to the list as a whole.
        let name = name.split(['[', '\'']).next()?;
        let DeValue::Table(table) = part.get_ref() else { break };
        (_, part) = table.iter().find(|(known, _)| known.get_ref() == name)?;
    }
    Some(part.span())
}

/// A message of a reader of TOML or JSON about a value of the wrong type, without the names of types of Rust.
pub fn plain(message: &str) -> String {
    let wrong = ["invalid type: ", "invalid value: "].iter().find_map(|start| message.strip_prefix(start));
    let Some((found, wanted)) = wrong.and_then(|rest| rest.split_once(", expected ")) else {
        return match message.strip_prefix("missing field ") {
            Some(field) => format!("the key {field} is missing"),
            None => message.to_owned(),
        };
    };
    let wanted = match wanted {
        "u8" | "u16" | "u32" | "u64" | "usize" => "a whole number from 0",
        "a boolean" => "true or false",
        "a string" => "a text in quotation marks",
        "a sequence" => "a list in brackets",
        wanted if wanted.starts_with("struct ") || wanted.starts_with("a map") => "a table",
        wanted => wanted,
    };
    let found = found.replace("string ", "text ").replace("integer ", "number ").replace("floating point ", "number ");
    format!("{wanted} is expected, not {}", found.replace("sequence", "a list").replace("map", "a table"))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use serde::Deserialize;

    use super::*;

    #[derive(Deserialize, Debug)]
    #[serde(deny_unknown_fields)]
    struct Shelf {
        name: String,
        #[serde(default)]
        books: Vec<Book>,
        #[serde(default)]
        places: BTreeMap<String, u32>,
    }

    #[derive(Deserialize, Debug)]
    #[serde(deny_unknown_fields)]
    struct Book {
        title: String,
        #[serde(default)]
        pages: u32,
    }

    fn read(text: &str) -> Result<Shelf, String> {
        let refused = |shelf: &Shelf| {
            let thick = shelf.books.iter().filter(|book| book.pages > 1000);
            let thick = thick.map(|book| ("books".to_owned(), Diagnostic::error(format!("{} is thick", book.title))));
            let far = shelf.places.iter().filter(|(_, place)| **place > 9);
            let far = far.map(|(key, _)| (format!("places.{key}"), Diagnostic::error(format!("{key} is far"))));
            thick.chain(far).collect()
        };
        read_toml(&Source::new("s.toml", text), refused).map_err(|report| report.render(false))
    }

    #[test]
    fn a_right_document_is_its_value() {
        let shelf = read("name = \"a\"\n[[books]]\ntitle = \"b\"\npages = 7\n[places]\nx = 1\n").unwrap();
        assert_eq!((shelf.name.as_str(), shelf.books[0].pages, shelf.places["x"]), ("a", 7, 1));
    }

    #[test]
    fn every_mistake_is_named_at_its_place() {
        let text = "nam = 1\nname = 2\n[places]\nx = \"1\"\ny = 11\nz = -1\n[[books]]\ntitle = 1\npages = 2\n\
                    [[books]]\ntitle = \"b\"\npges = 3\n";
        let shown = read(text).unwrap_err();
        for (place, message) in [
            ("s.toml:1:1", "did you mean `name`?"),
            ("s.toml:2:8", "a text in quotation marks is expected"),
            ("s.toml:4:5", "a whole number from 0 is expected"),
            ("s.toml:6:5", "a whole number from 0 is expected"),
            ("s.toml:8:9", "a text in quotation marks is expected"),
            ("s.toml:12:1", "did you mean `pages`?"),
        ] {
            assert!(shown.contains(place) && shown.contains(message), "{place} {message}\n{shown}");
        }
        assert!(shown.ends_with("6 errors"), "{shown}");
        let places = "name = \"a\"\n[places]\nx = 10\ny = 11\n";
        let shown = read(places).unwrap_err();
        assert!(shown.contains("s.toml:3:5") && shown.contains("s.toml:4:5") && shown.ends_with("2 errors"), "{shown}");
    }

    #[test]
    fn what_is_missing_is_named_where_it_is_missing() {
        let shown = read("[[books]]\ntitle = \"a\"\n").unwrap_err();
        assert!(shown.contains("the key `name` is missing"), "{shown}");
        let shown = read("name = \"a\"\n[[books]]\npages = 1\n[[books]]\npages = 2\n").unwrap_err();
        assert!(shown.contains("s.toml:2:1") && shown.contains("s.toml:4:1") && shown.ends_with("2 errors"), "{shown}");
    }

    #[test]
    fn all_mistakes_of_syntax_are_named() {
        let shown = read("name = \n[books\nplaces = {\n").unwrap_err();
        assert!(shown.contains("s.toml:1:8") && shown.contains("s.toml:2"), "{shown}");
    }

    #[test]
    fn a_flood_of_mistakes_is_cut_and_counted() {
        let text: String = (0..200).map(|n| format!("k{n} = {n}\n")).collect();
        let shown = read(&text).unwrap_err();
        assert!(shown.contains("150 more mistakes are not shown") && shown.ends_with("200 errors"), "{shown}");
    }
}
