//! Readers of scenes: meshes of all formats, materials and descriptions.

use messages::Report;
use scenes::generate::{GenerateOptions, scene};
use scenes::model::Scene;
use scenes::read::mesh::Mesh;
use scenes::read::{dsc, obj, off, ply, stl};
use scenes::write::{self, MeshFormat};

use crate::project::{literals, pieces};
use crate::seen::{PlantedFault, Seen};
use crate::surface::Surface;

const LONGEST: usize = 1500;

/// Octets that a reader may take for an input of that length, messages and their sources included.
const MEMORY: usize = 8 << 20;

/// OFF, as text and binary.
pub const OFF: Surface =
    Surface::text((LONGEST, MEMORY), "off", || seeds(MeshFormat::Off), read_off, &["scenes/src/read/off"]);

/// STL, as text and binary.
pub const STL: Surface =
    Surface::text((LONGEST, MEMORY), "stl", || seeds(MeshFormat::Stl), read_stl, &["scenes/src/read/stl"]);

/// PLY, as text and binary.
pub const PLY: Surface =
    Surface::text((LONGEST, MEMORY), "ply", || seeds(MeshFormat::Ply), read_ply, &["scenes/src/read/ply"]);

/// OBJ, with a library of materials beside it.
pub const OBJ: Surface = Surface::text(
    (LONGEST, MEMORY),
    "obj",
    || seeds(MeshFormat::Obj),
    read_obj,
    &["scenes/src/read/obj/mod.rs", "scenes/src/read/obj/statement.rs", "scenes/src/read/obj/lost.rs"],
);

/// Libraries of materials, read from an OBJ file that uses some of their names.
pub const MTL: Surface = Surface::text(
    (LONGEST, MEMORY),
    "mtl",
    mtl_seeds,
    read_mtl,
    &["scenes/src/read/obj/material.rs", "scenes/src/read/obj/library.rs"],
);

/// Descriptions of scenes.
pub const DSC: Surface = Surface::text((LONGEST, MEMORY), "dsc", dsc_seeds, read_dsc, &["scenes/src/read/dsc"]);

/// Small scenes with materials of all kinds.
fn small_scenes() -> Vec<Scene> {
    let least = |name: &str, level, triangles| {
        let options = GenerateOptions { level, triangles, ..GenerateOptions::default() };
        scene(name, &options).expect("the scene has such a size")
    };
    vec![
        least("triangle", None, None),
        least("terrain", None, Some(4)),
        least("slabs", Some(1), None),
        least("mirrors", Some(0), None),
    ]
}

/// Texts of the readers' own tests, of which the reader keeps those that are its own.
fn tests() -> Vec<Vec<u8>> {
    let sources =
        ["read_files", "read_mesh_damage", "read_mesh_variants", "read_meshes", "read_variants", "read_round_trip"];
    sources
        .iter()
        .flat_map(|name| literals(&format!("scenes/tests/scenes/{name}.rs")))
        .chain(literals("tests/faults.rs"))
        .collect()
}

fn seeds(format: MeshFormat) -> Vec<Vec<u8>> {
    let written = small_scenes().into_iter().flat_map(|scene| {
        let files = write::mesh(&scene, format, "a").expect("a generated scene can be written");
        files.into_iter().map(|(_, octets)| octets).collect::<Vec<_>>()
    });
    pieces(written.chain(tests()).collect(), LONGEST)
}

fn mtl_seeds() -> Vec<Vec<u8>> {
    seeds(MeshFormat::Obj)
        .into_iter()
        .filter(|text| text.windows(6).any(|window| window == b"newmtl"))
        .chain(tests())
        .collect()
}

fn dsc_seeds() -> Vec<Vec<u8>> {
    let written = small_scenes().into_iter().map(|scene| {
        let mut octets = Vec::new();
        write::dsc(&scene, &mut octets).expect("a generated scene can be written");
        octets
    });
    pieces(written.chain(tests()).collect(), LONGEST)
}

/// Marks a mesh, of which everything must refer to something.
fn mark(result: Result<Mesh, Report>, input: &[u8], seen: &mut Seen) -> Option<Mesh> {
    match result {
        Err(report) => {
            assert!(report.has_errors(), "a mesh is refused for a reason");
            seen.report(&report, input);
            None
        }
        Ok(mesh) => {
            seen.report(&mesh.warnings, input);
            let vertices = mesh.vertices.len() as u32;
            assert!(mesh.triangles.iter().flatten().all(|&vertex| vertex < vertices), "triangles have vertices");
            assert!(mesh.vertices.iter().flatten().all(|x| x.is_finite()), "vertices are finite");
            let materials = mesh.materials.len() as u32;
            assert!(mesh.surfaces.iter().all(|&material| material < materials), "surfaces have materials");
            assert!(mesh.surfaces.is_empty() || mesh.surfaces.len() == mesh.triangles.len(), "a surface a triangle");
            seen.count("vertices", mesh.vertices.len());
            seen.count("triangles", mesh.triangles.len());
            seen.count("materials", mesh.materials.len());
            Some(mesh)
        }
    }
}

fn read_off(input: &[u8], seen: &mut Seen) {
    let Some(mesh) = mark(off::parse(input, "a.off"), input, seen) else { return };
    seen.plant(PlantedFault::Panic, mesh.vertices.len() > 4 && mesh.triangles.len() == 3);
}

fn read_stl(input: &[u8], seen: &mut Seen) {
    let Some(mesh) = mark(stl::parse(input, "a.stl"), input, seen) else { return };
    seen.plant(PlantedFault::Abort, mesh.triangles.len() == 3 && mesh.vertices.len() == 4);
}

fn read_ply(input: &[u8], seen: &mut Seen) {
    let Some(mesh) = mark(ply::parse(input, "a.ply"), input, seen) else { return };
    seen.plant(PlantedFault::Large, mesh.triangles.len() == 1 && !mesh.warnings.0.is_empty());
}

fn read_obj(input: &[u8], seen: &mut Seen) {
    let mut opened = 0;
    let mut open = |name: &str| {
        opened += 1;
        Ok((name.to_owned(), b"newmtl red\nKd 1 0 0\nnewmtl glass\nd 0.3\nNi 1.5\n".to_vec()))
    };
    if mark(obj::parse(input, "a.obj", Some(&mut open)), input, seen).is_some() {
        seen.plant(PlantedFault::Panic, opened == 2);
    }
}

fn read_mtl(input: &[u8], seen: &mut Seen) {
    const USER: &[u8] = b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\nusemtl material_0\nf 2 3 1\nusemtl material_1\nf 3 2 1\nusemtl material_6\nf 3 1 2\nusemtl material_7\nf 1 3 2\nusemtl red brick\nf 3 1 2\n";
    let mut open = |name: &str| Ok((name.to_owned(), input.to_vec()));
    let Some(mesh) = mark(obj::parse(USER, "a.obj", Some(&mut open)), input, seen) else { return };
    seen.plant(PlantedFault::Endless, mesh.materials.iter().any(|material| material.index > 2.0));
}

fn read_dsc(input: &[u8], seen: &mut Seen) {
    let Some(source) = super::source("a.dsc", input) else { return };
    match dsc::parse(&source) {
        Err(report) => seen.report(&report, input),
        Ok(description) => {
            seen.report(&description.warnings, input);
            seen.count("materials", description.materials.len());
            seen.count("lights", description.lights.len());
            seen.count("surfaces", description.surfaces.len());
            seen.plant(PlantedFault::Panic, description.lights.len() == 3);
        }
    }
}
