//! Which variants are worth their clocks: those that no other one beats in clocks and error both.

use super::MeasuredVariant;

/// Says of each variant whether it is on the front of its scene, and if not, which one beats it: of clocks and error (the root of the mean
/// square difference) neither is larger, and one is smaller. Of several the first is named that is itself on the front.
pub fn rank(measured: &mut [MeasuredVariant]) {
    let costs: Vec<(String, f64, f64)> =
        measured.iter().map(|one| (one.scene.clone(), one.clocks, one.error.rmse)).collect();
    let beats = |other: usize, here: usize| {
        let ((other_scene, other_clocks, other_error), (scene, clocks, error)) = (&costs[other], &costs[here]);
        let is_better = other_clocks < clocks || other_error < error;
        other_scene == scene && other_clocks <= clocks && other_error <= error && is_better
    };
    let all = 0..measured.len();
    // A variant is on the front when no other beats it.
    let is_on_front: Vec<bool> = all.clone().map(|here| !all.clone().any(|other| beats(other, here))).collect();
    // Name one that does and is on the front itself; there always is one, since beating is transitive.
    for here in all.clone() {
        let by = all.clone().find(|&other| is_on_front[other] && beats(other, here));
        measured[here].is_on_front = is_on_front[here];
        measured[here].dominated_by = by.map(|by| measured[by].variant.clone());
    }
}
