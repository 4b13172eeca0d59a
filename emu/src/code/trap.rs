//! Traps: faults that stop a program, and their messages for a person.

use std::fmt;

use isa::Program;
use messages::{Diagnostic, Place};

use crate::code::Code;

/// Fault of a program, without its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// The word is no instruction.
    IllegalWord(u32),
    /// The row of an extension that has no body, and no meaning in Rust attached.
    NoMeaning(u32),
    /// The program counter left the program, which has this many words.
    OutsideProgram {
        /// Words of the program.
        words: u32,
    },
    /// An access that leaves the local buffer.
    Buffer {
        /// First octet.
        address: u32,
        /// Number of octets.
        octets: u32,
        /// Octets of the buffer.
        size: u32,
    },
    /// An access that leaves global memory.
    Memory {
        /// First octet.
        address: u32,
        /// Number of octets.
        octets: u32,
        /// Octets of the memory.
        size: u64,
    },
    /// The program executed `trap`, with this number.
    User(u32),
    /// A message of another length than the receiver asked for.
    MessageSize {
        /// Octets that were sent.
        sent: u32,
        /// Octets that the receiver takes.
        expected: u32,
    },
    /// A message for a core that does not exist.
    NoSuchCore {
        /// The number that was asked for.
        number: i32,
        /// The largest number there is.
        largest: u32,
    },
    /// Every core waits for another one.
    Deadlock,
    /// More instructions than a work item may take.
    StepLimit(u64),
    /// Refusal by the meaning in Rust of an extension instruction, with its reason.
    Refused(&'static str),
    /// A division by zero, where the machine traps on it.
    DivisionByZero,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Fault::IllegalWord(word) => write!(f, "the word {word:#010x} is no instruction"),
            Fault::NoMeaning(word) => {
                write!(f, "the extension instruction {word:#010x} has no body, and no meaning in Rust is attached")
            }
            Fault::OutsideProgram { words } => write!(f, "the program counter left the program of {words} words"),
            Fault::Buffer { address, octets, size } => {
                write!(f, "octets {} of the buffer, which has {size}", span(address, octets))
            }
            Fault::Memory { address, octets, size } => {
                write!(f, "octets {} of global memory, which has {size}", span(address, octets))
            }
            Fault::User(number) => write!(f, "trap {number}"),
            Fault::MessageSize { sent, expected } => {
                write!(f, "a message of {sent} octets where one of {expected} is received")
            }
            Fault::NoSuchCore { number, largest } => {
                write!(f, "a message for core {number}, where the largest number is {largest}")
            }
            Fault::Deadlock => write!(f, "every core waits for another one"),
            Fault::StepLimit(limit) => write!(f, "more than {limit} instructions in a work item"),
            Fault::Refused(why) => write!(f, "the instruction refused: {why}"),
            Fault::DivisionByZero => write!(f, "division by zero"),
        }
    }
}

/// `address..end`, the end without wrapping.
fn span(address: u32, octets: u32) -> String {
    format!("{address}..{}", u64::from(address) + u64::from(octets))
}

/// Reason for which an instruction was not executed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// Something is wrong.
    Fault(Fault),
    /// The machine is not ready; the instruction is to be tried again.
    Wait,
}

impl From<Fault> for Stop {
    fn from(fault: Fault) -> Stop {
        Stop::Fault(fault)
    }
}

/// A fault with the place where it happened.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Trap {
    /// Fault that stopped it.
    pub kind: Fault,
    /// Number of the core; the main processor is the number of cores.
    pub core: u32,
    /// Word of the instruction.
    pub pc: u32,
    /// Name of the function around it.
    pub function: Option<String>,
    /// `file:line` of the instruction; none outside of the program.
    pub place: Option<String>,
    /// Source line of the instruction, or of the program's last word where the program is left behind it.
    pub line: Option<Place>,
    /// The line of the body of the extension instruction that went wrong there, if it is one.
    pub body: Option<Place>,
    /// Details: the work item, what others wait for. Empty when nothing is known.
    pub detail: String,
}

impl Trap {
    /// The trap of a fault at a slot of a program.
    pub fn new(kind: Fault, core: u32, slot: u32, code: &Code) -> Trap {
        // What lies outside of the program belongs to no word of it, even where bodies are kept.
        let is_outside = matches!(kind, Fault::OutsideProgram { .. });
        let (program, pc) = (code.program, if is_outside { slot } else { code.word(slot) });
        // A program without an end is left behind its last word, which is shown then.
        let is_behind = is_outside && slot as usize == program.words.len();
        let shown = if is_behind { pc.saturating_sub(1) } else { pc };
        let function = program.function(pc).map(str::to_owned);
        Trap {
            kind,
            core,
            pc,
            function,
            place: program.place(pc),
            line: line_place(program, shown),
            body: if is_outside { None } else { code.body_place(slot) },
            detail: String::new(),
        }
    }

    /// Trap with more to say.
    pub fn with_detail(mut self, detail: impl Into<String>) -> Trap {
        self.detail = detail.into();
        self
    }

    /// The message with the source line.
    pub fn diagnostic(&self) -> Diagnostic {
        let mut message = Diagnostic::error(self.to_string());
        if matches!(self.kind, Fault::NoMeaning(_)) {
            message = message.hint("a program in Rust attaches one and runs it: docs/extensions.md");
        }
        if matches!(self.kind, Fault::OutsideProgram { .. }) {
            message = message.hint("a program ends with `halt`");
            return match &self.line {
                Some(line) => message.at(line.clone(), "the last word"),
                None => message,
            };
        }
        match (&self.line, &self.body) {
            (Some(line), None) => message.at(line.clone(), "stopped here"),
            (Some(line), Some(body)) => message.at(line.clone(), "stopped here").also(body.clone(), "in its body"),
            (None, Some(body)) => message.at(body.clone(), "in the body"),
            (None, None) => message,
        }
    }
}

impl fmt::Display for Trap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, on core {} at word {}", self.kind, self.core, self.pc)?;
        if let Some(function) = &self.function {
            write!(f, " in `{function}`")?;
        }
        if let Some(place) = &self.place {
            write!(f, " ({place})")?;
        }
        if let Some(Place { source, span }) = &self.body {
            write!(f, ", in its body at {}:{}", source.name, source.line_column(span.start).0)?;
        }
        if !self.detail.is_empty() {
            write!(f, "; {}", self.detail)?;
        }
        Ok(())
    }
}

impl std::error::Error for Trap {}

/// The source line of a word, without the blanks around it.
fn line_place(program: &Program, pc: u32) -> Option<Place> {
    let line = program.lines.get(pc as usize)?;
    let source = program.sources.get(line.source as usize)?;
    let before = line.line.checked_sub(1)? as usize;
    let start: usize = source.text.split_inclusive('\n').take(before).map(str::len).sum();
    let text = source.text[start..].lines().next()?;
    let blanks = text.len() - text.trim_start().len();
    Some(Place::new(source, start + blanks..start + blanks + text.trim().len()))
}
