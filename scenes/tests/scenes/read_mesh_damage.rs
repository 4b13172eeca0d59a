//! Damaged OBJ, MTL, STL and PLY files are refused and never worse.

use std::fs;
use std::path::Path;

use messages::Report;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use scenes::read::mesh::Mesh;
use scenes::read::{obj, ply, stl};

/// Every small file of the tests with this extension.
fn seeds(extension: &str) -> Vec<Vec<u8>> {
    let files = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files");
    let folder = if extension == "mtl" { "obj" } else { extension };
    let folders = ["good", "bad"].map(|kind| files.join(format!("{folder}_{kind}")));
    let entries = folders.iter().flat_map(|folder| fs::read_dir(folder).unwrap());
    let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|found| found == extension));
    paths.sort();
    paths.iter().map(|path| fs::read(path).unwrap()).collect()
}

/// Reads octets as `extension` says.
fn parse(extension: &str, bytes: &[u8]) -> Result<Mesh, Report> {
    match extension {
        "obj" => obj::parse(bytes, "f.obj", None),
        "stl" => stl::parse(bytes, "f.stl"),
        "ply" => ply::parse(bytes, "f.ply"),
        _ => {
            let mesh = "mtllib f.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\nusemtl a\nf 1 2 3\n";
            let mut library = |name: &str| Ok((name.to_string(), bytes.to_vec()));
            obj::parse(mesh.as_bytes(), "f.obj", Some(&mut library))
        }
    }
}

/// Input that is read must hold together, input that is refused must have a message.
fn survives(extension: &str, bytes: &[u8]) {
    match parse(extension, bytes) {
        Ok(mesh) => {
            assert!(mesh.vertices.iter().flatten().all(|x| x.is_finite()));
            assert!(mesh.triangles.iter().flatten().all(|&n| (n as usize) < mesh.vertices.len()));
            assert!(mesh.surfaces.is_empty() || mesh.surfaces.len() == mesh.triangles.len());
            assert!(mesh.surfaces.iter().all(|&n| (n as usize) < mesh.materials.len()));
            let shares = mesh.materials.iter().flat_map(|m| {
                let [red, green, blue] = m.colour;
                [red, green, blue, m.reflection, m.intensity]
            });
            assert!(shares.into_iter().all(|share| (0.0..=1.0).contains(&share)), "{:?}", mesh.materials);
            assert!(!mesh.warnings.has_errors());
            assert!(extension == "mtl" || mesh.triangles.len() <= bytes.len());
        }
        Err(report) => {
            assert!(report.has_errors());
            assert!(report.to_string().contains("error"));
        }
    }
}

const EXTENSIONS: [&str; 4] = ["obj", "mtl", "stl", "ply"];

#[test]
fn no_beginning_of_a_file_is_fatal() {
    for extension in EXTENSIONS {
        for bytes in seeds(extension) {
            (0..=bytes.len()).for_each(|end| survives(extension, &bytes[..end]));
        }
    }
}

fn any_seed() -> impl Strategy<Value = (&'static str, Vec<u8>)> {
    let all: Vec<_> = EXTENSIONS.iter().flat_map(|&e| seeds(e).into_iter().map(move |bytes| (e, bytes))).collect();
    prop::sample::select(all)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, rng_seed: RngSeed::Fixed(12), ..ProptestConfig::default() })]

    #[test]
    fn no_damage_to_a_file_is_fatal(
        (extension, seed) in any_seed(),
        edits in prop::collection::vec((any::<prop::sample::Index>(), 0..4_u8, any::<u8>()), 1..8),
    ) {
        let mut bytes = seed;
        let likely = b"0123456789.-+eE \n\r\t#/\\vfnanKsdillum,";
        for (index, edit, octet) in edits {
            let at = index.index(bytes.len() + 1);
            match edit {
                0 => bytes.insert(at, octet),
                1 => bytes.insert(at, likely[octet as usize % likely.len()]),
                2 if at < bytes.len() => { bytes.remove(at); }
                3 if at < bytes.len() => bytes[at] = likely[octet as usize % likely.len()],
                _ => bytes.truncate(at),
            }
        }
        survives(extension, &bytes);
    }

    #[test]
    fn no_octets_are_fatal(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        for extension in EXTENSIONS {
            survives(extension, &bytes);
        }
        let mut behind = b"ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty char x\nproperty char y\n\
            property char z\nelement face 9\nproperty list short char vertex_index\nend_header\n".to_vec();
        behind.extend(&bytes);
        survives("ply", &behind);
        let mut behind = vec![b' '; 80];
        behind.extend((bytes.len() as u32 / 50).to_le_bytes());
        behind.extend(&bytes);
        survives("stl", &behind);
    }
}
