//! The small files of `files/`, and what is read of them in a few lines.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use messages::Report;
use scenes::read::mesh::Mesh;

/// One of the folders in `files/`.
pub fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files").join(name)
}

/// The files of a folder that have the extension, by name, in order.
pub fn files(name: &str, extension: &str) -> Vec<(String, Vec<u8>)> {
    let mut files: Vec<(String, Vec<u8>)> = fs::read_dir(folder(name))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|found| found == extension))
        .map(|path| (path.file_name().unwrap().to_str().unwrap().to_string(), fs::read(&path).unwrap()))
        .collect();
    files.sort();
    files
}

const TETRAHEDRON: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const SIDES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

/// A mesh in a few lines.
pub fn shown(mesh: &Mesh) -> String {
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
        let (ks, kd, index) = (material.reflection, material.intensity, material.index);
        let rest =
            if (ks, kd, index) == (0.0, 0.9, 0.0) { String::new() } else { format!(" ks {ks} kd {kd} index {index}") };
        writeln!(text, "  colour {:?}{rest} of triangles {of:?}", material.colour).unwrap();
    }
    for line in mesh.warnings.to_string().lines() {
        writeln!(text, "  {line}").unwrap();
    }
    text
}

/// The scenes that each good file of a folder is read as.
pub fn all_read(name: &str, extension: &str, parse: impl Fn(&str, &[u8]) -> Result<Mesh, Report>) -> String {
    let mut text = String::new();
    for (name, bytes) in files(name, extension) {
        let mesh = parse(&name, &bytes).unwrap_or_else(|report| panic!("{name}: {report}"));
        writeln!(text, "{name}\n{}", shown(&mesh)).unwrap();
    }
    text
}

/// The messages about each bad file of a folder.
pub fn all_refused(name: &str, extension: &str, parse: impl Fn(&str, &[u8]) -> Result<Mesh, Report>) -> String {
    let mut text = String::new();
    for (name, bytes) in files(name, extension) {
        let report = parse(&name, &bytes).map(|mesh| panic!("{name} was read: {mesh:?}")).unwrap_err();
        assert!(report.has_errors(), "{name}");
        writeln!(text, "{report}\n\n").unwrap();
    }
    text
}
