//! The two passes: the first reads all lines, places words and octets and encodes what is known; the second encodes
//! what had to wait for names defined further on.

use std::collections::HashMap;
use std::rc::Rc;
use std::sync::Arc;

use isa::program::Line as ProgramLine;
use isa::table::Op;
use isa::{Isa, Program};
use messages::Source;

use crate::definition::Alias;
use crate::directive::DIRECTIVES;
use crate::explain;
use crate::expression::{EvaluationStep, Expression};
use crate::extension::Template;
use crate::frame::OpenText;
use crate::holding::{AliasSpan, OpenHolding};
use crate::instruction::Argument;
use crate::limits::{FRACTION_BITS, TEXT_OCTETS};
use crate::line::OriginLine;
use crate::listing::Record;
use crate::live_name::NameUse;
use crate::macros::Macro;
use crate::message::{Among, At, Messages, Problem};
use crate::operand::Register;
use crate::pseudo::PSEUDOS;
use crate::region::OpenRegion;
use crate::structure::OpenStructure;
use crate::symbol::{Name, Names, SymbolValue};
use crate::{Attempt, Options};

/// The part of the program that statements go to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Section {
    /// Instruction words.
    Code,
    /// The initial contents of the local buffer.
    Buffer,
}

/// A word or datum that is put in when all names are known.
#[derive(Debug)]
pub(crate) enum Fixup {
    Instruction { op: Op, arguments: Vec<Argument>, pc: usize },
    Word { expression: Expression, pc: usize },
    Data { expression: Expression, octet: usize, width: usize },
}

/// Everything that is known while assembling.
pub(crate) struct Assembler<'a> {
    pub isa: &'a Isa,
    pub options: &'a Options<'a>,
    pub operations: HashMap<&'a str, Op>,
    pub nop: u32,
    pub program: Program,
    pub messages: Messages,
    pub names: Names,
    pub macros: HashMap<Rc<str>, Rc<Macro>>,
    /// Lines of the outermost macro calls, by the contexts of what they lead to.
    pub call_lines: HashMap<u32, ProgramLine>,
    pub aliases: Vec<HashMap<Rc<str>, Alias>>,
    /// All names of registers that there were, in order.
    pub alias_spans: Vec<AliasSpan>,
    /// Formats of registers, a scope each.
    pub holdings: Vec<HashMap<Register, OpenHolding>>,
    /// Uses of names of registers by the words of the program.
    pub name_uses: Vec<NameUse>,
    /// The register of which the statement said what it holds.
    pub held: Option<(Register, Option<Name>)>,
    pub frames: Vec<OpenText>,
    pub section: Section,
    pub structure: Option<OpenStructure>,
    pub regions: Vec<OpenRegion>,
    pub known_regions: HashMap<(String, bool, Option<u16>), u16>,
    pub numeric: HashMap<Rc<str>, u32>,
    pub fixups: Vec<Fixup>,
    pub asserts: Vec<(Expression, String, At)>,
    pub entry: Option<Expression>,
    /// Names that decide the layout and were not known yet.
    pub early: Vec<(EvaluationStep, At)>,
    /// Files by the name that was asked for and the file that asked.
    pub included: HashMap<(String, u16), u16>,
    pub records: Vec<Record>,
    /// The name that the statement gave a number to.
    pub named: Option<Name>,
    pub pending_records: Vec<(usize, Name)>,
    pub expansions: usize,
    pub lines_read: usize,
    pub octets_read: usize,
    /// Octets that count towards [`crate::limits::SourceLimits::expanded_octets`].
    pub octets_expanded: usize,
    /// Some text could not be read, so that missing names say nothing.
    pub is_incomplete: bool,
    pub is_last_pass: bool,
    /// Set while the body of an extension instruction is assembled: then instructions become its steps.
    pub body: Option<Template>,
}

/// Assembles a source as far as possible; the program is whole when the report has no errors.
pub(crate) fn assemble(source: &Arc<Source>, isa: &Isa, options: &Options) -> Attempt {
    let mut assembler = new(isa, options);
    assembler.take_options(source);
    assembler.first_pass(source);
    assembler.second_pass();
    assembler.finish()
}

