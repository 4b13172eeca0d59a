//! The kernels in the rows of the ray unit, with the files of `vector` for what is not about rays.

use scenes::kdtree::{BuildMethod, Depth};
use scenes::layout::Layout;

use super::{Decisions, Formulas, SetAnswers, Team, file};
use crate::function::Function;
use crate::prelude::WalkMemory;
use crate::skip::Skip;

/// The set's answers.
pub(super) static SET: SetAnswers = SetAnswers {
    name: "ray",
    layout: Layout::Wide,
    tree: (Depth::Auto, BuildMethod::Binned),
    base: Some(super::KernelSet::Vector),
    compared_with: Some(super::KernelSet::Vector),
    files: &[(Function::Triangle, file!("ray/triangle.s")), (Function::ExitFace, file!("ray/exit_face.s"))],
    teams: &[
        Team { members: &[(Function::Packet, Some(file!("ray/packet.s"))), (Function::Triangle, None)] },
        Team {
            members: &[
                (Function::Trace, Some(file!("ray/trace.s"))),
                (Function::NextPacket, Some(file!("ray/next_packet.s"))),
                (Function::ExitFace, None),
                (Function::Descend, Some(file!("ray/descend.s"))),
                (Function::OwnPacket, Some(file!("ray/own_packet.s"))),
                (Function::FirstPacket, Some(file!("ray/first_packet.s"))),
            ],
        },
    ],
    walk: WalkMemory::Planes,
    walk_alone: WalkMemory::Boxes,
    loads_ahead: false,
    decisions: Decisions::Exact,
    formulas: Formulas::Vector,
    skips: Skip::ALL,
    refuses_packed: None,
};
