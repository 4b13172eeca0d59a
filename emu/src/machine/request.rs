//! Requests of a processor to the machine.

use crate::code::quantity::Octets;

/// What a transfer does with global memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// It copies a block to the buffer.
    Load,
    /// It reads a word.
    Read,
    /// It writes, or reads and writes.
    Write,
}

/// What a core waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Request {
    /// A transfer between it and global memory.
    Transfer {
        /// First octet in global memory.
        address: u32,
        /// Octets that go over the bus.
        octets: Octets,
        /// What it does.
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
