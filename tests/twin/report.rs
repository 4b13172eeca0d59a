//! The profile `report`, function by function: its assembly on random operands against its twin, in several words and modes.

use std::iter::successors;

use isa::number::Modes;
use kernels::constants::Constants;
use kernels::twin::Twin;
use kernels::twin::ray::{TwinRay, TwinSearch};
use kernels::twin::report::{self, ExitPoint, Transmission};
use kernels::twin::surface::Surface;
use kernels::{Function, KernelSet};
use proptest::prelude::*;

use super::Subject;
use super::bench::{Experiment, Place};
use super::functions::{
    HIT, MODES, PACKET, RAY_AND_BOX, agree, bounds, for_all, hit, packet_words, point_of_tree, ray, ray_and_box,
    subject, trees, triangle_and_ray, vertices,
};
use super::operands::{direction, vector, words};

fn literal(modes: Modes) -> Subject {
    subject("slabs", Some(4), modes).with(KernelSet::Report)
}

#[test]
fn surfaces() {
    let experiment = Experiment {
        functions: &[Function::Surface, Function::Normal, Function::Unit, Function::Sqrt],
        operands: HIT,
        body: "    movi near_slot, NEAR_SLOT\n    call link_trace, surface\n",
        results: &[Place::Vector("point"), Place::Vector("behind"), Place::Vector("facing"), Place::Scalar("cosine")],
    };
    for modes in MODES {
        let subject = literal(modes);
        let constants = Constants::new(&subject.image);
        agree(&subject, &experiment, hit(modes.word, constants.never), |case| {
            let ray = ray(&modes, case, 9);
            let normal = report::normal(&modes, constants.formats.direction, &vertices(case));
            let (facing, cosine, point, behind) = report::sides(&modes, &constants, &ray, case[15], normal);
            words(&[point, behind, facing], &[cosine])
        });
    }
}

/// The surface that a case of a triangle, a ray and a distance gives, of the first material.
fn surface(twin: &Twin<Modes>, case: &[i32]) -> Surface {
    let (modes, constants) = (&twin.arithmetic, &twin.constants);
    let ray = ray(modes, case, 9);
    let normal = report::normal(modes, constants.formats.direction, &vertices(case));
    let (facing, cosine, point, behind) = report::sides(modes, constants, &ray, case[15], normal);
    Surface { point, behind, facing, incident: ray.direction, cosine, material: twin.stage.materials[0] }
}

#[test]
fn secondary_rays() {
    const FUNCTIONS: &[Function] =
        &[Function::Surface, Function::Normal, Function::Unit, Function::Sqrt, Function::Reflect, Function::Refract];
    let experiment = Experiment {
        functions: FUNCTIONS,
        operands: &[
            Place::Triple("NEAR_SLOT + triangle.v0"),
            Place::Triple("NEAR_SLOT + triangle.v1"),
            Place::Triple("NEAR_SLOT + triangle.v2"),
            Place::Word("MATERIALS + material.index"),
            Place::Vector("origin"),
            Place::Vector("direction"),
            Place::Scalar("near_t"),
            Place::Scalar("inside"),
        ],
        // Both rays start from the ray that came; the reflected one waits in v27 and v28.
        body: "    movi near_slot, NEAR_SLOT\n    sb s0, triangle.material_id(near_slot)\n    \
               vmov v29, origin\n    vmov v30, direction\n    call link_node, reflect\n    vmov v27, origin\n    \
               vmov v28, direction\n    vmov origin, v29\n    vmov direction, v30\n    call link_node, refract\n    \
               mov s19, s12\n    bgez s12, 1f\n    movi s19, -1\n    vmov origin, v29\n    vmov direction, v30\n1:\n",
        results: &[
            Place::Vector("v27"),
            Place::Vector("v28"),
            Place::Scalar("s19"),
            Place::Vector("origin"),
            Place::Vector("direction"),
        ],
    };
    for modes in MODES {
        let subject = literal(modes);
        let twin = subject.twin();
        let most = i32::MAX >> (32 - modes.word);
        let cases = (triangle_and_ray(modes.word), 0..=twin.constants.never, 1..=most, any::<bool>());
        let cases = cases
            .prop_map(|(case, t, index, inside)| [&case[..9], &[index], &case[9..], &[t, i32::from(inside)]].concat());
        agree(&subject, &experiment, cases, |case| {
            let plain = [&case[..9], &case[10..]].concat();
            let mut surface = surface(&twin, &plain);
            surface.material.index = case[9];
            let reflected = report::reflect(&modes, &twin.constants, &surface);
            let (origin, direction) = (vector(&plain, 9), vector(&plain, 12));
            match report::refract(&modes, &twin.constants, &surface, plain[16] == 1) {
                Transmission::Total => {
                    [words(&[surface.point, reflected], &[-1]), words(&[origin, direction], &[])].concat()
                }
                Transmission::Through(refracted) => {
                    [words(&[surface.point, reflected], &[1]), words(&[surface.behind, refracted], &[])].concat()
                }
            }
        });
    }
}

#[test]
fn exit_faces() {
    let experiment = Experiment {
        functions: &[Function::ExitFace],
        operands: RAY_AND_BOX,
        body: "    vmov exit_point, zero_vector\n    call link_step, exit_face\n",
        results: &[
            Place::Scalar("exit_axis"),
            Place::Scalar("exit_plane"),
            Place::Scalar("exit_t"),
            Place::Vector("exit_point"),
        ],
    };
    for modes in MODES {
        let subject = literal(modes);
        let constants = Constants::new(&subject.image);
        agree(&subject, &experiment, ray_and_box(modes.word - 2), |case| {
            let (ray, bounds) = (ray(&modes, case, 0), bounds(case, 6));
            let ExitPoint { axis, plane, t, point } = report::exit_face(&modes, &constants, &ray, &bounds);
            [vec![axis as i32, plane, t], words(&[point], &[])].concat()
        });
    }
}

#[test]
fn descents() {
    let experiment = Experiment {
        functions: &[Function::Descend],
        operands: &[Place::Vector("direction"), Place::Vector("exit_point")],
        body: "    call link_step, descend\n",
        results: PACKET,
    };
    for modes in MODES {
        for subject in trees(modes) {
            let subject = subject.with(KernelSet::Report);
            let twin = subject.twin();
            let cases = (direction(modes.word - 2), point_of_tree(&subject)).prop_map(|(d, p)| words(&[d, p], &[]));
            agree(&subject, &experiment, cases, |case| {
                let ray = TwinRay::new(&modes, [0; 3], vector(case, 0));
                packet_words(&subject, Some(report::descend(&twin.stage, &ray, vector(case, 3))))
            });
        }
    }
}

/// A ray that starts inside the scene leaves it: each packet lies a plane farther than the one before, however the points are rounded.
#[test]
fn walks_end() {
    for modes in MODES {
        for subject in trees(modes) {
            let subject = subject.with(KernelSet::Report);
            let twin = subject.twin();
            let cases = (point_of_tree(&subject), direction(modes.word - 2));
            let cases = cases.prop_map(|(o, d)| words(&[o, d], &[]));
            for_all(cases, |case| {
                let ray = ray(&modes, case, 0);
                let search = TwinSearch { t: twin.constants.never, triangle: None, takes_any: false };
                let first = Some(report::own_packet(&twin.stage, &ray));
                let packets = successors(first, |here| twin.next_packet(&ray, here, &search));
                let most = twin.constants.most_steps as usize;
                assert!(packets.take(most + 1).count() <= most, "{ray:?} is stuck in {modes:?}");
            });
        }
    }
}
