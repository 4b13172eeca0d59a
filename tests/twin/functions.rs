//! Function by function: the assembly on random operands against its twin, in several words and modes.

use isa::number::{Modes, Overflow, Quantization, Vector};
use kernels::twin::descend::{descend, own_packet};
use kernels::twin::exit_face::exit_face;
use kernels::twin::ray::{ExitPlane, Packet, TwinRay, TwinSearch};
use kernels::twin::report;
use kernels::twin::unit::{sqrt, unit};
use kernels::{Function, KernelSet};
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use scenes::generate;
use scenes::image::{self, MemoryKind};
use scenes::kdtree::Bounds;
use scenes::layout::Layout;
use scenes::model::View;

use super::Subject;
use super::bench::{Bench, Experiment, Place};
use super::operands::{direction, number, point, vector, words};

/// Seed of all random operands.
const SEED: [u8; 32] = *b"lancer: the twins and the kernel";

/// Words and modes that functions are compared in.
pub(super) const MODES: [Modes; 5] = [
    Modes { word: 32, quantization: Quantization::Rnd, overflow: Overflow::Sat },
    Modes { word: 24, quantization: Quantization::Rnd, overflow: Overflow::Sat },
    Modes { word: 16, quantization: Quantization::TrnZero, overflow: Overflow::Sat },
    Modes { word: 21, quantization: Quantization::RndConv, overflow: Overflow::SatSym },
    Modes { word: 27, quantization: Quantization::Trn, overflow: Overflow::Wrap(0) },
];

/// The profiles whose kernels are in all functions different.
const PROFILES: [KernelSet; 2] = [KernelSet::Vector, KernelSet::Report];

/// A generated scene with a small picture.
pub(super) fn subject(name: &str, level: Option<u32>, modes: Modes) -> Subject {
    subject_in(image::MemoryOptions::default().layout, name, level, modes)
}

/// A generated scene with a small picture, in a layout.
pub(super) fn subject_in(layout: Layout, name: &str, level: Option<u32>, modes: Modes) -> Subject {
    let size = (8, 6);
    let scene =
        generate::scene(name, &generate::GenerateOptions { level, size, triangles: None }).expect("a generated scene");
    let options = image::MemoryOptions { layout, ..image::MemoryOptions::default() };
    Subject::new(scene, View::new(size), modes, options).expect("a scene that fits the word")
}

fn runner() -> TestRunner {
    testing::seeded_runner(12, &SEED)
}

/// Something that holds in all random cases.
pub(super) fn for_all(cases: impl Strategy<Value = Vec<i32>>, law: impl Fn(&[i32])) {
    let outcome = runner().run(&prop::collection::vec(cases, 1..250), |cases| {
        cases.iter().for_each(|case| law(case));
        Ok(())
    });
    if let Err(failure) = outcome {
        panic!("{failure}\nseed {SEED:?}");
    }
}

/// Runs the experiment on random cases and compares each result with the twin's.
pub(super) fn agree(
    subject: &Subject,
    experiment: &Experiment,
    cases: impl Strategy<Value = Vec<i32>>,
    twin: impl Fn(&[i32]) -> Vec<i32>,
) {
    let bench = Bench::new(subject, experiment);
    let outcome = runner().run(&prop::collection::vec(cases, 1..250), |cases| {
        for (case, machine) in cases.iter().zip(bench.run(&cases)) {
            prop_assert_eq!(machine, twin(case), "machine and twin at {:?} in {:?}", case, subject.modes);
        }
        Ok(())
    });
    if let Err(failure) = outcome {
        panic!("{failure}\nseed {SEED:?}");
    }
}

/// A wide number as the two words of a case.
fn wide_words(value: i64) -> Vec<i32> {
    vec![value as i32, (value >> 32) as i32]
}

fn wide(words: &[i32]) -> i64 {
    i64::from(words[1]) << 32 | i64::from(words[0] as u32)
}

