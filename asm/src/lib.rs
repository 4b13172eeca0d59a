//! Assembler and disassembler of lancer: text to [`isa::Program`] and words back to text. What an instruction is comes
//! from the rows of [`isa::Isa`] alone; this crate knows the language around them and runs nothing.
//!
//! The language is described in [`LANGUAGE`]; its parts are data: [`directive::DIRECTIVES`], [`pseudo::PSEUDOS`],
//! [`function::FUNCTIONS`], and the messages in [`explain::CODES`].

mod assembler;
mod computed;
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
pub mod extension;
mod foreign;
mod frame;
pub mod function;
pub mod hex;
mod holding;
mod include;
mod instruction;
pub mod limits;
mod line;
mod listing;
mod live_name;
mod macros;
mod map;
mod message;
pub mod object;
mod operand;
mod operator;
pub mod pseudo;
pub mod real;
mod region;
mod statement;
mod structure;
mod symbol;
mod token;

use std::sync::Arc;

use isa::{Isa, Program};
use limits::SourceLimits;
use messages::{Report, Source};

pub use disassembly::{disassemble, disassemble_program};
pub use instruction::{describe, usage};
pub use listing::listing;
pub use map::{MapEntry, NameKind, symbol_map};

/// A description of the language in Markdown; every example in it assembles.
pub const LANGUAGE: &str = include_str!("language.md");

/// Reads what `.include "name"` asks for; the second argument is the name of the including source.
pub type Loader<'a> = &'a dyn Fn(&str, &str) -> Result<Arc<Source>, String>;

/// Settings that a source cannot make for itself.
pub struct Options<'a> {
    /// Reads included files; an error is the reason without a full stop.
    pub include: Loader<'a>,
    /// Constants that are known before the first line.
    pub defines: Vec<(String, i64)>,
    /// Number formats that are known before the first line, with their fraction bits.
    pub formats: Vec<(String, i64)>,
    /// Work that the source may ask for.
    pub limits: SourceLimits,
}

impl Default for Options<'_> {
    /// No constants, no formats, no file can be included, and the largest limits.
    fn default() -> Self {
        Options {
            include: &|_, _| Err("there are no files here".into()),
            defines: Vec::new(),
            formats: Vec::new(),
            limits: SourceLimits::default(),
        }
    }
}

/// A source that assembled.
#[derive(Clone, Debug)]
pub struct Assembled {
    /// Words, buffer, symbols, lines and regions.
    pub program: Program,
    /// Warnings: likely mistakes, although the program is complete.
    pub warnings: Report,
    /// All names, in the order in which they were first seen.
    pub symbols: Vec<MapEntry>,
}

/// An assembly that may have failed, for listings; the program is whole when the report has no errors.
#[derive(Clone, Debug)]
pub struct Attempt {
    /// The words that were assembled; a statement that is wrong counts as words of zeros.
    pub program: Program,
    /// All errors and warnings.
    pub report: Report,
    /// All names that have a value.
    pub symbols: Vec<MapEntry>,
    pub(crate) records: Vec<listing::Record>,
}

impl Attempt {
    /// The program, when it is whole.
    ///
    /// # Errors
    /// The report, when it has errors.
    pub fn finish(self) -> Result<Assembled, Report> {
        if self.report.has_errors() {
            Err(self.report)
        } else {
            Ok(Assembled { program: self.program, warnings: self.report, symbols: self.symbols })
        }
    }
}

/// A name may be defined from outside, as a constant or a format.
///
/// # Errors
/// Why not, in one line: no name of the language, or the name of something else.
pub fn check_outside_name(text: &str, isa: &Isa) -> Result<(), String> {
    let is_name = text.starts_with(token::starts_name) && text.chars().all(token::continues_name);
    let what = if !is_name || text.contains('$') {
        return Err(format!("`{text}` is no name: letters, digits and `_`, no digit first"));
    } else if operand::looks_like_register(text) {
        "a register"
    } else if function::is_function(text) {
        "a function of expressions"
    } else if isa.ops().any(|op| *isa.definition(op).name == *text) || pseudo::find(text).is_some() {
        "an instruction"
    } else {
        return Ok(());
    };
    Err(format!("`{text}` is {what}: choose another name"))
}

/// Assembles `source`.
///
/// # Errors
/// All errors of the source, its macros and the files that it includes, in the order of the text, at most
/// [`limits::MESSAGES`] of them; warnings stand among them.
pub fn assemble(source: &Arc<Source>, isa: &Isa, options: &Options) -> Result<Assembled, Report> {
    attempt(source, isa, options).finish()
}

/// Assembles `source` as far as possible, so that [`listing`] can show it whatever its errors.
pub fn attempt(source: &Arc<Source>, isa: &Isa, options: &Options) -> Attempt {
    assembler::assemble(source, isa, options)
}
