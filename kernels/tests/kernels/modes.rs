//! Rounding and overflow modes: the origins of secondary rays, and whole pictures against double precision, in each of them.

use isa::number::{Modes, Overflow, Quantization, Vector};
use kernels::KernelSet;
use kernels::constants::{Constants, SIDE_MARGIN};
use kernels::twin::exact_triangle::exact_triangle;
use kernels::twin::ray::TwinRay;
use kernels::twin::surface::{major_axis, normal, point, sides};
use random::SplitMix64;
use scenes::image::{self, MemoryOptions};
use scenes::metrics::{self, PictureError};
use scenes::model::{Camera, Picture, Scene, View};
use scenes::reference;

use super::drawing::{coarse, twin_picture};

/// All pairs of a quantization and an overflow mode.
fn all_modes(word: u32) -> impl Iterator<Item = Modes> {
    let overflow =
        move |&quantization| Overflow::ALL.iter().map(move |&overflow| Modes { word, quantization, overflow });
    Quantization::ALL.iter().flat_map(overflow)
}

/// Scenes that figures are quoted for.
const MEASURED: usize = 5;

/// The difference of a twin's picture from double precision.
fn error(scene: &Scene, view: &View, set: KernelSet, modes: Modes, exact: &Picture) -> PictureError {
    let (_, picture) = twin_picture(scene, view, set, modes);
    metrics::compare(&picture, exact).expect("pictures of one size")
}

/// Five scenes in all quantization and overflow modes: in 32 bits no pixel is off and the pictures differ by less than 140 dB, in 24 bits at
/// most one pixel of a picture is, and the others differ by less than 90 dB.
#[test]
fn pictures_are_right_in_every_mode() {
    let size = (48, 36);
    for number in 0..MEASURED {
        let scene = coarse(number, 300, size);
        let view = View { shift: [0.137, 0.071], ..View::new(size) };
        let exact = reference::render(&scene, &view).expect("the reference draws any scene").picture;
        for set in [KernelSet::Vector, KernelSet::Ray] {
            for (word, most_off, least) in [(32, 0, 140.0), (24, 1, 90.0)] {
                for modes in all_modes(word) {
                    let error = error(&scene, &view, set, modes, &exact);
                    let others = error.psnr_others_db.unwrap_or(f64::INFINITY);
                    assert!(
                        error.off_pixels <= most_off && others >= least,
                        "{} by {set} in {modes:?}: {} off, {others:.1} dB",
                        scene.name,
                        error.off_pixels
                    );
                }
            }
        }
    }
}

/// Any mode, word of 16 to 32 bits and scene of a generator, in either camera: the error of pixels that are not off stays below the bound that
/// doubles with each bit less, and not more pixels are off than lie within some units of an edge.
#[test]
fn errors_stay_below_their_bound() {
    let size = (32, 24);
    let mut random = SplitMix64::new(31);
    for _ in 0..250 {
        let scene = coarse(random.below(MEASURED as u64) as usize, 300, size);
        let word = 16 + random.below(17) as u32;
        let all: Vec<Modes> = all_modes(word).collect();
        let modes = all[random.below(all.len() as u64) as usize];
        let set = [KernelSet::Vector, KernelSet::Ray][random.below(2) as usize];
        let camera = match random.below(2) {
            0 => Camera::Orthographic,
            _ => Camera::Perspective { eye: None, look: None, field: 45.0 },
        };
        // Not on the multiples of the scenes' symmetries, where samples lie on edges.
        let shift = [0; 2].map(|_| (random.below(1000) as f64 + 0.37) / 1000.0 - 0.5);
        let view = View { shift, camera, ..View::new(size) };
        let exact = reference::render(&scene, &view).expect("the reference draws any scene").picture;
        let error = error(&scene, &view, set, modes, &exact);
        let others = error.psnr_others_db.unwrap_or(f64::INFINITY);
        let least = (6.02 * f64::from(word) - 60.0).max(40.0);
        let most_off = 2.0 + f64::from(size.0 * size.1) * (13.0 - f64::from(word)).exp2();
        assert!(
            others >= least && error.off_pixels as f64 <= most_off,
            "{} by {set} in {modes:?}, {view:?}: {} off of at most {most_off:.1}, {others:.1} dB of at least {least:.1}",
            scene.name,
            error.off_pixels
        );
    }
}

/// Sixfold volume of the pyramid from a point to a triangle: positive on the side from which the corners run anticlockwise.
fn volume(at: Vector, vertices: &[Vector; 3]) -> i128 {
    let [a, b, c] = vertices.map(|corner| [0, 1, 2].map(|k| i128::from(corner[k]) - i128::from(at[k])));
    let cross = [b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]];
    -(0..3).map(|k| a[k] * cross[k]).sum::<i128>()
}

