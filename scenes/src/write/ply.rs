//! The writer of `.ply` meshes: binary, least octet first.

use std::io::{self, Write};

use super::ShortestNumber;
use crate::model::Scene;

/// Writes the mesh of a scene as a binary `.ply` file: coordinates in double precision, and for each triangle the
/// colour of its material in octets, rounded to nearest.
///
/// Vertices, triangles and their order read back bit for bit.
///
/// Errors: what the writer says, and a coordinate that is not finite.
pub fn ply(scene: &Scene, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "ply\nformat binary_little_endian 1.0")?;
    writeln!(out, "element vertex {}", scene.vertices.len())?;
    for axis in ["x", "y", "z"] {
        writeln!(out, "property double {axis}")?;
    }
    writeln!(out, "element face {}\nproperty list uchar uint vertex_indices", scene.triangles.len())?;
    for component in ["red", "green", "blue"] {
        writeln!(out, "property uchar {component}")?;
    }
    writeln!(out, "end_header")?;
    for &coordinate in scene.vertices.iter().flatten() {
        ShortestNumber::new(coordinate)?;
        out.write_all(&coordinate.to_le_bytes())?;
    }
    for triangle in &scene.triangles {
        out.write_all(&[3])?;
        for vertex in triangle.vertices {
            out.write_all(&vertex.to_le_bytes())?;
        }
        let colour = scene.materials[triangle.material as usize].colour;
        out.write_all(&colour.map(|component| (component * 255.0).round() as u8))?;
    }
    Ok(())
}