/// Numbers that are not negative and whose root fits the word: of any size, and near the places where roots are rounded.
fn squares(word: u32) -> impl Strategy<Value = i64> {
    let most = (1i64 << (word - 1)) - 1;
    let any_size = (0..most * most, 0..2 * word).prop_map(|(x, shift)| x >> shift);
    let near = (0..most, -2..=2i64, any::<bool>())
        .prop_map(|(root, by, is_between)| (root * root + if is_between { root } else { 0 } + by).max(0));
    prop_oneof![any_size, near]
}

#[test]
fn square_roots() {
    let operands = &[Place::Wide("w0")];
    let results = &[Place::Scalar("s12")];
    let body = "    call link_leaf, sqrt\n";
    let experiment = Experiment { functions: &[Function::Sqrt], operands, body, results };
    for modes in MODES {
        for profile in PROFILES {
            let subject = subject("slabs", Some(4), modes).with(profile);
            agree(&subject, &experiment, squares(modes.word).prop_map(wide_words), |case| {
                let (square, root) = (i128::from(wide(case)), sqrt(&modes, wide(case)));
                let twice = 2 * i128::from(root);
                assert!((twice - 1) * (twice - 1).max(0) <= 4 * square, "{root} is too large for {square}");
                assert!((twice + 1) * (twice + 1) > 4 * square, "{root} is too small for {square}");
                vec![root]
            });
        }
    }
}

#[test]
fn units() {
    let experiment = Experiment {
        functions: &[Function::Unit, Function::Sqrt],
        operands: &[Place::Vector("v6")],
        body: "    call link_step, unit\n",
        results: &[Place::Vector("v6")],
    };
    for modes in MODES {
        for profile in PROFILES {
            let subject = subject("slabs", Some(4), modes).with(profile);
            let unit = if profile == KernelSet::Report { report::unit } else { unit };
            let lane = || number(modes.word - 2);
            agree(&subject, &experiment, [lane(), lane(), lane()].prop_map(|v| v.to_vec()), |case| {
                unit(&modes, subject.image.formats.direction, vector(case, 0)).to_vec()
            });
        }
    }
}

/// Vertices, origin and direction.
pub(super) fn triangle_and_ray(word: u32) -> impl Strategy<Value = Vec<i32>> {
    let p = || point(word - 2);
    let small = (p(), [p(), p(), p()], 0..word - 4)
        .prop_map(|(at, corners, shift)| corners.map(|corner| [0, 1, 2].map(|k| at[k] / 2 + (corner[k] >> shift) / 2)));
    let corners = prop_oneof![[p(), p(), p()], small];
    let aim = [0..=8i32, 0..=8i32];
    // Half of the rays go where something is to be hit.
    (corners, p(), direction(word - 2), aim, any::<bool>()).prop_map(
        move |([a, b, c], origin, free, [u, v], is_aimed)| {
            let target = [0, 1, 2].map(|k| {
                let [a, b, c, o] = [a[k], b[k], c[k], origin[k]].map(f64::from);
                a + f64::from(u) / 8.0 * (b - a) + f64::from(v) / 8.0 * (c - a) - o
            });
            let length = target.iter().map(|x| x * x).sum::<f64>().sqrt();
            let aimed = target.map(|x| (x / length * f64::from(1u32 << (word - 2))).round() as i32);
            words(&[a, b, c, origin, if is_aimed && length > 0.0 { aimed } else { free }], &[])
        },
    )
}

pub(super) const CORNERS_AND_RAY: &[Place] = &[
    Place::Triple("SLOT + triangle.v0"),
    Place::Triple("SLOT + triangle.v1"),
    Place::Triple("SLOT + triangle.v2"),
    Place::Vector("origin"),
    Place::Vector("direction"),
];

/// The nearest triangle, a ray, and the distance at which it hits.
pub(super) const HIT: &[Place] = &[
    Place::Triple("NEAR_SLOT + triangle.v0"),
    Place::Triple("NEAR_SLOT + triangle.v1"),
    Place::Triple("NEAR_SLOT + triangle.v2"),
    Place::Vector("origin"),
    Place::Vector("direction"),
    Place::Scalar("near_t"),
];

