//! Instructions that are loaded for a run: what they do, count and report, against their bodies written out in registers of the program.

#[path = "extension/mod.rs"]
mod extension;
