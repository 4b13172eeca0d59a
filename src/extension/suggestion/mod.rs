//! Sequences of instructions that would pay most as one instruction, from the counts of a run.

mod flow;
mod pattern;
mod source;

use std::collections::BTreeMap;
use std::fmt::Write;

use emu::code::Code;
use isa::Isa;
use isa::picture::CUSTOM;
use kernels::Function;

use self::flow::Flow;
use self::pattern::{MOST_BITS, Pattern, is_plain};
use crate::drawing::Drawing;
use crate::job::Job;

/// Longest sequence.
const LONGEST: usize = 12;

/// Bits that tell instructions of one major opcode apart.
const SELECTOR: u32 = 4;

/// Least share of the run's instructions that a suggestion saves.
const LEAST_SHARE: f64 = 0.0005;

/// One instruction in the place of a sequence.
#[derive(Clone, Debug)]
pub struct Suggestion {
    /// Its name.
    pub name: String,
    /// Its row.
    pub row: String,
    /// Lines of its body.
    pub lines: Vec<String>,
    /// The functions in which the sequence stands, each once.
    pub functions: Vec<&'static str>,
    /// Places of the program.
    pub places: usize,
    /// How often it is executed.
    pub executions: u64,
    /// Clocks of its instructions, one after the other.
    pub serial: u64,
    /// Clocks of the longest chain of results in it.
    pub critical: u64,
}

/// What a run suggests.
#[derive(Clone, Debug)]
pub struct Suggestions {
    /// The instructions, the one that saves most first.
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
    /// Instructions that it saves.
    pub fn saved(&self) -> u64 {
        self.executions * (self.lines.len() as u64 - 1)
    }
}

/// A place where a pattern stands.
struct Site {
    start: usize,
    length: usize,
    fields: Vec<u8>,
    function: &'static str,
}

