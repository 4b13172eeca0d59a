//! Scenes that are written read back as the same ones, bit for bit.

use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use scenes::generate::{self, GenerateOptions};
use scenes::model::{Light, Material, Scene, Triangle};
use scenes::read::Loaded;
use scenes::write::MeshFormat;
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
        let scene = generate::scene(generator.name, &GenerateOptions::default()).unwrap();
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
    let scene = generate::scene("triangle", &GenerateOptions::default()).unwrap();
    let mut infinite = scene.clone();
    infinite.vertices[1][2] = f64::INFINITY;
    let error = write::off(&infinite, &mut Vec::new()).unwrap_err();
    assert_eq!(error.to_string(), "inf cannot be written: not a finite number");
    let mut bright = scene.clone();
    bright.lights[0].colour[1] = 1.5;
    let error = write::stl(&infinite, &mut Vec::new()).unwrap_err();
    assert_eq!(error.to_string(), "inf cannot be written: not a finite number in single precision");
    for format in MeshFormat::ALL {
        assert!(write::mesh(&infinite, format, "mesh").is_err(), "{format}");
    }
    let error = write::dsc(&bright, &mut Vec::new()).unwrap_err();
    assert_eq!(error.to_string(), "the colour component 1.5 is above 1");
}

/// Writes the mesh of a scene in a format, and reads it alone and with a description.
fn mesh_there_and_back(folder: &Path, scene: &Scene, format: MeshFormat) -> (Loaded, Loaded) {
    for (name, octets) in write::mesh(scene, format, "mesh").unwrap() {
        fs::write(folder.join(name), octets).unwrap();
    }
    let mut description = Vec::new();
    write::dsc(scene, &mut description).unwrap();
    let path = folder.join("scene.dsc");
    fs::write(&path, description).unwrap();
    let mesh = folder.join(format!("mesh.{format}"));
    let read = |path, mesh| read::load(path, mesh).unwrap_or_else(|report| panic!("{format}: {report}"));
    (read(&mesh, None), read(&path, Some(&mesh)))
}

/// Positions of the corners of all triangles, through `f`.
fn corners(scene: &Scene, f: fn(f64) -> f64) -> Vec<[[u64; 3]; 3]> {
    let place = |n: u32| scene.vertices[n as usize].map(|x| (f(x) + 0.0).to_bits());
    scene.triangles.iter().map(|triangle| triangle.vertices.map(place)).collect()
}

/// Effect of a material on light without ambient light: colour times kd, ks, kt and the index where it shows.
fn effect(material: &Material) -> [f64; 6] {
    let kt = material.transmission();
    let [red, green, blue] = material.colour.map(|c| c * material.intensity);
    [red, green, blue, material.reflection, kt, if kt > 0.0 { material.index } else { 0.0 }]
}

