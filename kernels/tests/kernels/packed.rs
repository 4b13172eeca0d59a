//! Pictures from the layout `packed` beside those from `wide`: the same bits from fewer octets.

use emu::machine::{Config, RunOutcome, Setup};
use emu::octets::Memory;
use isa::Isa;
use isa::number::{Modes, Overflow, Quantization, Vector};
use kernels::{KernelOptions, KernelSet, build};
use scenes::cadrage::Overrides;
use scenes::generate::SCENES;
use scenes::image::{self, MemoryImage, MemoryKind, MemoryOptions};
use scenes::kdtree::VISIT;
use scenes::layout::Layout;
use scenes::model::{Camera, Scene, View};

use super::drawing::coarse;

const SIZE: (u32, u32) = (10, 8);

/// The sets whose kernels read the layout `packed`.
const SETS: [KernelSet; 3] = [KernelSet::Ray, KernelSet::Vector, KernelSet::Packet];

/// A picture to be drawn: everything that decides a picture here.
struct Frame<'a> {
    scene: &'a Scene,
    view: &'a View,
    set: KernelSet,
    modes: Modes,
    formats: Overrides,
    /// Cost of visiting a node of the tree, in percent of a test.
    visit: u32,
}

impl<'a> Frame<'a> {
    fn plain(scene: &'a Scene, view: &'a View, set: KernelSet, word: u32) -> Frame<'a> {
        Frame { scene, view, set, modes: rounded(word), formats: Overrides::default(), visit: VISIT }
    }

    fn image(&self, layout: Layout) -> Option<MemoryImage> {
        let options = MemoryOptions {
            word: self.modes.word,
            layout,
            kd_depth: self.set.kd_depth(),
            kd_method: self.set.kd_method(),
            kd_visit: self.visit,
            formats: self.formats,
        };
        image::build(self.scene, self.view, &options).ok()
    }

    /// Outcome of the run; `None` where the word is too short for the scene.
    fn run(&self, layout: Layout) -> Option<(MemoryImage, RunOutcome)> {
        let image = self.image(layout)?;
        let isa = Isa::base();
        let options = KernelOptions { profile: self.set, ..KernelOptions::default() };
        let built = build(self.scene, self.view, &image, &isa, &options)
            .unwrap_or_else(|report| panic!("{}", report.render(false)));
        assert!(built.warnings.0.is_empty(), "{}", built.warnings);
        let mut config = Config::default();
        let Modes { word, quantization, overflow } = self.modes;
        (config.arithmetic.word, config.arithmetic.quantization, config.arithmetic.overflow) =
            (word, quantization, overflow);
        let (core, main) = (&built.cores, &built.main);
        let setup = Setup { config: &config, isa: &isa, core, main, kinds: Vec::new(), options: Default::default() };
        match emu::run(&setup, Memory::new(image.bytes.clone()), &mut |_| {}) {
            Ok(frame) => Some((image, frame)),
            Err(failure) => panic!("{} by {} in {:?}: {failure}", self.scene.name, self.set, self.modes),
        }
    }

    fn pixels(&self, layout: Layout) -> Option<Vec<Vector>> {
        let (image, frame) = self.run(layout)?;
        let start = image.region(MemoryKind::Frame).start;
        let pixel =
            |n: u32| [0, 1, 2].map(|k| frame.memory.word(start + 12 * n + 4 * k).expect("the frame is in memory"));
        Some((0..SIZE.0 * SIZE.1).map(pixel).collect())
    }
}

fn rounded(word: u32) -> Modes {
    Modes { word, quantization: Quantization::Rnd, overflow: Overflow::Sat }
}

