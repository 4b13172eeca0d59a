//! `lancer disassemble`: words to assembly text.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::arguments::ExtensionArguments;
use crate::failure::{Exit, Failure};
use crate::files;
use crate::files::program::{LoadedFile, ProgramFile, load_any};
use crate::terminal::Terminal;

const EXAMPLES: &str = "\
Examples:
  lancer disassemble first.o
  lancer disassemble first.hex -o again.s
  lancer assemble first.s -o first.bin && lancer disassemble first.bin";

/// Shows the instructions and data of a program's file. The text assembles to the same words and octets.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct DisassembleArguments {
    /// Program: an object file (.o), text for $readmemh (.hex); anything else is words of 32 bits, little-endian.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    #[command(flatten)]
    extensions: ExtensionArguments,
    /// Assembly file [default: standard output].
    #[arg(short, long, value_name = "FILE.s")]
    output: Option<PathBuf>,
}

/// Reads, disassembles and prints.
pub(super) fn execute(arguments: &DisassembleArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    files::check_spared(arguments.output.as_deref(), [&arguments.file]).map_err(Failure::usage)?;
    let isa = arguments.extensions.isa()?;
    let program = match load_any(&arguments.file)? {
        LoadedFile::Program(program) => *program,
        LoadedFile::Other(octets) => ProgramFile::Binary.decode(&arguments.file, octets)?,
    };
    let text = asm::disassemble_program(&program, &isa);
    match arguments.output.as_deref().filter(|path| *path != Path::new(files::STANDARD)) {
        Some(path) => files::write(path, text.as_bytes())?,
        None => terminal.print(&text)?,
    }
    Ok(Exit::Done)
}