/// An assembler that has read nothing.
pub(crate) fn new<'a>(isa: &'a Isa, options: &'a Options<'a>) -> Assembler<'a> {
    let operations: HashMap<&str, Op> = isa.ops().map(|op| (&*isa.definition(op).name, op)).collect();
    // Gaps in the code are filled with `mov s0, s0`, which does nothing: `s0` ignores writes.
    let nop = operations.get("mov").and_then(|&op| isa.encode(op, &[0, 0]).ok()).unwrap_or(0);
    Assembler {
        isa,
        options,
        operations,
        nop,
        program: Program::default(),
        messages: Messages::default(),
        names: Names::default(),
        macros: HashMap::new(),
        call_lines: HashMap::new(),
        // The outermost scope of register names and of their formats is open from the start; functions open more.
        aliases: vec![HashMap::new()],
        alias_spans: Vec::new(),
        holdings: vec![HashMap::new()],
        name_uses: Vec::new(),
        held: None,
        frames: Vec::new(),
        section: Section::Code,
        structure: None,
        regions: Vec::new(),
        known_regions: HashMap::new(),
        numeric: HashMap::new(),
        fixups: Vec::new(),
        asserts: Vec::new(),
        entry: None,
        early: Vec::new(),
        included: HashMap::new(),
        records: Vec::new(),
        named: None,
        pending_records: Vec::new(),
        expansions: 0,
        lines_read: 0,
        octets_read: 0,
        octets_expanded: 0,
        is_incomplete: false,
        is_last_pass: false,
        body: None,
    }
}

