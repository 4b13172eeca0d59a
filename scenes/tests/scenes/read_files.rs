//! Small files of every kind, each read or refused: `files/` holds them, the snapshots say what comes of them.

use std::fmt::Write;

use messages::{Report, Source};
use scenes::read::{self, dsc, off};

use super::shown::{all_read, all_refused, files, folder};

#[test]
fn every_variant_of_off_is_read() {
    insta::assert_snapshot!(all_read("off_good", "off", |name, bytes| off::parse(bytes, name)));
}

#[test]
fn every_broken_off_is_refused() {
    insta::assert_snapshot!(all_refused("off_bad", "off", |name, bytes| off::parse(bytes, name)));
}

fn parse_dsc(name: &str, bytes: &[u8]) -> Result<dsc::Description, Report> {
    dsc::parse(&Source::new(name, String::from_utf8_lossy(bytes)))
}

#[test]
fn every_variant_of_dsc_is_read() {
    let mut text = String::new();
    for (name, bytes) in files("dsc_good", "dsc") {
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
    for (name, bytes) in files("dsc_bad", "dsc") {
        let report = parse_dsc(&name, &bytes).map(|read| panic!("{name} was read: {read:?}")).unwrap_err();
        assert!(report.has_errors(), "{name}");
        writeln!(text, "{report}\n\n").unwrap();
    }
    insta::assert_snapshot!(text);
}

/// The messages of loading, without the folder's path.
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
        // A description and its mesh, found beside it or given
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
        // Names that lead to nothing, with and without one that is like them
        ("alone.dsc", None),
        ("alone.dsc", Some("godo.off")),
        ("goood.dsc", None),
        ("good", None),
        ("nothing_like_it.dsc", None),
        ("good.dsc/inside.dsc", None),
        (".", None),
        // Files in each other's place, or of no known kind
        ("good.off", Some("good.off")),
        ("good.dsc", Some("good.dsc")),
        ("unknown.txt", None),
        // Meshes of the other formats, with a description and alone, known by their contents where no ending names them
        ("with_obj.dsc", None),
        ("with_ply.dsc", None),
        ("with_stl.dsc", None),
        ("with_stl.stl", None),
        ("with_ply.dsc", Some("with_obj.obj")),
        ("stl_counts_differ.dsc", None),
        ("ply_counts_differ.dsc", None),
        ("binary_mesh", None),
        ("ply_mesh", None),
        ("obj_mesh", None),
        ("solid.obj", None),
        ("with_obj.obj", None),
    ] {
        writeln!(text, "{path} {}\n{}\n", mesh.unwrap_or_default(), said(path, mesh)).unwrap();
    }
    insta::assert_snapshot!(text);
}
