//! Shadows: beside each number of a program the real number that exact arithmetic on the same inputs would have given. Decisions are the
//! machine's; the shadow says where it would have taken others.
//!
//! A [`Shadow`] watches one core on the interpreter: it sees the operands of an instruction before it is executed and its results afterwards.
//! The formulas are in `rows`, one a row of the table. [`frame`] watches all processors of a picture.

pub mod frame;
pub mod ledger;
mod long_real;
#[cfg(test)]
mod long_real_tests;
mod memory;
mod number;
mod parts;
mod program;
mod rows;
mod settle;
mod watcher;

pub use frame::ShadowFrame;
pub use ledger::{FormatGap, LargestError, LineErrors, ShadowLedger, ShadowSite, ShadowSites};
pub use long_real::LongReal;
pub use memory::ShadowMemory;
pub use number::{Deviation, ShadowNumber};
pub use parts::ErrorParts;
pub use program::ShadowProgram;
pub use watcher::{MessageVector, Shadow, ShadowLetter};
