//! The assembler as its users see it: the language, messages, limits, outputs, and what holds for all sources.

mod diagnostics;
mod language;
mod limits;
mod outputs;
mod properties;
