//! A debugger that goes back: a program or the work item of a pixel on a lone core, whose state after n instructions is a function of the settings
//! and of n. The session moves; commands and the Debug Adapter Protocol are doors to it.

mod checkpoints;
mod command;
mod condition;
pub mod dap;
mod disassembly;
mod door;
mod memory;
mod motion;
mod place;
#[cfg(feature = "full")]
mod screen;
mod session;
mod shadow;
mod stop;
mod target;
mod trial;

pub use command::{COMMANDS, DebugCommand};
pub use door::{Answer, Door};
#[cfg(feature = "full")]
pub use screen::DebugScreen;
pub use session::{Direction, Session, StopReason};
pub use target::DebugTarget;
