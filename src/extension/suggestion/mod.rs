//! Sequences of instructions that would pay most as one instruction, from the counts of a run.

mod block;
mod flow;
mod pattern;
mod result;
mod source;
mod words;

use std::collections::BTreeMap;
use std::fmt::Write;

use emu::code::Code;
use kernels::Function;

pub use self::result::{SUGGESTION_SCHEMA, SuggestionResult};

use self::block::{Block, blocks};
use self::flow::ProgramFlow;
use self::pattern::Pattern;
use self::words::Majors;
use crate::drawing::Drawing;
use crate::job::Job;

/// Least share of the run's instructions that a suggestion saves.
const LEAST_SHARE: f64 = 0.0005;

/// One instruction in the place of a sequence.
#[derive(Clone, Debug)]
pub struct Suggestion {
    /// Name of the suggested instruction.
    pub name: String,
    /// Row of the suggested instruction.
    pub row: String,
    /// Lines of its body.
    pub lines: Vec<String>,
    /// The functions in which the sequence stands, each once.
    pub functions: Vec<&'static str>,
    /// Places of the program.
    pub places: usize,
    /// Places where other instructions stood between those of the sequence.
    pub apart: usize,
    /// Number of executions.
    pub executions: u64,
    /// Clocks of its instructions, one after the other.
    pub serial: u64,
    /// Clocks of the longest chain of results in it.
    pub critical: u64,
}

/// Suggestions from a run.
#[derive(Clone, Debug)]
pub struct Suggestions {
    /// The instructions, the one that saves most time on the machine first.
    pub found: Vec<Suggestion>,
    /// Their file.
    pub extension: String,
    /// The functions that use them, with their text for this scene.
    pub kernels: Vec<(Function, String)>,
    /// Instructions of the run.
    pub instructions: u64,
    /// Clocks that the cores computed.
    pub clocks: u64,
}

impl Suggestion {
    /// Clocks of computing that it saves at most, on the machine of the run: when it takes as long as its chain.
    pub fn saved_clocks(&self) -> u64 {
        self.executions * (self.serial - self.critical)
    }

    /// Instructions that it saves.
    pub fn saved(&self) -> u64 {
        self.executions * (self.lines.len() as u64 - 1)
    }
}

impl Suggestions {
    /// Speed-up of the cores at most, when a suggested instruction takes as long as its chain (Amdahl).
    pub fn speedup(&self, found: &Suggestion) -> f64 {
        self.clocks as f64 / self.clocks.saturating_sub(found.saved_clocks()).max(1) as f64
    }
}

