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
        if self.is_too_many {
            return false;
        }
        self.cutter.fan(vertices, corners, &mut self.triangles);
        // A triangle knows the face that it comes from, because attributes are given by face.
        self.origins.resize(self.triangles.len(), self.drawn);
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
        if let Some(largest) = self.cutter.excess() {
            let message = format!("{name}: its concave polygons have too many corners to be cut into triangles");
            let (face, corners) = (self.origins[largest.first as usize], largest.corners);
            let hint = format!("face {face}, counted from 0, has {corners}: cut them where the file was made");
            warnings.push(Diagnostic::error(message).hint(hint));
        }
        let is_refused = !warnings.is_empty();
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
        // A mesh that is refused stays as it was read.
        if !is_refused {
            self.cutter.cut(&vertices, &mut self.triangles);
            warnings.extend(census(name, &vertices, &self.triangles));
        }
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

    #[test]
    fn a_file_of_many_concave_faces_is_refused_before_any_is_cut() {
        let zigzag = |n: u32| [f64::from(n), if n == 0 { 2.0 } else { f64::from(n % 2) }, 0.0];
        let vertices: Vec<Vec3> = (0..1_010).map(zigzag).collect();
        let corners: Vec<u32> = (0..1_010).collect();
        let read = |count: usize| {
            let mut faces = Faces::default();
            assert!(!faces.push(&vertices, &corners[..2], Spec::Default), "left out, and not counted");
            for n in 0..count {
                let size = if n == 2 { 1_010 } else { 1_000 };
                assert!(faces.push(&vertices, &corners[..size], Spec::Default));
            }
            faces.into_mesh("a.off", vertices.clone(), None)
        };
        let is_fan = |mesh: &Mesh| mesh.triangles[..998].iter().all(|triangle| triangle[0] == 0);
        let mesh = read(130);
        let [error, left_out] = &mesh.warnings.0[..] else { panic!("{:?}", mesh.warnings) };
        assert_eq!(error.message, "a.off: its concave polygons have too many corners to be cut into triangles");
        let hint = "face 2, counted from 0, has 1010: cut them where the file was made";
        assert_eq!(error.hint.as_deref(), Some(hint));
        assert_eq!(left_out.message, "a.off: 1 face has fewer than 3 corners and cannot be seen");
        assert!(mesh.warnings.has_errors() && is_fan(&mesh));
        let mesh = read(3);
        assert!(!mesh.warnings.has_errors() && !is_fan(&mesh));
    }
}
