//! The reader of `.ply` meshes, text and binary of either order of octets. Header and binary forms are decoded by the
//! library `ply-rs-bw`; what elements stand for is put together here.

mod binary;
mod header;
mod row;
mod text;

use std::borrow::Cow;

use messages::{Diagnostic, Report};
use ply_rs_bw::ply::Encoding;

use self::header::{Element, Role};
use self::row::ElementRow;
use super::colour::{Spec, Writing};
use super::faces::Faces;
use super::format::{Likelihood, MeshReader};
use super::mesh::Mesh;
use super::words::{self, Words, counted};
use crate::model::Vec3;

/// The reader's row.
pub(super) static READER: MeshReader = MeshReader {
    extensions: &["ply"],
    sniff: |_, word| Likelihood::likely_if(word == "ply"),
    parse: |bytes, name, _| parse(bytes, name),
};

/// Reads a PLY file; `name` is shown in messages.
///
/// - Element `vertex` has x, y, z; element `face` the list `vertex_indices` or `vertex_index`, counted from 0; element
///   `tristrips` lists of strips with -1 between.
/// - Colours of faces become materials: 0..255 in whole-number types, else 0..1. Colours of vertices, other elements
///   and comments are read over.
///
/// Errors: several at once in the header, the first one behind it.
pub fn parse<'a>(bytes: impl Into<Cow<'a, [u8]>>, name: &str) -> Result<Mesh, Report> {
    let bytes = bytes.into();
    messages::refuse_utf16(&bytes, name)?;
    let start = words::start(&bytes);
    let Some(length) = header::length(&bytes) else {
        return Err(without_end(&bytes, name));
    };
    let head = words::source(name, Cow::Borrowed(&bytes[..length]));
    let mut words = Words::new(&head, start);
    let Some((header, elements)) = header::read(&mut words) else {
        return words.finish(None);
    };
    match header.encoding {
        Encoding::Ascii => {
            // The places of the header are the same in the whole text.
            let source = words::source(name, bytes);
            let at = head.text.len();
            let mut words = Words::new(&source, at);
            let mesh = text::read(&mut words, &elements, name);
            words.finish(mesh)
        }
        encoding => {
            let mesh = binary::read(&bytes, length, encoding, &elements, &mut words);
            words.finish(mesh)
        }
    }
}

/// A file whose header does not end, or that is no PLY at all.
fn without_end(bytes: &[u8], name: &str) -> Report {
    let source = words::source(name, Cow::Borrowed(&bytes[..bytes.len().min(4096)]));
    let mut words = Words::new(&source, words::start(bytes));
    match words.next() {
        None => words.complain(Diagnostic::error("the file is empty").at(words.end(), "expected `ply`")),
        Some(word) if word.text == "ply" => {
            let error = Diagnostic::error("the header does not end").at(words.place(word.span()), "starts here");
            words.complain(error.hint("its last line is `end_header`"));
        }
        Some(word) => words.refuse(word, "a PLY file starts with `ply`", "not `ply`"),
    }
    words.into_report()
}

/// The complaint about an element: the message, and what in the element is meant where that is one of its corners.
struct Complaint {
    message: String,
    corner: Option<i64>,
}

impl Complaint {
    fn new(message: String) -> Complaint {
        Complaint { message, corner: None }
    }
}

/// The elements of a file on their way to a mesh.
#[derive(Default)]
struct PlyContents {
    vertices: Vec<Vec3>,
    faces: Faces,
    has_vertex_colours: bool,
    corners: Vec<u32>,
}

impl PlyContents {
    /// Takes an element of a role; `number` counts from 0.
    fn push(&mut self, role: Role, number: usize, row: &ElementRow) -> Result<(), Complaint> {
        match role {
            Role::Vertices => {
                if !row.position.iter().all(|x| x.is_finite()) {
                    return Err(Complaint::new(format!("vertex {number} has a coordinate that is not finite")));
                }
                self.has_vertex_colours |= row.colour[0].is_some();
                self.vertices.push(row.position);
                Ok(())
            }
            Role::Faces => self.face(number, row),
            Role::Strips => self.strips(number, row),
            Role::Other => Ok(()),
        }
    }

