//! The kernels of `report` with two of the buffers of its section 6.2: while one triangle is tested, the
//! next one comes, of the same packet to the same buffer, of the packet behind to the other.

use scenes::kdtree::{BuildMethod, DEPTH, Depth};
use scenes::layout::Layout;

use super::{Decisions, Formulas, SetAnswers, Team, file};
use crate::function::Function;
use crate::prelude::WalkMemory;
use crate::skip::Skip;

/// The set's answers. Its search asks for triangles ahead, and its tests of a packet go along with that; when the user replaces one of the two, both
/// are those of `report`.
pub(super) static SET: SetAnswers = SetAnswers {
    name: "prefetched",
    layout: Layout::Report,
    tree: (Depth::Levels(DEPTH), BuildMethod::Report),
    base: Some(super::KernelSet::Report),
    compared_with: Some(super::KernelSet::Buffered),
    files: &[],
    teams: &[Team {
        members: &[
            (Function::Trace, Some(file!("prefetched/trace.s"))),
            (Function::Packet, Some(file!("prefetched/packet.s"))),
        ],
    }],
    walk: WalkMemory::Restart,
    walk_alone: WalkMemory::Restart,
    loads_ahead: true,
    decisions: Decisions::Rounded,
    formulas: Formulas::Printed,
    skips: &[Skip::Features, Skip::Weightless, Skip::Unlit, Skip::AnyHit, Skip::Beyond],
    refuses_packed: super::report::SET.refuses_packed,
};
