//! `lancer assemble`: assembly text to words.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;
use isa::diagnostic::{Diagnostic, Report, Source};
use isa::{Isa, Program};

use crate::arguments;
use crate::failure::{Exit, Failure};
use crate::files::{self, words::WordFile};
use crate::listing;
use crate::table::count;
use crate::terminal::Terminal;

const EXAMPLES: &str = "\
Examples:
  lancer assemble first.s                       # all errors of the file, or its size
  lancer assemble first.s -o first.bin          # words, little-endian
  lancer assemble first.s -o first.hex --list   # text for $readmemh, and a listing
  lancer assemble triangle.s -D WIDTH=320 --format dir=30 -I kernels";

/// Assembles a program and shows all errors of it in one run.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct AssembleArguments {
    #[command(flatten)]
    source: SourceArguments,
    /// Words of the program: .bin (32 bits, little-endian) or .hex (text for $readmemh).
    #[arg(short, long, value_name = "FILE", value_parser = WordFile::check)]
    output: Option<PathBuf>,
    /// Octets of the program's initial data.
    #[arg(long, value_name = "FILE")]
    data: Option<PathBuf>,
    /// Prints a listing: words beside their source lines, data, symbols.
    #[arg(long)]
    list: bool,
}

/// A source and what it cannot say for itself.
#[derive(Args, Clone, Debug)]
pub(super) struct SourceArguments {
    /// Assembly file.
    #[arg(value_name = "FILE.s")]
    pub(super) file: PathBuf,
    /// Constant that is known before the first line; may be repeated.
    #[arg(short = 'D', long = "define", value_name = "NAME=VALUE", value_parser = definition)]
    defines: Vec<(String, i64)>,
    /// Number format that is known before the first line, by its fraction bits; may be repeated.
    #[arg(long = "format", value_name = "NAME=BITS", value_parser = definition)]
    formats: Vec<(String, i64)>,
    /// Folder in which included files are looked for, after that of the including file; may be repeated.
    #[arg(short = 'I', long = "include", value_name = "FOLDER")]
    folders: Vec<PathBuf>,
}

fn definition(text: &str) -> Result<(String, i64), String> {
    let (name, value) = arguments::setting::<String>(text)?;
    Ok((name, arguments::numbered(&value)?))
}

/// Assembles a file and shows its warnings.
pub(super) fn assembled(arguments: &SourceArguments, isa: &Isa, terminal: &Terminal) -> Result<Program, Failure> {
    let source = files::source(&arguments.file)?;
    let include = |wanted: &str, from: &str| included(wanted, from, &arguments.folders);
    let (defines, formats) = (arguments.defines.clone(), arguments.formats.clone());
    let assembled = asm::assemble(&source, isa, &asm::Options { include: &include, defines, formats })?;
    terminal.show(&assembled.warnings);
    Ok(assembled.program)
}

/// The file that `.include` means: beside the including one, else in the folders in their order.
fn included(wanted: &str, from: &str, folders: &[PathBuf]) -> Result<Arc<Source>, String> {
    let beside = Path::new(from).parent().unwrap_or(Path::new("")).join(wanted);
    let candidates = std::iter::once(beside).chain(folders.iter().map(|folder| folder.join(wanted)));
    let found = candidates.clone().find(|candidate| candidate.is_file());
    let Some(found) = found else {
        let tried: Vec<String> = candidates.map(|candidate| format!("`{}`", candidate.display())).collect();
        return Err(format!("there is no file {}", tried.join(", nor ")));
    };
    files::source(&found).map_err(|report| report.0.first().map_or_else(String::new, |first| first.message.clone()))
}

/// Assembles, writes and prints.
pub(super) fn execute(arguments: &AssembleArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let outputs = [arguments.output.as_deref(), arguments.data.as_deref()];
    let all = outputs.into_iter().flatten();
    files::check_distinct(all.clone().chain([arguments.source.file.as_path()])).map_err(Failure::usage)?;
    for output in all {
        files::check_target(output)?;
    }
    let program = assembled(&arguments.source, &Isa::base(), terminal)?;
    if let Some(path) = &arguments.data {
        files::write(path, &program.buffer)?;
    }
    if let Some(path) = &arguments.output {
        files::write(path, &WordFile::of(path).map_err(usage)?.encode(&program.words))?;
        if arguments.data.is_none() && !program.buffer.is_empty() {
            let data = count(program.buffer.len() as u64, "octet", "octets");
            let message = format!("{} holds the words alone; the program has {data} of data", path.display());
            terminal.show(&Report::from(Diagnostic::warning(message).hint("write them with `--data FILE`")));
        }
    }
    if arguments.list {
        terminal.print(&listing::text(&program))?;
    } else if arguments.output.is_none() {
        let words = count(program.words.len() as u64, "word", "words");
        let data = count(program.buffer.len() as u64, "octet", "octets");
        terminal.print(&format!("{}: {words}, {data} of data\n", arguments.source.file.display()))?;
    }
    Ok(Exit::Done)
}

fn usage(message: String) -> Failure {
    Failure::usage(Diagnostic::error(message))
}
