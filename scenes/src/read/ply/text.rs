//! The text form of PLY: the numbers of one element after another. An element may go on in the next line, but ends with
//! its line, so that a missing number is found where it is missing.

use messages::Diagnostic;
use ply_rs_bw::ply::{PropertyType, ScalarType};

use super::super::mesh::Mesh;
use super::super::words::{Word, Words, shortened};
use super::header::{Element, Role};
use super::row::{ElementRow, PropertySlot};
use super::{PlyContents, has_room, is_empty, which};

/// A property of an element, ready to be read many times.
struct TextColumn<'d> {
    name: &'d str,
    slot: PropertySlot,
    kind: &'d PropertyType,
}

/// Reads the elements that follow the header; `None` after a complaint.
pub(super) fn read(words: &mut Words<'_>, elements: &[Element<'_>], name: &str) -> Option<Mesh> {
    let mut contents = PlyContents::default();
    for element in elements.iter().filter(|element| !is_empty(element)) {
        if !has_room(words, element, words.remaining(), true) {
            return None;
        }
        let properties = element.definition.properties.iter();
        let columns: Vec<TextColumn<'_>> = properties
            .map(|(name, property)| TextColumn { name, slot: slot(element.role, name), kind: &property.data_type })
            .collect();
        let mut row = ElementRow::default();
        for number in 0..element.definition.count {
            let mut reader = ElementReader { words, element, number, first: None, last_end: 0, cut: None, read: 0 };
            let first = reader.read(&columns, &mut row)?;
            if let Err(complaint) = contents.push(element.role, number, &row) {
                let end = words.position();
                words.seek(first.start);
                let corner = complaint.corner.and_then(|corner| {
                    std::iter::from_fn(|| words.next().filter(|word| word.start < end))
                        .skip(1)
                        .find(|word| word.text.parse() == Ok(corner))
                });
                words.refuse(corner.unwrap_or(first), complaint.message, "out of range");
                return None;
            }
        }
    }
    if let Some(word) = words.next() {
        let place = words.place(word.span());
        let warning = Diagnostic::warning("the file goes on after its last element");
        let last = elements.iter().rfind(|element| !is_empty(element));
        words.complain(match (word.text.parse::<f64>(), last) {
            // Faces cut short by a vertex that was taken for one would be a picture of something else.
            (Ok(_), _) if contents.faces.has_left_out() => {
                let error = Diagnostic::error("the file goes on after its last element");
                error.at(place, "a number too many").hint("one of the counts is too small")
            }
            (Ok(_), Some(last)) => {
                let warning = warning.at(place, "not read from here on");
                warning.also(words.place(last.count.span()), "the number of these elements is too small")
            }
            _ => warning.at(place, "not read"),
        });
    }
    Some(contents.into_mesh(words, elements, name))
}

/// Place of a property of an element in a row.
fn slot(role: Role, name: &str) -> PropertySlot {
    match (role, PropertySlot::of(name)) {
        (Role::Vertices, slot @ (PropertySlot::Position(_) | PropertySlot::Colour(_))) => slot,
        (Role::Faces, slot @ (PropertySlot::Colour(_) | PropertySlot::Corners)) => slot,
        (Role::Strips, slot @ PropertySlot::Corners) => slot,
        _ => PropertySlot::Unused,
    }
}

/// Reads one element.
struct ElementReader<'r, 'a, 'e> {
    words: &'r mut Words<'a>,
    element: &'r Element<'e>,
    number: usize,
    first: Option<Word<'a>>,
    /// End of the last word that was read.
    last_end: usize,
    /// End of the first line, and what it ends before, where the element goes on in another.
    cut: Option<(usize, String)>,
    /// Numbers read so far.
    read: usize,
}

