//! Files of extensions: rows as the table of instructions has them, each with a body in assembly. What a body then does to registers is
//! the business of engines.

mod body;
mod file;
mod immediate;
mod row;
mod template;

use std::ops::Range;
use std::sync::Arc;

use isa::Isa;
use isa::extension::Summary;
use isa::table::Op;
use messages::{Diagnostic, Place, Report, Source};

pub(crate) use template::Template;

use crate::explain;

/// An instruction that was added.
#[derive(Clone, Debug)]
pub struct LoadedInstruction {
    /// The instruction's number.
    pub op: Op,
    /// Name of the extension.
    pub extension: String,
    /// The reach of its body: steps, outcomes, accesses.
    pub summary: Summary,
    /// The row in the file.
    pub row: Place,
    /// Places of the outcomes in the file.
    pub outcomes: Vec<Place>,
    /// The file says that the semantics are in Rust; there may be a body beside them.
    pub is_rust: bool,
}

/// Most instructions of all extensions of a run.
pub const MOST_INSTRUCTIONS: usize = 1024;
/// Most steps of a body.
pub const MOST_STEPS: usize = 1024;
/// Most operations of a class that an outcome may cost.
pub const MOST_COST: u64 = 1_000_000;

/// The source of a file of extensions.
///
/// # Errors
/// Octets that are not UTF-8, with their place.
pub fn source(name: &str, octets: Vec<u8>) -> Result<Arc<Source>, Report> {
    messages::refuse_packed(&octets, name)?;
    messages::refuse_utf16(&octets, name)?;
    String::from_utf8(octets).map(|text| Source::new(name, messages::with_plain_ends(text))).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let source = Source::new(name, String::from_utf8_lossy(error.as_bytes()));
        let message = format!("octet {} of the file is not UTF-8", at + 1);
        Diagnostic::error(message)
            .code(explain::CHARACTER)
            .at(Place::new(&source, at..at + '\u{fffd}'.len_utf8()), "no character")
            .hint("save the file as UTF-8")
            .into()
    })
}

/// Adds the instructions of a file to an instruction set; `include` reads what the file includes.
///
/// # Errors
/// All errors of the file, each with its place; then nothing is added.
pub fn load(isa: &mut Isa, source: &Arc<Source>, include: crate::Loader) -> Result<Vec<LoadedInstruction>, Report> {
    let mut extended = isa.clone();
    let loaded = file::load(&mut extended, source, include)?;
    *isa = extended;
    Ok(loaded)
}

fn error(
    code: &'static str,
    message: impl Into<String>,
    source: &Arc<Source>,
    span: Range<usize>,
    label: &str,
) -> Diagnostic {
    Diagnostic::error(message).code(code).at(Place::new(source, span), label)
}
