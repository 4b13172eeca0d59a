//! The surfaces, by what they read.

pub mod arguments;
pub mod debugger;
pub mod engines;
pub mod machines;
pub mod meshes;
pub mod programs;
pub mod protections;
pub mod recordings;
pub mod results;
pub mod scenes;
pub mod settings;
pub mod sources;

use std::sync::Arc;

use messages::Source;

/// A source of octets, read as text as files are.
fn source(name: &str, input: &[u8]) -> Option<Arc<Source>> {
    lancer::files::source_of(std::path::Path::new(name), input.to_vec()).ok()
}