    fn face(&mut self, number: usize, row: &ElementRow) -> Result<(), Complaint> {
        self.corners.clear();
        for &corner in &row.corners {
            let vertex = self.vertex(corner, || format!("face {number}"))?;
            self.corners.push(vertex);
        }
        let colour = match row.colour {
            [Some(red), Some(green), Some(blue)] => Spec::Components([red, green, blue], Writing::Decimal),
            _ => Spec::Default,
        };
        self.faces.push(&self.vertices, &self.corners, colour);
        Ok(())
    }

    /// Every corner from the third of a strip on ends a triangle with the two before it, turned alternately.
    fn strips(&mut self, number: usize, row: &ElementRow) -> Result<(), Complaint> {
        for strip in row.corners.split(|&corner| corner == -1) {
            for (n, three) in strip.windows(3).enumerate() {
                let turned = [three[n % 2], three[1 - n % 2], three[2]];
                let mut corners = [0; 3];
                for (corner, vertex) in turned.into_iter().zip(&mut corners) {
                    *vertex = self.vertex(corner, || format!("strip {number}"))?;
                }
                self.faces.push(&self.vertices, &corners, Spec::Default);
            }
        }
        Ok(())
    }

    fn vertex(&self, corner: i64, of: impl Fn() -> String) -> Result<u32, Complaint> {
        let count = self.vertices.len();
        match u32::try_from(corner) {
            Ok(number) if (number as usize) < count => Ok(number),
            _ => {
                let known = match count {
                    0 => "there are none before it".to_string(),
                    _ => format!("vertices go from 0 to {}", count - 1),
                };
                let message = format!("{} has vertex {corner}, but {known}", of());
                Err(Complaint { message, corner: Some(corner) })
            }
        }
    }

    fn into_mesh(self, words: &mut Words<'_>, elements: &[Element<'_>], name: &str) -> Mesh {
        if self.has_vertex_colours {
            words.complain(Diagnostic::warning(format!("{name}: colours of vertices are not used")));
        }
        let others: Vec<&str> = elements
            .iter()
            .filter(|element| element.role == Role::Other && element.definition.count > 0)
            .map(|element| element.definition.name.as_str())
            .collect();
        if !others.is_empty() {
            let subject = counted(others.len(), "kind of elements is", "kinds of elements are");
            words.complain(Diagnostic::warning(format!("{name}: {subject} not used: {}", others.join(", "))));
        }
        let with_faces = elements.iter().find(|element| element.role == Role::Faces);
        let count = with_faces.map(|element| words.place(element.count.span()));
        self.faces.into_mesh(name, self.vertices, count)
    }
}

/// "vertex 3 of 8".
fn which(element: &Element<'_>, number: usize) -> String {
    format!("{} {number} of {}", element.definition.name, element.definition.count)
}

/// A file with `rest` octets left may hold an element; somewhat too many pass, as in `Words::room`.
fn has_room(words: &mut Words<'_>, element: &Element<'_>, rest: usize, is_text: bool) -> bool {
    let least = header::least(&element.definition, is_text);
    let most = (rest + 1).checked_div(least).unwrap_or(usize::MAX);
    let count = element.definition.count;
    if count / 16 <= most {
        return true;
    }
    let name = &element.definition.name;
    let message = format!("{count} of element `{name}` are announced, but the file has room for {most} at most");
    words.refuse(element.count, message, "a wrong number, or the file is cut short");
    false
}

/// An element's properties say nothing: then it takes no room either, however many there are.
fn is_empty(element: &Element<'_>) -> bool {
    element.definition.properties.is_empty()
}
