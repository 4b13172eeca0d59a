//! Programs that tests and fuzzers generate: a builder that knows no assembly text, and generators of work that comes to an end. Nothing here
//! executes a word.

pub mod builder;
pub mod generate;
pub mod main_processor;
