//! The kernels of `report` with two of the buffers of its section 6.2: while one triangle is tested, the
//! next one comes, of the same packet to the same buffer, of the packet behind to the other.

use super::{KernelSet, SetAnswers, Team, file, report};
use crate::function::Function;

/// The set's answers; all others are those of `report`. Its search asks for triangles ahead, and its tests of a packet go along with that; when the
/// user replaces one of the two, both are those of `report`.
pub(super) static SET: SetAnswers = SetAnswers {
    name: "prefetched",
    base: Some(KernelSet::Report),
    compared_with: Some(KernelSet::Buffered),
    files: &[],
    teams: &[Team {
        members: &[
            (Function::Trace, Some(file!("prefetched/trace.s"))),
            (Function::Packet, Some(file!("prefetched/packet.s"))),
        ],
    }],
    loads_ahead: true,
    ..report::SET
};
