#![doc = include_str!("../docs/library.md")]

pub mod accuracy;
pub mod annex;
#[cfg(feature = "cli")]
pub mod arguments;
pub mod benchmark;
#[cfg(feature = "cli")]
pub mod command;
pub mod cores;
#[cfg(feature = "cli")]
pub mod difference;
pub mod drawing;
pub mod energy;
pub mod extension;
pub mod failure;
pub mod files;
pub mod input;
pub mod job;
pub mod load;
pub mod machine;
#[cfg(feature = "cli")]
pub mod manual;
pub mod message;
pub mod numeral;
pub mod profiles;
pub mod result;
pub mod settings;
pub mod skips;
pub mod stress;
#[cfg(feature = "cli")]
pub mod summary;
pub mod sweep;
#[cfg(feature = "cli")]
pub mod table;
#[cfg(feature = "cli")]
pub mod terminal;
#[cfg(feature = "cli")]
pub mod trace;

pub use drawing::{Drawing, draw, render};
pub use emu::machine::Config as MachineConfig;
pub use failure::Failure;
pub use files::picture::PictureFormat;
pub use input::scene;
pub use job::Job;
pub use kernels::KernelSet;
pub use result::Render;
