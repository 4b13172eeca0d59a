//! Distance of the twins' unit vectors and secondary rays from double precision, in units in the last place (ulp) of a direction.

use std::fmt::Write;

use isa::number::{Modes, Vector};
use kernels::twin::reflect::reflect;
use kernels::twin::refract::{Refraction, refract, refracts};
use kernels::twin::stage::StageMaterial;
use kernels::twin::surface::{Surface, normal};
use kernels::twin::unit::unit;
use kernels::twin::vector_arithmetic::VectorArithmetic;

use super::accuracy::{Errors, Exact, WORDS, exact_cross, full, modes};
use super::operands::Series;

/// Vectors of a series.
const VECTORS: usize = 50_000;

fn ulps(found: Vector, exact: [f64; 3], bits: u32) -> f64 {
    let one = f64::from(1u32 << bits);
    (0..3).map(|k| (f64::from(found[k]) - exact[k] * one).abs()).fold(0.0, f64::max)
}

fn double(vector: Vector, bits: u32) -> [f64; 3] {
    vector.map(|lane| f64::from(lane) / f64::from(1u32 << bits))
}

fn double_dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[test]
fn unit_vectors_against_double_precision() {
    let mut text = format!("{VECTORS} vectors each, largest error of a lane in ulp\n");
    for word in WORDS {
        let (modes, bits) = (modes(word), word - 2);
        let mut series = Series::new(23);
        let (mut normals, mut units) = (Errors::default(), Errors::default());
        for _ in 0..VECTORS {
            let vertices = series.triangle(bits, bits - 2);
            let [a, b, c] = vertices.map(|vertex| vertex.map(i128::from));
            let edge = |p: Exact, q: Exact| [0, 1, 2].map(|k| p[k] - q[k]);
            let exact = exact_cross(edge(b, a), edge(c, a)).map(|lane| lane as f64);
            let length = double_dot(exact, exact).sqrt();
            if length > 0.0 {
                let direction = [0, 0, 1 << bits];
                let (facing, _) = normal(&modes, bits, direction, &vertices);
                let turn = if exact[2] > 0.0 { -1.0 } else { 1.0 };
                // A normal that is almost at right angles to the ray may be turned either way.
                let error = |turn: f64| ulps(facing, exact.map(|lane| turn * lane / length), bits);
                normals.0.push(error(turn).min(error(-turn)));
            }
            let way = series.point(1 << bits).map(|lane| lane >> (series.bits() % u64::from(bits)));
            let length = double_dot(way.map(f64::from), way.map(f64::from)).sqrt();
            if length > 0.0 {
                let found = unit(&modes, bits, modes.normalized(way.map(i64::from)));
                units.0.push(ulps(found, way.map(|lane| f64::from(lane) / length), bits));
            }
        }
        let _ = writeln!(text, "{word} bits, normals: {}", normals.figures());
        let _ = writeln!(text, "{word} bits, unit vectors: {}", units.figures());
    }
    insta::assert_snapshot!(text);
}

/// A surface that is met in a certain way, of glass with a ratio of indices.
fn met(modes: &Modes, bits: u32, facing: Vector, incident: Vector, eta: i32) -> Option<Surface> {
    let cosine = modes.dot(facing, incident, bits);
    let facing = if cosine > 0 { facing.map(|lane| -lane) } else { facing };
    let material =
        StageMaterial { colour: [0; 3], reflection: 0, intensity: 0, transmission: 1, index: eta, inverse_index: 1 };
    let cosine = cosine.abs();
    (cosine > 0).then_some(Surface { point: [0; 3], behind: [0; 3], facing, incident, cosine, material })
}

#[test]
fn secondary_rays_against_double_precision() {
    let mut text = format!("{VECTORS} rays each, largest error of a lane in ulp\n");
    for word in WORDS {
        let (modes, constants, bits) = (modes(word), full(word), word - 2);
        let mut series = Series::new(24);
        let (mut reflected, mut refracted) = (Errors::default(), Errors::default());
        let (mut total, mut wrong) = (0, 0);
        for _ in 0..VECTORS {
            // Ratios from 1/7.5 to 7.5.
            let ratio = (series.unit() * 2.0).exp();
            let eta = (ratio * f64::from(1u32 << constants.formats.index)).round() as i32;
            let (facing, incident) = (series.direction(bits), series.direction(bits));
            let Some(surface) = met(&modes, bits, facing, incident, eta) else { continue };
            let (n, d) = (double(surface.facing, bits), double(incident, bits));
            let eta = f64::from(eta) / f64::from(1u32 << constants.formats.index);
            let c = -double_dot(n, d);
            let exact = [0, 1, 2].map(|k| d[k] + 2.0 * c * n[k]);
            reflected.0.push(ulps(reflect(&modes, &constants, &surface), exact, bits));
            let k = 1.0 - eta * eta * (1.0 - c * c);
            match refracts(&modes, &constants, &surface, 1 << constants.formats.weight, true) {
                Refraction::Opaque => panic!("the material lets light through"),
                Refraction::Total(_) => {
                    total += 1;
                    wrong += usize::from(k >= 0.0);
                }
                Refraction::Through { .. } if k < 0.0 => wrong += 1,
                Refraction::Through { k: raw, eta: ratio, .. } => {
                    let exact = [0, 1, 2].map(|j| eta * (d[j] + c * n[j]) - k.sqrt() * n[j]);
                    refracted.0.push(ulps(refract(&modes, &constants, &surface, raw, ratio), exact, bits));
                }
            }
        }
        let _ = writeln!(text, "{word} bits, reflected: {}", reflected.figures());
        let _ = writeln!(text, "{word} bits, refracted: {}", refracted.figures());
        let _ = writeln!(text, "{word} bits, total reflection: {total}, {wrong} wrong");
    }
    insta::assert_snapshot!(text);
}
