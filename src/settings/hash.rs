//! Hashes of contents: a scene, files, kernels. Names, paths and the order of reading are no part of them.

use std::sync::Arc;

use kernels::{Function, KernelSet, prelude};
use messages::Source;
use scenes::layout::Layout;
use scenes::model::{Light, Material, Scene, Triangle};
use sha2::{Digest, Sha256};

use crate::result::hexadecimal;

/// SHA-256 of texts, each with its length before it, in hexadecimal.
pub fn texts<'a>(texts: impl IntoIterator<Item = &'a str>) -> String {
    parts(texts.into_iter().map(str::as_bytes))
}

/// SHA-256 of octets in parts, each with its length (64 bits, least octet first) before it, in hexadecimal.
pub fn parts<'a>(parts: impl IntoIterator<Item = &'a [u8]>) -> String {
    let mut hash = Sha256::new();
    for part in parts {
        hash.update((part.len() as u64).to_le_bytes());
        hash.update(part);
    }
    hexadecimal(&hash.finalize())
}

/// SHA-256 of a scene as it was read, in hexadecimal: materials, lights, vertices and triangles, each list with its length before it, numbers
/// in double precision (64 bits) or whole (32 bits), least octet first. The name and the size of the picture are no part of it, nor is how
/// the files are written.
pub fn scene(scene: &Scene) -> String {
    let Scene { name: _, size: _, materials, lights, vertices, triangles } = scene;
    let mut hash = Sha256::new();
    let mut octets = Vec::new();
    // Lists are handed over in parts, so that a large scene is not copied as a whole.
    let count = |hash: &mut Sha256, length: usize| hash.update((length as u64).to_le_bytes());
    let mut reals = |hash: &mut Sha256, reals: &mut dyn Iterator<Item = f64>| {
        octets.clear();
        octets.extend(reals.flat_map(f64::to_le_bytes));
        hash.update(&octets);
    };
    count(&mut hash, materials.len());
    for &Material { colour, reflection, intensity, index } in materials {
        reals(&mut hash, &mut colour.into_iter().chain([reflection, intensity, index]));
    }
    count(&mut hash, lights.len());
    for &Light { position, colour } in lights {
        reals(&mut hash, &mut position.into_iter().chain(colour));
    }
    count(&mut hash, vertices.len());
    for part in vertices.chunks(1024) {
        reals(&mut hash, &mut part.iter().flatten().copied());
    }
    count(&mut hash, triangles.len());
    for part in triangles.chunks(1024) {
        let numbers = part.iter().flat_map(|&Triangle { vertices: [a, b, c], material }| [a, b, c, material]);
        hash.update(numbers.flat_map(u32::to_le_bytes).collect::<Vec<u8>>());
    }
    hexadecimal(&hash.finalize())
}

/// SHA-256 of all assembly that a set of kernels may be put together from, files of the user's own in the place of the set's, in hexadecimal.
pub fn kernels(set: KernelSet, layout: Layout, replaced: &[(Function, Arc<Source>)]) -> String {
    let functions: Vec<Function> = replaced.iter().map(|&(function, _)| function).collect();
    let mut sources: Vec<String> = prelude::included(layout).iter().map(|source| source.text.clone()).collect();
    for &function in Function::ALL {
        let own = replaced.iter().rev().find(|(other, _)| *other == function).map(|(_, source)| source.text.clone());
        sources.push(own.or_else(|| Some(set.file(function, &functions)?.1.to_owned())).unwrap_or_default());
    }
    texts(sources.iter().map(String::as_str))
}

#[cfg(test)]
mod tests {
    use scenes::generate::{self, GenerateOptions};

    use super::*;

    #[test]
    fn a_scene_is_known_by_its_contents() {
        let first = generate::scene("cornell", &GenerateOptions::default()).unwrap();
        let named = Scene { name: "other".into(), size: (1, 1), ..first.clone() };
        assert_eq!(scene(&first), scene(&named));
        let mut moved = first.clone();
        moved.vertices[0][1] += 1e-9;
        let mut light = first.clone();
        light.lights[0].colour[2] *= 0.5;
        let mut turned = first.clone();
        turned.triangles[3].vertices.swap(0, 1);
        let mut hashes: Vec<String> = [&first, &moved, &light, &turned].map(scene).to_vec();
        hashes.sort();
        hashes.dedup();
        assert_eq!(hashes.len(), 4);
    }

    #[test]
    fn kernels_are_known_by_their_texts() {
        let mut hashes: Vec<String> = KernelSet::ALL.iter().map(|&set| kernels(set, set.layout(), &[])).collect();
        let own = |text: &str| vec![(Function::ALL[0], Source::new("a.s", text))];
        hashes.push(kernels(KernelSet::default(), Layout::Wide, &own("nop")));
        hashes.push(kernels(KernelSet::default(), Layout::Wide, &own("nop\n")));
        hashes.push(kernels(KernelSet::default(), Layout::Report, &own("nop\n")));
        let before = hashes.len();
        hashes.sort();
        hashes.dedup();
        assert_eq!(hashes.len(), before);
    }
}
