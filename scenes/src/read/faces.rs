//! From the faces of a file to the triangles of a mesh, the same for every mesh format. Where corners and colours come
//! from is not known here.

use messages::{Diagnostic, Place, Report};

use super::colour::{FaceColours, Spec};
use super::mesh::{Mesh, census};
use super::polygon::Cutter;
use super::words::counted;
use crate::model::Vec3;

/// Most triangles of a mesh: a polygon of n corners in 2 octets each is n - 2 triangles of 16.
const MOST: usize = 1 << 24;

/// Faces on their way to triangles.
#[derive(Default)]
pub(super) struct Faces {
    cutter: Cutter,
    colours: FaceColours,
    triangles: Vec<[u32; 3]>,
    /// The face of each triangle, counted without those left out.
    origins: Vec<u32>,
    drawn: u32,
    left_out: usize,
    is_too_many: bool,
    /// The first face that would take too long to be cut, counted without those left out, and its corners.
    too_long: Option<(u32, usize)>,
}

impl Faces {
    /// No faces yet, and memory for as many as the file can hold.
    pub(super) fn with_room(room: usize) -> Faces {
        Faces { triangles: Vec::with_capacity(room), origins: Vec::with_capacity(room), ..Faces::default() }
    }

    /// Takes a face whose corners are all in range; false when it has too few to be drawn, or none more can be.
    pub(super) fn push(&mut self, vertices: &[Vec3], corners: &[u32], colour: Spec) -> bool {
        self.push_up_to(MOST, vertices, corners, colour)
    }

    fn push_up_to(&mut self, most: usize, vertices: &[Vec3], corners: &[u32], colour: Spec) -> bool {
        if corners.len() < 3 {
            self.left_out += 1;
            return false;
        }
        self.is_too_many |= self.triangles.len() + corners.len() - 2 > most;
        if self.is_too_many || self.too_long.is_some() {
            return false;
        }
        let (triangles, origins, face) = (&mut self.triangles, &mut self.origins, self.drawn);
        // A triangle knows the face that it comes from, because attributes are given by face.
        let is_cut = self.cutter.cut(vertices, corners, |triangle| {
            triangles.push(triangle);
            origins.push(face);
        });
        if !is_cut {
            self.too_long = Some((face, corners.len()));
            return false;
        }
        self.colours.push(self.drawn as usize, colour);
        self.drawn += 1;
        true
    }

    /// True where faces had too few corners to be drawn.
    pub(super) fn has_left_out(&self) -> bool {
        self.left_out > 0
    }

    /// Attributes of each drawn face, in their order, for each triangle.
    pub(super) fn spread(&self, of_faces: &[u32]) -> Vec<u32> {
        self.origins.iter().map(|&face| of_faces[face as usize]).collect()
    }

    /// The mesh, with warnings about what is odd in it, and an error when there were more triangles, or corners of concave
    /// polygons, than a mesh may have.
    pub(super) fn into_mesh(mut self, name: &str, vertices: Vec<Vec3>, count: Option<Place>) -> Mesh {
        let mut warnings = Vec::new();
        if self.is_too_many {
            let error = Diagnostic::error(format!("{name}: its faces are more than {MOST} triangles"));
            warnings.push(error.hint("polygons count as the triangles that they are cut into"));
        }
        if let Some((face, corners)) = self.too_long {
            let message = format!("{name}: its concave polygons have too many corners to be cut into triangles");
            let hint = format!("face {face}, counted from 0, has {corners}: cut them where the file was made");
            warnings.push(Diagnostic::error(message).hint(hint));
        }
        if self.left_out > 0 {
            let subject = counted(self.left_out, "face has", "faces have");
            warnings.push(Diagnostic::warning(format!("{name}: {subject} fewer than 3 corners and cannot be seen")));
        }
        // Faces that were left out have had their warning.
        if self.triangles.is_empty() && self.left_out == 0 && !vertices.is_empty() {
            warnings.push(Diagnostic::warning(format!("{name}: vertices without faces cannot be seen")));
        }
        if vertices.is_empty() {
            warnings.push(Diagnostic::warning(format!("{name}: the mesh is empty: there is nothing to be seen")));
        }
        let (materials, of_faces) =
            std::mem::take(&mut self.colours).into_materials(self.drawn as usize, name, &mut warnings);
        let surfaces = match materials.is_empty() {
            true => Vec::new(),
            false => self.spread(&of_faces),
        };
        warnings.extend(census(name, &vertices, &self.triangles));
        Mesh {
            vertices,
            triangles: self.triangles,
            materials,
            material_names: Vec::new(),
            surfaces,
            faces: self.drawn as usize,
            count,
            warnings: Report(warnings),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mesh_of_too_many_triangles_has_an_error_and_no_more_of_them() {
        let vertices = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let mut faces = Faces::default();
        let mut push = |corners: &[u32]| faces.push_up_to(3, &vertices, corners, Spec::Default);
        assert!(push(&[0, 1, 2, 3]) && push(&[0, 1, 2]));
        assert!(!push(&[0, 1, 2]) && !push(&[0, 1, 2, 3]));
        let mesh = faces.into_mesh("a.off", vertices.to_vec(), None);
        assert_eq!(mesh.triangles.len(), 3);
        let error = mesh.warnings.0[0].message.as_str();
        assert!(mesh.warnings.has_errors() && error == "a.off: its faces are more than 16777216 triangles", "{error}");
    }
}
