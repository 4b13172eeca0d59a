//! Worth of an extension: what its file makes one suspect, and a scene drawn without and with it.

mod comparison;
mod file;
mod findings;
mod suggestion;
#[cfg(feature = "cli")]
mod text;

pub use comparison::{ExtensionResult, SCHEMA, VariantResult, compare};
pub use file::{extend, extend_by};
pub use findings::findings;
pub use suggestion::{SUGGESTION_SCHEMA, Suggestion, SuggestionResult, Suggestions, suggest};
