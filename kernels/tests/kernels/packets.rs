//! Pictures of the set `packet` beside those of `ray`: the same bits from other rows, layouts and transfers.

use emu::machine::{Config, Setup};
use emu::octets::Memory;
use isa::Isa;
use isa::number::{Modes, Overflow, Quantization, Vector};
use kernels::{KernelOptions, KernelSet, build};
use scenes::generate::SCENES;
use scenes::image::{self, MemoryKind, MemoryOptions};
use scenes::layout::Layout;
use scenes::model::{Camera, Scene, View};

use super::drawing::coarse;

const SIZE: (u32, u32) = (10, 8);

/// The pixels that the machine draws; `None` where the word is too short for the scene.
fn drawn(scene: &Scene, view: &View, set: KernelSet, layout: Layout, modes: Modes) -> Option<Vec<Vector>> {
    let options = MemoryOptions { word: modes.word, layout, ..MemoryOptions::default() };
    let image = image::build(scene, view, &options).ok()?;
    let isa = Isa::base();
    let options = KernelOptions { profile: set, ..KernelOptions::default() };
    let built = build(scene, view, &image, &isa, &options).unwrap_or_else(|report| panic!("{}", report.render(false)));
    let mut config = Config::default();
    let Modes { word, quantization, overflow } = modes;
    (config.arithmetic.word, config.arithmetic.quantization, config.arithmetic.overflow) =
        (word, quantization, overflow);
    let (core, main) = (&built.cores, &built.main);
    let setup = Setup { config: &config, isa: &isa, core, main, kinds: Vec::new(), options: Default::default() };
    let frame = match emu::run(&setup, Memory::new(image.bytes.clone()), &mut |_| {}) {
        Ok(frame) => frame,
        Err(failure) => panic!("{} by {set} in {modes:?}: {failure}", scene.name),
    };
    let start = image.region(MemoryKind::Frame).start;
    let pixel = |n: u32| [0, 1, 2].map(|k| frame.memory.word(start + 12 * n + 4 * k).expect("the frame is in memory"));
    Some((0..SIZE.0 * SIZE.1).map(pixel).collect())
}

/// All scenes in words of 16 to 32 bits, in turn in all modes and cameras, on samples between the symmetries of the scenes and on them.
#[test]
fn packets_draw_what_the_ray_unit_draws() {
    let all = || Quantization::ALL.iter().flat_map(|&q| Overflow::ALL.iter().map(move |&overflow| (q, overflow)));
    let mut modes = all().cycle();
    let mut drawings = 0;
    for number in 0..SCENES.len() {
        let scene = coarse(number, 200, SIZE);
        for word in 16..=32 {
            let (quantization, overflow) = modes.next().expect("modes go round");
            let modes = Modes { word, quantization, overflow };
            let is_odd = (number as u32 + word) % 2 == 1;
            let camera = match is_odd {
                true => Camera::Orthographic,
                false => Camera::Perspective { eye: None, look: None, field: 45.0 },
            };
            let shift = if word % 3 == 0 { [0.0; 2] } else { [0.137, 0.071] };
            let view = View { camera, shift, ..View::new(SIZE) };
            let Some(expected) = drawn(&scene, &view, KernelSet::Ray, Layout::Wide, modes) else { continue };
            let layout = if word % 5 == 0 { Layout::Wide } else { Layout::Packet };
            let found = drawn(&scene, &view, KernelSet::Packet, layout, modes);
            assert!(found == Some(expected), "{} in {modes:?} from {layout}", scene.name);
            drawings += 1;
        }
    }
    assert!(drawings > 120, "only {drawings} pictures were compared");
}
