//! The kernels of `report` with the buffer of its section 6.2: the triangles of a packet are fetched, up to 512 of them, and then tested.

use super::{KernelSet, SetAnswers, file, report};
use crate::function::Function;

/// The set's answers; all others are those of `report`.
pub(super) static SET: SetAnswers = SetAnswers {
    name: "buffered",
    base: Some(KernelSet::Report),
    compared_with: Some(KernelSet::Report),
    files: &[(Function::Packet, file!("buffered/packet.s"))],
    ..report::SET
};
