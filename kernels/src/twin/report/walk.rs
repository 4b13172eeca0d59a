//! From packet to packet by the rounded point where the ray leaves (report 5.3.4).

use isa::number::Vector;

use super::crossing::exit_face;
use crate::constants::Constants;
use crate::twin::ray::{Packet, TwinRay, TwinSearch};
use crate::twin::stage::TwinStage;
use crate::twin::vector_arithmetic::VectorArithmetic;

/// From the root down to the packet that has a point; in the plane of a split the ray's direction decides.
pub fn descend(stage: &TwinStage, ray: &TwinRay, point: Vector) -> Packet {
    stage.descend(|axis, at| point[axis] > at || point[axis] == at && !ray.is_backwards(axis))
}

/// The packet in which a ray starts that starts inside the scene's box.
pub fn own_packet(stage: &TwinStage, ray: &TwinRay) -> Packet {
    descend(stage, ray, ray.origin)
}

/// The packet after the current one; `None` when the search is over: the ray leaves the scene, or the nearest hit is nearer than the exit.
pub fn next_packet(
    arithmetic: &impl VectorArithmetic,
    constants: &Constants,
    stage: &TwinStage,
    ray: &TwinRay,
    packet: &Packet,
    search: &TwinSearch,
) -> Option<Packet> {
    let exit = exit_face(arithmetic, constants, ray, &packet.bounds);
    if (search.takes_any || search.triangle.is_some()) && search.t < exit.t {
        return None;
    }
    let outer = match exit.axis {
        3 => 0,
        axis if ray.is_backwards(axis) => stage.bounds.low[axis],
        axis => stage.bounds.high[axis],
    };
    (outer != exit.plane).then(|| descend(stage, ray, exit.point))
}
