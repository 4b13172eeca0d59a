//! Which instructions there are beside the table's.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use asm::extension::{self, LoadedInstruction};
use clap::Args;
use isa::Isa;
use messages::{Report, Source};

use crate::files;

/// Files of extensions.
#[derive(Args, Clone, Debug, Default)]
pub struct ExtensionArguments {
    /// File of instructions that are added to the table's; may be repeated.
    #[arg(long = "ext", value_name = "FILE.isa")]
    pub extensions: Vec<PathBuf>,
}

impl ExtensionArguments {
    /// The table with the instructions of all files.
    ///
    /// # Errors
    /// What is wrong in the files.
    pub fn isa(&self) -> Result<Isa, Report> {
        let mut isa = Isa::base();
        for path in &self.extensions {
            extend(&mut isa, path)?;
        }
        Ok(isa)
    }
}

/// Adds the instructions of a file to an instruction set.
///
/// # Errors
/// A file that cannot be read, or what is wrong in it.
pub fn extend(isa: &mut Isa, path: &Path) -> Result<Vec<LoadedInstruction>, Report> {
    let source = extension::source(&path.display().to_string(), files::read(path)?)?;
    extension::load(isa, &source, &included)
}

/// The file that `.include` means: beside the including one.
fn included(wanted: &str, from: &str) -> Result<Arc<Source>, String> {
    let path = Path::new(from).parent().unwrap_or(Path::new("")).join(wanted);
    files::source(&path).map_err(|report| report.0.first().map_or_else(String::new, |first| first.message.clone()))
}
