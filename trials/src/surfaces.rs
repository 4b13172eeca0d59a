//! Secondary rays after a hit: their origins and directions.

use std::ops::Range;
use std::sync::LazyLock;

use fixed::types::I2F30;
use isa::number::ray::Ray;
use isa::number::{Modes, Nearest32, Overflow, Quantization, Vector};
use kernels::KernelSet;
use kernels::twin::exact_triangle::exact_triangle;
use kernels::twin::ray;
use kernels::twin::refract::{Refraction, refracts};
use kernels::twin::stage::StageMaterial;
use kernels::twin::surface::{Surface, normal, sides};
use kernels::twin::unit::unit;
use kernels::twin::vector_arithmetic::VectorArithmetic;

use crate::mesh::{ClosedMesh, sphere};
use crate::series::Random;
use crate::tally::{TrialTally, tally};
use crate::target::Target;

/// A component of a direction, in the format that directions have in a word of 32 bits.
type Component = I2F30;

/// Steps of a component between 0 and 1.
const ONE: f64 = (1u32 << Component::FRAC_NBITS) as f64;

/// Secondary rays of each hit.
const SPAWNS: u64 = 1000;

static BALL: LazyLock<Target> =
    LazyLock::new(|| Target::new(&ClosedMesh { name: "sphere", triangles: sphere(2, |_| 1.0) }, KernelSet::Ray));

fn rounded(direction: [f64; 3]) -> Vector {
    direction.map(|x| Component::from_num(x).to_bits())
}

/// All pairs of a quantization and an overflow mode.
static MODES: LazyLock<Vec<Modes>> = LazyLock::new(|| {
    let pairs =
        Quantization::ALL.iter().flat_map(|&quantization| Overflow::ALL.iter().map(move |&o| (quantization, o)));
    pairs.map(|(quantization, overflow)| Modes { quantization, overflow, ..Modes::default() }).collect()
});

/// Rays that start on a convex body, in each mode of rounding and overflow: those that leave it hit nothing, those that enter it hit it once
/// more.
pub fn self_intersection(seed: u64, trials: Range<u64>) -> TrialTally {
    tally(trials, |trial| {
        let twin = &BALL.twin;
        let mut random = Random::new(seed, trial / SPAWNS);
        let inner = random.point(1 << 27);
        let back = random.direction();
        let away = rounded(back.map(|x| -x));
        let origin = std::array::from_fn(|k| inner[k] + (back[k] * f64::from(1 << 30)) as i32);
        let first = Ray { origin, direction: away };
        let Some((_, index)) = BALL.nearest(&first)? else { return Ok(0.0) };
        let modes = MODES[(trial / SPAWNS) as usize % MODES.len()];
        let (came, corners) = (ray::TwinRay::new(&modes, origin, away), BALL.corners(index));
        let t = exact_triangle(&modes, &twin.constants, &came, corners);
        let (facing, _) = normal(&modes, twin.constants.formats.direction, away, corners);
        let (point, behind) = sides(&modes, &twin.constants, &came, t, facing, corners);
        let direction = rounded(Random::new(seed ^ 1, trial).direction());
        if direction == [0; 3] || on_side(index, &first, direction) == 0 {
            return Ok(0.0);
        }
        let is_leaving = on_side(index, &first, direction) > 0;
        let start = if is_leaving { point } else { behind };
        let hits = BALL.crossings(&Ray { origin: start, direction }).len();
        match hits == usize::from(!is_leaving) {
            true => Ok(0.0),
            false => Err(format!("from {start:?} along {direction:?}: {hits} hits, triangle {index}, {modes:?}")),
        }
    })
}

/// The sign of the way away from a triangle's plane, positive on the side from which a ray has come; exact.
fn on_side(index: u32, came: &Ray, direction: Vector) -> i128 {
    let [a, b, c] = BALL.corners(index).map(|corner| corner.map(i128::from));
    let (e, f): ([i128; 3], [i128; 3]) = (std::array::from_fn(|k| b[k] - a[k]), std::array::from_fn(|k| c[k] - a[k]));
    let normal = [e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]];
    let along = |way: Vector| (0..3).map(|k| normal[k] * i128::from(way[k])).sum::<i128>();
    along(direction).signum() * -along(came.direction).signum()
}

