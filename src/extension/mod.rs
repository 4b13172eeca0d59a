//! Worth of an extension: what its file makes one suspect, and a scene drawn without and with it.

mod comparison;
mod findings;
mod suggestion;
#[cfg(feature = "cli")]
mod text;

pub use comparison::{ExtensionResult, SCHEMA, VariantResult, compare};
pub use findings::findings;
pub use suggestion::{SUGGESTION_SCHEMA, Suggestion, SuggestionResult, Suggestions, suggest};
