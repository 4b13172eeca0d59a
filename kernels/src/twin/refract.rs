//! Refracted rays (report 4.2, corrected).

use isa::number::Vector;

use super::surface::Surface;
use super::unit::sqrt;
use super::vector_arithmetic::VectorArithmetic;
use crate::constants::Constants;

/// Fate of the light that a material lets through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refraction {
    /// The material is opaque.
    Opaque,
    /// Total reflection: the reflected ray takes over this weight.
    Total(i32),
    /// A ray goes through.
    Through {
        /// Weight of the refracted ray.
        weight: i32,
        /// 1 - eta^2 (1 - cosine^2), in the direction format.
        k: i32,
        /// Ratio of the indices of refraction, in the index format.
        eta: i32,
    },
}

/// Refraction of a ray of weight `weight` at a surface, if any; `inside` says whether it is in a body.
pub fn refracts(
    arithmetic: &impl VectorArithmetic,
    constants: &Constants,
    surface: &Surface,
    weight: i32,
    inside: bool,
) -> Refraction {
    let (material, formats) = (&surface.material, &constants.formats);
    if material.transmission == 0 {
        return Refraction::Opaque;
    }
    let (bits, one) = (formats.direction, 1i32 << formats.direction);
    let weight = arithmetic.times(weight, material.transmission, formats.weight);
    let eta = if inside { material.index } else { material.inverse_index };
    let sine_squared = arithmetic.minus(one, arithmetic.times(surface.cosine, surface.cosine, bits));
    let once = arithmetic.times(sine_squared, eta, bits);
    // A square of 64 does not fit the direction format, so whether it exceeds 1 is asked before it is rounded to it.
    let square = i64::from(once) * i64::from(eta);
    let shift = (2 * formats.index).saturating_sub(bits);
    if square > i64::from(one) << shift {
        return Refraction::Total(weight);
    }
    Refraction::Through { weight, k: arithmetic.minus(one, arithmetic.narrow64(square, shift)), eta }
}

/// The direction of the refracted ray, eta (D + c N) - sqrt(k) N: no part of it is longer than 1.
pub fn refract(
    arithmetic: &impl VectorArithmetic,
    constants: &Constants,
    surface: &Surface,
    k: i32,
    eta: i32,
) -> Vector {
    let (bits, index) = (constants.formats.direction, constants.formats.index);
    let root = sqrt(arithmetic, arithmetic.widen(i128::from(k) << bits, 0));
    let tangent = arithmetic.sum(surface.incident, arithmetic.scaled(surface.facing, surface.cosine, bits));
    arithmetic.difference(arithmetic.scaled(tangent, eta, index), arithmetic.scaled(surface.facing, root, bits))
}
