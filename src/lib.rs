//! lancer's command line as a library: from scene files through the emulated coprocessor to pictures, counts and
//! tables. What a command prints is decided here; what it computes, in the crates below.

pub mod accuracy;
pub mod annex;
pub mod arguments;
pub mod benchmark;
pub mod command;
pub mod drawing;
pub mod extension;
pub mod failure;
pub mod files;
pub mod input;
pub mod job;
pub mod load;
pub mod machine;
pub mod manual;
pub mod profiles;
pub mod result;
pub mod savings;
pub mod scaling;
pub mod stress;
pub mod summary;
pub mod table;
pub mod terminal;
pub mod trace;