/// Units by which a rounded point may have to move along the major axis, with a unit of t as long as two of positions: each of the three
/// components is off by `e` and t by 2 e, where e is 1/2 for rounding to nearest and less than 1 else, as seen along an axis that the normal
/// is at least 1 / sqrt 3 along, and one more for lying strictly on its side.
fn most_units(quantization: Quantization) -> i32 {
    let e = match quantization {
        Quantization::Trn | Quantization::TrnZero => 1.0,
        _ => 0.5,
    };
    (3.0 * e + 2.0 * e * 3f64.sqrt()) as i32 + 1 + 1
}

/// Points lie strictly on their sides of the triangle's plane, by exact volumes, and moved by the fewest units: one less, and the point is in
/// the plane, beyond it, or closer than what two roundings may hide.
#[test]
fn secondary_rays_start_on_their_sides() {
    let mut random = SplitMix64::new(32);
    let mut moves = [0; 12];
    let words: Vec<(Constants, Vec<Modes>)> = (16..=32).map(|word| (full(word), all_modes(word).collect())).collect();
    for n in 0..150_000 {
        let (constants, all) = &words[random.below(words.len() as u64) as usize];
        let (word, modes) = (constants.formats.word, all[n % all.len()]);
        let mut coordinate = |most: i64| random.below(2 * most as u64) as i64 - most;
        let most = 1i64 << (word - 2);
        let size = most >> (coordinate(4) + 4).min(word as i64 - 12).max(0);
        let centre = [0; 3].map(|_| coordinate((most - size).max(1)));
        let vertices: [Vector; 3] = [0; 3].map(|_| centre.map(|x| (x + coordinate(size)) as i32));
        let origin: Vector = [0; 3].map(|_| coordinate(most) as i32);
        // Towards a point in the middle of the triangle.
        let weights = [0; 3].map(|_| 1.0 + coordinate(1000) as f64 / 1001.0);
        let sum: f64 = weights.iter().sum();
        let target = [0, 1, 2].map(|k| (0..3).map(|v| weights[v] / sum * f64::from(vertices[v][k])).sum::<f64>());
        let way = [0, 1, 2].map(|k| target[k] - f64::from(origin[k]));
        let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
        let one = f64::from(1 << constants.formats.direction);
        let direction = way.map(|x| (x / length * one).round() as i32);
        let ray = TwinRay::new(&modes, origin, direction);
        let t = exact_triangle(&modes, constants, &ray, &vertices);
        if t == constants.missed || t >= constants.never {
            continue;
        }
        let (facing, _) = normal(&modes, constants.formats.direction, direction, &vertices);
        let axis = major_axis(facing);
        let plain = point(&modes, constants, &ray, t);
        let (before, behind) = sides(&modes, constants, &ray, t, facing, &vertices);
        // The normal's component along the axis, by which a volume changes with each unit.
        let mut next = plain;
        next[axis] += 1;
        let step = volume(next, &vertices) - volume(plain, &vertices);
        if step.abs() < 1 << (constants.side_fraction + constants.side_shift) {
            continue;
        }
        let outwards = i128::from(facing[axis].signum()) * step.signum();
        for (place, side) in [(before, outwards), (behind, -outwards)] {
            assert!(
                volume(place, &vertices) * side > 0,
                "{place:?} is not on its side of {vertices:?}, from {plain:?} in {modes:?}"
            );
            let units = place[axis] - plain[axis];
            assert!((0..3).all(|k| k == axis || place[k] == plain[k]));
            assert!(units.abs() <= most_units(modes.quantization), "{units} units in {modes:?}");
            moves[units.unsigned_abs() as usize] += 1;
            if units != 0 {
                let mut less = place;
                less[axis] -= units.signum();
                let rest = volume(less, &vertices) * side;
                let hidden = (i128::from(2 * SIDE_MARGIN) * step.abs()) >> constants.side_fraction;
                assert!(rest <= hidden, "{units} units are more than are needed, in {modes:?}");
            }
        }
    }
    assert!(moves[0] > 10_000 && moves[1] > 10_000 && moves[2] > 1_000, "{moves:?}");
}

/// Constants of a scene that fills the word.
fn full(word: u32) -> Constants {
    let scene = coarse(0, 300, (1, 1));
    let image = image::build(&scene, &View::new((1, 1)), &MemoryOptions { word, ..MemoryOptions::default() });
    let constants = Constants::new(&image.expect("the scene fits the word"));
    // The widest differences that positions of the word have.
    Constants {
        side_shift: 4,
        formats: scenes::cadrage::Formats { t: constants.formats.position - 1, ..constants.formats },
        ..constants
    }
}
