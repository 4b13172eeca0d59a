//! The kernels of `report` with the buffer of its section 6.2: the triangles of a packet are fetched, up to 512 of them, and then tested.

use scenes::kdtree::{BuildMethod, DEPTH, Depth};
use scenes::layout::Layout;

use super::{Decisions, Formulas, SetAnswers, file};
use crate::function::Function;
use crate::prelude::WalkMemory;
use crate::skip::Skip;

/// The set's answers.
pub(super) static SET: SetAnswers = SetAnswers {
    name: "buffered",
    layout: Layout::Report,
    tree: (Depth::Levels(DEPTH), BuildMethod::Report),
    base: Some(super::KernelSet::Report),
    compared_with: Some(super::KernelSet::Report),
    files: &[(Function::Packet, file!("buffered/packet.s"))],
    teams: &[],
    walk: WalkMemory::Restart,
    walk_alone: WalkMemory::Restart,
    loads_ahead: false,
    decisions: Decisions::Rounded,
    formulas: Formulas::Printed,
    skips: &[Skip::Features, Skip::Weightless, Skip::Unlit, Skip::AnyHit, Skip::Beyond],
    refuses_packed: super::report::SET.refuses_packed,
};
