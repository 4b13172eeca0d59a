//! The binary forms of PLY: one element after another without gaps, in the order of octets that the header names.

use std::io::{Cursor, ErrorKind};

use messages::Diagnostic;
use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::Encoding;

use super::super::mesh::Mesh;
use super::super::words::{Words, counted};
use super::header::Element;
use super::row::ElementRow;
use super::{PlyContents, has_room, is_empty, which};

/// Reads the elements from octet `start` on; `None` after a complaint.
pub(super) fn read(
    bytes: &[u8],
    start: usize,
    encoding: Encoding,
    elements: &[Element<'_>],
    words: &mut Words<'_>,
) -> Option<Mesh> {
    let name = words.place(0..0).source.name.clone();
    let parser = Parser::<ElementRow>::new();
    let mut contents = PlyContents::default();
    let mut cursor = Cursor::new(bytes);
    cursor.set_position(start as u64);
    for element in elements.iter().filter(|element| !is_empty(element)) {
        if !has_room(words, element, bytes.len() - cursor.position() as usize, false) {
            return None;
        }
        for number in 0..element.definition.count {
            let at = cursor.position();
            let row = match encoding {
                Encoding::BinaryBigEndian => parser.read_big_endian_element(&mut cursor, &element.definition),
                _ => parser.read_little_endian_element(&mut cursor, &element.definition),
            };
            let message = match row {
                Ok(row) => match contents.push(element.role, number, &row) {
                    Ok(()) => continue,
                    Err(complaint) => format!("{} (octet {at})", complaint.message),
                },
                Err(error) if error.kind() == ErrorKind::UnexpectedEof => {
                    format!("the file ends at octet {} within {} (octet {at})", bytes.len(), which(element, number))
                }
                Err(error) => {
                    let text = error.to_string();
                    let reason = text.lines().next().unwrap_or_default();
                    format!("{} cannot be read (octet {at}): {reason}", which(element, number))
                }
            };
            // Behind an element that failed nothing is where it seems to be, so its complaint is the only one.
            let place = words.place(element.count.span());
            words.complain(Diagnostic::error(message).at(place, "the number of these elements"));
            return None;
        }
    }
    // Octets behind the last element do no harm: all that was announced is there.
    let rest = bytes.len() - cursor.position() as usize;
    if rest > 0 {
        let rest = counted(rest, "octet is", "octets are");
        let message = format!("{name}: {rest} not read, behind the last element");
        words.complain(Diagnostic::warning(message));
    }
    Some(contents.into_mesh(words, elements, &name))
}
