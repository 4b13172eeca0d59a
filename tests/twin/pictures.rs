//! Whole pictures: the frame that the machine draws and the twin's, word for word.

use emu::machine::{RunFailure, Setup};
use emu::octets::Memory;
use emu::trap::Fault;
use isa::Isa;
use isa::number::{Modes, Overflow, Quantization, Vector};
use kernels::KernelSet;
use kernels::build::Crop;
use kernels::twin;
use scenes::generate;
use scenes::image::{self, MemoryKind};
use scenes::layout::Layout;
use scenes::model::{Camera, Scene, View};

use super::Subject;

/// The number of the kernels' trap for a ray that visits more packets than there are.
const STUCK: u32 = 1;

impl Subject {
    /// The pixels that the machine draws, `None` when a ray is stuck.
    fn drawn(&self, crop: Crop) -> Option<Vec<Vector>> {
        let isa = Isa::base();
        let options =
            kernels::KernelOptions { crop: Some(crop), profile: self.profile, ..kernels::KernelOptions::default() };
        let build = kernels::build(&self.scene, &self.view, &self.image, &isa, &options)
            .unwrap_or_else(|report| panic!("{}", report.render(false)));
        let config = self.machine();
        let setup = Setup {
            config: &config,
            isa: &isa,
            core: &build.cores,
            main: &build.main,
            kinds: Vec::new(),
            options: emu::machine::RunOptions::default(),
        };
        let frame = match emu::run(&setup, Memory::new(self.image.bytes.clone()), &mut |_| {}) {
            Ok(frame) => frame,
            Err(RunFailure::Trap(trap)) if trap.kind == Fault::User(STUCK) => return None,
            Err(failure) => panic!("{failure}"),
        };
        let start = self.image.region(MemoryKind::Frame).start;
        let pixel = |n: u32| {
            std::array::from_fn(|k| frame.memory.word(start + 12 * n + 4 * k as u32).expect("the frame is in memory"))
        };
        Some((0..crop.width * crop.height).map(pixel).collect())
    }

    /// The pixels that the twin draws, `None` when a ray is stuck.
    fn drawn_by_twin(&self, crop: Crop) -> Option<Vec<Vector>> {
        match twin::render(&self.image, &self.features, &crop, self.profile, self.modes) {
            Ok(pixels) => Some(pixels),
            Err(twin::TwinFailure::Stuck { .. }) => None,
            Err(failure) => panic!("{failure}"),
        }
    }

    /// True where there is a picture at all; fails where the two differ.
    fn check(&self, crop: Crop, what: &str) -> bool {
        let (machine, twin) = (self.drawn(crop), self.drawn_by_twin(crop));
        match (&machine, &twin) {
            (Some(machine), Some(twin)) => {
                assert_eq!(machine.len(), twin.len(), "{what}");
                for (n, (machine, twin)) in machine.iter().zip(twin).enumerate() {
                    assert_eq!(machine, twin, "machine and twin, pixel {n} of {what}");
                }
            }
            _ => assert_eq!(machine.is_none(), twin.is_none(), "a ray of the machine, of the twin is stuck: {what}"),
        }
        machine.is_some()
    }
}

/// Settings of the scenes' pictures.
#[derive(Clone, Copy, Debug)]
struct Setting {
    modes: Modes,
    is_perspective: bool,
    bounces: u32,
    background: f64,
    layout: Layout,
    shift: f64,
    profile: KernelSet,
}

const PLAIN: Setting = Setting {
    modes: Modes { word: 32, quantization: Quantization::Rnd, overflow: Overflow::Sat },
    is_perspective: false,
    bounces: 5,
    background: 0.0,
    layout: Layout::Wide,
    shift: 0.137,
    profile: KernelSet::Vector,
};

const fn word(word: u32) -> Modes {
    Modes { word, ..PLAIN.modes }
}

const SIZE: (u32, u32) = (24, 18);

const ALL: Crop = Crop { column: 0, row: 0, width: SIZE.0, height: SIZE.1 };

/// A generated scene, small.
fn small(name: &str) -> Scene {
    let level = match name {
        "cornell" | "sphereflake" | "mirrors" => Some(1),
        "slabs" => Some(4),
        "slivers" => Some(12),
        _ => None,
    };
    let triangles = (name == "terrain").then_some(300);
    generate::scene(name, &generate::GenerateOptions { level, triangles, size: SIZE }).expect("a scene of the list")
}