/// Finds up to `most` instructions.
pub fn suggest(job: &Job, drawing: &Drawing, name: &str, most: usize) -> Suggestions {
    // Decode both programs, and count how often each word ran.
    let isa = &job.isa;
    let program = &drawing.build.cores;
    let timing = job.machine.timing();
    let code = Code::new(program, isa, timing);
    let flow = ProgramFlow::new(program, isa);
    let main_flow = ProgramFlow::new(&drawing.build.main, isa);
    let counts: Vec<u64> = (0..code.words()).map(|pc| drawing.frame.tally.word(&code, pc).instructions).collect();
    // A function that both programs have must read the same in both, since one file serves both.
    let mut functions: Vec<(Function, Vec<Block>)> = Vec::new();
    for &function in Function::ALL {
        let name = function.name();
        let own = blocks(program, &flow, isa, name, &counts);
        let here = source::text(program, &flow, isa, name, &own);
        let mains = blocks(&drawing.build.main, &main_flow, isa, name, &[]);
        let is_alike = || here == source::text(&drawing.build.main, &main_flow, isa, name, &mains);
        if here.is_some() && (source::range(&drawing.build.main, name).is_none() || is_alike()) {
            functions.push((function, own));
        }
    }
    // Take the sequence that saves most time, put the instruction in all of its places, and look again: what is left may form others.
    let total: u64 = counts.iter().sum();
    let mut majors = Majors::new(isa);
    let mut found: Vec<Suggestion> = Vec::new();
    while found.len() < most {
        // Sum what each sequence would save over all blocks.
        let mut totals: BTreeMap<&str, Saving> = BTreeMap::new();
        for block in functions.iter_mut().flat_map(|(_, blocks)| blocks) {
            block.search(&flow, isa, &timing);
        }
        for block in functions.iter().flat_map(|(_, blocks)| blocks) {
            let mut ends: BTreeMap<&str, usize> = BTreeMap::new();
            for candidate in block.candidates.iter().flatten() {
                // Of sequences that overlap the first counts.
                if ends.get(&*candidate.key).is_none_or(|&end| end <= candidate.window.start) {
                    ends.insert(&candidate.key, candidate.window.end);
                    let Pattern { lines, serial, critical, .. } = &candidate.pattern;
                    let entry = totals.entry(&candidate.key).or_default();
                    entry.bits = candidate.pattern.bits();
                    entry.clocks += block.count * (serial - critical);
                    entry.instructions += block.count * (lines.len() as u64 - 1);
                }
            }
        }
        // Choose the one that saves most clocks of computing on this machine, of equal ones the one that saves most instructions,
        // then the one with fewest operand bits, as long as it is worth an opcode.
        let is_worth = |saving: &Saving| saving.instructions as f64 >= LEAST_SHARE * total as f64;
        let fitting = totals.into_iter().filter(|(_, saving)| majors.has_room(saving.bits) && is_worth(saving));
        let best =
            fitting.max_by_key(|(_, saving)| (saving.clocks, saving.instructions, std::cmp::Reverse(saving.bits)));
        let Some((key, _)) = best else { break };
        let key = key.to_owned();
        let mnemonic = format!("{name}{}", found.len() + 1);
        // Replace it wherever it stands; each replacement changes the block, so the search starts anew.
        let mut sites = Sites::default();
        for block in functions.iter_mut().flat_map(|(_, blocks)| blocks) {
            loop {
                let candidates = block.search(&flow, isa, &timing);
                let Some(site) = candidates.iter().find(|candidate| candidate.key == key).cloned() else { break };
                block.replace(&site, site.pattern.call(&mnemonic, &site.fields));
                sites.add(block, site.is_apart, site.pattern);
            }
        }
        let Some(pattern) = sites.pattern else { break };
        let row = majors.row(&mnemonic, &pattern);
        let Pattern { lines, serial, critical, .. } = pattern;
        let Sites { functions, places, apart, executions, .. } = sites;
        let name = mnemonic;
        found.push(Suggestion { name, row, lines, functions, places, apart, executions, serial, critical });
    }
    // What is left may form a sequence that saves more than one before it.
    found.sort_by_key(|one| std::cmp::Reverse((one.saved_clocks(), one.saved())));
    // Write the functions that changed as files that serve them.
    let scene = crate::job::result_name(&job.scene);
    let kernels =
        functions.iter().filter(|(function, _)| found.iter().any(|one| one.functions.contains(&function.name())));
    let kernels = kernels.filter_map(|(function, blocks)| {
        let text = source::text(program, &flow, isa, function.name(), blocks)?;
        let head =
            format!("; `{}` as it is assembled for {scene}, with instructions of {name}.isa.\n", function.name());
        Some((*function, format!("{head}; team: {}\n{text}", job.kernels.profile)))
    });
    Suggestions {
        kernels: kernels.collect(),
        extension: extension(name, &scene, &found),
        found,
        instructions: total,
        clocks: drawing.frame.processors[..job.machine.cores as usize].iter().map(|core| core.busy.0).sum(),
    }
}

/// Savings of a sequence over all its places.
#[derive(Clone, Copy, Debug, Default)]
struct Saving {
    /// Clocks of computing, at most.
    clocks: u64,
    /// Instructions.
    instructions: u64,
    /// Operand bits of the instruction in its place.
    bits: u32,
}

/// Sites of one instruction in the program.
#[derive(Default)]
struct Sites {
    pattern: Option<Pattern>,
    functions: Vec<&'static str>,
    places: usize,
    apart: usize,
    executions: u64,
}

impl Sites {
    fn add(&mut self, block: &Block, is_apart: bool, pattern: Pattern) {
        self.pattern = Some(pattern);
        self.places += 1;
        self.apart += usize::from(is_apart);
        self.executions += block.count;
        if self.functions.last() != Some(&block.function) {
            self.functions.push(block.function);
        }
    }
}

/// The file of the instructions.
fn extension(name: &str, scene: &str, found: &[Suggestion]) -> String {
    let mut text = format!(
        "; Sequences of instructions of {scene} as single instructions, written by `lancer extension suggest`.\n.extension {name}\n"
    );
    for one in found {
        let _ = write!(
            text,
            "\n;; {} instructions of {}, executed {} times.\n.instr {}\n",
            one.lines.len(),
            one.functions.join(", "),
            one.executions,
            one.row
        );
        one.lines.iter().for_each(|line| {
            let _ = writeln!(text, "    {line}");
        });
        text.push_str(".end\n");
    }
    text
}
