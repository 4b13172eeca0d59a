//! The header of a PLY file. The library reads it; line by line it is asked first, so that a mistake has a place.

use messages::{Diagnostic, did_you_mean};
use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{ElementDef, Header, PropertyType, ScalarType};

use super::super::words::{Word, Words, shortened};
use super::row::{CORNERS, ElementRow, POSITION};

/// Octets in which a header must end.
const HEAD: usize = 1 << 20;

/// Names of the types of numbers.
const TYPES: [&str; 16] = [
    "char", "uchar", "short", "ushort", "int", "uint", "float", "double", "int8", "uint8", "int16", "uint16", "int32",
    "uint32", "float32", "float64",
];

/// Keywords at the start of lines.
const KEYWORDS: [&str; 7] = ["ply", "format", "comment", "obj_info", "element", "property", "end_header"];

/// Octets of the header: all lines up to `end_header`, the end of that line included; `None` without one.
pub(super) fn length(bytes: &[u8]) -> Option<usize> {
    let mut start = 0;
    while start < bytes.len().min(HEAD) {
        let line = &bytes[start..];
        let length = line.iter().position(|&octet| octet == b'\n' || octet == b'\r').unwrap_or(line.len());
        // Some programs end lines with a carriage return alone; then a line feed that follows belongs to the data.
        let has_both = line[length..].starts_with(b"\r\n");
        let end = (start + length + if has_both { 2 } else { 1 }).min(bytes.len());
        if line[..length].trim_ascii() == b"end_header" {
            return Some(end);
        }
        start = end;
    }
    None
}

/// The purpose of an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    Vertices,
    Faces,
    /// Strips of triangles, one after another in a list with -1 between.
    Strips,
    Other,
}

/// An element of the header.
pub(super) struct Element<'a> {
    pub role: Role,
    pub definition: ElementDef,
    /// Place of the number of elements.
    pub count: Word<'a>,
}

