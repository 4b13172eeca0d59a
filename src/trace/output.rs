//! Output of a trace of instructions, line by line: to standard output, or to a file that appears when the trace is whole.

use std::path::Path;

use emu::stepper::Stepper;
use messages::Diagnostic;

use super::instruction::{TraceClocks, head, next};
use super::window::TraceWindows;
use crate::failure::Failure;
use crate::files::{self, FileStream};
use crate::numeral::count;
use crate::terminal::Terminal;

/// Form of a trace.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TraceForm {
    /// A line of text an instruction, under a head.
    Text,
    /// A line of JSON an instruction.
    JsonLines,
}

impl TraceForm {
    /// The form that a file's name asks for: JSON lines where it ends in `.jsonl` or `.json`. Of standard output `is_json` says it.
    pub fn of(path: &Path, is_json: bool) -> TraceForm {
        let extension = path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase);
        let is_named = matches!(extension.as_deref(), Some("jsonl" | "json"));
        match is_named || (is_standard(path) && is_json) {
            true => TraceForm::JsonLines,
            false => TraceForm::Text,
        }
    }
}

/// The path means standard output.
pub fn is_standard(path: &Path) -> bool {
    path == Path::new(files::STANDARD)
}

/// Octets that are gathered before they are written to standard output.
const AT_ONCE: usize = 1 << 16;

/// Place where the lines go.
enum TraceTarget<'a> {
    Standard(&'a mut Terminal, Vec<u8>),
    File(FileStream),
}

impl TraceTarget<'_> {
    fn line(&mut self, text: &str) -> Result<(), Failure> {
        match self {
            TraceTarget::Standard(terminal, gathered) => {
                gathered.extend(text.as_bytes());
                gathered.push(b'\n');
                if gathered.len() >= AT_ONCE {
                    terminal.print_octets(gathered)?;
                    gathered.clear();
                }
                Ok(())
            }
            TraceTarget::File(file) => Ok(file.line(text)?),
        }
    }

    fn finish(self) -> Result<(), Failure> {
        match self {
            TraceTarget::Standard(terminal, gathered) => terminal.print_octets(&gathered),
            TraceTarget::File(file) => Ok(file.finish()?),
        }
    }
}

/// Writes the instructions of a core that lie in the windows, to the program's end or the end of the windows; yields their number.
///
/// # Errors
/// A place that cannot be written.
pub fn write_instructions(
    stepper: &mut Stepper,
    clocks: TraceClocks,
    windows: &TraceWindows,
    path: &Path,
    form: TraceForm,
    terminal: &mut Terminal,
) -> Result<u64, Failure> {
    let mut target = match is_standard(path) {
        true => TraceTarget::Standard(terminal, Vec::new()),
        false => TraceTarget::File(FileStream::new(path)?),
    };
    if form == TraceForm::Text {
        target.line(&head())?;
    }
    let steps = windows.steps();
    // What comes before the first window needs no records.
    stepper.run_to(steps.start);
    let mut written = 0;
    while stepper.end().is_none() && stepper.steps() < steps.end {
        if !windows.has(stepper) {
            stepper.step();
            continue;
        }
        let Some(record) = next(stepper, clocks) else { break };
        let line = match form {
            TraceForm::Text => record.line(),
            TraceForm::JsonLines => record.json(),
        };
        target.line(&line)?;
        written += 1;
    }
    target.finish()?;
    if written == 0 {
        let executed = count(stepper.steps(), "instruction", "instructions");
        terminal.show(&Diagnostic::warning(format!("no instruction lies in the windows: {executed} came by")).into());
    }
    Ok(written)
}
