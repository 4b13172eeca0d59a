//! No triangle at all: a picture of the background.

use super::Sizes;
use super::mesh::MeshBuilder;
use crate::model::Scene;

/// A light that nothing receives.
pub(super) fn build(sizes: &Sizes) -> Scene {
    let mut mesh = MeshBuilder::new("empty", sizes.size);
    mesh.light([0.0, 1.0, 0.0], 1.0);
    mesh.scene
}
