//! Entry of a camera ray into the scene (report, pseudo code 4).

use std::array::from_fn;

use super::descend::descend;
use super::exit_face::runs;
use super::ray::{ExitPlane, Packet, TwinRay};
use super::stage::TwinStage;
use super::vector_arithmetic::VectorArithmetic;

/// The first packet of a ray that may start outside the scene's box; `None` when it misses the box.
///
/// The last of the planes that it enters by has to come before the first that it leaves by; of planes of axes a < b met at the same t,
/// a is the later one exactly when the direction along a is negative.
pub fn first_packet(arithmetic: &impl VectorArithmetic, stage: &TwinStage, ray: &TwinRay) -> Option<Packet> {
    let (low, high) = (stage.bounds.low, stage.bounds.high);
    let near = from_fn(|k| if ray.is_backwards(k) { high[k] } else { low[k] });
    let far = from_fn(|k| if ray.is_backwards(k) { low[k] } else { high[k] });
    let (enter, leave) = (runs(arithmetic, ray, near), runs(arithmetic, ray, far));
    if leave.iter().any(|&run| run <= 0) {
        return None;
    }
    let mut entry = ExitPlane::START;
    for k in (0..3).filter(|&k| enter[k] > 0) {
        if ray.steep[k] == 0 {
            return None;
        }
        let met = arithmetic.wide_product(enter[k], entry.slope);
        let last = arithmetic.wide_product(entry.run, ray.steep[k]);
        if met > last || met == last && !ray.is_backwards(entry.axis) {
            entry = ExitPlane { axis: k, plane: near[k], run: enter[k], slope: ray.steep[k] };
        }
    }
    let is_before =
        |k: usize| arithmetic.wide_product(entry.run, ray.steep[k]) < arithmetic.wide_product(leave[k], entry.slope);
    (0..3).all(is_before).then(|| descend(arithmetic, stage, ray, &entry))
}
