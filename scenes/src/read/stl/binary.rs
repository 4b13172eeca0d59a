//! The binary form of STL: 80 octets of anything, the number of triangles, 50 octets for each; least octet first.

use std::borrow::Cow;
use std::io::Cursor;

use messages::{Diagnostic, Report};

use super::super::mesh::Mesh;
use super::super::words::counted;
use super::SharedCorners;

/// Octets before the first triangle.
const HEADER: usize = 84;

/// Octets of a triangle.
const TRIANGLE: usize = 50;

/// Triangles that the file announces; `None` when it ends before that.
fn announced(bytes: &[u8]) -> Option<usize> {
    let count: [u8; 4] = bytes.get(HEADER - 4..HEADER)?.try_into().ok()?;
    Some(u32::from_le_bytes(count) as usize)
}

/// The length of a file is that of the triangles which it announces.
pub(super) fn is_exact(bytes: &[u8]) -> bool {
    announced(bytes).is_some_and(|count| bytes.len() == HEADER + count * TRIANGLE)
}

/// Reads a binary file.
pub(super) fn parse(bytes: Cow<'_, [u8]>, name: &str) -> Result<Mesh, Report> {
    let refuse = |message: String| Err(Diagnostic::error(format!("{name}: {message}")).into());
    let Some(count) = announced(&bytes) else {
        return refuse(format!(
            "the file ends at octet {}, before the number of triangles of a binary STL",
            bytes.len()
        ));
    };
    let room = (bytes.len() - HEADER) / TRIANGLE;
    if count > room {
        let announced = counted(count, "triangle is announced", "triangles are announced");
        let message = format!("{announced} (octet 80), but the file has room for {room}");
        let error = Diagnostic::error(format!("{name}: {message}"));
        return Err(match count.checked_sub(room) {
            Some(1) => error.hint(format!("it ends at octet {} within the last one", bytes.len())).into(),
            _ => error.hint("the file is cut short, or no binary STL").into(),
        });
    }
    let rest = bytes.len() - HEADER - count * TRIANGLE;
    let mut warnings = Vec::new();
    if rest > 0 {
        let rest = counted(rest, "octet is", "octets are");
        warnings.push(Diagnostic::warning(format!("{name}: {rest} not read, behind the last triangle")));
    }
    let triangles = bytes[HEADER..].chunks_exact(TRIANGLE).take(count);
    let attributed = triangles.filter(|triangle| triangle[48..] != [0; 2]).count();
    if attributed > 0 {
        let subject = counted(attributed, "triangle has an attribute", "triangles have attributes");
        warnings.push(Diagnostic::warning(format!("{name}: {subject}, likely colours, which are not used")));
    }
    let mut bytes = bytes;
    if bytes.starts_with(b"solid") {
        // The library takes this word for a text's.
        bytes.to_mut()[..5].fill(0);
    }
    let mut corners = SharedCorners::default();
    let mut reader = Cursor::new(&bytes[..]);
    let triangles = stl_io::create_stl_reader(&mut reader)
        .map_err(|error| Diagnostic::error(format!("{name} cannot be read as STL: {error}")))?;
    for (n, triangle) in triangles.enumerate() {
        let at = HEADER + n * TRIANGLE;
        match triangle {
            Ok(triangle) if corners.push(&triangle) => {}
            Ok(_) => return refuse(format!("triangle {n} has a coordinate that is not finite (octet {})", at + 12)),
            Err(error) => return refuse(format!("triangle {n} cannot be read (octet {at}): {error}")),
        }
    }
    Ok(corners.into_mesh(name, warnings))
}
