//! Small files of every kind, each read or refused: `files/` holds them, the snapshots say what comes of them.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use isa::diagnostic::{Report, Source};
use scenes::read::{self, dsc, mesh::Mesh, off};

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files").join(name)
}

/// The files of a folder by name, in order.
fn files(name: &str) -> Vec<(String, Vec<u8>)> {
    let mut files: Vec<(String, Vec<u8>)> = fs::read_dir(folder(name))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .map(|path| (path.file_name().unwrap().to_str().unwrap().to_string(), fs::read(&path).unwrap()))
        .collect();
    files.sort();
    files
}

const TETRAHEDRON: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const SIDES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

/// A mesh in a few lines.
fn shown(mesh: &Mesh) -> String {
    let mut text = match mesh.vertices.as_slice() {
        vertices if *vertices == TETRAHEDRON => "  the corners of the tetrahedron\n".to_string(),
        vertices => format!("  corners {vertices:?}\n"),
    };
    match mesh.triangles.as_slice() {
        triangles if *triangles == SIDES => text.push_str("  its sides\n"),
        triangles => writeln!(text, "  {} faces: {triangles:?}", mesh.faces).unwrap(),
    }
    for (n, material) in mesh.materials.iter().enumerate() {
        let of: Vec<usize> = (0..mesh.surfaces.len()).filter(|&t| mesh.surfaces[t] as usize == n).collect();
        writeln!(text, "  colour {:?} of triangles {of:?}", material.colour).unwrap();
    }
    for line in mesh.warnings.to_string().lines() {
        writeln!(text, "  {line}").unwrap();
    }
    text
}

#[test]
fn every_variant_of_off_is_read() {
    let mut text = String::new();
    for (name, bytes) in files("off_good") {
        let mesh = off::parse(&bytes, &name).unwrap_or_else(|report| panic!("{name}: {report}"));
        writeln!(text, "{name}\n{}", shown(&mesh)).unwrap();
    }
    insta::assert_snapshot!(text);
}

#[test]
fn every_broken_off_is_refused() {
    let mut text = String::new();
    for (name, bytes) in files("off_bad") {
        let report = off::parse(&bytes, &name).map(|mesh| panic!("{name} was read: {mesh:?}")).unwrap_err();
        assert!(report.has_errors(), "{name}");
        writeln!(text, "{report}\n\n").unwrap();
    }
    insta::assert_snapshot!(text);
}

fn parse_dsc(name: &str, bytes: &[u8]) -> Result<dsc::Description, Report> {
    dsc::parse(&Source::new(name, String::from_utf8_lossy(bytes)))
}

#[test]
fn every_variant_of_dsc_is_read() {
    let mut text = String::new();
    for (name, bytes) in files("dsc_good") {
        let read = parse_dsc(&name, &bytes).unwrap_or_else(|report| panic!("{name}: {report}"));
        writeln!(text, "{name}: {:?}, triangles {:?}", read.size, read.surfaces).unwrap();
        read.materials.iter().for_each(|material| writeln!(text, "  {material:?}").unwrap());
        read.lights.iter().for_each(|light| writeln!(text, "  {light:?}").unwrap());
        writeln!(text, "{}\n", read.warnings).unwrap();
    }
    insta::assert_snapshot!(text);
}

#[test]
fn every_broken_dsc_is_refused() {
    let mut text = String::new();
    for (name, bytes) in files("dsc_bad") {
        let report = parse_dsc(&name, &bytes).map(|read| panic!("{name} was read: {read:?}")).unwrap_err();
        assert!(report.has_errors(), "{name}");
        writeln!(text, "{report}\n\n").unwrap();
    }
    insta::assert_snapshot!(text);
}

/// What loading says, without the folder's path.
fn said(path: &str, mesh: Option<&str>) -> String {
    let folder = folder("pairs");
    let mesh = mesh.map(|mesh| folder.join(mesh));
    let text = match read::load(&folder.join(path), mesh.as_deref()) {
        Ok(loaded) => {
            let scene = loaded.scene;
            format!(
                "`{}`: {:?}, {} materials, lights {:?}, triangles of materials {:?}\n{}",
                scene.name,
                scene.size,
                scene.materials.len(),
                scene.lights,
                scene.triangles.iter().map(|t| t.material).collect::<Vec<u32>>(),
                loaded.warnings,
            )
        }
        Err(report) => report.to_string(),
    };
    text.replace(&format!("{}/", folder.display()), "").replace(&folder.display().to_string(), "FOLDER")
}

#[test]
fn files_are_found_and_belong_together() {
    let mut text = String::new();
    for (path, mesh) in [
        ("good.dsc", None),
        ("good.off", None),
        ("good.dsc", Some("good.off")),
        ("good.dsc", Some("mesh.txt")),
        ("upper.dsc", None),
        ("description", Some("good.off")),
        ("mesh.txt", None),
        ("counts_differ.dsc", None),
        ("faces_counted.dsc", None),
        ("both_wrong.dsc", None),
        ("alone.dsc", None),
        ("alone.dsc", Some("godo.off")),
        ("goood.dsc", None),
        ("good", None),
        ("nothing_like_it.dsc", None),
        ("good.dsc/inside.dsc", None),
        (".", None),
        ("good.off", Some("good.off")),
        ("good.dsc", Some("good.dsc")),
        ("unknown.txt", None),
    ] {
        writeln!(text, "{path} {}\n{}\n", mesh.unwrap_or_default(), said(path, mesh)).unwrap();
    }
    insta::assert_snapshot!(text);
}
