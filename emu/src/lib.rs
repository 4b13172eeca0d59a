//! Machine of lancer: words to effects, time and counts. It knows no assembly text, no scene and no picture.

//!
//! Its wings, each of which uses only those before it: [`code`] (programs decoded, and the state that they work on), [`semantics`] (what
//! instructions do), [`extension`] (the same in Rust, for instructions of extensions), [`profile`], [`engine`] (whatever executes programs),
//! [`machine`] (cores and the bus on their clocks), [`replay`] (work items run once and put on the clock afterwards), [`run()`] (the front
//! door), [`inject`] (faults on purpose), [`shadow`] (real numbers beside the machine's), [`stepper`] (a lone core instruction by instruction) and
//! [`conformance`] (trials of extensions in Rust).

pub mod code;
pub mod conformance;
pub mod engine;
pub mod extension;
pub mod inject;
pub mod machine;
pub mod profile;
pub mod replay;
mod run;
pub mod semantics;
pub mod shadow;
pub mod stepper;

pub use code::{octets, quantity, registers, tally, timing, trap};
pub use replay::{count, weigh};
pub use run::{machines_at_once, run, run_all, step};
