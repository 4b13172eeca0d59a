//! Hashes by which people compare pictures and runs.

use serde::Serialize;
use sha2::{Digest, Sha256};

use super::regions::without_clocks;
use super::{BusResult, ByClass, Main, ProcessorResult, RegionCounts, Render, hexadecimal};

/// Pixels that are hashed at once.
const AT_ONCE: usize = 1024;

/// SHA-256 over width and height (unsigned, 32 bits, little-endian) and the three raw words of each pixel (signed, 32
/// bits, little-endian), row 0 first; in hexadecimal.
pub fn image_hash(size: (u32, u32), words: &[[i32; 3]]) -> String {
    let mut hash = Sha256::new();
    hash.update(size.0.to_le_bytes());
    hash.update(size.1.to_le_bytes());
    // Some pixels at a time, since each update costs more than the few octets of a word.
    let mut octets = Vec::with_capacity(12 * AT_ONCE);
    for pixels in words.chunks(AT_ONCE) {
        octets.clear();
        octets.extend(pixels.as_flattened().iter().flat_map(|word| word.to_le_bytes()));
        hash.update(&octets);
    }
    hexadecimal(&hash.finalize())
}

/// SHA-256 over the JSON, without blanks, of the keys `image_hash`, `instructions`, `counts`, `octets`, `clocks`,
/// `cores`, `functions`, `regions`, `main` and `bus`: picture, counts and clocks, but nothing that depends on how the
/// host computes the reference, and no clocks of functions; in hexadecimal.
pub fn run_hash(result: &Render) -> String {
    #[derive(Serialize)]
    struct Run<'a> {
        image_hash: &'a str,
        instructions: u64,
        counts: ByClass,
        octets: u64,
        clocks: u64,
        cores: Vec<ProcessorResult>,
        functions: Vec<RegionCounts>,
        regions: Vec<RegionCounts>,
        main: Main,
        bus: &'a BusResult,
    }
    // Clocks of functions are there only when they were asked for, and say nothing of another run.
    let core = |core: &ProcessorResult| ProcessorResult { functions: None, regions: None, ..core.clone() };
    // The order of the keys is part of the hash.
    let run = Run {
        image_hash: &result.image_hash,
        instructions: result.instructions,
        counts: result.counts,
        octets: result.octets,
        clocks: result.clocks,
        cores: result.cores.iter().map(core).collect(),
        functions: without_clocks(&result.functions),
        regions: without_clocks(&result.regions),
        main: Main { functions: without_clocks(&result.main.functions), regions: None, ..result.main.clone() },
        bus: &result.bus,
    };
    let text = serde_json::to_vec(&run).expect("results have string keys");
    hexadecimal(&Sha256::digest(text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_of_a_picture_is_that_of_its_octets() {
        // hashlib.sha256(struct.pack("<II6i", 2, 1, 1, 2, 3, -1, 0, 2147483647)) in Python.
        let words = [[1, 2, 3], [-1, 0, i32::MAX]];
        let expected = "881ae5005cdf5531ccc93f0e010fdc0271ce358067d619a2713539a77d1a3c16";
        assert_eq!(image_hash((2, 1), &words), expected);
        assert_ne!(image_hash((1, 2), &words), image_hash((2, 1), &words));
    }
}
