//! Files of instructions that are added to the table's.

use std::cell::RefCell;
use std::path::Path;
use std::sync::Arc;

use asm::extension::{self, LoadedInstruction};
use isa::Isa;
use messages::{Report, Source};

use crate::files;

/// Adds the instructions of a file to an instruction set; gives what was loaded, and the texts of the file and of all that it includes.
///
/// # Errors
/// A file that cannot be read, or mistakes in it.
pub fn extend(isa: &mut Isa, path: &Path) -> Result<(Vec<LoadedInstruction>, Vec<Arc<Source>>), Report> {
    extend_by(isa, path, files::read(path)?)
}

/// Adds the instructions of a file that has been read; see [`extend`].
///
/// # Errors
/// Mistakes in the file or in one that it includes.
pub fn extend_by(
    isa: &mut Isa,
    path: &Path,
    octets: Vec<u8>,
) -> Result<(Vec<LoadedInstruction>, Vec<Arc<Source>>), Report> {
    let source = extension::source(&path.display().to_string(), octets)?;
    let texts = RefCell::new(vec![source.clone()]);
    let open =
        |wanted: &str, from: &str| included(wanted, from).inspect(|source| texts.borrow_mut().push(source.clone()));
    let loaded = extension::load(isa, &source, &open)?;
    Ok((loaded, texts.into_inner()))
}

/// The file that `.include` means: beside the including one.
fn included(wanted: &str, from: &str) -> Result<Arc<Source>, String> {
    let path = Path::new(from).parent().unwrap_or(Path::new("")).join(wanted);
    files::source(&path).map_err(|report| report.0.first().map_or_else(String::new, |first| first.message.clone()))
}
