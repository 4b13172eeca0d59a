//! Surface by surface: the assembly of point, normal and secondary rays on random operands against its twin.

use isa::number::Modes;
use kernels::Function;
use kernels::constants::Constants;
use kernels::twin::Twin;
use kernels::twin::reflect::{reflect, reflects};
use kernels::twin::refract::{Refraction, refract, refracts};
use kernels::twin::surface::{Surface, normal, sides};
use proptest::prelude::*;

use super::bench::{Experiment, Place};
use super::functions::{HIT, MODES, agree, hit, ray, subject, vertices};
use super::operands::{direction, point, vector, words};

#[test]
fn surfaces() {
    let experiment = Experiment {
        functions: &[Function::Surface, Function::Normal, Function::Unit, Function::Sqrt],
        operands: HIT,
        body: "    movi near_slot, NEAR_SLOT\n    call link_shade, surface\n",
        results: &[
            Place::Vector("point"),
            Place::Vector("behind"),
            Place::Vector("facing"),
            Place::Vector("incident"),
            Place::Scalar("cosine"),
        ],
    };
    for modes in MODES {
        let subject = subject("slabs", Some(4), modes);
        let constants = Constants::new(&subject.image);
        agree(&subject, &experiment, hit(modes.word, constants.never), |case| {
            let ray = ray(&modes, case, 9);
            let (facing, cosine) = normal(&modes, constants.formats.direction, ray.direction, &vertices(case));
            let (point, behind) = sides(&modes, &constants, &ray, case[15], facing, &vertices(case));
            words(&[point, behind, facing, ray.direction], &[cosine])
        });
    }
}

/// A surface with the first material of a scene; tests set what they need.
fn surface(twin: &Twin<Modes>) -> Surface {
    let material = twin.stage.materials[0];
    Surface { point: [0; 3], behind: [0; 3], facing: [0; 3], incident: [0; 3], cosine: 0, material }
}

#[test]
fn reflected_rays() {
    let experiment = Experiment {
        functions: &[Function::Reflect, Function::OwnPacket, Function::Descend],
        operands: &[
            Place::Vector("point"),
            Place::Vector("facing"),
            Place::Vector("incident"),
            Place::Scalar("cosine"),
        ],
        body: "    call link_node, reflect\n",
        results: &[Place::Vector("origin"), Place::Vector("direction")],
    };
    for modes in MODES {
        let subject = subject("slabs", Some(4), modes);
        let (twin, bits) = (subject.twin(), modes.word - 2);
        let cases = (point(bits), direction(bits), direction(bits), 0..=1 << bits);
        agree(&subject, &experiment, cases.prop_map(|(p, n, i, cosine)| words(&[p, n, i], &[cosine])), |case| {
            let (facing, incident, cosine) = (vector(case, 3), vector(case, 6), case[9]);
            let surface = Surface { facing, incident, cosine, ..surface(&twin) };
            words(&[vector(case, 0), reflect(&modes, &twin.constants, &surface)], &[])
        });
    }
}

#[test]
fn weights_of_children() {
    let experiment = Experiment {
        functions: &[Function::Refracts, Function::Reflects],
        operands: &[
            Place::Word("MATERIALS + material.reflection"),
            Place::Word("MATERIALS + material.transmission"),
            Place::Word("MATERIALS + material.index"),
            Place::Word("MATERIALS + material.inverse_index"),
            Place::Scalar("weight_now"),
            Place::Scalar("inside"),
            Place::Scalar("cosine"),
        ],
        // k and eta are cleared first, since they are written only where a ray goes through.
        body: "    movi s12, MATERIALS\n    sw s12, MATERIAL_AT(s0)\n    movi node, NODES\n    sw s0, raynode.k(node)\n    \
               sw s0, raynode.eta(node)\n    call link_node, refracts\n    call link_node, reflects\n",
        results: &[
            Place::Scalar("refracted_weight"),
            Place::Scalar("reflected_weight"),
            Place::Word("NODES + raynode.k"),
            Place::Word("NODES + raynode.eta"),
        ],
    };
    for modes in MODES {
        let subject = subject("slabs", Some(4), modes);
        let (twin, one, most) = (subject.twin(), 1 << (modes.word - 2), i32::MAX >> (32 - modes.word));
        // Any four words will do as a material, and a cosine may be two units above 1 by rounding.
        let weight = || prop_oneof![0..=one, Just(0), Just(one)];
        let index = || 1..=most;
        let cases = (weight(), weight(), index(), index(), weight(), 0..=1i32, 0..=one + 2);
        let cases = cases.prop_map(|(ks, kt, index, inverse, w, inside, c)| vec![ks, kt, index, inverse, w, inside, c]);
        agree(&subject, &experiment, cases, |case| {
            let &[reflection, transmission, index, inverse_index, weight, inside, cosine] = case else {
                panic!("a case of seven words")
            };
            let mut surface = Surface { cosine, ..surface(&twin) };
            surface.material.reflection = reflection;
            surface.material.transmission = transmission;
            (surface.material.index, surface.material.inverse_index) = (index, inverse_index);
            let (refracted, total, k, eta) = match refracts(&modes, &twin.constants, &surface, weight, inside == 1) {
                Refraction::Opaque => (0, 0, 0, 0),
                Refraction::Total(total) => (0, total, 0, 0),
                Refraction::Through { weight, k, eta } => (weight, 0, k, eta),
            };
            vec![refracted, reflects(&modes, &twin.constants, &surface, weight, total), k, eta]
        });
    }
}

#[test]
fn refracted_rays() {
    let experiment = Experiment {
        functions: &[Function::Refract, Function::OwnPacket, Function::Descend, Function::Sqrt],
        operands: &[
            Place::Word("NODES + raynode.k"),
            Place::Word("NODES + raynode.eta"),
            Place::Word("NODES + raynode.cosine"),
            Place::Word("NODES + raynode.inside"),
            Place::Triple("NODES + raynode.normal"),
            Place::Triple("NODES + raynode.incident"),
            Place::Triple("NODES + raynode.behind"),
        ],
        body: "    movi node, NODES\n    call link_node, refract\n",
        results: &[Place::Vector("origin"), Place::Vector("direction"), Place::Scalar("inside")],
    };
    for modes in MODES {
        let subject = subject("slabs", Some(4), modes);
        let (twin, bits) = (subject.twin(), modes.word - 2);
        let (one, most) = (1 << bits, i32::MAX >> (32 - modes.word));
        // Words of a case: k, eta, cosine, inside, normal from 4 on, incident from 7, behind from 10; rounding puts k up to 3 units above 1
        let cases = (0..=one + 3, 1..=most, 0..=one, 0..=1i32, direction(bits), direction(bits), point(bits));
        let cases = cases.prop_map(|(k, eta, cosine, inside, normal, incident, behind)| {
            [vec![k, eta, cosine, inside], words(&[normal, incident, behind], &[])].concat()
        });
        agree(&subject, &experiment, cases, |case| {
            let (facing, incident) = (vector(case, 4), vector(case, 7));
            let surface = Surface { facing, incident, cosine: case[2], ..surface(&twin) };
            let direction = refract(&modes, &twin.constants, &surface, case[0], case[1]);
            // The ray starts behind the surface, so it is inside where it was not before.
            words(&[vector(case, 10), direction], &[1 - case[3]])
        });
    }
}
