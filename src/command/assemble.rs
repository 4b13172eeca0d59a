//! `lancer assemble`: assembly text to words.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use asm::Attempt;
use clap::Args;
use isa::{Isa, Program};
use messages::{Diagnostic, Report, Source};

use super::assemble_result::AssembledProgram;
use super::invocation::CommandSettings;
use crate::arguments::{self, ExtensionArguments};
use crate::failure::{Exit, Failure};
use crate::files::{self, program::ProgramFile};
use crate::numeral::count;
use crate::result::{self, WithSettings};
use crate::settings::hash;
use crate::terminal::Terminal;

const EXAMPLES: &str = "\
Examples:
  lancer assemble first.s                       # all errors of the file, or its size
  lancer assemble first.s -o first.o            # everything, for lancer run and lancer disassemble
  lancer assemble first.s -o first.hex --list   # text for $readmemh, and a listing
  lancer assemble first.s -o first.bin --data first.dat --list=first.lst --map=first.map
  lancer assemble first.s -o - | lancer run -   # - is standard input and output
  lancer assemble first.s --json                # words, data, names and functions for a script
  lancer assemble triangle.s -D WIDTH=320 --format dir=30 -I kernels";

/// In the place of a file's name, standard output.
const PRINTED: &str = files::STANDARD;

/// Assembles a program and shows all errors of it in one run.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct AssembleArguments {
    /// Assembly file.
    #[arg(value_name = "FILE.s")]
    file: PathBuf,
    #[command(flatten)]
    source: SourceArguments,
    #[command(flatten)]
    extensions: ExtensionArguments,
    /// Program: .o (object file), or its words alone: .bin (32 bits, little-endian), .hex (text for $readmemh).
    #[arg(short, long, value_name = "FILE", value_parser = ProgramFile::check)]
    output: Option<PathBuf>,
    /// Octets of the program's initial data; text for $readmemh where the name ends in .hex.
    #[arg(long, value_name = "FILE")]
    data: Option<PathBuf>,
    /// Listing: what each line became, also when there are errors [default: standard output].
    #[arg(long, value_name = "FILE", num_args = 0..=1, require_equals = true, default_missing_value = PRINTED)]
    list: Option<PathBuf>,
    /// Map of the names, functions and regions, with their places [default: standard output].
    #[arg(long, value_name = "FILE", num_args = 0..=1, require_equals = true, default_missing_value = PRINTED)]
    map: Option<PathBuf>,
    /// Prints the program as JSON: words, data, names, functions.
    #[arg(long)]
    json: bool,
}

/// Options for what a source cannot say for itself.
#[derive(Args, Clone, Debug)]
pub(super) struct SourceArguments {
    /// Constant that is known before the first line; may be repeated.
    #[arg(short = 'D', long = "define", value_name = "NAME=VALUE", value_parser = definition)]
    pub(super) defines: Vec<(String, i64)>,
    /// Number format that is known before the first line, by its fraction bits; may be repeated.
    #[arg(long = "format", value_name = "NAME=BITS", value_parser = definition)]
    pub(super) formats: Vec<(String, i64)>,
    /// Folder in which included files are looked for, after that of the including file; may be repeated.
    #[arg(short = 'I', long = "include", value_name = "FOLDER")]
    pub(super) folders: Vec<PathBuf>,
}

pub(super) fn definition(text: &str) -> Result<(String, i64), String> {
    let (name, value) = arguments::setting::<String>(text)?;
    asm::check_outside_name(&name, &Isa::base())?;
    Ok((name, arguments::numbered(&value)?))
}

impl SourceArguments {
    /// True with options that only an assembler can follow.
    pub(super) fn has_options(&self) -> bool {
        !(self.defines.is_empty() && self.formats.is_empty() && self.folders.is_empty())
    }
}

/// Assembles a source and shows its warnings.
pub(super) fn assembled(
    source: &Arc<Source>,
    arguments: &SourceArguments,
    isa: &Isa,
    terminal: &Terminal,
) -> Result<Program, Failure> {
    let assembled = attempted(source, arguments, isa).finish()?;
    terminal.show(&assembled.warnings);
    Ok(assembled.program)
}

