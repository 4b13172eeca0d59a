//! A bench for single functions: a small program that loads operands, calls a function and stores what it gives, over and over.

use std::fmt::Write;
use std::sync::Arc;

use emu::machine::one_core::{OneCore, run};
use emu::octets::Memory;
use isa::{Isa, Program};
use kernels::Function;
use kernels::build::Crop;
use kernels::prelude;
use messages::Source;

use super::Subject;

/// Home of an operand or a result.
#[derive(Clone, Copy, Debug)]
pub enum Place {
    /// A scalar register: one word.
    Scalar(&'static str),
    /// A vector register: three words.
    Vector(&'static str),
    /// A wide register: two words, the low one first.
    Wide(&'static str),
    /// A word of the buffer.
    Word(&'static str),
    /// Three words of the buffer.
    Triple(&'static str),
}

impl Place {
    fn words(self) -> usize {
        match self {
            Place::Scalar(_) | Place::Word(_) => 1,
            Place::Wide(_) => 2,
            Place::Vector(_) | Place::Triple(_) => 3,
        }
    }

    fn load(self, from: usize) -> String {
        let at = format!("CASE + {}(s0)", 4 * from);
        match self {
            Place::Scalar(register) => format!("    lw {register}, {at}\n"),
            Place::Vector(register) => format!("    lv {register}, {at}\n"),
            Place::Wide(register) => format!("    lwide {register}, {at}\n"),
            Place::Word(place) => format!("    lw s12, {at}\n    sw s12, {place}(s0)\n"),
            Place::Triple(place) => format!("    lv v6, {at}\n    sv v6, {place}(s0)\n"),
        }
    }

    fn store(self, to: usize) -> String {
        let at = format!("RESULT + {}(s0)", 4 * to);
        match self {
            Place::Scalar(register) => format!("    sw {register}, {at}\n"),
            Place::Vector(register) => format!("    sv {register}, {at}\n"),
            Place::Wide(register) => format!("    swide {register}, {at}\n"),
            Place::Word(place) => format!("    lw s12, {place}(s0)\n    sw s12, {at}\n"),
            Place::Triple(place) => format!("    lv v6, {place}(s0)\n    sv v6, {at}\n"),
        }
    }
}

/// Work that is done with a case.
pub struct Experiment {
    /// Functions of the subject's profile that take part.
    pub functions: &'static [Function],
    /// Operands, in the order of a case's words; those of the buffer come first.
    pub operands: &'static [Place],
    /// Instructions that work on them; s31 is not to be changed.
    pub body: &'static str,
    /// Results.
    pub results: &'static [Place],
}

/// An experiment, assembled for a subject.
pub struct Bench<'a> {
    subject: &'a Subject,
    program: Program,
    cases_at: u32,
    results: usize,
}

impl<'a> Bench<'a> {
    pub fn new(subject: &'a Subject, experiment: &Experiment) -> Bench<'a> {
        let cases_at = (subject.image.bytes.len() as u32).next_multiple_of(16);
        let crop = Crop { column: 0, row: 0, width: 1, height: 1 };
        let walk = subject.profile.walk(&[]);
        let scene = prelude::text(&subject.image, &subject.features, &crop, walk, false);
        let mut files: Vec<Arc<Source>> = vec![Source::new("<scene>", scene)];
        files.extend(prelude::included(subject.image.layout));
        let own = experiment.functions.iter().filter_map(|function| subject.profile.file(*function, &[]));
        files.extend(own.map(|(name, text)| Source::new(name, text)));
        files.push(Source::new("<driver>", driver(experiment, cases_at)));
        let assembled = prelude::assemble("<bench>", &files, &Isa::base())
            .unwrap_or_else(|report| panic!("{}", report.render(false)));
        let results = experiment.results.iter().map(|place| place.words()).sum();
        Bench { subject, program: assembled.program, cases_at, results }
    }

    /// The results of each case.
    pub fn run(&self, cases: &[Vec<i32>]) -> Vec<Vec<i32>> {
        let mut memory = self.subject.image.bytes.clone();
        memory.resize(self.cases_at as usize, 0);
        for case in cases {
            memory.extend(std::iter::once(&1).chain(case).flat_map(|word| word.to_le_bytes()));
            memory.resize(memory.len() + 4 * self.results, 0);
        }
        // Where the next case would begin.
        memory.resize(memory.len() + 1024, 0);
        let (isa, config) = (Isa::base(), self.subject.machine());
        let one_core = OneCore { step_limit: 1_000_000_000, ..OneCore::new(&config, &isa, &self.program) };
        let run = run(&one_core, Memory::new(memory)).unwrap_or_else(|report| panic!("{}", report.render(false)));
        if let Some(trap) = run.trap {
            panic!("{trap}");
        }
        let mut at = self.cases_at;
        let mut results = Vec::new();
        for case in cases {
            at += 4 * (1 + case.len() as u32);
            let word = |k: usize| run.memory.word(at + 4 * k as u32).expect("results are in memory");
            results.push((0..self.results).map(word).collect());
            at += 4 * self.results as u32;
        }
        results
    }
}

/// A case is the word 1, its operands, and room for its results; the word 0 ends the list.
fn driver(experiment: &Experiment, cases_at: u32) -> String {
    let operands: usize = experiment.operands.iter().map(|place| place.words()).sum();
    let results: usize = experiment.results.iter().map(|place| place.words()).sum();
    let (taken, given) = (4 * (1 + operands), 4 * results);
    let mut text = format!(
        ".entry driver\n.func driver\n    li s31, {cases_at}\ndriver_case:\n    movi s12, CASE\n    movi s13, {taken}\n    \
         load s12, s31, s13\n    lw s12, CASE(s0)\n    beqz s12, driver_end\n"
    );
    let mut at = 1;
    for place in experiment.operands {
        text.push_str(&place.load(at));
        at += place.words();
    }
    text.push_str(experiment.body);
    let mut at = 0;
    for place in experiment.results {
        text.push_str(&place.store(at));
        at += place.words();
    }
    let _ = write!(
        text,
        "\n    lea s31, {taken}(s31)\n    movi s12, RESULT\n    movi s13, {given}\n    store s31, s12, s13\n    lea s31, {given}(s31)\n    \
         jump driver_case\ndriver_end:\n    halt\n.endfunc\n.buffer\nCASE: .space {taken}\nRESULT: .space {given}\n.text\n"
    );
    text
}
