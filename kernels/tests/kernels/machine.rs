//! Perspective pictures as the machine draws them, pixel by pixel as the twins do: rays that enter the scene by one face, by any of three, by none,
//! or start in it.

use std::array::from_fn;

use emu::machine::{Config, RunOptions, Setup};
use emu::octets::Memory;
use isa::Isa;
use isa::number::{Modes, Vector};
use kernels::build::{Crop, KernelOptions, SceneFeatures};
use kernels::skip::Skips;
use kernels::{KernelSet, twin};
use scenes::generate::{self, GenerateOptions};
use scenes::image::{self, MemoryKind, MemoryOptions};
use scenes::layout::PIXEL;
use scenes::model::{Camera, Light, Scene, View};

/// The pixels that the machine draws, and those of the twin.
fn drawn(scene: &Scene, view: &View, set: KernelSet, word: u32, skips: Skips) -> [Vec<Vector>; 2] {
    let mut config = Config::default();
    config.arithmetic.word = word;
    let memory = MemoryOptions { word, layout: set.layout(), ..MemoryOptions::default() };
    let image = image::build(scene, view, &memory).expect("the scene fits the word");
    let options = KernelOptions { profile: set, skips, ..KernelOptions::default() };
    let isa = Isa::base();
    let build = kernels::build(scene, view, &image, &isa, &options).expect("our kernels have no errors");
    let (width, height) = view.size;
    let crop = Crop { column: 0, row: 0, width, height };
    let features = SceneFeatures::new(scene, view, &image.formats, &options);
    let modes = Modes { word, ..Modes::default() };
    let expected = twin::render(&image, &features, &crop, set, modes).expect("no ray is stuck");
    let setup = Setup {
        config: &config,
        isa: &isa,
        core: &build.cores,
        main: &build.main,
        kinds: Vec::new(),
        options: RunOptions::default(),
    };
    let frame = emu::run(&setup, Memory::new(image.bytes.clone()), &mut |_| {}).expect("nothing traps");
    let start = image.region(MemoryKind::Frame).start;
    let word = |at: u32| frame.memory.word(at).expect("the frame is in memory");
    let pixel = |number: u32| from_fn(|k| word(start + number * PIXEL.octets() + 4 * k as u32));
    [(0..width * height).map(pixel).collect(), expected]
}

#[test]
fn perspective_rays_are_those_of_the_twin() {
    let size = (20, 15);
    let options = GenerateOptions { level: Some(1), size, ..GenerateOptions::default() };
    let scene = generate::scene("sphereflake", &options).expect("a scene of the list");
    let (low, high) = scene.bounds().expect("it has triangles");
    let at = |share: [f64; 3]| Some([0, 1, 2].map(|k| low[k] + share[k] * (high[k] - low[k])));
    let eyes = [None, at([3.0, 2.5, 4.0]), at([-20.0, 0.5, 0.4]), at([0.5, 300.0, 900.0]), at([0.45, 0.52, 0.6])];
    for (number, eye) in eyes.into_iter().enumerate() {
        let field = [60.0, 60.0, 3.0, 0.1, 60.0][number];
        let look = if number == 4 { at([0.5, 0.5, 0.0]) } else { None };
        let view = View { camera: Camera::Perspective { eye, look, field }, ..View::new(size) };
        for &set in KernelSet::ALL {
            for (word, skips) in [(32, Skips::ALL), (20, Skips::NONE)] {
                let [found, expected] = drawn(&scene, &view, set, word, skips);
                let wrong = found.iter().zip(&expected).filter(|(found, expected)| found != expected).count();
                assert_eq!(wrong, 0, "{wrong} pixels by {set} in {word} bits from {eye:?}");
                assert!(number == 4 || expected.iter().any(|pixel| pixel != &expected[0]), "{eye:?} sees nothing");
            }
        }
    }
}

#[test]
fn lights_with_steps_of_their_own_are_those_of_the_twin() {
    let size = (20, 15);
    let options = GenerateOptions { level: Some(1), size, ..GenerateOptions::default() };
    let near = generate::scene("sphereflake", &options).expect("a scene of the list");
    let light = near.lights[0];
    // One far light beside near ones, and more lights than the buffer holds.
    for (count, distance) in [(2, 40.0), (2, 1e12), (20, 3e3)] {
        let mut scene = near.clone();
        scene.lights = (0..count)
            .map(|k| {
                let times = if k % 2 == 0 { distance } else { 1.0 };
                let colour = light.colour.map(|x| x / f64::from(count));
                Light { position: light.position.map(|x| x * times * (1.0 + 0.1 * f64::from(k))), colour }
            })
            .collect();
        for &set in KernelSet::ALL {
            for (word, skips) in [(32, Skips::ALL), (20, Skips::NONE)] {
                let [found, expected] = drawn(&scene, &View::new(size), set, word, skips);
                let wrong = found.iter().zip(&expected).filter(|(found, expected)| found != expected).count();
                assert_eq!(wrong, 0, "{wrong} pixels by {set} in {word} bits, {count} lights at {distance}");
            }
        }
    }
}

#[test]
fn a_picture_needs_no_more_stack_than_the_page_says() {
    let page = include_str!("../../../docs/engines.md");
    let (_, rest) = page.split_once("A thread needs ").expect("the page says what a thread needs");
    let kib: usize = rest.split(' ').next().and_then(|number| number.parse().ok()).expect("it is a number");
    let options = GenerateOptions { level: Some(1), size: (6, 5), ..GenerateOptions::default() };
    let scene = generate::scene("mirrors", &options).expect("a scene of the list");
    let view = View::new((6, 5));
    // On one thread recording and replaying share its stack.
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).stack_size(kib << 10).build();
        let pool = pool.expect("threads can be had");
        for &set in KernelSet::ALL {
            let [found, expected] = pool.install(|| drawn(&scene, &view, set, 32, Skips::ALL));
            assert_eq!(found, expected, "{set:?} on {threads} threads");
        }
    }
}
