//! Assembled programs, which machines run: words, the initial buffer, and what ties them to source lines,
//! functions and regions.

use std::collections::BTreeMap;
use std::sync::Arc;

use messages::Source;

use crate::naming::{ComputedInstruction, HeldFormat, NamedRegister, RecordMap};

/// A line of one of a program's sources.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Line {
    /// Index into [`Program::sources`].
    pub source: u16,
    /// Line from 1.
    pub line: u32,
}

/// A stretch of code that counts are reported for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Region {
    /// The region's name.
    pub name: String,
    /// The region is a function (`.func`), entered by calls; else it is a region (`.region`), entered by running into it.
    pub is_function: bool,
    /// The region around it, an index into [`Program::regions`].
    pub parent: Option<u16>,
}

/// An assembled program.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Program {
    /// Instruction words; a program counter is an index into them.
    pub words: Vec<u32>,
    /// Contents of the local buffer at the start of a work item, from address 0.
    pub buffer: Vec<u8>,
    /// The word at which execution starts.
    pub entry: u32,
    /// Labels and constants by name: labels of code in words, of data in octets.
    pub symbols: BTreeMap<String, i64>,
    /// The files it was made from.
    pub sources: Vec<Arc<Source>>,
    /// The source line of each word; where a macro made the word, its line in the macro.
    pub lines: Vec<Line>,
    /// The line outside of all macros that each word came from: its own, or that of the macro's call. Empty where that is not known.
    pub call_lines: Vec<Line>,
    /// Functions and regions.
    pub regions: Vec<Region>,
    /// The innermost region of each word.
    pub region_of: Vec<Option<u16>>,
    /// Number formats by name, with their fraction bits (0 to 63).
    pub formats: BTreeMap<String, u32>,
    /// Fraction bits of formats of which [`Program::formats`] has others, because assembly text cannot write them: positions of a scene that is
    /// 2^300 long have -270. Nothing but what people are shown goes by them, and object files do not have them.
    pub shown_formats: BTreeMap<String, i32>,
    /// Other names of registers, with the words where they are known.
    pub register_names: Vec<NamedRegister>,
    /// Formats of what registers hold, with the words where that is said.
    pub holds: Vec<HeldFormat>,
    /// Instructions that functions compute in many steps (`.computes`).
    pub computed: Vec<ComputedInstruction>,
    /// Structures of records in memory.
    pub records: Vec<RecordMap>,
}

impl Program {
    /// `file:line` of a word, for messages.
    pub fn place(&self, pc: u32) -> Option<String> {
        let line = self.lines.get(pc as usize)?;
        Some(format!("{}:{}", self.sources.get(line.source as usize)?.name, line.line))
    }

    /// The line at which a macro was called that made a word; `None` for a word that no macro made.
    pub fn call_line(&self, pc: u32) -> Option<Line> {
        let line = self.call_lines.get(pc as usize)?;
        (self.lines.get(pc as usize) != Some(line)).then_some(*line)
    }

    /// Text of a source line, without its end; `None` of a line that no source has.
    pub fn line_text(&self, line: Line) -> Option<&str> {
        self.sources.get(usize::from(line.source))?.text.lines().nth((line.line as usize).checked_sub(1)?)
    }

    /// Name of the innermost function around a word.
    pub fn function(&self, pc: u32) -> Option<&str> {
        let mut region = (*self.region_of.get(pc as usize)?)?;
        loop {
            let here = self.regions.get(region as usize)?;
            if here.is_function {
                return Some(&here.name);
            }
            region = here.parent?;
        }
    }
}
