//! Options that add instructions to the table's.

use std::path::PathBuf;

use clap::Args;
use isa::Isa;
use messages::Report;

use crate::extension::extend;

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
    /// Mistakes in the files of extensions.
    pub fn isa(&self) -> Result<Isa, Report> {
        let mut isa = Isa::base();
        for path in &self.extensions {
            extend(&mut isa, path)?;
        }
        Ok(isa)
    }
}