/// Draws every scene; those that a word of that length refuses are skipped, and counted.
fn check_all(setting: &Setting) -> usize {
    let view = View {
        camera: if setting.is_perspective {
            Camera::Perspective { eye: None, look: None, field: 45.0 }
        } else {
            Camera::Orthographic
        },
        shift: [setting.shift, setting.shift / 2.0],
        bounces: setting.bounces,
        background: [setting.background, setting.background / 2.0, setting.background / 3.0],
        ..View::new(SIZE)
    };
    let options = image::MemoryOptions { layout: setting.layout, ..image::MemoryOptions::default() };
    let mut refused = 0;
    for generator in generate::SCENES {
        match Subject::new(small(generator.name), view.clone(), setting.modes, options) {
            Ok(subject) => {
                let subject = subject.with(setting.profile);
                let what = format!("{} with {setting:?}", generator.name);
                assert!(subject.check(ALL, &what), "a ray is stuck: {what}");
            }
            Err(_) => refused += 1,
        }
    }
    refused
}

#[test]
fn pictures_of_32_bits() {
    assert_eq!(check_all(&PLAIN), 0);
    assert_eq!(check_all(&Setting { is_perspective: true, background: 0.3, bounces: 2, ..PLAIN }), 0);
}

#[test]
fn pictures_of_fewer_bits() {
    assert_eq!(check_all(&Setting { modes: word(24), is_perspective: true, ..PLAIN }), 0);
    assert_eq!(check_all(&Setting { modes: word(20), bounces: 0, background: 0.7, ..PLAIN }), 0);
    assert_eq!(check_all(&Setting { modes: word(16), is_perspective: true, bounces: 2, ..PLAIN }), 0);
}

#[test]
fn pictures_of_odd_words() {
    assert_eq!(check_all(&Setting { modes: word(27), bounces: 2, ..PLAIN }), 0);
    assert_eq!(check_all(&Setting { modes: word(13), is_perspective: true, background: 1.0, ..PLAIN }), 0);
    assert_eq!(check_all(&Setting { modes: word(8), ..PLAIN }), 0);
}

#[test]
fn pictures_in_the_reports_layout_with_rays_on_edges() {
    assert_eq!(check_all(&Setting { layout: Layout::Report, shift: 0.0, ..PLAIN }), 0);
}

#[test]
fn pictures_that_are_rounded_down_and_wrap() {
    let modes = Modes { word: 27, quantization: Quantization::Trn, overflow: Overflow::Wrap(0) };
    assert_eq!(check_all(&Setting { modes, is_perspective: true, background: 0.2, ..PLAIN }), 0);
    let modes = Modes { word: 18, quantization: Quantization::RndConv, overflow: Overflow::SatSym };
    assert_eq!(check_all(&Setting { modes, bounces: 2, ..PLAIN }), 0);
}

#[test]
fn pictures_of_the_ray_unit() {
    let ray = Setting { profile: KernelSet::Ray, ..PLAIN };
    assert_eq!(check_all(&ray), 0);
    assert_eq!(check_all(&Setting { is_perspective: true, background: 0.3, bounces: 2, ..ray }), 0);
    assert_eq!(check_all(&Setting { layout: Layout::Report, shift: 0.0, ..ray }), 0);
}

#[test]
fn pictures_of_the_ray_unit_in_fewer_bits() {
    let ray = Setting { profile: KernelSet::Ray, ..PLAIN };
    assert_eq!(check_all(&Setting { modes: word(24), is_perspective: true, ..ray }), 0);
    assert_eq!(check_all(&Setting { modes: word(16), shift: 0.0, bounces: 2, ..ray }), 0);
    assert_eq!(check_all(&Setting { modes: word(8), background: 1.0, ..ray }), 0);
    let modes = Modes { word: 21, quantization: Quantization::Trn, overflow: Overflow::Wrap(0) };
    assert_eq!(check_all(&Setting { modes, is_perspective: true, layout: Layout::Report, ..ray }), 0);
}

#[test]
fn pictures_of_packets() {
    let packet = Setting { profile: KernelSet::Packet, layout: Layout::Packet, ..PLAIN };
    assert_eq!(check_all(&packet), 0);
    assert_eq!(check_all(&Setting { is_perspective: true, background: 0.3, bounces: 2, ..packet }), 0);
    assert_eq!(check_all(&Setting { layout: Layout::Report, shift: 0.0, ..packet }), 0);
    assert_eq!(check_all(&Setting { layout: Layout::Wide, shift: 0.0, ..packet }), 0);
}