/// Reads a header which is all of the text; `None` after a complaint.
pub(super) fn read<'a>(words: &mut Words<'a>) -> Option<(Header, Vec<Element<'a>>)> {
    let parser = Parser::<ElementRow>::new();
    let mut lines = String::new();
    // Elements by name, each with its number and the names of its properties.
    let mut elements: Vec<(Word<'a>, Word<'a>, Vec<&'a str>)> = Vec::new();
    let mut first = None;
    let mut has_format = false;
    while let Some(word) = words.next() {
        let line = words.line_from(word.start);
        words.seek(line.span().end);
        lines.push_str(line.text);
        lines.push('\n');
        if first.is_none() && word.text != "ply" {
            words.refuse(word, "a PLY file starts with `ply`", "not `ply`");
            return None;
        }
        if first.is_some() && word.text == "ply" {
            words.refuse(word, "`ply` is there twice", "another file?");
            return None;
        }
        first.get_or_insert(word);
        let parts: Vec<Word<'a>> = line.parts().collect();
        // The library names no place, so each line is tried by itself first.
        if parser.read_header_line(line.text).is_err() {
            refuse(words, word, line);
            // What follows is not wrong because of this.
            match word.text {
                "format" => has_format = true,
                "element" => elements.push((word, word, Vec::new())),
                _ => {}
            }
            continue;
        }
        match word.text {
            "format" if has_format => words.refuse(word, "the format is there twice", "again"),
            "format" => {
                has_format = true;
                if let Some(version) = parts.get(2).filter(|version| version.text != "1.0") {
                    let message = format!("the version of the format is `{}`", shortened(version.text));
                    words.refuse(*version, message, "only 1.0 can be read");
                }
            }
            "element" => {
                words.whole(parts[2], || format!("the number of elements `{}`", shortened(parts[1].text)));
                if elements.iter().any(|(name, ..)| name.text == parts[1].text) {
                    words.refuse(parts[1], format!("element `{}` is there twice", parts[1].text), "again");
                }
                elements.push((parts[1], parts[2], Vec::new()));
            }
            "property" => match (elements.last_mut(), parts.last()) {
                (Some((element, _, properties)), Some(&name)) => {
                    if properties.contains(&name.text) {
                        let message = format!("property `{}` of element `{}` is there twice", name.text, element.text);
                        words.refuse(name, message, "again");
                    }
                    properties.push(name.text);
                }
                _ => words.refuse(word, "a property belongs to an element", "before the first `element`"),
            },
            _ => {}
        }
    }
    let first = first?;
    if !has_format {
        let error =
            Diagnostic::error("the header has no line `format`").at(words.place(first.span()), "in this header");
        words.complain(
            error.hint("it follows the first: `format ascii 1.0`, or binary_little_endian, binary_big_endian"),
        );
    }
    if words.has_errors() {
        return None;
    }
    let header = match parser.read_header(&mut Reader::new(lines.as_bytes())) {
        Ok(header) => header,
        Err(error) => {
            let text = error.to_string();
            let message = text.lines().next().unwrap_or_default();
            words.refuse(first, format!("this header cannot be read: {message}"), "header");
            return None;
        }
    };
    let known =
        elements.into_iter().filter_map(|(name, count, _)| Some((header.elements.get(name.text)?, name, count)));
    let mut elements = Vec::new();
    for (definition, name, count) in known {
        let role = role(words, definition, name)?;
        elements.push(Element { role, definition: definition.clone(), count });
    }
    Some((header, elements))
}

/// Purpose of an element, when it has what that takes.
fn role(words: &mut Words<'_>, definition: &ElementDef, name: Word<'_>) -> Option<Role> {
    let role = match name.text {
        "vertex" => Role::Vertices,
        "face" => Role::Faces,
        "tristrips" => Role::Strips,
        _ => return Some(Role::Other),
    };
    let has_number =
        |name: &str| definition.properties.get(name).is_some_and(|p| matches!(p.data_type, PropertyType::Scalar(_)));
    let is_whole = |kind: &ScalarType| !matches!(kind, ScalarType::Float | ScalarType::Double);
    let has_list = |name: &str| {
        definition
            .properties
            .get(name)
            .is_some_and(|p| matches!(&p.data_type, PropertyType::List(_, kind) if is_whole(kind)))
    };
    let missing = match role {
        Role::Vertices => POSITION.iter().find(|axis| !has_number(axis)).map(|axis| format!("no number `{axis}`")),
        _ if CORNERS.iter().any(|list| has_list(list)) => None,
        _ => Some("no list `vertex_indices` of whole numbers".to_string()),
    };
    match missing {
        Some(missing) if definition.count > 0 => {
            words.refuse(name, format!("element `{}` has {missing}", name.text), "among its properties");
            None
        }
        _ => Some(role),
    }
}

/// Says what is wrong with a line that the library does not understand.
fn refuse(words: &mut Words<'_>, keyword: Word<'_>, line: Word<'_>) {
    let parts: Vec<Word<'_>> = line.parts().collect();
    let at = |n: usize| parts.get(n).copied();
    let whole = words.place(line.span());
    let hint = match keyword.text {
        "format" => "formats are `format ascii 1.0`, binary_little_endian and binary_big_endian".to_string(),
        "element" => {
            // A count that is no number has its own complaint, which says more than the form of the line.
            if let (Some(name), Some(count), 3) = (at(1), at(2), parts.len())
                && words.whole(count, || format!("the number of elements `{}`", shortened(name.text))).is_none()
            {
                return;
            }
            "an element is `element name number`".to_string()
        }
        "property" => {
            let is_list = at(1).is_some_and(|word| word.text == "list");
            // `property list uchar int vertex_indices` has types in places 2 and 3, `property float x` in place 1.
            let types = if is_list { 2..4 } else { 1..2 };
            let unknown = types.filter_map(at).find(|word| !TYPES.contains(&word.text));
            if let Some(word) = unknown {
                let message = format!("`{}` is no type of PLY", shortened(word.text));
                let error = Diagnostic::error(message).at(words.place(word.span()), "not a type");
                // The first eight are all there are: the others are their second names.
                let hint = did_you_mean(&shortened(word.text), TYPES)
                    .unwrap_or_else(|| format!("the types are {}", TYPES[..8].join(", ")));
                words.complain(error.hint(hint));
                return;
            }
            "a property is `property type name`, or `property list type type name`".to_string()
        }
        text => {
            let message = format!("`{}` starts no line of a PLY header", shortened(text));
            let error = Diagnostic::error(message).at(words.place(keyword.span()), "not known");
            words.complain(match did_you_mean(&shortened(text), KEYWORDS) {
                Some(hint) => error.hint(hint),
                None => error,
            });
            return;
        }
    };
    let message = format!("this is no line `{}`", keyword.text);
    words.complain(Diagnostic::error(message).at(whole, "not understood").hint(hint));
}

/// Fewest octets that an element takes: in text a digit and a gap for each number.
pub(super) fn least(definition: &ElementDef, is_text: bool) -> usize {
    let octets = |kind: &ScalarType| match kind {
        _ if is_text => 2,
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    };
    let kinds = definition.properties.values().map(|property| match &property.data_type {
        PropertyType::Scalar(kind) | PropertyType::List(kind, _) => octets(kind),
    });
    kinds.sum()
}