#[test]
fn every_generated_scene_comes_back_in_every_format() {
    let folder = tempfile::tempdir().unwrap();
    for generator in generate::SCENES {
        let options =
            GenerateOptions { triangles: generator.triangles.as_ref().map(|_| 500), ..GenerateOptions::default() };
        let scene = generate::scene(generator.name, &options).unwrap();
        for format in MeshFormat::ALL {
            let (alone, described) = mesh_there_and_back(folder.path(), &scene, format);
            let (alone, described) = (alone.scene, described.scene);
            let what = format!("{} as {format}", scene.name);
            // With a description STL loses precision and which corners are shared, the other formats nothing.
            if format == MeshFormat::Stl {
                let single = |x: f64| f64::from(x as f32);
                assert!(corners(&described, |x| x) == corners(&scene, single), "{what}");
                let materials = |scene: &Scene| scene.triangles.iter().map(|t| t.material).collect::<Vec<_>>();
                assert!(materials(&described) == materials(&scene), "{what}");
            } else {
                assert!(described.vertices == scene.vertices && described.triangles == scene.triangles, "{what}");
            }
            assert!(corners(&alone, |x| x) == corners(&described, |x| x), "{what}");
            // Alone, a mesh has what its format keeps of materials: nothing, colours, colours in octets, or all that has an effect.
            for (own, wanted) in alone.triangles.iter().zip(&scene.triangles) {
                let (own, wanted) =
                    (&alone.materials[own.material as usize], &scene.materials[wanted.material as usize]);
                match format {
                    MeshFormat::Stl => assert_eq!(own.colour, [0.8; 3]),
                    MeshFormat::Off => assert_eq!(own.colour, wanted.colour),
                    MeshFormat::Ply => assert_eq!(own.colour, wanted.colour.map(|c| (c * 255.0).round() / 255.0)),
                    MeshFormat::Obj => {
                        let close = effect(own).iter().zip(effect(wanted)).all(|(a, b)| (a - b).abs() < 1e-12);
                        assert!(close, "{what}: {own:?} {wanted:?}");
                    }
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 120, rng_seed: RngSeed::Fixed(5), ..ProptestConfig::default() })]

    #[test]
    fn any_mesh_comes_back(scene in scenes(), format in prop::sample::select(MeshFormat::ALL.to_vec())) {
        let folder = tempfile::tempdir().unwrap();
        let mut scene = scene;
        if format == MeshFormat::Stl {
            // Single precision has fewer magnitudes.
            scene.vertices.iter_mut().flatten().for_each(|x| *x = x.clamp(-3e38, 3e38));
        }
        let (alone, described) = mesh_there_and_back(folder.path(), &scene, format);
        if format != MeshFormat::Stl {
            prop_assert_eq!(&described.scene.triangles, &scene.triangles);
            prop_assert_eq!(bits(&described.scene), bits(&scene));
        }
        let single: fn(f64) -> f64 = if format == MeshFormat::Stl { |x| f64::from(x as f32) } else { |x| x };
        prop_assert_eq!(corners(&alone.scene, |x| x), corners(&scene, single));
        prop_assert!(!alone.scene.check().has_errors());
        // What has been through a format once goes through it again as it is.
        let lost = write::losses(&alone, format);
        prop_assert!(lost.0.is_empty(), "{}", lost);
        let (again, _) = mesh_there_and_back(folder.path(), &alone.scene, format);
        prop_assert_eq!((again.scene.size, &again.scene.lights), (alone.scene.size, &alone.scene.lights));
        let effects = |scene: &Scene| -> Vec<[f64; 6]> {
            scene.triangles.iter().map(|t| effect(&scene.materials[t.material as usize])).collect()
        };
        for (one, other) in effects(&again.scene).iter().zip(effects(&alone.scene)) {
            prop_assert!(one.iter().zip(other).all(|(a, b)| (a - b).abs() < 1e-12), "{:?} {:?}", one, other);
        }
    }
}

#[test]
fn what_a_format_does_not_hold_is_said() {
    let mut text = String::new();
    for name in ["cornell", "triangle", "empty"] {
        let scene = Loaded::from(generate::scene(name, &GenerateOptions::default()).unwrap());
        for format in MeshFormat::ALL {
            writeln!(text, "{name}\n{}", write::losses(&scene, format)).unwrap();
            writeln!(text, "beside a .dsc: {}\n", write::losses_beside_description(&scene, format)).unwrap();
        }
    }
    insta::assert_snapshot!(text);
}

#[test]
fn formats_have_names() {
    for format in MeshFormat::ALL {
        assert_eq!(format.name().to_uppercase().parse(), Ok(format));
    }
    assert!("plly".parse::<MeshFormat>().unwrap_err().to_string().contains("did you mean `ply`?"));
}

/// The least of up to five times: others use the machine too.
fn least_time(work: impl Fn()) -> Duration {
    let time = || {
        let start = Instant::now();
        work();
        start.elapsed()
    };
    let mut least = time();
    for _ in 0..4 {
        if least > Duration::from_millis(500) {
            least = least.min(time());
        }
    }
    least
}

/// Measured: 0.07 s of processor time; a busy machine may take several times that.
#[test]
fn a_mesh_of_88_000_triangles_is_read_within_a_second() {
    let options = GenerateOptions { triangles: Some(88_000), ..GenerateOptions::default() };
    let scene = generate::scene("terrain", &options).unwrap();
    let mut mesh = Vec::new();
    write::off(&scene, &mut mesh).unwrap();
    let taken = least_time(|| assert_eq!(read::off::parse(&mesh, "terrain.off").unwrap().triangles.len(), 88_000));
    assert!(taken < Duration::from_secs(1), "{taken:?}");
}

/// Measured: 0.03 to 0.05 s. STL as text takes 0.45 s, since its library copies every word; the limit
/// for that one only shows whether the time is out of proportion.
#[test]
fn meshes_of_88_000_triangles_are_read_in_time_in_every_format() {
    let options = GenerateOptions { triangles: Some(88_000), ..GenerateOptions::default() };
    let scene = generate::scene("terrain", &options).unwrap();
    let mut files: Vec<(String, Vec<u8>)> =
        MeshFormat::ALL.iter().map(|&format| write::mesh(&scene, format, "mesh").unwrap().pop().unwrap()).collect();
    files.push(("text.stl".to_string(), stl_text(&scene)));
    for (name, octets) in files {
        let read = || match name.rsplit('.').next().unwrap() {
            "off" => read::off::parse(&octets, &name),
            "obj" => read::obj::parse(&octets, &name, None),
            "ply" => read::ply::parse(&octets, &name),
            _ => read::stl::parse(&octets, &name),
        };
        let taken = least_time(|| assert_eq!(read().unwrap().triangles.len(), 88_000));
        let limit = Duration::from_secs(if name == "text.stl" { 5 } else { 1 });
        assert!(taken < limit, "{name} {taken:?}");
    }
}

/// The text form of STL, which is not written otherwise.
fn stl_text(scene: &Scene) -> Vec<u8> {
    let mut text = "solid text\n".to_string();
    for triangle in &scene.triangles {
        text.push_str("facet normal 0 0 0\nouter loop\n");
        for vertex in triangle.vertices {
            let [x, y, z] = scene.vertices[vertex as usize];
            writeln!(text, "vertex {x} {y} {z}").unwrap();
        }
        text.push_str("endloop\nendfacet\n");
    }
    text.push_str("endsolid text\n");
    text.into_bytes()
}
