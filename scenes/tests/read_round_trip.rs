//! What is written reads back as the same scene, bit for bit.

use std::fs;
use std::path::Path;

use scenes::generate::{self, Options};
use scenes::model::Scene;
use scenes::{read, write};

/// Writes a scene under `folder` and reads it again.
fn there_and_back(folder: &Path, scene: &Scene) -> Scene {
    let mut description = Vec::new();
    write::dsc(scene, &mut description).unwrap();
    let mut mesh = Vec::new();
    write::off(scene, &mut mesh).unwrap();
    let path = folder.join(format!("{}.dsc", scene.name));
    fs::write(&path, description).unwrap();
    fs::write(path.with_extension("off"), mesh).unwrap();
    let loaded = read::load(&path, None).unwrap_or_else(|report| panic!("{}: {report}", scene.name));
    loaded.scene
}

#[test]
fn every_generated_scene_comes_back() {
    let folder = tempfile::tempdir().unwrap();
    for generator in generate::SCENES {
        let scene = generate::scene(generator.name, &Options::default()).unwrap();
        let back = there_and_back(folder.path(), &scene);
        // Compared in parts: a difference in one of 30,000 vertices should not print them all.
        assert_eq!(back.name, scene.name);
        assert_eq!(back.size, scene.size);
        assert_eq!(back.materials, scene.materials);
        assert_eq!(back.lights, scene.lights);
        let bits = |scene: &Scene| scene.vertices.iter().flatten().map(|x| x.to_bits()).collect::<Vec<u64>>();
        assert!(bits(&back) == bits(&scene), "vertices of {}", scene.name);
        assert!(back.triangles == scene.triangles, "triangles of {}", scene.name);
    }
}
