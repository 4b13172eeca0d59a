//! Fixed-point numbers of IEEE 1666 (SystemC) on unbounded integers: what an operation gives in any format, and vectors of operands and
//! results that come from elsewhere. It is written from the definitions of the modes, not from the machine's arithmetic, whose model it is.

mod operation;
#[cfg(test)]
mod tests;
mod vector;

pub use operation::{Format, Number, Operation, OperationOutcome, operate};
pub use vector::{HEADER, TestVector, parse};
