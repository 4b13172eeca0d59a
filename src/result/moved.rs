//! Octets that were moved by kind of data, which with a cache are others than those that were asked for.

use emu::machine::{KindUse, RunOutcome};

use super::ByKind;
use crate::job::Job;

/// Octets over the bus, and beside it, by kind of data: those that were asked for, but of the kind in the caches the lines that were filled
/// instead of the reads.
///
/// For example 900 octets of nodes asked of caches that filled 400, and 100 of triangles: 400 of nodes and 100 of triangles were moved.
pub(super) fn moved_kinds(job: &Job, frame: &RunOutcome) -> ByKind {
    let moved = |kind: &KindUse| match kind.kind == job.machine.cache.kind {
        true => (kind.octets.0 + frame.cache.filled.0).saturating_sub(frame.cache.asked.0),
        false => kind.octets.0,
    };
    ByKind(frame.kinds.iter().map(|kind| (kind.kind.clone(), moved(kind))).collect())
}
