//! What an instruction is, and its arithmetic.

pub mod diagnostic;
