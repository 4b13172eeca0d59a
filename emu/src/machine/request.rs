//! Requests of a processor to the machine.

use crate::code::quantity::Octets;

/// Access of a transfer to global memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// A block is copied to the buffer.
    Load,
    /// Words are read.
    Read,
    /// Words are written, or read and written.
    Write,
}

/// Request that a core waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Request {
    /// A transfer between it and global memory.
    Transfer {
        /// First octet in global memory.
        address: u32,
        /// Octets that go over the bus.
        octets: Octets,
        /// Access to global memory.
        access: Access,
    },
    /// A message to another processor.
    Send {
        /// The receiver.
        to: u32,
        /// Octets that go over the bus.
        octets: Octets,
    },
    /// A message for it.
    Receive,
    /// The others, at a barrier.
    Barrier,
}
