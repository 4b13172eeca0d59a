//! Exit of a ray from a packet, without division.

use std::array::from_fn;

use scenes::kdtree::Bounds;

use super::ray::{ExitPlane, TwinRay};
use super::vector_arithmetic::VectorArithmetic;

/// The nearest of the three planes ahead of a ray that is in a box.
///
/// Of planes of axes a < b met at the same t, a is first exactly when the direction along a is positive.
pub fn exit_face(arithmetic: &impl VectorArithmetic, ray: &TwinRay, bounds: &Bounds) -> ExitPlane {
    let plane = from_fn(|k| if ray.is_backwards(k) { bounds.low[k] } else { bounds.high[k] });
    let run = runs(arithmetic, ray, plane);
    let axis = (1..3).fold(0, |first, k| {
        // run_a / |D_a| against run_b / |D_b| as products, so an axis along which the ray does not move is never the first.
        let met = arithmetic.wide_product(run[first], ray.steep[k]);
        let other = arithmetic.wide_product(run[k], ray.steep[first]);
        if other < met || other == met && ray.is_backwards(first) { k } else { first }
    });
    ExitPlane { axis, plane: plane[axis], run: run[axis], slope: ray.steep[axis] }
}

/// Distances of planes ahead of a ray's origin, each along its axis.
pub(super) fn runs(arithmetic: &impl VectorArithmetic, ray: &TwinRay, plane: [i32; 3]) -> [i32; 3] {
    let ahead = arithmetic.difference(plane, ray.origin);
    from_fn(|k| if ray.is_backwards(k) { arithmetic.negative(ahead[k]) } else { ahead[k] })
}
