//! Reflected rays (report 4.1).

use isa::number::Vector;

use super::surface::Surface;
use super::vector_arithmetic::VectorArithmetic;
use crate::constants::Constants;

/// The weight of the reflected ray of a path with weight `weight`; `total` is what total reflection adds.
pub fn reflects(
    arithmetic: &impl VectorArithmetic,
    constants: &Constants,
    surface: &Surface,
    weight: i32,
    total: i32,
) -> i32 {
    arithmetic.plus(total, arithmetic.times(surface.material.reflection, weight, constants.formats.weight))
}

/// The direction of the reflected ray, D + 2 c N with c = -N . D.
pub fn reflect(arithmetic: &impl VectorArithmetic, constants: &Constants, surface: &Surface) -> Vector {
    let along = arithmetic.scaled(surface.facing, surface.cosine, constants.formats.direction);
    // In two steps: 2 c may be 2, which a direction cannot hold.
    arithmetic.sum(arithmetic.sum(surface.incident, along), along)
}
