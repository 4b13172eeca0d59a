//! Assembler and disassembler of lancer: text to [`isa::Program`] and words back to text. What an instruction is comes
//! from the rows of [`isa::Isa`] alone; this crate knows the language around them and runs nothing.

mod assembler;
mod conditional;
mod cursor;
mod data;
mod decimal;
mod definition;
pub mod directive;
mod disassembly;
mod evaluation;
pub mod explain;
mod expression;
mod frame;
mod instruction;
pub mod limits;
mod line;
mod macros;
mod message;
mod operand;
pub mod pseudo;
mod region;
mod structure;
mod symbol;
mod token;

use std::sync::Arc;

use isa::diagnostic::{Report, Source};
use isa::{Isa, Program};

pub use disassembly::disassemble;

/// Reads what `.include "name"` asks for; the second argument is the name of the including source.
pub type Loader<'a> = &'a dyn Fn(&str, &str) -> Result<Arc<Source>, String>;

/// What a source cannot say for itself.
pub struct Options<'a> {
    /// Reads included files; an error is the reason without a full stop.
    pub include: Loader<'a>,
    /// Constants that are known before the first line.
    pub defines: Vec<(String, i64)>,
    /// Number formats that are known before the first line, with their fraction bits.
    pub formats: Vec<(String, i64)>,
}

impl Default for Options<'_> {
    /// No constants, no formats, and no file can be included.
    fn default() -> Self {
        Options { include: &|_, _| Err("there are no files here".into()), defines: Vec::new(), formats: Vec::new() }
    }
}

/// A source that assembled.
#[derive(Clone, Debug)]
pub struct Assembled {
    /// Words, buffer, symbols, lines and regions.
    pub program: Program,
    /// What is likely a mistake although the program is complete.
    pub warnings: Report,
}

/// Assembles `source`.
///
/// # Errors
/// All errors of the source, its macros and the files that it includes, in the order of the text, at most
/// [`limits::MESSAGES`] of them; warnings stand among them.
pub fn assemble(source: &Arc<Source>, isa: &Isa, options: &Options) -> Result<Assembled, Report> {
    let (program, report) = assembler::assemble(source, isa, options);
    if report.has_errors() { Err(report) } else { Ok(Assembled { program, warnings: report }) }
}