impl Assembler<'_> {
    pub(crate) fn take_options(&mut self, source: &Arc<Source>) {
        self.program.sources.push(source.clone());
        for (text, value) in &self.options.defines {
            let name = self.names.intern(text);
            self.names.set(name, SymbolValue::Constant(*value), None);
        }
        for (text, bits) in &self.options.formats {
            if (0..=FRACTION_BITS).contains(bits) {
                let name = self.names.intern(text);
                self.names.set_format(name, *bits as u32);
            } else {
                let message =
                    format!("the format `{text}` cannot have {bits} fraction bits, only 0 to {FRACTION_BITS}");
                let mut problem = Problem::new(explain::RANGE, message, At::default(), "");
                problem.at = None;
                self.messages.add(problem);
            }
        }
    }

    fn first_pass(&mut self, source: &Arc<Source>) {
        if source.text.len() > TEXT_OCTETS {
            let message = format!("the file is longer than {TEXT_OCTETS} octets");
            self.messages.add(Problem::new(explain::SIZE, message, At::default(), "starts here"));
            return;
        }
        self.enter_file(0, At::default());
        self.read_frames();
    }

    /// Reads the lines of all frames, and says what is open at their end.
    pub(crate) fn read_frames(&mut self) {
        while let Some(line) = self.fetch() {
            self.line(&line);
        }
        if self.is_incomplete {
            return;
        }
        // What is still open at the end of the text.
        for open in std::mem::take(&mut self.regions) {
            self.messages.add(open.unclosed());
        }
        if let Some(open) = self.structure.take() {
            self.messages.add(Problem::new(explain::UNCLOSED, "`.endstruct` is missing", open.at, "opened here"));
        }
    }

    /// The current place: in words in the code, in octets in the buffer.
    pub(crate) fn location(&self) -> i64 {
        match self.section {
            Section::Code => self.program.words.len() as i64,
            Section::Buffer => self.program.buffer.len() as i64,
        }
    }

    /// Appends a word to the code.
    pub(crate) fn emit(&mut self, word: u32, line: &OriginLine) {
        if !self.takes_step(line) {
            return;
        }
        // A repetition can ask for more words than any machine has.
        let most = self.options.limits.words;
        if self.program.words.len() >= most {
            let message = format!("the program has more than {most} words");
            self.give_up(Problem::new(explain::SIZE, message, line.at_all(), "one too many"));
            return;
        }
        self.program.words.push(word);
        let own = ProgramLine { source: line.source, line: line.number };
        self.program.lines.push(own);
        self.program.call_lines.push(self.outermost_call(line.context).unwrap_or(own));
        self.program.region_of.push(self.regions.last().map(|open| open.index));
    }

    pub(crate) fn second_pass(&mut self) {
        self.is_last_pass = true;
        // Report the names that decided the layout and were not known, then compute what `.equ` left open.
        self.report_early();
        self.resolve_pending();
        // Put in what waited for names.
        for fixup in std::mem::take(&mut self.fixups) {
            match fixup {
                Fixup::Instruction { op, arguments, pc } if self.body.is_some() => {
                    match self.encode_step(op, &arguments, pc) {
                        Ok(act) => self.set_act(pc, act),
                        Err(failures) => failures.into_iter().for_each(|failure| self.report_failure(failure)),
                    }
                }
                Fixup::Instruction { op, arguments, pc } => match self.encode(op, &arguments, pc) {
                    Ok(word) => self.program.words[pc] = word,
                    Err(failures) => failures.into_iter().for_each(|failure| self.report_failure(failure)),
                },
                Fixup::Word { expression, pc } => match self.data_value(4, &expression) {
                    Ok(value) => self.program.words[pc] = value as u32,
                    Err(failure) => self.report_failure(failure),
                },
                Fixup::Data { expression, octet, width } => match self.data_value(width, &expression) {
                    Ok(value) => {
                        self.program.buffer[octet..octet + width].copy_from_slice(&value.to_le_bytes()[..width]);
                    }
                    Err(failure) => self.report_failure(failure),
                },
            }
        }
        // Assertions see the final values.
        for (expression, text, _) in std::mem::take(&mut self.asserts) {
            match self.evaluate(&expression) {
                Ok(0) => {
                    let label = match self.sides(&expression) {
                        Some((mark, a, b)) => format!("{a} {mark} {b} does not hold"),
                        None => "this is 0".into(),
                    };
                    self.messages.add(Problem::new(explain::ASSERTED, text, expression.at, label));
                }
                Ok(_) => {}
                Err(failure) => self.report_failure(failure),
            }
        }
        self.resolve_entry();
    }

    pub(crate) fn finish(mut self) -> Attempt {
        // Names that a mistake may have meant are sought among those of the outermost scope.
        let outermost: Vec<Rc<str>> = self.aliases.iter().flat_map(|scope| scope.keys().cloned()).collect();
        self.finish_naming();
        self.finish_computed();
        let symbols = self.map();
        self.program.symbols = symbols.iter().map(|entry| (entry.name.clone(), entry.value)).collect();
        // Constants that were known late appear in the listing with their values.
        for (place, name) in std::mem::take(&mut self.pending_records) {
            if let Some(SymbolValue::Constant(value)) = self.names.get(name).map(|symbol| &symbol.value) {
                self.records[place].value = Some(*value);
            }
        }
        let registers: Vec<String> = [('s', 32), ('v', 32), ('w', 8)]
            .into_iter()
            .flat_map(|(file, count)| (0..count).map(move |number| format!("{file}{number}")))
            .collect();
        // Names by kind, for suggestions: only those that the place of the mistake could have.
        let known = |among: Among| -> Vec<&str> {
            match among {
                Among::Instructions => (self.operations.keys().copied())
                    .chain(PSEUDOS.iter().map(|pseudo| pseudo.name))
                    .chain(self.macros.keys().map(|name| &**name))
                    .collect(),
                Among::Directives => DIRECTIVES.iter().flat_map(|d| d.also.iter().copied().chain([d.name])).collect(),
                Among::Symbols => {
                    let symbols = self.names.symbols().map(|(_, text, _)| &**text);
                    symbols.filter(|text| !text.contains(['$', '#'])).chain(self.names.formats()).collect()
                }
                Among::Formats => self.names.formats().collect(),
                Among::Sizes => self.names.sized().collect(),
                Among::Registers => {
                    let aliases = outermost.iter().map(|name| &**name);
                    aliases.chain(registers.iter().map(String::as_str)).collect()
                }
            }
        };
        let messages = std::mem::take(&mut self.messages);
        let report = messages.report(&self.program.sources, self.options.limits.compared_names, known);
        Attempt { program: self.program, report, symbols, records: self.records }
    }
}
