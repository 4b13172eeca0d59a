//! The OFF reader (report 5.2), for the files that are about: text and binary, with or without a header, colours,
//! normals, more dimensions and polygons. The format is that of Geomview's manual page oogl(5).

mod binary;
mod header;
mod text;

use std::borrow::Cow;

use messages::Report;

use self::header::Header;
use super::format::{Likelihood, MeshReader};
use super::mesh::Mesh;
use super::words::{self, Words};
use crate::model::Vec3;

/// The reader's row. Headers are many (OFF, COFF, 4OFF, STCNOFF, ...); all contain OFF.
pub(super) static READER: MeshReader = MeshReader {
    extensions: &["off"],
    sniff: |_, word| Likelihood::likely_if(word.contains("OFF")),
    parse: |bytes, name, _| parse(bytes, name),
};

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
    messages::refuse_utf16(&bytes, name)?;
    let start = words::start(&bytes);
    if binary::is_likely(&bytes) {
        let source = words::source(name, Cow::Borrowed(&bytes[..bytes.len().min(binary::HEAD)]));
        let mut words = Words::new(&source, start);
        if let Some(header) = header::read(&mut words)
            && let Some(binary) = header.binary
        {
            let mesh = binary::read(&bytes, &header, binary, &mut words);
            return words.finish(mesh);
        }
    }
    let source = words::source(name, bytes);
    let mut words = Words::new(&source, start);
    let mesh = header::read(&mut words).and_then(|header| text::read(&mut words, &header));
    words.finish(mesh)
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
