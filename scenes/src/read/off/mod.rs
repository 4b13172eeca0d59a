//! The OFF reader (report 5.2), for the files that are about: text and binary, with or without a header, colours,
//! normals, more dimensions and polygons. The format is that of Geomview's manual page oogl(5).

mod binary;
mod colour;
mod header;
mod text;

use std::borrow::Cow;

use isa::diagnostic::{Diagnostic, Report};

use self::colour::FaceColours;
use self::header::Header;
use super::mesh::{Mesh, census};
use super::polygon::Cutter;
use super::words::{self, Words, counted};
use crate::model::Vec3;

/// Reads an OFF file (octets that are handed over are not copied); `name` is shown in messages.
///
/// - Vertex numbers count from 0. Polygons are cut into triangles; those with fewer than three corners are left out
///   with a warning, triangles without area and repeated ones stay, with a warning.
/// - 4OFF divides by the last number of a position; nOFF takes the first three numbers.
/// - Normals, texture positions and colours of vertices are read over. Face colours become materials.
/// - Octets that are not UTF-8 are accepted in comments.
///
/// Errors: several at once where it stays clear what follows.
pub fn parse<'a>(bytes: impl Into<Cow<'a, [u8]>>, name: &str) -> Result<Mesh, Report> {
    let bytes = bytes.into();
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        let error = Diagnostic::error(format!("{name} is UTF-16 text, which is not read"));
        return Err(error.hint("save it as UTF-8 or ASCII").into());
    }
    let start = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
    if binary::is_likely(&bytes) {
        let source = words::source(name, Cow::Borrowed(&bytes[..bytes.len().min(binary::HEAD)]));
        let mut words = Words::new(&source, start);
        if let Some(header) = header::read(&mut words)
            && let Some(binary) = header.binary
        {
            let mesh = binary::read(&bytes, &header, binary, &mut words);
            return finish(mesh, words);
        }
    }
    let source = words::source(name, bytes);
    let mut words = Words::new(&source, start);
    let mesh = header::read(&mut words).and_then(|header| text::read(&mut words, &header));
    finish(mesh, words)
}

/// The mesh when there was no error, else everything that was found.
fn finish(mesh: Option<Mesh>, words: Words<'_>) -> Result<Mesh, Report> {
    let has_errors = words.has_errors();
    let mut report = words.into_report();
    match mesh {
        Some(mut mesh) if !has_errors => {
            report.0.append(&mut mesh.warnings.0);
            Ok(Mesh { warnings: report, ..mesh })
        }
        _ => Err(report),
    }
}

/// Faces on their way to triangles: what text and binary files have in common.
#[derive(Default)]
struct Faces {
    cutter: Cutter,
    colours: FaceColours,
    triangles: Vec<[u32; 3]>,
    /// The face of each triangle, counted without those left out.
    origins: Vec<u32>,
    drawn: u32,
    left_out: usize,
}

impl Faces {
    /// No faces yet, and memory for as many as the file can hold.
    fn with_room(room: usize) -> Faces {
        Faces { triangles: Vec::with_capacity(room), origins: Vec::with_capacity(room), ..Faces::default() }
    }

    /// Takes a face whose corners are all in range.
    fn push(&mut self, vertices: &[Vec3], corners: &[u32], colour: colour::Spec) {
        if corners.len() < 3 {
            self.left_out += 1;
            return;
        }
        let (triangles, origins, face) = (&mut self.triangles, &mut self.origins, self.drawn);
        self.cutter.cut(vertices, corners, |triangle| {
            triangles.push(triangle);
            origins.push(face);
        });
        self.colours.push(self.drawn as usize, colour);
        self.drawn += 1;
    }

    /// The mesh, with warnings about what is odd in it.
    fn into_mesh(self, name: &str, vertices: Vec<Vec3>, count: Option<isa::diagnostic::Place>) -> Mesh {
        let mut warnings = Vec::new();
        if self.left_out > 0 {
            let subject = counted(self.left_out, "face has", "faces have");
            warnings.push(Diagnostic::warning(format!("{name}: {subject} fewer than 3 corners and cannot be seen")));
        }
        let (materials, of_faces) = self.colours.into_materials(self.drawn as usize, name, &mut warnings);
        let surfaces = match materials.is_empty() {
            true => Vec::new(),
            false => self.origins.iter().map(|&face| of_faces[face as usize]).collect(),
        };
        warnings.extend(census(name, &vertices, &self.triangles));
        Mesh {
            vertices,
            triangles: self.triangles,
            materials,
            surfaces,
            faces: self.drawn as usize,
            count,
            warnings: Report(warnings),
        }
    }
}

/// A position from the numbers of a vertex; `None` when it lies at infinity.
fn position(header: &Header, numbers: &[f64]) -> Option<Vec3> {
    let (numbers, divisor) = match header.is_homogeneous {
        true => (&numbers[..numbers.len() - 1], numbers[numbers.len() - 1]),
        false => (numbers, 1.0),
    };
    let point = [0, 1, 2].map(|k| numbers.get(k).copied().unwrap_or(0.0) / divisor);
    point.iter().all(|x| x.is_finite()).then_some(point)
}
