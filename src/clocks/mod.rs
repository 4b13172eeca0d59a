//! Clocks of a frame's functions as people look at them: stacks of calls with what they took, and source lines. Counting is the machine's; charts
//! and tables of what stands here are in files of their own.

mod flame;
mod lines;
mod stacks;
mod text;

pub use flame::flame;
pub use lines::{LineClocks, lines};
pub use stacks::{ClockStack, folded, stacks};
pub use text::{functions, line_table};