#[test]
fn pictures_of_packets_in_fewer_bits() {
    let packet = Setting { profile: KernelSet::Packet, layout: Layout::Packet, ..PLAIN };
    assert_eq!(check_all(&Setting { modes: word(24), is_perspective: true, ..packet }), 0);
    assert_eq!(check_all(&Setting { modes: word(16), shift: 0.0, bounces: 2, ..packet }), 0);
    assert_eq!(check_all(&Setting { modes: word(8), background: 1.0, layout: Layout::Wide, ..packet }), 0);
    let modes = Modes { word: 21, quantization: Quantization::Trn, overflow: Overflow::Wrap(0) };
    assert_eq!(check_all(&Setting { modes, is_perspective: true, layout: Layout::Report, ..packet }), 0);
}

/// The layout that has packets is read by all sets as the wide one.
#[test]
fn pictures_of_the_layout_of_packets_by_other_kernels() {
    for profile in [KernelSet::Report, KernelSet::Vector, KernelSet::Ray] {
        assert_eq!(check_all(&Setting { profile, layout: Layout::Packet, bounces: 2, ..PLAIN }), 0);
    }
}

#[test]
fn pictures_as_the_report_draws_them() {
    let report = Setting { profile: KernelSet::Report, layout: Layout::Report, ..PLAIN };
    assert_eq!(check_all(&report), 0);
    assert_eq!(check_all(&Setting { is_perspective: true, background: 0.3, bounces: 2, ..report }), 0);
    assert_eq!(check_all(&Setting { layout: Layout::Wide, shift: 0.0, ..report }), 0);
}

#[test]
fn pictures_as_the_report_draws_them_in_fewer_bits() {
    let report = Setting { profile: KernelSet::Report, layout: Layout::Wide, ..PLAIN };
    assert_eq!(check_all(&Setting { modes: word(24), is_perspective: true, background: 0.7, ..report }), 0);
    assert_eq!(check_all(&Setting { modes: word(16), layout: Layout::Report, bounces: 2, ..report }), 0);
    assert_eq!(check_all(&Setting { modes: word(8), ..report }), 0);
    let modes = Modes { word: 27, quantization: Quantization::Trn, overflow: Overflow::Wrap(0) };
    assert_eq!(check_all(&Setting { modes, is_perspective: true, ..report }), 0);
}

#[test]
fn parts_of_pictures() {
    let view = View { shift: [0.3, 0.1], ..View::new((50, 40)) };
    let subject =
        Subject::new(small("cornell"), view, PLAIN.modes, image::MemoryOptions::default()).expect("a small scene");
    for crop in [
        Crop { column: 20, row: 11, width: 7, height: 5 },
        Crop { column: 49, row: 39, width: 1, height: 1 },
        Crop { column: 0, row: 39, width: 50, height: 1 },
    ] {
        assert!(subject.check(crop, &format!("{crop:?}")));
    }
}

/// Scenes of any size that doubles hold are drawn by the machine bit for bit as those of size 1.
#[test]
fn pictures_of_any_size() {
    for generator in &generate::SCENES[..5] {
        for set in KernelSet::ALL {
            let drawn = |exponent: i32| {
                let mut scene = small(generator.name);
                let larger = |point: [f64; 3]| point.map(|x| x * f64::from(exponent).exp2());
                scene.vertices.iter_mut().for_each(|vertex| *vertex = larger(*vertex));
                scene.lights.iter_mut().for_each(|light| light.position = larger(light.position));
                let options = image::MemoryOptions { layout: set.layout(), ..image::MemoryOptions::default() };
                let view = View { shift: [0.137, 0.071], ..View::new(SIZE) };
                let subject = Subject::new(scene, view, PLAIN.modes, options).expect("any size fits the grid");
                subject.with(*set).drawn(ALL).expect("no ray is stuck")
            };
            let plain = drawn(0);
            for exponent in [-300, 300] {
                assert!(drawn(exponent) == plain, "{} times 2^{exponent} by {set}", generator.name);
            }
        }
    }
}

/// A packet of more triangles than a word of 8 bits counts, in modes that make much of it.
#[test]
fn pictures_of_long_packets_in_short_words() {
    let mut scene = small("triangle");
    let first = scene.triangles[0];
    scene.triangles.extend([first; 300]);
    for overflow in [Overflow::Sat, Overflow::Wrap(0), Overflow::SatZero] {
        let modes = Modes { overflow, ..word(8) };
        for set in [KernelSet::Vector, KernelSet::Ray, KernelSet::Packet] {
            for layout in Layout::ALL {
                let options = image::MemoryOptions { layout, ..image::MemoryOptions::default() };
                let subject = Subject::new(scene.clone(), View::new(SIZE), modes, options).expect("a small scene");
                let what = format!("300 triangles in {modes:?} by {set} from {layout}");
                assert!(subject.with(set).check(ALL, &what));
            }
        }
    }
}
