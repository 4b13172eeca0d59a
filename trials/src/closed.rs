//! Rays aimed exactly at what a rounded test decides wrongly: vertices, edges, and the planes that divide the tree.

use std::ops::Range;
use std::sync::LazyLock;

use isa::number::ray::Ray;
use isa::number::{Arithmetic, Modes, Overflow, Quantization, Vector};
use kernels::KernelSet;
use scenes::image::MemoryOptions;
use scenes::layout::Layout;

use crate::mesh::closed;
use crate::series::Random;
use crate::tally::{TrialTally, tally};
use crate::target::{Target, through};

/// Of so many rays one is searched for in all triangles too.
const EVERY: u64 = 16;

static TARGETS: LazyLock<Vec<Target>> =
    LazyLock::new(|| closed().iter().map(|mesh| Target::new(mesh, KernelSet::Ray)).collect());

/// Words in which meshes are packed.
const WORDS: [u32; 4] = [12, 16, 20, 24];

/// The meshes as the layout `packed` stores them, in words of so many bits.
static PACKED: LazyLock<Vec<(u32, Target<Modes>)>> = LazyLock::new(|| {
    let packed = |word: u32| {
        let options = MemoryOptions { word, layout: Layout::Packed, ..MemoryOptions::default() };
        let modes = Modes { word, quantization: Quantization::Rnd, overflow: Overflow::Sat };
        closed().map(|mesh| (word, Target::stored(&mesh, KernelSet::Ray, &options, modes)))
    };
    WORDS.into_iter().flat_map(packed).collect()
});

/// Checks a ray for each trial, the meshes in turn.
fn check(seed: u64, trials: Range<u64>, aim: impl Fn(&Target, &mut Random) -> Ray + Sync) -> TrialTally {
    tally(trials, |trial| {
        let target = &TARGETS[(trial % TARGETS.len() as u64) as usize];
        let ray = aim(target, &mut Random::new(seed, trial));
        target.check_closed(&ray, (trial / TARGETS.len() as u64).is_multiple_of(EVERY)).map(|()| 0.0)
    })
}

/// At vertices, at middles of edges and of triangles; in or across planes of the tree, now and then along an axis.
pub fn closed_meshes(seed: u64, trials: Range<u64>) -> TrialTally {
    check(seed, trials, |target, random| aimed(target, random, start))
}

/// As [`closed_meshes`], at meshes that are packed in short words, whose vertices are moved far by rounding.
pub fn packed_words(seed: u64, trials: Range<u64>) -> TrialTally {
    tally(trials, |trial| {
        let (word, target) = &PACKED[(trial % PACKED.len() as u64) as usize];
        let random = &mut Random::new(seed, trial);
        let ray = aimed(target, random, |random| {
            let reach = [1 << (word - 2), 1 << (word - 3)][random.below(2)];
            random.point(reach)
        });
        target.check_leaks(&ray, (trial / PACKED.len() as u64).is_multiple_of(EVERY)).map(|()| 0.0)
    })
}

/// A ray from a point at a point of the mesh.
fn aimed<T: Arithmetic>(target: &Target<T>, random: &mut Random, start: impl FnOnce(&mut Random) -> Vector) -> Ray {
    let mut towards = point(target, random);
    let mut origin = start(random);
    for k in 0..3 {
        // One coordinate in eight makes the ray run at right angles to an axis, one in eight lies in a plane of the tree.
        match random.below(8) {
            0 => origin[k] = towards[k],
            1 => towards[k] = split(target, random, k).unwrap_or(towards[k]),
            _ => {}
        }
    }
    through(origin, towards)
}

/// In one or two planes that divide the tree, through edges and corners of its boxes.
pub fn split_planes(seed: u64, trials: Range<u64>) -> TrialTally {
    check(seed, trials, |target, random| {
        let mut towards = point(target, random);
        let mut origin = start(random);
        for k in 0..3 {
            let Some(at) = split(target, random, k) else { continue };
            match random.below(3) {
                // In the plane.
                0 => (origin[k], towards[k]) = (at, at),
                // Through it at the point at which the ray meets others.
                1 => towards[k] = at,
                _ => {}
            }
        }
        through(origin, towards)
    })
}

/// Along one axis, or at right angles to one, through vertices.
pub fn zero_directions(seed: u64, trials: Range<u64>) -> TrialTally {
    check(seed, trials, |target, random| {
        let towards = point(target, random);
        let mut origin = start(random);
        let first = random.below(3);
        for k in (0..1 + random.below(2)).map(|more| (first + more) % 3) {
            origin[k] = towards[k];
        }
        through(origin, towards)
    })
}

/// A point of the mesh that a ray can be aimed at exactly.
fn point<T: Arithmetic>(target: &Target<T>, random: &mut Random) -> Vector {
    let [a, b, c] = *target.corners(random.below(target.len()) as u32);
    match random.below(4) {
        // Vertices of the meshes are multiples of four, so these points are exact.
        0 => std::array::from_fn(|k| (a[k] + b[k]) / 2),
        1 => std::array::from_fn(|k| (a[k] + b[k]) / 4 + c[k] / 2),
        _ => a,
    }
}

/// From far away, or from within the mesh's box.
fn start(random: &mut Random) -> Vector {
    let reach = [1 << 30, 1 << 29][random.below(2)];
    random.point(reach)
}

fn split<T: Arithmetic>(target: &Target<T>, random: &mut Random, axis: usize) -> Option<i32> {
    let splits = &target.splits[axis];
    (!splits.is_empty()).then(|| splits[random.below(splits.len())])
}