/// Unit vectors of vectors between 2^-14 and 2^14 long with 16 fraction bits; the error of a component in units in the last place.
///
/// Brought into the word, a vector is exact and at least 2^29 long. Its length is off by at most 1/2, so a component of the unit vector by at most 1,
/// and its own rounding adds 1/2.
pub fn normalising(seed: u64, trials: Range<u64>) -> TrialTally {
    tally(trials, |trial| {
        let mut random = Random::new(seed, trial);
        let length = (16.0 + 14.0 * random.unit()).exp2();
        let vector = random.direction().map(|x| (x * length).round());
        let exact = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
        if exact == 0.0 {
            return Ok(0.0);
        }
        let found = unit(&Nearest32, Component::FRAC_NBITS, Nearest32.normalized(vector.map(|x| x as i64)));
        let off = |k: usize| (Component::from_bits(found[k]).to_num::<f64>() - vector[k] / exact).abs() * ONE;
        Ok((0..3).map(off).fold(0.0, f64::max))
    })
}

/// Rays that leave glass next to the critical angle: how far from it, as 1 - eta^2 (1 - c^2) in units in the last place, a ray is still taken for one
/// of the other side.
///
/// With eta up to 2.49, c^2 off by less than 3/2 (c and the square, rounded), and two products, of which the first has the two fraction bits less
/// of an index of refraction, so that its half unit is 2: 3/2 eta^2 + 2 eta + 1/2 is the most, 14.8.
pub fn critical_angle(seed: u64, trials: Range<u64>) -> TrialTally {
    let constants = &BALL.twin.constants;
    let index = constants.formats.index;
    tally(trials, |trial| {
        // Choose an index of refraction from 1.01 to 2.49, and a sine beside the critical one, on either side and mostly very near: off by less than a 2^0 to 2^-31 of it.
        let mut random = Random::new(seed, trial);
        let eta = ((1.75 + 0.74 * random.unit()) * f64::from(1u32 << index)).round();
        let ratio = eta / f64::from(1u32 << index);
        let sine = (1.0 + random.unit() * (-(random.below(32) as f64)).exp2()) / ratio;
        if !(0.0..1.0).contains(&sine) {
            return Ok(0.0);
        }
        // Make a ray of that sine: a normal, and a direction at right angles to it.
        let normal = random.direction();
        let other = random.direction();
        let along = (0..3).map(|k| normal[k] * other[k]).sum::<f64>();
        let aside: [f64; 3] = std::array::from_fn(|k| other[k] - along * normal[k]);
        let length = aside.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length < 0.01 {
            return Ok(0.0);
        }
        // Round both to the format of directions.
        let cosine = (1.0 - sine * sine).sqrt();
        let incident = rounded(std::array::from_fn(|k| sine * aside[k] / length - cosine * normal[k]));
        let facing = rounded(normal);
        let material = StageMaterial {
            colour: [0; 3],
            reflection: 0,
            intensity: 0,
            transmission: 1 << constants.formats.weight,
            index: eta as i32,
            inverse_index: 0,
        };
        let rounded_cosine = -Nearest32.dot(facing, incident, Component::FRAC_NBITS);
        let surface = Surface { point: [0; 3], behind: [0; 3], facing, incident, cosine: rounded_cosine, material };
        // Decide again in double precision from the rounded vectors.
        let value = |raw: i32| Component::from_bits(raw).to_num::<f64>();
        let exact = -(0..3).map(|k| value(facing[k]) * value(incident[k])).sum::<f64>();
        let k = 1.0 - ratio * ratio * (1.0 - exact * exact);
        let is_total = matches!(
            refracts(&Nearest32, constants, &surface, 1 << constants.formats.weight, true),
            Refraction::Total(_)
        );
        Ok(if is_total == (k < 0.0) { 0.0 } else { k.abs() * ONE })
    })
}
