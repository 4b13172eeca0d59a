//! The walk and the searches of the profiles `ray` and `packet` against their twins.

use std::array::from_fn;
use std::iter::successors;
use std::ops::Range;

use isa::number::{Modes, Vector};
use kernels::twin::Twin;
use kernels::twin::planes::Packets;
use kernels::twin::ray::{Packet, TwinRay, TwinSearch};
use kernels::{Function, KernelSet};
use proptest::prelude::*;
use scenes::image::MemoryKind;
use scenes::layout::Layout;

use super::Subject;
use super::bench::{Experiment, Place};
use super::functions::{MODES, agree, packet_words, point_of_tree, trees, trees_in};
use super::operands::{direction, vector, words};

/// The walk of the ray unit, from the first packet to the last, against the walk with planes and against that from box to box.
#[test]
fn walks_of_the_ray_unit() {
    let experiment = Experiment {
        functions: &[Function::OwnPacket, Function::NextPacket, Function::Descend],
        operands: &[Place::Vector("origin"), Place::Vector("direction")],
        // s29 counts the packets; s30 becomes 31 s30 + address at each, so that their order counts too.
        body: "    mov near, s0\n    li near_t, NEVER\n    mov any_hit, s0\n    mov s29, s0\n    mov s30, s0\n    \
               call link_packet, own_packet\n    bltz packet_count, 2f\n1:\n    movi s12, 31\n    imul s30, s30, s12\n    \
               iadd s30, s30, packet_refs\n    iaddi s29, s29, 1\n    call link_packet, next_packet\n    bgez packet_count, 1b\n2:\n",
        results: &[Place::Scalar("s29"), Place::Scalar("s30")],
    };
    for modes in MODES {
        for subject in trees(modes) {
            let subject = subject.with(KernelSet::Ray);
            let twin = subject.twin();
            // The address of a packet does not depend on its box.
            let address = |references: Range<u32>| {
                let bounds = twin.stage.bounds;
                packet_words(&subject, Some(Packet { bounds, references }))[1]
            };
            let cases = (point_of_tree(&subject), direction(modes.word - 2)).prop_map(|(o, d)| words(&[o, d], &[]));
            agree(&subject, &experiment, cases, |case| {
                let (origin, direction) = (vector(case, 0), vector(case, 3));
                let ray = TwinRay::new(&modes, origin, direction);
                // Walk with planes and from box to box: both must name the same packets in the same order
                let exact = isa::number::ray::Ray { origin, direction };
                let packets = Packets::new(&twin.stage.nodes, &twin.stage.bounds, exact);
                let packets: Vec<i32> = packets.map(address).collect();
                let search = TwinSearch { t: twin.constants.never, triangle: None, takes_any: false };
                let from_box_to_box = successors(twin.own_packet(&ray), |here| twin.next_packet(&ray, here, &search));
                assert_eq!(packets, from_box_to_box.map(|packet| address(packet.references)).collect::<Vec<_>>());
                let sum = packets.iter().fold(0i32, |sum, &address| sum.wrapping_mul(31).wrapping_add(address));
                vec![packets.len() as i32, sum]
            });
        }
    }
}

/// Rays through vertices and planes of a tree, so that most decisions are ties.
fn aimed(subject: &Subject) -> impl Strategy<Value = [Vector; 2]> + use<> {
    let stage = subject.twin().stage;
    let vertices: Vec<Vector> = stage.triangles.iter().flat_map(|triangle| triangle.vertices).collect();
    let towards = prop_oneof![prop::sample::select(vertices), point_of_tree(subject)];
    // Not of unit length: the ray passes through the very point.
    (point_of_tree(subject), towards).prop_map(|(origin, towards)| [origin, from_fn(|k| towards[k] - origin[k])])
}

/// The sets that search in rows of the ray unit, each in its own layout and in another one.
const SETS: [(KernelSet, Layout); 6] = [
    (KernelSet::Ray, Layout::Wide),
    (KernelSet::Ray, Layout::Packed),
    (KernelSet::Packet, Layout::Packed),
    (KernelSet::Ray, Layout::Packet),
    (KernelSet::Packet, Layout::Packet),
    (KernelSet::Packet, Layout::Wide),
];

/// Result of a search of a twin, as the kernel's registers have it.
fn found(subject: &Subject, twin: &Twin<Modes>, ray: &TwinRay, mut search: TwinSearch) -> Vec<i32> {
    let triangles = subject.image.region(MemoryKind::Triangles).start;
    let octets = subject.image.structures.triangle.octets();
    if let Some(first) = twin.own_packet(ray) {
        twin.trace(ray, first, &mut search).expect("a walk with planes ends");
    }
    vec![search.t, search.triangle.map_or(0, |index| (triangles + index * octets) as i32)]
}

/// Whole searches for the nearest hit.
#[test]
fn searches_of_aimed_rays() {
    let experiment = Experiment {
        functions: &[Function::OwnPacket, Function::Trace, Function::Packet, Function::NextPacket, Function::Descend],
        operands: &[Place::Vector("origin"), Place::Vector("direction")],
        body: "    mov near, s0\n    li near_t, NEVER\n    mov any_hit, s0\n    movi near_slot, NEAR_SLOT\n    movi slot, SLOT\n    \
               call link_packet, own_packet\n    call link_trace, trace\n",
        results: &[Place::Scalar("near_t"), Place::Scalar("near")],
    };
    let in_turn = MODES.into_iter().zip(SETS[1..].iter().cycle().copied());
    for (modes, (set, layout)) in MODES.into_iter().map(|modes| (modes, SETS[0])).chain(in_turn) {
        for subject in trees_in(layout, modes) {
            let subject = subject.with(set);
            let twin = subject.twin();
            let cases = aimed(&subject).prop_map(|ray| words(&ray, &[]));
            agree(&subject, &experiment, cases, |case| {
                let ray = TwinRay::new(&modes, vector(case, 0), vector(case, 3));
                let search = TwinSearch { t: twin.constants.never, triangle: None, takes_any: false };
                found(&subject, &twin, &ray, search)
            });
        }
    }
}

/// Whole searches for any hit before a distance.
#[test]
fn searches_of_aimed_shadow_rays() {
    let experiment = Experiment {
        functions: &[Function::OwnPacket, Function::Trace, Function::Packet, Function::NextPacket, Function::Descend],
        operands: &[Place::Vector("origin"), Place::Vector("direction"), Place::Scalar("near_t")],
        body: "    mov near, s0\n    movi any_hit, 1\n    movi near_slot, NEAR_SLOT\n    movi slot, SLOT\n    \
               call link_packet, own_packet\n    call link_trace, trace\n    bnez near, 1f\n    mov near_t, s0\n1:\n",
        results: &[Place::Scalar("near_t"), Place::Scalar("near")],
    };
    for (modes, (set, layout)) in MODES.into_iter().zip(SETS.iter().cycle().copied()) {
        for subject in trees_in(layout, modes) {
            let subject = subject.with(set);
            let twin = subject.twin();
            // Of directions as long as the way to a point of the tree, distances are fractions of one.
            let near = 1 << twin.constants.along().min(modes.word - 2);
            let cases = (aimed(&subject), 0..=near).prop_map(|(ray, t)| words(&ray, &[t]));
            agree(&subject, &experiment, cases, |case| {
                let ray = TwinRay::new(&modes, vector(case, 0), vector(case, 3));
                let search = TwinSearch { t: case[6], triangle: None, takes_any: true };
                let found = found(&subject, &twin, &ray, search);
                if found[1] == 0 { vec![0, 0] } else { found }
            });
        }
    }
}