impl<'a> ElementReader<'_, 'a, '_> {
    /// Reads all numbers of the element into a row; its first word. `None` after a complaint.
    fn read(&mut self, columns: &[TextColumn<'_>], row: &mut ElementRow) -> Option<Word<'a>> {
        row.clear();
        for column in columns {
            match column.kind {
                PropertyType::Scalar(kind) => {
                    let value = self.number(column, kind, false)?;
                    row.set(column.slot, value, kind);
                }
                PropertyType::List(length, kind) => {
                    let length = self.number(column, length, true)?;
                    // A length that the file does not hold ends with the file, not with the host's memory.
                    for _ in 0..length as u64 {
                        let value = self.number(column, kind, false)?;
                        if column.slot == PropertySlot::Corners {
                            row.corners.push(value as i64);
                        }
                    }
                }
            }
        }
        let first = self.first?;
        if let Some(word) = self.words.next_in_line() {
            self.refuse_line(first, word);
            return None;
        }
        Some(first)
    }

    /// The next number of a property; `None` after a complaint.
    fn number(&mut self, column: &TextColumn<'_>, kind: &ScalarType, is_length: bool) -> Option<f64> {
        let what = || if is_length { format!("the length of `{}`", column.name) } else { format!("`{}`", column.name) };
        let Some(word) = self.words.next() else {
            let which = which(self.element, self.number);
            let message = match self.first {
                None => format!("the file ends before {which}"),
                Some(_) => format!("the file ends before {} of {which}", what()),
            };
            let error = Diagnostic::error(message).at(self.words.end(), "the end");
            let count = self.words.place(self.element.count.span());
            self.words.complain(error.also(count, "the number of these elements"));
            return None;
        };
        // Note where the element's first line ends, which is what is wrong if there is a number too many later
        if self.first.is_none() {
            self.first = Some(word);
        } else if self.cut.is_none() && self.words.starts_line(word) {
            self.cut = Some((self.last_end, what()));
        }
        self.last_end = word.span().end;
        self.read += 1;
        let is_used = is_length || matches!(column.slot, PropertySlot::Position(_) | PropertySlot::Corners);
        // A float is rounded once, from the text: by way of double precision it may end at a neighbour.
        let value = match kind {
            ScalarType::Float => word.text.parse::<f32>().map(f64::from),
            _ => word.text.parse::<f64>(),
        };
        // Nothing depends on a number that is not used, so it may be `nan` or infinite.
        if let Ok(value) = value
            && (fits(kind, value) || !is_used && !fits(&ScalarType::Double, value))
            && !(is_length && value < 0.0)
        {
            return Some(value);
        }
        let message =
            format!("expected {} of {}, found `{}`", what(), which(self.element, self.number), shortened(word.text));
        let label = match is_length && word.text.starts_with('-') {
            true => "negative".to_string(),
            false => format!("not {}", name_of(kind)),
        };
        self.words.refuse(word, message, label);
        None
    }

    /// Says that an element does not end with its line, where `extra` follows it.
    fn refuse_line(&mut self, first: Word<'_>, extra: Word<'a>) {
        let which = which(self.element, self.number);
        let (more, end) = self.words.rest_of_line(extra);
        let error = match self.cut.take() {
            Some((end, what)) => Diagnostic::error(format!("the line of {which} ends before {what}"))
                .at(self.words.place(end..end), "more is expected")
                .also(self.words.place(extra.span()), "too much, if it goes on in this line")
                .hint("an element may take several lines, but the next one starts a new line"),
            None => Diagnostic::error(format!("{which} should have {} numbers", self.read))
                .at(self.words.place(first.start..end), format!("{} here", self.read + more))
                .hint("the properties of the header say what follows what"),
        };
        self.words.complain(error);
    }
}

/// True where a type has a value.
fn fits(kind: &ScalarType, value: f64) -> bool {
    // Whole numbers may have a point.
    let within = |low: f64, high: f64| value.fract() == 0.0 && (low..=high).contains(&value);
    match kind {
        ScalarType::Char => within(-128.0, 127.0),
        ScalarType::UChar => within(0.0, 255.0),
        ScalarType::Short => within(-32_768.0, 32_767.0),
        ScalarType::UShort => within(0.0, 65_535.0),
        ScalarType::Int => within(f64::from(i32::MIN), f64::from(i32::MAX)),
        ScalarType::UInt => within(0.0, f64::from(u32::MAX)),
        ScalarType::Float | ScalarType::Double => value.is_finite(),
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