/// Cases for [`HIT`], with distances up to `most`.
pub(super) fn hit(word: u32, most: i32) -> impl Strategy<Value = Vec<i32>> {
    (triangle_and_ray(word), 0..=most).prop_map(|(case, t)| [&case[..], &[t]].concat())
}

/// The triangle that starts a case.
pub(super) fn vertices(case: &[i32]) -> [Vector; 3] {
    [0, 3, 6].map(|at| vector(case, at))
}

#[test]
fn triangles() {
    let body = "    movi slot, SLOT\n    call link_step, triangle\n";
    let (operands, results) = (CORNERS_AND_RAY, &[Place::Scalar("s12")]);
    let experiment = Experiment { functions: &[Function::Triangle], operands, body, results };
    for modes in MODES {
        for profile in PROFILES {
            let subject = subject("slabs", Some(4), modes).with(profile);
            let twin = subject.twin();
            agree(&subject, &experiment, triangle_and_ray(modes.word), |case| {
                vec![twin.triangle(&ray(&modes, case, 9), &vertices(case))]
            });
        }
    }
}

pub(super) const RAY_AND_BOX: &[Place] =
    &[Place::Vector("origin"), Place::Vector("direction"), Place::Vector("box_low"), Place::Vector("box_high")];

/// Origin, direction and the corners of a box, for [`RAY_AND_BOX`].
pub(super) fn ray_and_box(bits: u32) -> impl Strategy<Value = Vec<i32>> {
    (point(bits), direction(bits), point(bits), point(bits)).prop_map(|(origin, direction, a, b)| {
        let (low, high) = ([0, 1, 2].map(|k| a[k].min(b[k])), [0, 1, 2].map(|k| a[k].max(b[k])));
        words(&[origin, direction, low, high], &[])
    })
}

/// The ray whose origin and direction start at a word of a case.
pub(super) fn ray(modes: &Modes, case: &[i32], at: usize) -> TwinRay {
    TwinRay::new(modes, vector(case, at), vector(case, at + 3))
}

/// The box whose corners start at a word of a case.
pub(super) fn bounds(case: &[i32], at: usize) -> Bounds {
    Bounds { low: vector(case, at), high: vector(case, at + 3) }
}

#[test]
fn exit_faces() {
    let experiment = Experiment {
        functions: &[Function::ExitFace],
        operands: RAY_AND_BOX,
        body: "    vabs steep, direction\n    vlt backwards, direction, zero_vector\n    call link_step, exit_face\n",
        results: &[
            Place::Scalar("exit_axis"),
            Place::Scalar("exit_plane"),
            Place::Scalar("exit_run"),
            Place::Scalar("exit_slope"),
        ],
    };
    for modes in MODES {
        let subject = subject("slabs", Some(4), modes);
        agree(&subject, &experiment, ray_and_box(modes.word - 2), |case| {
            let (ray, bounds) = (ray(&modes, case, 0), bounds(case, 6));
            let ExitPlane { axis, plane, run, slope } = exit_face(&modes, &ray, &bounds);
            vec![axis as i32, plane, run, slope]
        });
    }
}

/// A packet in registers: number of triangles, address of the references, box.
pub(super) const PACKET: &[Place] =
    &[Place::Scalar("packet_count"), Place::Scalar("packet_refs"), Place::Vector("box_low"), Place::Vector("box_high")];

pub(super) fn packet_words(subject: &Subject, packet: Option<Packet>) -> Vec<i32> {
    match packet {
        None => vec![-1, 0, 0, 0, 0, 0, 0, 0],
        Some(Packet { bounds, references }) => {
            let first = subject.image.region(MemoryKind::References).start + 4 * references.start;
            let address = if references.is_empty() { 0 } else { first };
            [references.len() as i32, address as i32].into_iter().chain(bounds.low).chain(bounds.high).collect()
        }
    }
}