/// Finds up to `most` instructions.
pub fn suggest(job: &Job, drawing: &Drawing, name: &str, most: usize) -> Suggestions {
    let isa = &job.isa;
    let program = &drawing.build.cores;
    let timing = job.machine.timing();
    let code = Code::new(program, isa, timing);
    let flow = Flow::new(program, isa);
    let main_flow = Flow::new(&drawing.build.main, isa);
    let counts: Vec<u64> = (0..code.words()).map(|pc| drawing.frame.tally.word(&code, pc).instructions).collect();
    // A function that both programs have must read the same in both, since one file serves both.
    let none = BTreeMap::new();
    let functions: Vec<Function> = (Function::ALL.iter().copied())
        .filter(|function| {
            let here = source::text(program, &flow, isa, function.name(), &none);
            let is_in_main = source::range(&drawing.build.main, function.name()).is_some();
            here.is_some()
                && (!is_in_main || here == source::text(&drawing.build.main, &main_flow, isa, function.name(), &none))
        })
        .collect();
    let total: u64 = counts.iter().sum();
    let mut is_used = vec![false; program.words.len()];
    let mut found: Vec<(Pattern, Vec<Site>, String, String)> = Vec::new();
    let mut majors = Majors::new(isa);
    while found.len() < most {
        let mut candidates: BTreeMap<String, (Pattern, Vec<Site>, u64)> = BTreeMap::new();
        for &function in &functions {
            let Some((_, range)) = source::range(program, function.name()) else { continue };
            for start in range.clone() {
                for length in 1..=LONGEST.min(range.end - start) {
                    let last = start + length - 1;
                    let ends = is_used[last]
                        || length > 1 && (flow.is_leader[last] || program.region_of[last] != program.region_of[start])
                        || !flow.instructions[last].is_some_and(|instruction| is_plain(&instruction, isa));
                    if ends {
                        break;
                    }
                    if length == 1 || counts[start] == 0 {
                        continue;
                    }
                    let Some((pattern, fields)) = Pattern::new(&flow, isa, start, length, &timing) else { continue };
                    let key = format!("{:?} {:?}", pattern.operands, pattern.lines);
                    let (_, sites, saved) = candidates.entry(key).or_insert_with(|| (pattern, Vec::new(), 0));
                    // Of sequences that overlap the first counts.
                    if sites.last().is_none_or(|site| site.start + site.length <= start) {
                        *saved += counts[start] * (length as u64 - 1);
                        sites.push(Site { start, length, fields, function: function.name() });
                    }
                }
            }
        }
        let fitting = candidates.into_values().filter(|(pattern, ..)| majors.has_room(pattern.bits()));
        let Some((pattern, sites, saved)) =
            fitting.max_by_key(|(pattern, _, saved)| (*saved, std::cmp::Reverse(pattern.bits())))
        else {
            break;
        };
        if (saved as f64) < LEAST_SHARE * total as f64 {
            break;
        }
        for site in &sites {
            is_used[site.start..site.start + site.length].fill(true);
        }
        let mnemonic = format!("{name}{}", found.len() + 1);
        let row = majors.row(&mnemonic, &pattern);
        found.push((pattern, sites, mnemonic, row));
    }
    let mut replaced: BTreeMap<usize, (usize, String)> = BTreeMap::new();
    let mut suggestions = Vec::new();
    for (pattern, sites, mnemonic, row) in found {
        let executions = sites.iter().map(|site| counts[site.start]).sum();
        for site in &sites {
            let registers = pattern.operands.iter().zip(&site.fields);
            let registers: Vec<String> =
                registers.map(|((_, kind), number)| isa::register_name(*kind, *number)).collect();
            replaced.insert(site.start, (site.length, format!("{mnemonic} {}", registers.join(", "))));
        }
        let mut names: Vec<&'static str> = sites.iter().map(|site| site.function).collect();
        names.dedup();
        let Pattern { lines, serial, critical, .. } = pattern;
        suggestions.push(Suggestion {
            name: mnemonic,
            row,
            lines,
            functions: names,
            places: sites.len(),
            executions,
            serial,
            critical,
        });
    }
    let scene = crate::job::result_name(&job.scene);
    let kernels = functions
        .into_iter()
        .filter(|function| suggestions.iter().any(|found| found.functions.contains(&function.name())));
    let kernels = kernels.filter_map(|function| {
        let text = source::text(program, &flow, isa, function.name(), &replaced)?;
        let head =
            format!("; `{}` as it is assembled for {scene}, with instructions of {name}.isa.\n", function.name());
        Some((function, head + &text))
    });
    Suggestions {
        kernels: kernels.collect(),
        extension: extension(name, &scene, &suggestions),
        found: suggestions,
        instructions: total,
        clocks: drawing.frame.processors[..job.machine.cores as usize].iter().map(|core| core.busy.0).sum(),
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

/// Words that are left for extensions.
struct Majors {
    /// Major opcodes that are free as a whole, the last one first.
    free: Vec<&'static str>,
    /// The one that short instructions share, and how many of them there are.
    shared: Option<(&'static str, u32)>,
}

impl Majors {
    fn new(isa: &Isa) -> Majors {
        let is_free = |bits: &str| {
            let major = u32::from_str_radix(bits, 2).unwrap_or(0);
            isa.extensions().all(|op| isa.row(op).picture.value >> 26 != major)
        };
        Majors {
            free: CUSTOM.iter().rev().filter(|(_, bits)| is_free(bits)).map(|(name, _)| *name).collect(),
            shared: None,
        }
    }

    fn has_room(&self, bits: u32) -> bool {
        let shares = bits + SELECTOR <= MOST_BITS && self.shared.is_some_and(|(_, count)| count < 1 << SELECTOR);
        shares || !self.free.is_empty()
    }

    /// The row of a pattern, with words of its own.
    fn row(&mut self, name: &str, pattern: &Pattern) -> String {
        let bits = pattern.bits();
        let mut picture = String::new();
        let mut fields: Vec<(char, u8)> =
            pattern.operands.iter().map(|&(letter, kind)| (letter, kind.width().unwrap_or(0))).collect();
        fields.sort_by_key(|(letter, _)| isa::picture::LETTERS.iter().position(|&other| other == *letter as u8));
        for (letter, width) in fields {
            let _ = write!(picture, " {}", letter.to_string().repeat(width.into()));
        }
        let major = if bits + SELECTOR <= MOST_BITS {
            let (major, count) = match self.shared.take().filter(|(_, count)| *count < 1 << SELECTOR) {
                Some(shared) => shared,
                None => (self.free.pop().unwrap_or(CUSTOM[0].0), 0),
            };
            let rest = (MOST_BITS - SELECTOR - bits) as usize;
            let _ = write!(picture, " {}{count:0width$b}", "-".repeat(rest), width = SELECTOR as usize);
            self.shared = Some((major, count + 1));
            major
        } else {
            let _ = write!(picture, " {}", "-".repeat((MOST_BITS - bits) as usize));
            self.free.pop().unwrap_or(CUSTOM[0].0)
        };
        let operands: Vec<String> =
            pattern.operands.iter().map(|(letter, kind)| format!("{letter}: {}", kind.name())).collect();
        format!("{name} ({})  \"{major}{}\"  [Done(body)]", operands.join(", "), picture.trim_end())
    }
}
