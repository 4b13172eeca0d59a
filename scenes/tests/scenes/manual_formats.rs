//! The examples in `docs/formats.md` are read as that page says.

use std::fs;
use std::path::Path;

use messages::{Report, Source};
use scenes::read::{dsc, obj, off, ply, stl};

/// The example of a format.
fn example(language: &str) -> String {
    let manual = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/formats.md")).unwrap();
    let start = manual.find(&format!("```{language}\n")).unwrap_or_else(|| panic!("no example of {language}"));
    let text = &manual[start + language.len() + 4..];
    text[..text.find("```").unwrap()].to_string()
}

#[test]
fn the_description_is_one_of_the_meshes() {
    let description = dsc::parse(&Source::new("example.dsc", example("dsc"))).unwrap();
    assert_eq!((description.size, description.surfaces.as_slice()), ((320, 240), [0, 0, 0, 1].as_slice()));
    assert_eq!(description.warnings, Report::default());
    assert!(description.materials[1].transmission() > 0.79);
}

#[test]
fn all_meshes_are_the_same_tetrahedron() {
    let off = off::parse(example("off").as_bytes(), "example.off").unwrap();
    let mut library = |name: &str| Ok((name.to_string(), example("mtl").into_bytes()));
    let obj = obj::parse(example("obj").as_bytes(), "example.obj", Some(&mut library)).unwrap();
    let ply = ply::parse(example("ply").as_bytes(), "example.ply").unwrap();
    for mesh in [&off, &obj, &ply] {
        assert_eq!((&mesh.vertices, &mesh.triangles), (&off.vertices, &off.triangles));
        assert_eq!(mesh.warnings, Report::default());
    }
    assert_eq!((off.materials.len(), obj.materials.len(), ply.materials.len()), (4, 2, 2));
    let glass = obj.materials[1];
    assert_eq!((glass.colour, glass.intensity, glass.transmission(), glass.index), ([0.5, 0.5, 1.0], 0.25, 0.75, 1.5));
}

#[test]
fn the_facet_is_a_triangle() {
    let stl = stl::parse(example("stl").as_bytes(), "example.stl").unwrap();
    assert_eq!((stl.triangles, stl.warnings), (vec![[0, 1, 2]], Report::default()));
}