/// Assembles a source as far as that is possible.
pub(super) fn attempted(source: &Arc<Source>, arguments: &SourceArguments, isa: &Isa) -> Attempt {
    let include = |wanted: &str, from: &str| included(wanted, from, &arguments.folders);
    let (defines, formats) = (arguments.defines.clone(), arguments.formats.clone());
    asm::attempt(source, isa, &asm::Options { include: &include, defines, formats, ..asm::Options::default() })
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
pub(super) fn execute(
    arguments: &AssembleArguments,
    given: &CommandSettings,
    terminal: &mut Terminal,
) -> Result<Exit, Failure> {
    // Refuse before any work what would overwrite an input or another output.
    let outputs = [&arguments.output, &arguments.data, &arguments.list, &arguments.map];
    let all = outputs.into_iter().flatten().map(PathBuf::as_path).filter(|path| *path != Path::new(PRINTED));
    // A listing and a map are both texts, which may follow each other.
    let has_text = [&arguments.list, &arguments.map].iter().any(|path| path.as_deref() == Some(Path::new(PRINTED)));
    let octets = [&arguments.output, &arguments.data].into_iter().flatten().map(PathBuf::as_path);
    if has_text && arguments.json {
        let message = Diagnostic::error("a listing and JSON would both go to standard output");
        return Err(Failure::usage(message.hint("name a file: --list=FILE, --map=FILE")));
    }
    files::takes_output(octets, arguments.json || has_text).map_err(Failure::usage)?;
    files::check_distinct(all.clone()).map_err(Failure::usage)?;
    files::check_spared(all.clone(), arguments.extensions.extensions.iter().chain([&arguments.file]))
        .map_err(Failure::usage)?;
    for output in all.clone() {
        files::check_target(output)?;
    }
    let isa = arguments.extensions.isa()?;
    let attempt = attempted(&files::source(&arguments.file)?, &arguments.source, &isa);
    // Included files are known only now.
    files::check_spared(all, attempt.program.sources.iter().map(|source| &source.name)).map_err(Failure::usage)?;
    // The listing shows errors in their places, so it is written whatever they are.
    let mut results = ResultFiles::default();
    if let Some(path) = &arguments.list {
        results.add(path, asm::listing(&attempt));
    }
    let assembled = match attempt.finish() {
        Ok(assembled) => assembled,
        // Errors are wanted in the listing most of all.
        Err(report) => {
            results.write(terminal)?;
            return Err(report.into());
        }
    };
    terminal.show(&assembled.warnings);
    if let Some(path) = &arguments.map {
        let gap = if arguments.list.as_deref() == Some(Path::new(PRINTED)) { "\n" } else { "" };
        let text = asm::symbol_map(&assembled);
        results.add(path, if path == Path::new(PRINTED) { gap.to_owned() + &text } else { text });
    }
    let program = &assembled.program;
    add_program(arguments, program, &mut results, terminal)?;
    let written: Vec<PathBuf> = results.files.iter().map(|(path, _)| path.clone()).collect();
    results.write(terminal)?;
    if arguments.json {
        let file = files::shown(&arguments.file);
        let assembled = AssembledProgram::new(file, program, &written);
        let sources = program.sources.iter().map(|source| source.text.as_str());
        let settings = given.clone().with_hash(hash::texts(sources));
        terminal.print(&result::json(&WithSettings::new(&assembled, settings)))?;
        return Ok(Exit::Done);
    }
    // Who asked for no file is told that there are no errors.
    if outputs.iter().all(|output| output.is_none()) {
        let words = count(program.words.len() as u64, "word", "words");
        let data = count(program.buffer.len() as u64, "octet", "octets");
        terminal.print(&format!("{}: {words}, {data} of data\n", files::shown(&arguments.file)))?;
    }
    Ok(Exit::Done)
}

/// Adds the program and its data where they are asked for.
fn add_program(
    arguments: &AssembleArguments,
    program: &Program,
    results: &mut ResultFiles,
    terminal: &Terminal,
) -> Result<(), Failure> {
    if let Some(path) = &arguments.data {
        let is_text = ProgramFile::of(path) == Ok(ProgramFile::Hexadecimal);
        results.files.push((
            path.clone(),
            if is_text { asm::hex::octets(&program.buffer).into_bytes() } else { program.buffer.clone() },
        ));
    }
    if let Some(path) = &arguments.output {
        let format = ProgramFile::written(path).map_err(|message| Failure::usage(Diagnostic::error(message)))?;
        results.files.push((path.clone(), format.encode(program)));
        if format != ProgramFile::Object && arguments.data.is_none() && !program.buffer.is_empty() {
            let data = count(program.buffer.len() as u64, "octet", "octets");
            let message = format!("{} holds the words alone; the program has {data} of data", path.display());
            let hint = "write them with `--data FILE`, or everything into a file that ends in .o";
            terminal.show(&Report::from(Diagnostic::warning(message).hint(hint)));
        }
    }
    Ok(())
}

/// ResultFiles on their way to files, which appear together, and to standard output.
#[derive(Default)]
struct ResultFiles {
    files: Vec<(PathBuf, Vec<u8>)>,
    printed: String,
}

impl ResultFiles {
    fn add(&mut self, path: &Path, text: String) {
        match path == Path::new(PRINTED) {
            true => self.printed += &text,
            false => self.files.push((path.to_owned(), text.into_bytes())),
        }
    }

    fn write(self, terminal: &mut Terminal) -> Result<(), Failure> {
        files::write_all(&self.files)?;
        terminal.print(&self.printed)
    }
}
