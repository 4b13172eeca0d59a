//! Crossings of a ray and the planes of a box: by the formula of 3.1.1, with a division each and a rounded point.

use std::array::from_fn;

use isa::number::Vector;
use scenes::kdtree::Bounds;

use super::scalar::dot;
use super::walk::descend;
use crate::constants::Constants;
use crate::twin::ray::{Packet, TwinRay};
use crate::twin::stage::TwinStage;
use crate::twin::vector_arithmetic::VectorArithmetic;

/// Exit of a ray from a packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExitPoint {
    /// Axis of the plane; 3 for a ray without a direction, which leaves by none.
    pub axis: usize,
    /// Coordinate of the plane, raw; 0 where there is none.
    pub plane: i32,
    /// Distance along the ray.
    pub t: i32,
    /// The point, in the packet and on the plane.
    pub point: Vector,
}

/// A crossing of a ray with a plane.
struct PlaneCrossing {
    axis: usize,
    plane: i32,
    /// s = n . (V0 - P0) / n . u.
    t: i32,
    /// P0 + s u, with each component rounded.
    point: Vector,
    /// n . u: positive where the ray leaves by the plane.
    slope: i32,
}

/// The crossings with the six planes of a box, those that are parallel to the ray left out: by axis, the plane of small coordinates first.
fn crossings(
    arithmetic: &impl VectorArithmetic,
    constants: &Constants,
    ray: &TwinRay,
    bounds: &Bounds,
) -> impl Iterator<Item = PlaneCrossing> {
    let (bits, along) = (constants.formats.direction, constants.along());
    let planes = (0..3).flat_map(move |axis| [(axis, -1, bounds.low), (axis, 1, bounds.high)]);
    planes.filter_map(move |(axis, side, corner)| {
        let mut outward = [0; 3];
        outward[axis] = side << bits;
        let slope = dot(arithmetic, outward, ray.direction, bits);
        if slope == 0 {
            return None;
        }
        let ahead = dot(arithmetic, outward, arithmetic.difference(corner, ray.origin), bits);
        let t = arithmetic.quotient(i128::from(ahead) << along, slope.into());
        let point = arithmetic.sum(ray.origin, arithmetic.scaled(ray.direction, t, along));
        Some(PlaneCrossing { axis, plane: corner[axis], t, point, slope })
    })
}

/// The nearest of the crossings by which the ray leaves; of equal ones the last. Each point is brought into the packet.
pub fn exit_face(
    arithmetic: &impl VectorArithmetic,
    constants: &Constants,
    ray: &TwinRay,
    bounds: &Bounds,
) -> ExitPoint {
    let mut exit = ExitPoint { axis: 3, plane: 0, t: constants.missed, point: [0; 3] };
    for PlaneCrossing { axis, plane, t, mut point, slope } in crossings(arithmetic, constants, ray, bounds) {
        if slope > 0 && t <= exit.t {
            point = from_fn(|k| point[k].max(bounds.low[k]).min(bounds.high[k]));
            point[axis] = plane;
            exit = ExitPoint { axis, plane, t, point };
        }
    }
    exit
}

/// The first packet of a ray that may start outside the scene's box; `None` when no crossing lies in the box's surface. The nearest one
/// that does is where the ray enters (report, pseudo code 4).
pub fn first_packet(
    arithmetic: &impl VectorArithmetic,
    constants: &Constants,
    stage: &TwinStage,
    ray: &TwinRay,
) -> Option<Packet> {
    let bounds = &stage.bounds;
    let is_between = |point: Vector, k: usize| (bounds.low[k]..=bounds.high[k]).contains(&point[k]);
    if (0..3).all(|k| is_between(ray.origin, k)) {
        return Some(descend(stage, ray, ray.origin));
    }
    let mut nearest = None;
    for PlaneCrossing { axis, plane, t, mut point, .. } in crossings(arithmetic, constants, ray, bounds) {
        point[axis] = plane;
        let is_valid = t > 0 && (0..3).all(|k| is_between(point, k));
        if is_valid && nearest.is_none_or(|(nearest, _)| t <= nearest) {
            nearest = Some((t, point));
        }
    }
    nearest.map(|(_, point)| descend(stage, ray, point))
}
