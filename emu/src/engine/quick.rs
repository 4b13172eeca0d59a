//! Reads of global memory that an engine does by itself, and tells the link of later.

use std::mem::offset_of;

/// A read of global memory that was done.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotedRead {
    /// Clocks since the transfer before it.
    pub clocks: u32,
    /// Slot of the instruction.
    pub slot: u32,
    /// First octet.
    pub address: u32,
    /// Octets.
    pub octets: u32,
    /// Calling context, where clocks of functions are measured; else 0.
    pub context: u32,
}

impl NotedRead {
    /// Places of the fields, in octets, in their order.
    pub const OFFSETS: [i32; 5] = [
        offset_of!(NotedRead, clocks) as i32,
        offset_of!(NotedRead, slot) as i32,
        offset_of!(NotedRead, address) as i32,
        offset_of!(NotedRead, octets) as i32,
        offset_of!(NotedRead, context) as i32,
    ];
}

/// A link whose memory may be read directly, as long as it is told of that in the end.
///
/// This is asked for behind the first receive of a work item, whose way there depends on nothing.
pub trait Quick {
    /// Global memory, if it lies in one piece.
    fn memory(&self) -> Option<&[u8]>;

    /// The range around an address whose data are of one kind: its first address, its length, and the kind.
    fn kind(&mut self, address: u32) -> (u32, u32, u32);

    /// Adds octets that were read of a kind.
    fn add(&mut self, kind: u32, octets: u64);

    /// Keeps reads, of which the last one was at a clock; false where there is no room, so that the item is in vain.
    fn keep(&mut self, reads: &[NotedRead], before: u64) -> bool;

    /// Clock of the last transfer.
    fn before(&self) -> u64;
}