/// All scenes in words of 8 to 32 bits, the sets in turn, in turn in all modes and cameras, some with coarser positions.
#[test]
fn packed_scenes_are_drawn_as_wide_ones() {
    let all = || Quantization::ALL.iter().flat_map(|&q| Overflow::ALL.iter().map(move |&overflow| (q, overflow)));
    let mut modes = all().cycle();
    let mut drawings = 0;
    for number in 0..SCENES.len() {
        let scene = coarse(number, 200, SIZE);
        for word in 8..=32u32 {
            let (quantization, overflow) = modes.next().expect("modes go round");
            // The turn chooses the rest: the set by thirds, the camera by halves, the tree by fifths, and each fourth has coarser positions.
            let turn = number + word as usize;
            let camera = match turn / 4 % 2 {
                0 => Camera::Orthographic,
                _ => Camera::Perspective { eye: None, look: None, field: 45.0 },
            };
            let view = View { camera, shift: [0.137, 0.071], ..View::new(SIZE) };
            let position = (turn % 4 == 3).then_some(6);
            let frame = Frame {
                scene: &scene,
                view: &view,
                set: SETS[turn % 3],
                modes: Modes { word, quantization, overflow },
                formats: Overrides { position, ..Overrides::default() },
                visit: [VISIT, 20][turn % 5 % 2],
            };
            // A word may be too short for the scene: then there is nothing to compare.
            let Some(expected) = frame.pixels(Layout::Wide) else { continue };
            let found = frame.pixels(Layout::Packed);
            assert!(found == Some(expected), "{} by {} in {:?}", scene.name, frame.set, frame.modes);
            drawings += 1;
        }
    }
    assert!(drawings > 150, "only {drawings} pictures were compared");
}

/// The octets that move, of 16 and of 20 bits, against those of the layout `wide` in 32 bits.
#[test]
fn packed_scenes_move_few_octets() {
    let view = View { shift: [0.137, 0.071], ..View::new(SIZE) };
    for number in 0..5 {
        let scene = coarse(number, 2_000, SIZE);
        for set in SETS {
            let moved = |word, layout| {
                let frame = Frame::plain(&scene, &view, set, word);
                let (_, frame) = frame.run(layout).expect("the scene fits");
                frame.processors.iter().map(|processor| processor.octets.0).sum::<u64>()
            };
            let wide = moved(32, Layout::Wide);
            for (word, most) in [(16, 0.6), (20, 0.75)] {
                let share = moved(word, Layout::Packed) as f64 / wide as f64;
                assert!(share <= most, "{} by {set} in {word} bits: {share:.3} of the octets", scene.name);
            }
        }
    }
}

/// The tree decides where a walk goes and which triangles it meets, and not what the picture is.
#[test]
fn trees_for_cheap_visits_give_the_same_pictures() {
    let view = View { shift: [0.137, 0.071], ..View::new(SIZE) };
    for number in 0..5 {
        let scene = coarse(number, 2_000, SIZE);
        for (set, layout) in
            [(KernelSet::Ray, Layout::Packed), (KernelSet::Vector, Layout::Wide), (KernelSet::Packet, Layout::Packet)]
        {
            let drawn = |visit| {
                let frame = Frame { visit, ..Frame::plain(&scene, &view, set, 22) };
                let nodes = frame.image(layout).expect("the scene fits").tree.nodes;
                (nodes, frame.pixels(layout))
            };
            let ((nodes, pixels), (more, same)) = (drawn(VISIT), drawn(25));
            assert!(more > nodes && same == pixels, "{} by {set}: {nodes} and {more} nodes", scene.name);
        }
    }
}

#[test]
fn the_reports_kernels_refuse_packed_structures() {
    let scene = coarse(0, 200, SIZE);
    let view = View::new(SIZE);
    let frame = Frame::plain(&scene, &view, KernelSet::Report, 16);
    let image = frame.image(Layout::Packed).expect("the scene fits");
    let options = KernelOptions { profile: KernelSet::Report, ..KernelOptions::default() };
    let refusal = build(&scene, &view, &image, &Isa::base(), &options).unwrap_err().render(false);
    assert!(refusal.contains("the kernels of `report` do not read the layout `packed`"), "{refusal}");
    assert!(refusal.contains("no rows that unpack fields"), "{refusal}");
}