/// Scenes with trees of different kinds.
pub(super) fn trees(modes: Modes) -> [Subject; 3] {
    trees_in(image::MemoryOptions::default().layout, modes)
}

/// Scenes with trees of different kinds, in a layout.
pub(super) fn trees_in(layout: Layout, modes: Modes) -> [Subject; 3] {
    [("slivers", 8), ("cornell", 2), ("slabs", 4)].map(|(name, level)| subject_in(layout, name, Some(level), modes))
}

/// A point whose coordinates are often in planes of the tree.
pub(super) fn point_of_tree(subject: &Subject) -> impl Strategy<Value = [i32; 3]> + use<> {
    let tree = subject.image.decode().expect("the image is whole").tree;
    let corners: Vec<[i32; 3]> = tree.nodes().flat_map(|node| [node.bounds.low, node.bounds.high]).collect();
    let Bounds { low, high } = subject.image.bounds;
    let lane = move |k: usize| {
        let planes: Vec<i32> = corners.iter().map(|corner| corner[k]).collect();
        prop_oneof![low[k]..=high[k], prop::sample::select(planes)]
    };
    [0, 1, 2].map(lane).prop_map(|lanes| lanes)
}

#[test]
fn descents() {
    let experiment = Experiment {
        functions: &[Function::Descend],
        operands: &[
            Place::Vector("origin"),
            Place::Vector("direction"),
            Place::Scalar("exit_axis"),
            Place::Scalar("exit_plane"),
            Place::Scalar("exit_run"),
            Place::Scalar("exit_slope"),
        ],
        body: "    vmov fars, zero_vector\n    vlt backwards, direction, zero_vector\n    call link_step, descend\n",
        results: PACKET,
    };
    for modes in MODES {
        for subject in trees(modes) {
            let twin = subject.twin();
            let p = point_of_tree(&subject);
            let cases = (point_of_tree(&subject), direction(modes.word - 2), 0..4usize, p);
            let cases = cases.prop_map(move |(origin, direction, axis, plane)| {
                // An exit plane ahead of the origin, or the start of a ray.
                if axis == 3 {
                    return words(&[origin, direction], &[3, 0, 0, 1]);
                }
                let run = (plane[axis] - origin[axis]) * if direction[axis] < 0 { -1 } else { 1 };
                words(&[origin, direction], &[axis as i32, plane[axis], run, direction[axis].abs()])
            });
            agree(&subject, &experiment, cases, |case| {
                let ray = TwinRay::new(&modes, vector(case, 0), vector(case, 3));
                let exit = ExitPlane { axis: case[6] as usize, plane: case[7], run: case[8], slope: case[9] };
                packet_words(&subject, Some(descend(&modes, &twin.stage, &ray, &exit)))
            });
        }
    }
}

#[test]
fn first_packets() {
    let experiment = Experiment {
        functions: &[Function::FirstPacket, Function::Descend],
        operands: &[Place::Vector("origin"), Place::Vector("direction")],
        body: "    call link_packet, first_packet\n    bgez packet_count, 1f\n    mov packet_refs, s0\n    \
               vmov box_low, zero_vector\n    vmov box_high, zero_vector\n1:\n",
        results: PACKET,
    };
    for modes in MODES {
        for subject in PROFILES.into_iter().flat_map(|profile| trees(modes).map(|subject| subject.with(profile))) {
            let twin = subject.twin();
            let origin = prop_oneof![point_of_tree(&subject), point(modes.word - 2)];
            let cases = (origin, direction(modes.word - 2)).prop_map(|(o, d)| words(&[o, d], &[]));
            agree(&subject, &experiment, cases, |case| {
                packet_words(&subject, twin.camera_packet(&ray(&modes, case, 0)))
            });
        }
    }
}

