//! The command line as a user meets it: the built program, its streams, its exit codes and the files that it leaves.

mod advise;
mod annex;
mod bench;
mod clocks;
mod comparisons;
mod convert;
mod cores;
mod debug;
mod demo;
mod extensions;
mod files;
mod help;
mod messages;
mod numbers;
mod programs;
mod render;
mod report;
mod scene;
mod schema;
pub mod session;
mod settings;
mod standard;
mod streams;
mod sweep;
mod trace;
mod width;
