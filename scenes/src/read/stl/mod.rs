//! The reader of `.stl` meshes, text and binary. The formats are decoded by the library `stl_io`; what a file is, and
//! what is wrong with it, is found out here and in `text`.

mod binary;
mod text;

use std::borrow::Cow;
use std::collections::HashMap;

use messages::{Diagnostic, Report};
use stl_io::Triangle;

use super::colour::Spec;
use super::faces::Faces;
use super::format::{Likelihood, MeshReader};
use super::mesh::Mesh;
use super::words;
use crate::model::Vec3;

/// Reads an STL file; `name` is shown in messages. Numbers are of single precision, in text too.
///
/// - Corners with the same coordinates become one vertex; normals are not used.
/// - A file is binary when its length is that of the triangles it announces, whatever its first word is.
/// - Colours, which some programs hide in binary files, are read over with a warning.
///
/// Errors: the first mistake.
pub fn parse<'a>(bytes: impl Into<Cow<'a, [u8]>>, name: &str) -> Result<Mesh, Report> {
    let bytes = bytes.into();
    messages::refuse_utf16(&bytes, name)?;
    if binary::is_exact(&bytes) || !(is_text(&bytes) || bytes.is_empty()) {
        return binary::parse(bytes, name);
    }
    text::parse(bytes, name)
}

/// A file starts as text does. A binary file has zeros in the number of its triangles at least, if that is
/// less than 2^24.
fn is_text(bytes: &[u8]) -> bool {
    let bytes = words::without_end_mark(bytes);
    let is_control = |&octet: &u8| octet < b' ' && !octet.is_ascii_whitespace() && octet != b'\x0b';
    !bytes[..bytes.len().min(512)].iter().any(is_control)
}

/// The reader's row. A file as long as the triangles that it announces is binary STL, whatever its first word is.
pub(super) static READER: MeshReader = MeshReader {
    extensions: &["stl"],
    sniff: |bytes, word| match binary::is_exact(bytes) {
        true => Likelihood::Certain,
        false => Likelihood::likely_if(word.eq_ignore_ascii_case("solid")),
    },
    parse: |bytes, name, _| parse(bytes, name),
};

/// Triangles on their way to a mesh.
#[derive(Default)]
struct SharedCorners {
    vertices: Vec<Vec3>,
    numbers: HashMap<[u32; 3], u32>,
    faces: Faces,
}

impl SharedCorners {
    /// Takes a triangle; false when a coordinate is not finite.
    fn push(&mut self, triangle: &Triangle) -> bool {
        if !triangle.vertices.iter().flat_map(|corner| corner.0).all(f32::is_finite) {
            return false;
        }
        let corners = triangle.vertices.map(|corner| {
            // Adding zero makes -0 and 0 the same.
            let corner = corner.0.map(|x| x + 0.0);
            *self.numbers.entry(corner.map(f32::to_bits)).or_insert_with(|| {
                self.vertices.push(corner.map(f64::from));
                self.vertices.len() as u32 - 1
            })
        });
        self.faces.push(&self.vertices, &corners, Spec::Default);
        true
    }

    fn into_mesh(self, name: &str, mut warnings: Vec<Diagnostic>) -> Mesh {
        let mut mesh = self.faces.into_mesh(name, self.vertices, None);
        warnings.append(&mut mesh.warnings.0);
        Mesh { warnings: Report(warnings), ..mesh }
    }
}