#[test]
fn next_packets() {
    let experiment = Experiment {
        functions: &[Function::NextPacket, Function::ExitFace, Function::Descend],
        operands: &[
            Place::Vector("origin"),
            Place::Vector("direction"),
            Place::Vector("box_low"),
            Place::Vector("box_high"),
            Place::Scalar("near_t"),
            Place::Scalar("near"),
            Place::Scalar("any_hit"),
        ],
        // The walk traps where `steps` comes to 0, so of two one may be taken. Without a packet the kernel leaves its registers as they are: they
        // are cleared, as `packet_words` has them.
        body: "    vmov fars, zero_vector\n    vlt backwards, direction, zero_vector\n    vabs steep, direction\n    \
               movi steps, 2\n    call link_packet, next_packet\n    bgez packet_count, 1f\n    mov packet_refs, s0\n    \
               vmov box_low, zero_vector\n    vmov box_high, zero_vector\n1:\n",
        results: PACKET,
    };
    for modes in MODES {
        for subject in PROFILES.into_iter().flat_map(|profile| trees(modes).map(|subject| subject.with(profile))) {
            let twin = subject.twin();
            let most = twin.constants.missed;
            let cases = (
                point_of_tree(&subject),
                direction(modes.word - 2),
                prop_oneof![0..=most, Just(most)],
                any::<bool>(),
                any::<bool>(),
            );
            // Words of a case: origin from 0 on, direction from 3, the box from 6, then near_t 12, near 13, any_hit 14
            let walker = subject.twin();
            let cases = cases.prop_map(move |(origin, direction, t, near, any)| {
                let Packet { bounds, .. } =
                    walker.own_packet(&TwinRay::new(&modes, origin, direction)).expect("the ray starts in the scene");
                words(&[origin, direction, bounds.low, bounds.high], &[t, i32::from(near), i32::from(any)])
            });
            agree(&subject, &experiment, cases, |case| {
                let packet = Packet { bounds: bounds(case, 6), references: 0..0 };
                let search =
                    TwinSearch { t: case[12], triangle: (case[13] == 1).then_some(0), takes_any: case[14] == 1 };
                packet_words(&subject, twin.next_packet(&ray(&modes, case, 0), &packet, &search))
            });
        }
    }
}

/// The whole way of a ray through the tree, as the number of its packets and a checksum over them.
#[test]
fn walks() {
    let experiment = Experiment {
        functions: &[Function::OwnPacket, Function::NextPacket, Function::ExitFace, Function::Descend],
        operands: &[Place::Vector("origin"), Place::Vector("direction")],
        body: "    vabs steep, direction\n    li steps, MOST_STEPS\n    mov near, s0\n    mov any_hit, s0\n    mov s29, s0\n    \
               mov s30, s0\n    call link_packet, own_packet\nwalk_packet:\n    movi s12, 31\n    imul s30, s30, s12\n    \
               iadd s30, s30, packet_refs\n    iaddi s29, s29, 1\n    call link_packet, next_packet\n    \
               bgez packet_count, walk_packet\n",
        results: &[Place::Scalar("s29"), Place::Scalar("s30")],
    };
    for modes in MODES {
        for subject in trees(modes) {
            let twin = subject.twin();
            let cases = (point_of_tree(&subject), direction(modes.word - 2)).prop_map(|(o, d)| words(&[o, d], &[]));
            agree(&subject, &experiment, cases, |case| {
                let ray = TwinRay::new(&modes, vector(case, 0), vector(case, 3));
                let search = TwinSearch { t: twin.constants.never, triangle: None, takes_any: false };
                let mut packet = Some(own_packet(&modes, &twin.stage, &ray));
                let (mut packets, mut sum) = (0, 0i32);
                while let Some(here) = packet {
                    packets += 1;
                    sum = sum.wrapping_mul(31).wrapping_add(packet_words(&subject, Some(here.clone()))[1]);
                    packet = twin.next_packet(&ray, &here, &search);
                }
                vec![packets, sum]
            });
        }
    }
}
