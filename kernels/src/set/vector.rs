//! The kernels in vector and wide rows: exact products, one rounding at the end.

use scenes::kdtree::{BuildMethod, Depth};
use scenes::layout::Layout;

use super::{Decisions, Formulas, SetAnswers, file};
use crate::function::Function;
use crate::prelude::WalkMemory;
use crate::skip::Skip;

/// The set's answers.
pub(super) static SET: SetAnswers = SetAnswers {
    name: "vector",
    layout: Layout::Wide,
    tree: (Depth::Auto, BuildMethod::Binned),
    base: None,
    compared_with: Some(super::KernelSet::Report),
    files: &[
        (Function::Pixel, file!("vector/pixel.s")),
        (Function::RayTree, file!("vector/ray_tree.s")),
        (Function::Contribution, file!("vector/contribution.s")),
        (Function::Trace, file!("vector/trace.s")),
        (Function::Packet, file!("vector/packet.s")),
        (Function::Triangle, file!("vector/triangle.s")),
        (Function::NextPacket, file!("vector/next_packet.s")),
        (Function::ExitFace, file!("vector/exit_face.s")),
        (Function::Descend, file!("vector/descend.s")),
        (Function::OwnPacket, file!("vector/own_packet.s")),
        (Function::Surface, file!("vector/surface.s")),
        (Function::Normal, file!("vector/normal.s")),
        (Function::Unit, file!("vector/unit.s")),
        (Function::Sqrt, file!("vector/sqrt.s")),
        (Function::Shade, file!("vector/shade.s")),
        (Function::Reflects, file!("vector/reflects.s")),
        (Function::Reflect, file!("vector/reflect.s")),
        (Function::Refracts, file!("vector/refracts.s")),
        (Function::Refract, file!("vector/refract.s")),
        (Function::Dispatch, file!("vector/dispatch.s")),
        (Function::Interpolate, file!("vector/interpolate.s")),
        (Function::FirstPacket, file!("vector/first_packet.s")),
    ],
    teams: &[],
    walk: WalkMemory::Boxes,
    walk_alone: WalkMemory::Boxes,
    loads_ahead: false,
    decisions: Decisions::Wide,
    formulas: Formulas::Vector,
    skips: Skip::ALL,
    refuses_packed: None,
};
