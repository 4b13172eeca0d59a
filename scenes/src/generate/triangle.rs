//! One triangle: the smallest scene that shows anything.

use super::Sizes;
use super::mesh::MeshBuilder;
use crate::model::Scene;

/// One orange triangle, a little out of the picture's plane.
pub(super) fn build(sizes: &Sizes) -> Scene {
    let mut mesh = MeshBuilder::new("triangle", sizes.size);
    let orange = mesh.matte([1.0, 0.55, 0.15], 0.9);
    let corners = [[-1.3, -1.0, 0.1], [1.37, -0.83, -0.2], [0.21, 1.07, -0.4]].map(|p| mesh.vertex(p));
    mesh.triangle(corners, orange);
    mesh.light([-2.0, 3.0, 4.0], 1.0);
    mesh.scene
}
