//! The ray-tracing kernels: their assembly, how a scene's constants reach it, and which file serves which function.
//! What a word does is said in `emu`, what a scene is in `scenes`.

pub mod annex;
pub mod build;
pub mod function;
pub mod prelude;

pub use build::{Build, Options, build};
pub use function::{Function, Profile};
