//! The kernels as the report prints them: every triangle of a packet is tested, whole, and each search starts at the root.

use scenes::kdtree::{BuildMethod, DEPTH, Depth};
use scenes::layout::Layout;

use super::{Decisions, Formulas, SetAnswers, file};
use crate::function::Function;
use crate::prelude::WalkMemory;
use crate::skip::Skip;

/// The set's answers. The main processor's `dispatch` and `interpolate`, which the report does not have, are those of `vector`.
pub(super) static SET: SetAnswers = SetAnswers {
    name: "report",
    layout: Layout::Report,
    tree: (Depth::Levels(DEPTH), BuildMethod::Report),
    base: Some(super::KernelSet::Vector),
    compared_with: None,
    files: &[
        (Function::Pixel, file!("report/pixel.s")),
        (Function::RayTree, file!("report/ray_tree.s")),
        (Function::Contribution, file!("report/contribution.s")),
        (Function::Trace, file!("report/trace.s")),
        (Function::Packet, file!("report/packet.s")),
        (Function::Triangle, file!("report/triangle.s")),
        (Function::NextPacket, file!("report/next_packet.s")),
        (Function::ExitFace, file!("report/exit_face.s")),
        (Function::Descend, file!("report/descend.s")),
        (Function::OwnPacket, file!("report/own_packet.s")),
        (Function::Surface, file!("report/surface.s")),
        (Function::Normal, file!("report/normal.s")),
        (Function::Unit, file!("report/unit.s")),
        (Function::Sqrt, file!("report/sqrt.s")),
        (Function::Shade, file!("report/shade.s")),
        (Function::Reflects, file!("report/reflects.s")),
        (Function::Reflect, file!("report/reflect.s")),
        (Function::Refracts, file!("report/refracts.s")),
        (Function::Refract, file!("report/refract.s")),
        (Function::FirstPacket, file!("report/first_packet.s")),
    ],
    teams: &[],
    walk: WalkMemory::Restart,
    walk_alone: WalkMemory::Restart,
    loads_ahead: false,
    decisions: Decisions::Rounded,
    formulas: Formulas::Printed,
    skips: &[Skip::Features, Skip::Weightless, Skip::Unlit, Skip::AnyHit, Skip::Beyond],
    refuses_packed: Some(
        "they read structures octet by octet, as the report prints them, and the report has no rows that unpack fields of few bits",
    ),
};
