//! The text form of PLY: one element a line.

use messages::Diagnostic;
use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::ScalarType;

use super::super::mesh::Mesh;
use super::super::words::{Word, Words, counted, shortened};
use super::header::{Element, Expected, expected};
use super::row::Row;
use super::{PlyContents, has_room, is_empty, which};

/// Reads the elements that follow the header; `None` after a complaint.
pub(super) fn read(words: &mut Words<'_>, elements: &[Element<'_>], name: &str) -> Option<Mesh> {
    let parser = Parser::<Row>::new();
    let mut contents = PlyContents::default();
    for element in elements.iter().filter(|element| !is_empty(element)) {
        if !has_room(words, element, words.remaining(), true) {
            return None;
        }
        for number in 0..element.definition.count {
            let Some(first) = words.next() else {
                let message = format!("the file ends before {}", which(element, number));
                let error = Diagnostic::error(message).at(words.end(), "the end");
                words.complain(error.also(words.place(element.count.span()), "the number of these elements"));
                return None;
            };
            let line = words.line_from(first.start);
            words.seek(line.span().end);
            let row = match parser.read_ascii_element(line.text, &element.definition) {
                Ok(row) => row,
                // The library knows fewer ways to write a number than there are.
                Err(_) => match parser.read_ascii_element(&plain(line.text), &element.definition) {
                    Ok(row) => row,
                    Err(error) => {
                        explain(words, element, number, line, &error.to_string());
                        return None;
                    }
                },
            };
            let found = line.text.split_whitespace().count();
            if found != row.numbers {
                let message = format!("{} should have {} numbers", which(element, number), row.numbers);
                let error = Diagnostic::error(message).at(words.place(line.span()), format!("{found} here"));
                words.complain(error.hint("the properties of the header say what follows what"));
                return None;
            }
            if let Err(complaint) = contents.push(element.role, number, &row) {
                let corner = complaint
                    .corner
                    .and_then(|corner| line.parts().skip(1).find(|word| word.text.parse() == Ok(corner)));
                match corner {
                    Some(corner) => words.refuse(corner, complaint.message, "out of range"),
                    None => explain(words, element, number, line, &complaint.message),
                }
                return None;
            }
        }
    }
    if let Some(word) = words.next() {
        let place = words.place(word.span());
        let message = "the file goes on after its last element";
        words.complain(match word.text.parse::<f64>() {
            Ok(_) => Diagnostic::error(message).at(place, "a number too many").hint("one of the counts is too small"),
            Err(_) => Diagnostic::warning(message).at(place, "not read"),
        });
    }
    Some(contents.into_mesh(words, elements, name))
}

/// A line with its numbers as the library reads them: digits before and behind the point.
fn plain(line: &str) -> String {
    let plain = |word: &str| match word.parse::<f64>() {
        Ok(value) if value.is_finite() => value.to_string(),
        _ => word.to_string(),
    };
    line.split_whitespace().map(plain).collect::<Vec<_>>().join(" ")
}

/// A word can be a number of a type.
fn fits(kind: &ScalarType, text: &str) -> bool {
    // As in `plain`, whole numbers may have a point.
    let whole = || text.parse::<f64>().ok().filter(|value| value.fract() == 0.0);
    let within = |low: f64, high: f64| whole().is_some_and(|value| (low..=high).contains(&value));
    match kind {
        ScalarType::Char => within(-128.0, 127.0),
        ScalarType::UChar => within(0.0, 255.0),
        ScalarType::Short => within(-32_768.0, 32_767.0),
        ScalarType::UShort => within(0.0, 65_535.0),
        ScalarType::Int => within(f64::from(i32::MIN), f64::from(i32::MAX)),
        ScalarType::UInt => within(0.0, f64::from(u32::MAX)),
        ScalarType::Float => text.parse::<f32>().is_ok_and(f32::is_finite),
        ScalarType::Double => text.parse::<f64>().is_ok_and(f64::is_finite),
    }
}

fn name_of(kind: &ScalarType) -> &'static str {
    match kind {
        ScalarType::Char => "a whole number from -128 to 127",
        ScalarType::UChar => "a whole number from 0 to 255",
        ScalarType::Short => "a whole number from -32768 to 32767",
        ScalarType::UShort => "a whole number from 0 to 65535",
        ScalarType::Int => "a whole number of 32 bits",
        ScalarType::UInt => "a whole number of 32 bits without sign",
        ScalarType::Float => "a finite number of single precision",
        ScalarType::Double => "a finite number",
    }
}

/// Says what is wrong with a line that the library does not read; `reason` is its own.
fn explain(words: &mut Words<'_>, element: &Element<'_>, number: usize, line: Word<'_>, reason: &str) {
    let found: Vec<Word<'_>> = line.parts().collect();
    let texts: Vec<&str> = found.iter().map(|word| word.text).collect();
    let which = which(element, number);
    for Expected { words: range, name, kind, is_length } in expected(&element.definition, &texts) {
        let name = if is_length { format!("the length of `{name}`") } else { format!("`{name}`") };
        for k in range {
            let Some(&word) = found.get(k) else {
                let message = format!("the line of {which} ends before {name}");
                let end = line.span().end;
                let error = Diagnostic::error(message).at(words.place(end..end), "more is expected");
                words.complain(error.hint("each element has a line of its own"));
                return;
            };
            if !fits(kind, word.text) || is_length && word.text.starts_with('-') {
                let message = format!("expected {name} of {which}, found `{}`", shortened(word.text));
                words.refuse(
                    word,
                    message,
                    match is_length && word.text.starts_with('-') {
                        true => "negative".to_string(),
                        false => format!("not {}", name_of(kind)),
                    },
                );
                return;
            }
        }
    }
    let reason = reason.lines().last().unwrap_or_default().trim();
    let message = format!("{which} cannot be read: {}", shortened(reason));
    words.refuse(line, message, counted(found.len(), "number", "numbers"));
}
