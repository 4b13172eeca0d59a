//! Down the kd tree to the packet in which a ray is at a plane, or in which it starts.

use std::cmp::Ordering;

use super::ray::{ExitPlane, Packet, TwinRay};
use super::stage::TwinStage;
use super::vector_arithmetic::VectorArithmetic;

/// The packet in which the ray is just behind the plane (for [`ExitPlane::START`], in which it starts).
///
/// At a split s of axis j the point's coordinate O_j + D_j run / slope is compared with s as products.
pub fn descend(arithmetic: &impl VectorArithmetic, stage: &TwinStage, ray: &TwinRay, exit: &ExitPlane) -> Packet {
    // Both sides times the exit's slope, so that nothing is divided: (s - O_j) |D_k| against D_j run_k. At run 3, slope 2 and D_j = 4 the
    // ray is 6 along axis j, and a split 5 away (5 x 2 = 10) is behind it (4 x 3 = 12).
    let runs = ray.direction.map(|direction| arithmetic.wide_product(exit.run, direction));
    stage.descend(|axis, at| {
        let split = arithmetic.wide_product(arithmetic.minus(at, ray.origin[axis]), exit.slope);
        match split.cmp(&runs[axis]) {
            Ordering::Less => true,
            Ordering::Greater => false,
            // Behind a plane that is crossed lies the side to which the ray goes, ahead of one that is not the other.
            Ordering::Equal => has_crossed(ray, exit, axis, at) != ray.is_backwards(axis),
        }
    })
}

/// A split that is met together with the exit plane is met before it, the direction being moved by (e, e^2, e^3).
fn has_crossed(ray: &TwinRay, exit: &ExitPlane, axis: usize, at: i32) -> bool {
    match axis.cmp(&exit.axis) {
        _ if at == ray.origin[axis] => true,
        Ordering::Equal => true,
        Ordering::Less => !ray.is_backwards(axis),
        Ordering::Greater => ray.is_backwards(exit.axis),
    }
}

/// The packet in which a ray starts that starts inside the scene's box.
pub fn own_packet(arithmetic: &impl VectorArithmetic, stage: &TwinStage, ray: &TwinRay) -> Packet {
    descend(arithmetic, stage, ray, &ExitPlane::START)
}
