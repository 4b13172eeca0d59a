//! What is written reads back as the same scene, bit for bit.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use scenes::generate::{self, Options};
use scenes::model::{Light, Material, Scene, Triangle};
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

/// Every number of a scene as bits: 0 and -0 differ.
fn bits(scene: &Scene) -> Vec<u64> {
    let materials = scene.materials.iter().flat_map(|m| {
        let [r, g, b] = m.colour;
        [r, g, b, m.reflection, m.intensity, m.index]
    });
    let lights = scene.lights.iter().flat_map(|light| light.position.into_iter().chain(light.colour));
    materials.chain(lights).chain(scene.vertices.iter().flatten().copied()).map(f64::to_bits).collect()
}

#[test]
fn every_generated_scene_comes_back() {
    let folder = tempfile::tempdir().unwrap();
    for generator in generate::SCENES {
        let scene = generate::scene(generator.name, &Options::default()).unwrap();
        let back = there_and_back(folder.path(), &scene);
        // Compared in parts: a difference in one of 30,000 vertices should not print them all.
        assert_eq!((&back.name, back.size), (&scene.name, scene.size));
        assert_eq!(back.materials, scene.materials);
        assert_eq!(back.lights, scene.lights);
        assert!(bits(&back) == bits(&scene), "numbers of {}", scene.name);
        assert!(back.triangles == scene.triangles, "triangles of {}", scene.name);
    }
}

fn share() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), Just(1.0), 0.0..=1.0, 0.0..1e-300]
}

fn scenes() -> impl Strategy<Value = Scene> {
    let any_finite =
        prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO | prop::num::f64::NEGATIVE;
    let place = prop::array::uniform3(any_finite);
    let colour = || prop::array::uniform3(share());
    let material = (colour(), share(), share(), prop_oneof![Just(0.0), 0.0..5.0])
        .prop_map(|(colour, reflection, intensity, index)| Material { colour, reflection, intensity, index });
    let light = (place, colour()).prop_map(|(position, colour)| Light { position, colour });
    let parts = (
        prop::collection::vec(material, 1..6),
        prop::collection::vec(light, 0..4),
        prop::collection::vec(place, 1..10),
        (1..=65_535_u32, 1..=65_535_u32),
    );
    parts.prop_flat_map(|(materials, lights, vertices, size)| {
        let triangle = (prop::array::uniform3(0..vertices.len() as u32), 0..materials.len() as u32);
        prop::collection::vec(triangle, 0..10).prop_map(move |triangles| Scene {
            name: "any".to_string(),
            size,
            materials: materials.clone(),
            lights: lights.clone(),
            vertices: vertices.clone(),
            triangles: triangles.into_iter().map(|(vertices, material)| Triangle { vertices, material }).collect(),
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, rng_seed: RngSeed::Fixed(4), ..ProptestConfig::default() })]

    #[test]
    fn any_scene_comes_back(scene in scenes()) {
        let folder = tempfile::tempdir().unwrap();
        let back = there_and_back(folder.path(), &scene);
        prop_assert_eq!(&back, &scene);
        prop_assert_eq!(bits(&back), bits(&scene));
    }
}

#[test]
fn what_could_not_be_read_is_not_written() {
    let scene = generate::scene("triangle", &Options::default()).unwrap();
    let mut infinite = scene.clone();
    infinite.vertices[1][2] = f64::INFINITY;
    let error = write::off(&infinite, &mut Vec::new()).unwrap_err();
    assert_eq!(error.to_string(), "inf cannot be written: not a finite number");
    let mut bright = scene.clone();
    bright.lights[0].colour[1] = 1.5;
    let error = write::dsc(&bright, &mut Vec::new()).unwrap_err();
    assert_eq!(error.to_string(), "the colour component 1.5 is above 1");
}

/// Measured: 0.07 s of processor time; a busy machine may take several times that.
#[test]
fn a_mesh_of_88_000_triangles_is_read_within_a_second() {
    let options = Options { triangles: Some(88_000), ..Options::default() };
    let scene = generate::scene("terrain", &options).unwrap();
    let mut mesh = Vec::new();
    write::off(&scene, &mut mesh).unwrap();
    let start = Instant::now();
    let read = read::off::parse(&mesh, "terrain.off").unwrap();
    let taken = start.elapsed();
    assert_eq!(read.triangles.len(), 88_000);
    assert!(taken < Duration::from_secs(1), "{taken:?}");
}
