//! Faults on purpose: bits flip at a place and a moment, and only what they could touch is run again. How a fault is counted and shown is not
//! said here. Faults of grants are put into the whole machine, whose work items are replayed.
//!
//! A frame without a fault is run once ([`GoldenFrame`]). A work item begins from reset, so its beginning is a checkpoint: a flip in registers,
//! buffer, a result or on the bus runs one work item again, one in a program or in global memory those that execute or read the word. Only
//! where one of them answers otherwise the main processor is run again, with all other answers as they were.

mod flip;
mod frame;
mod golden;
mod grants;
mod injector;
mod item;
mod link;
mod main_link;
mod protection;

pub use flip::{BitFlip, FlipPattern, FlipShape, REGISTER_WORDS, RegisterWord};
pub use frame::HangLimit;
pub use golden::{GoldenFrame, GoldenTotals, GuestLimits, MOST_TRANSFERS};
pub use injector::{FlipRequest, InjectedEnd, InjectedFlip, inject, inject_at};
pub use item::FlipHit;
pub use link::{BusWord, ItemTraffic};
pub use protection::{RETRY_CLOCKS, SeenFlip};

pub use crate::machine::{FaultKind, Protection};
