//! The writer of `.stl` meshes, through the library `stl_io`: binary.

use std::io::{self, Error, ErrorKind, Write};

use stl_io::{Normal, Triangle, Vertex};

use crate::model::{Scene, Vec3};
use crate::vector::{cross, sub, unit};

/// Writes the triangles of a scene as a binary `.stl` file, with coordinates of single precision and the normals that
/// go with their sense of rotation (zero for triangles without area).
///
/// Errors: what the writer says, and a coordinate that is not finite in single precision.
pub fn stl(scene: &Scene, out: &mut impl Write) -> io::Result<()> {
    let beyond = scene.vertices.iter().flatten().find(|&&coordinate| !(coordinate as f32).is_finite());
    if let Some(coordinate) = beyond {
        let message = format!("{coordinate:e} cannot be written: not a finite number in single precision");
        return Err(Error::new(ErrorKind::InvalidData, message));
    }
    let triangles = scene.triangles.iter().map(|triangle| {
        let corners = triangle.vertices.map(|vertex| scene.vertices[vertex as usize]);
        Triangle {
            normal: Normal::new(normal(corners).map(|x| x as f32)),
            vertices: corners.map(|corner| Vertex::new(corner.map(|x| x as f32))),
        }
    });
    stl_io::write_stl(out, triangles)
}

/// The normal of unit length, zero where there is none.
fn normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    unit(cross(sub(b, a), sub(c, a))).unwrap_or_default()
}
