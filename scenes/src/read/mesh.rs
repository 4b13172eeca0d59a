//! The mesh that every format is read into, and the account of what is odd in it. Nothing here knows of a file format.

use messages::{Diagnostic, Place, Report};

use super::words::counted;
use crate::model::{Material, Vec3};

/// A mesh as its file describes it: polygons are already triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Positions in the file's units; all finite.
    pub vertices: Vec<Vec3>,
    /// Vertices of each triangle by number, all in range.
    pub triangles: Vec<[u32; 3]>,
    /// The surfaces that the file's colours ask for; empty when it has no colours.
    pub materials: Vec<Material>,
    /// Names of the materials, empty for one without; no names at all where the format has none.
    pub material_names: Vec<String>,
    /// The material of each triangle by number; empty when the file has no colours.
    pub surfaces: Vec<u32>,
    /// Faces of the file that were drawn, whatever their number of corners.
    pub faces: usize,
    /// Place of the number of faces, in formats that give it.
    pub count: Option<Place>,
    /// Warnings: what is likely a mistake.
    pub warnings: Report,
}

/// The surface of triangles that their file says nothing about.
pub(crate) const GREY: Material = Material { colour: [0.8; 3], reflection: 0.0, intensity: 0.9, index: 0.0 };

/// Warnings about triangles that cannot be seen or are there twice; `name` is the file's.
pub(super) fn census(name: &str, vertices: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Diagnostic> {
    let mut warnings = Vec::new();
    let mut flat = triangles.iter().enumerate().filter(|(_, corners)| is_flat(corners.map(|n| vertices[n as usize])));
    if let Some((first, _)) = flat.next() {
        let more = flat.count();
        let subject = counted(more + 1, "triangle has", "triangles have");
        let message = format!("{name}: {subject} no area and cannot be seen ({})", which(first, more));
        warnings.push(Diagnostic::warning(message));
    }
    let repeated = repeated(triangles);
    if let Some(&first) = repeated.first() {
        let more = repeated.len() - 1;
        let subject = counted(more + 1, "triangle repeats an earlier one", "triangles repeat earlier ones");
        let message = format!("{name}: {subject} ({})", which(first as usize, more));
        warnings.push(Diagnostic::warning(message));
    }
    warnings
}

/// Triangles with the same three vertices as an earlier one, in any order, by number.
pub(crate) fn repeated(triangles: &[[u32; 3]]) -> Vec<u32> {
    let mut sorted: Vec<([u32; 3], u32)> = (0..)
        .zip(triangles)
        .map(|(n, corners)| {
            let mut corners = *corners;
            corners.sort_unstable();
            (corners, n)
        })
        .collect();
    sorted.sort_unstable();
    let mut repeated: Vec<u32> =
        sorted.windows(2).filter(|pair| pair[0].0 == pair[1].0).map(|pair| pair[1].1).collect();
    repeated.sort_unstable();
    repeated
}

fn which(first: usize, more: usize) -> String {
    if more == 0 { format!("triangle {first}") } else { format!("the first is triangle {first}") }
}

/// A triangle has no area. Edges are scaled first, so that small coordinates do not vanish in the product.
pub(crate) fn is_flat([a, b, c]: [Vec3; 3]) -> bool {
    let edge = |p: Vec3| {
        let edge = [0, 1, 2].map(|k| p[k] / 2.0 - a[k] / 2.0);
        let size = edge.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
        edge.map(|x| if size > 0.0 { x / size } else { 0.0 })
    };
    let (u, v) = (edge(b), edge(c));
    [(1, 2), (2, 0), (0, 1)].iter().all(|&(k, l)| u[k] * v[l] - u[l] * v[k] == 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flat_triangles_are_told_from_thin_ones() {
        let tiny = 1e-200;
        assert!(is_flat([[0.0; 3], [1.0, 2.0, 3.0], [2.0, 4.0, 6.0]]), "on a line");
        assert!(is_flat([[1.0; 3], [1.0; 3], [2.0, 4.0, 6.0]]), "two corners alike");
        assert!(!is_flat([[0.0; 3], [tiny, 0.0, 0.0], [0.0, tiny, 0.0]]), "small");
        assert!(!is_flat([[0.0; 3], [1e9, 0.0, 0.0], [1e9, 1e-3, 0.0]]), "thin");
        assert!(!is_flat([[-1.7e308, 0.0, 0.0], [1.7e308, 0.0, 0.0], [0.0, 1e308, 0.0]]), "large");
    }

    #[test]
    fn repetitions_are_counted_whatever_their_turn() {
        let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let warnings = census("f", &vertices, &[[0, 1, 2], [1, 2, 3], [2, 1, 0], [1, 2, 0], [3, 3, 1]]);
        let texts: Vec<&str> = warnings.iter().map(|warning| warning.message.as_str()).collect();
        assert_eq!(
            texts,
            [
                "f: 1 triangle has no area and cannot be seen (triangle 4)",
                "f: 2 triangles repeat earlier ones (the first is triangle 2)",
            ]
        );
    }
}
