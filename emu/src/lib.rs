//! Machine of lancer: words to effects, time and counts. It knows no assembly text, no scene and no picture.

pub mod code;
pub mod engine;
pub mod exec;
pub mod machine;
pub mod meaning;
pub mod octets;
mod order;
pub mod profile;
pub mod quantity;
pub mod registers;
pub mod replay;
mod run;
mod splice;
pub mod tally;
pub mod timing;
pub mod trap;

pub use replay::count;
pub use run::{run, run_all, step};
