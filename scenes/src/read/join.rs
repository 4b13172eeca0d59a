//! A mesh and what is said about it become a scene.

use messages::{Diagnostic, Report};

use super::Loaded;
use super::dsc::Description;
use super::mesh::{GREY, Mesh};
use crate::model::{Light, Scene, Triangle};

/// The scene of a `.dsc` and its mesh. Error: their numbers of triangles differ.
pub(super) fn described(name: String, description: Description, mesh: Mesh) -> Result<Loaded, Report> {
    let (wanted, found) = (description.surfaces.len(), mesh.triangles.len());
    if wanted != found {
        let message = format!("the description is about {wanted} triangles, but the mesh has {found}");
        let mut error = Diagnostic::error(message).at(description.count, format!("{wanted} triangles"));
        if let Some(count) = mesh.count {
            let label = match mesh.faces {
                faces if faces == found => format!("{found} triangles"),
                faces => format!("{faces} faces, cut into {found} triangles"),
            };
            error = error.also(count, label);
        }
        if wanted == mesh.faces {
            error = error.hint("a polygon of n corners is n - 2 triangles, and each needs its material");
        }
        return Err(error.into());
    }
    let mut warnings = description.warnings;
    warnings.0.extend(mesh.warnings.0);
    let scene = Scene {
        name,
        size: description.size,
        materials: description.materials,
        lights: description.lights,
        triangles: triangles(&mesh.triangles, &description.surfaces),
        vertices: mesh.vertices,
    };
    Ok(Loaded { warnings, ..Loaded::from(scene) })
}

/// Width and height of the picture of a mesh without description, in pixels.
pub(crate) const SIZE: (u32, u32) = (320, 240);

/// The scene of a mesh without description: its own colours or grey, one light above the camera, 320 x 240 pixels.
pub(super) fn alone(name: String, mesh: Mesh) -> Loaded {
    let mut scene = Scene {
        name,
        size: SIZE,
        materials: mesh.materials,
        lights: Vec::new(),
        triangles: triangles(&mesh.triangles, &mesh.surfaces),
        vertices: mesh.vertices,
    };
    if scene.materials.is_empty() {
        scene.materials.push(GREY);
    }
    scene.lights.push(light(&scene));
    Loaded { warnings: mesh.warnings, material_names: mesh.material_names, ..Loaded::from(scene) }
}

/// The light of a mesh without description: white, above and in front of the middle of its box by the larger of the
/// box's width and height.
pub(crate) fn light(scene: &Scene) -> Light {
    let (low, high) = scene.bounds().unwrap_or(([0.0; 3], [0.0; 3]));
    let size = (high[0] - low[0]).max(high[1] - low[1]);
    let size = if size > 0.0 && size.is_finite() { size } else { 1.0 };
    let centre = [0, 1].map(|k| low[k] / 2.0 + high[k] / 2.0);
    Light { position: [centre[0], centre[1] + size, high[2] + size], colour: [1.0; 3] }
}

fn triangles(corners: &[[u32; 3]], surfaces: &[u32]) -> Vec<Triangle> {
    let surfaces = surfaces.iter().copied().chain(std::iter::repeat(0));
    corners.iter().zip(surfaces).map(|(&vertices, material)| Triangle { vertices, material }).collect()
}
