//! Shadows of a run as a result: what exact arithmetic on the same inputs would have given, which lines brought errors in, and of which of them
//! the final error consists. `docs/shadow.md` explains it with an example.

#[cfg(feature = "cli")]
mod numbers;
mod picture;
#[cfg(feature = "cli")]
mod program;
mod result;
#[cfg(feature = "cli")]
mod text;
mod totals;

#[cfg(feature = "cli")]
pub use numbers::{number_text, register_errors, register_numbers, ulps};
pub use picture::picture;
#[cfg(feature = "cli")]
pub use program::program;
pub use result::{DiedLine, FormatGapResult, OutputPart, ShadowFunction, ShadowLine, ShadowOutput, ShadowResult};
#[cfg(feature = "cli")]
pub use text::{died_table, shadow_text};
pub use totals::{ShadowedNumber, SourcePrograms};
