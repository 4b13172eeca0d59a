//! Parts of a scene that a format of meshes cannot hold: what would be different if the mesh were read again.

use std::collections::HashSet;

use messages::{Diagnostic, Report};

use super::MeshFormat;
use crate::model::{Material, Scene};
use crate::read::Loaded;
use crate::read::join;
use crate::read::mesh::GREY;

/// Parts of a scene that are not in its mesh when that stands alone: warnings, none where reading it gives the same picture and
/// the same names.
pub fn losses(loaded: &Loaded, format: MeshFormat) -> Report {
    let scene = &loaded.scene;
    let mut lost = Vec::new();
    if scene.size != join::SIZE {
        lost.push("the size of the picture");
    }
    match scene.lights.as_slice() {
        [] => lost.push("that there is no light"),
        lights if lights != [join::light(scene)] => lost.push("the lights"),
        _ => {}
    }
    lost.extend(lost_of_materials(&used(scene), format));
    let has_hint = !lost.is_empty();
    lost.extend(lost_digits(scene, format));
    lost.extend(lost_names(loaded).filter(|_| format != MeshFormat::Obj));
    warning(format.name(), &lost, has_hint)
}

/// Parts of a scene that are not in its mesh when a `.dsc` stands beside that, which holds all the rest. A `.dsc` with materials of
/// its own makes those of the mesh count for nothing, so that their names are lost whatever the mesh is.
pub fn losses_beside_description(loaded: &Loaded, format: MeshFormat) -> Report {
    let mut report = warning(format.name(), &Vec::from_iter(lost_digits(&loaded.scene, format)), false);
    report.0.append(&mut warning("dsc", &Vec::from_iter(lost_names(loaded)), false).0);
    report
}

fn lost_names(loaded: &Loaded) -> Option<&'static str> {
    loaded.material_names.iter().any(|name| !name.is_empty()).then_some("the names of materials")
}

/// The materials that triangles have.
fn used(scene: &Scene) -> Vec<&Material> {
    let used: HashSet<u32> = scene.triangles.iter().map(|triangle| triangle.material).collect();
    scene.materials.iter().zip(0..).filter(|(_, number)| used.contains(number)).map(|(material, _)| material).collect()
}

fn lost_of_materials(used: &[&Material], format: MeshFormat) -> Vec<&'static str> {
    let is_seen = |test: fn(&Material) -> bool| used.iter().any(|material| test(material));
    let is_dull = |material: &Material| material.reflection == 0.0 && material.transmission() == 0.0;
    match format {
        MeshFormat::Stl if used.iter().all(|&material| *material == GREY) => Vec::new(),
        MeshFormat::Stl => vec![if used.len() > 1 { "the materials" } else { "the material" }],
        MeshFormat::Obj => {
            let lost = is_seen(|m| m.transmission() == 0.0 && (read_back(m) - m.intensity).abs() > 1e-12);
            Vec::from_iter(lost.then_some("the share of ambient light in some materials"))
        }
        MeshFormat::Off | MeshFormat::Ply => {
            let has_effects = used.iter().any(|material| !is_dull(material));
            let is_brighter = used.iter().any(|material| is_dull(material) && material.intensity != GREY.intensity);
            let is_finer = is_seen(|m| m.colour.iter().any(|c| (c * 255.0).round() / 255.0 != *c));
            let lost = [
                (has_effects, "mirrors and glass"),
                (is_brighter, "how much light some materials scatter"),
                (is_finer && format == MeshFormat::Ply, "digits of colours beyond 8 bits"),
            ];
            lost.into_iter().filter(|(is_lost, _)| *is_lost).map(|(_, what)| what).collect()
        }
    }
}

/// The diffuse coefficient kd that an opaque material of a library is read with.
fn read_back(material: &Material) -> f64 {
    let diffuse = material.colour.map(|component| component * material.intensity);
    diffuse.into_iter().fold(1.0 - material.reflection, f64::max)
}

fn lost_digits(scene: &Scene, format: MeshFormat) -> Option<&'static str> {
    let is_single = |x: &f64| f64::from(*x as f32) == *x;
    let is_lost = format == MeshFormat::Stl && !scene.vertices.iter().flatten().all(is_single);
    is_lost.then_some("digits beyond single precision")
}

fn warning(format: &str, lost: &[&str], has_hint: bool) -> Report {
    let Some((last, rest)) = lost.split_last() else { return Report::default() };
    let list = if rest.is_empty() { (*last).to_string() } else { format!("{} and {last}", rest.join(", ")) };
    let article = if ["ply", "dsc"].contains(&format) { "a" } else { "an" };
    let warning = Diagnostic::warning(format!("{article} .{format} file does not hold {list}"));
    if has_hint { warning.hint("a .dsc beside it holds all but the mesh").into() } else { warning.into() }
}
