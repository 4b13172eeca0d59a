//! Small OBJ, STL and PLY files of every kind, each read or refused: `files/` holds them, the snapshots say what comes
//! of them.

use std::fs;

use messages::{Diagnostic, Report};
use scenes::read::{mesh::Mesh, obj, ply, stl};

use super::shown::{all_read, all_refused, folder};

/// Reads an OBJ file with the libraries beside it.
fn parse_obj(from: &str, name: &str, bytes: &[u8]) -> Result<Mesh, Report> {
    let folder = folder(from);
    let mut open = |library: &str| {
        let octets = fs::read(folder.join(library)).map_err(|_| Diagnostic::error(format!("there is no {library}")))?;
        Ok((library.to_string(), octets))
    };
    obj::parse(bytes, name, Some(&mut open))
}

#[test]
fn every_kind_of_obj_is_read() {
    insta::assert_snapshot!(all_read("obj_good", "obj", |name, bytes| parse_obj("obj_good", name, bytes)));
}

#[test]
fn every_broken_obj_is_refused() {
    insta::assert_snapshot!(all_refused("obj_bad", "obj", |name, bytes| parse_obj("obj_bad", name, bytes)));
}

#[test]
fn a_description_needs_no_material_library() {
    let bytes = fs::read(folder("obj_good").join("library_missing.obj")).unwrap();
    let mesh = obj::parse(&bytes, "f.obj", None).unwrap();
    assert_eq!((mesh.triangles.len(), mesh.materials.len(), mesh.warnings), (4, 0, Report::default()));
}

#[test]
fn every_kind_of_stl_is_read() {
    insta::assert_snapshot!(all_read("stl_good", "stl", |name, bytes| stl::parse(bytes, name)));
}

#[test]
fn every_broken_stl_is_refused() {
    insta::assert_snapshot!(all_refused("stl_bad", "stl", |name, bytes| stl::parse(bytes, name)));
}

#[test]
fn every_kind_of_ply_is_read() {
    insta::assert_snapshot!(all_read("ply_good", "ply", |name, bytes| ply::parse(bytes, name)));
}

#[test]
fn every_broken_ply_is_refused() {
    insta::assert_snapshot!(all_refused("ply_bad", "ply", |name, bytes| ply::parse(bytes, name)));
}
