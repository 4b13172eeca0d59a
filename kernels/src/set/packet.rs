//! The kernels in the rows that meet a whole packet and walk down several levels, else as those of `ray`.

use scenes::kdtree::{BuildMethod, Depth};
use scenes::layout::Layout;

use super::{Decisions, Formulas, SetAnswers, Team, file};
use crate::function::Function;
use crate::prelude::WalkMemory;
use crate::skip::Skip;

/// The set's answers. Its search is one loop; when the user replaces a part of it, the search is that of the files that stand alone. A packet comes
/// whole, so that nobody asks whether a triangle of it was met before, and a triangle that was hit comes whole, too.
pub(super) static SET: SetAnswers = SetAnswers {
    name: "packet",
    layout: Layout::Packet,
    tree: (Depth::Auto, BuildMethod::Binned),
    base: Some(super::KernelSet::Ray),
    compared_with: Some(super::KernelSet::Ray),
    files: &[],
    teams: &[Team {
        members: &[
            (Function::Trace, Some(file!("packet/trace.s"))),
            (Function::Packet, None),
            (Function::Triangle, None),
            (Function::NextPacket, None),
            (Function::ExitFace, None),
            (Function::Descend, Some(file!("packet/descend.s"))),
            (Function::OwnPacket, Some(file!("ray/own_packet.s"))),
            (Function::FirstPacket, Some(file!("ray/first_packet.s"))),
        ],
    }],
    walk: WalkMemory::Blocks,
    walk_alone: WalkMemory::Boxes,
    loads_ahead: false,
    decisions: Decisions::Exact,
    formulas: Formulas::Vector,
    skips: &[Skip::Features, Skip::Weightless, Skip::Unlit, Skip::AnyHit, Skip::Missed, Skip::Beyond, Skip::Empty],
    refuses_packed: None,
};
