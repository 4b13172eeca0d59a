//! The ray-tracing kernels: their assembly, how a scene's constants reach it, which file serves which function, and their bit-exact twins
//! in Rust.
//! What a word does is said in `emu`, what a scene is in `scenes`.

pub mod annex;
pub mod build;
pub mod constants;
pub mod function;
pub mod prelude;
pub mod set;
pub mod skip;
pub mod twin;

pub use build::{Build, KernelOptions, build};
pub use function::Function;
pub use set::KernelSet;
pub use skip::{Skip, Skips};
