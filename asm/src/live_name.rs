//! Names of one register that meet: one is read where another one, known at the same place, was written last on every way. Found by following
//! the flow of control through the program, calls included; nothing is said of registers with a single name.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::ops::Range;

use isa::{Instruction, Isa, Kind, Op};
use messages::Severity;

use crate::assembler::Assembler;
use crate::explain;
use crate::holding::AliasSpan;
use crate::message::{At, Problem};
use crate::operand::Register;

/// A name that operands of some words were written with.
#[derive(Clone, Debug)]
pub(crate) struct NameUse {
    /// Number of the name among all.
    alias: usize,
    at: At,
    words: Range<u32>,
}

/// Names that a register was perhaps written by last, a bit each.
type Writers = u64;

/// Bit of a register that is as it was when the function was entered.
const UNCHANGED: Writers = 1 << 63;

/// Bit of a register that was written last without a name.
const UNNAMED: Writers = 1 << 62;

/// Bit of a word that control reaches.
const REACHED: Writers = 1 << 61;

/// Names of one register that are told apart; of a register with more nothing is said.
const MOST_NAMES: usize = 60;

/// Steps of following that a program may take before nothing more is said.
const MOST_STEPS: usize = 20_000_000;

/// NameFlow of control behind a word.
#[derive(Clone, Copy)]
enum Course {
    /// To the next word.
    On,
    /// To the next word or to another.
    Branch(usize),
    /// To another word.
    Jump(usize),
    /// Into a function and back.
    Call(usize),
    /// Back, or nowhere that is known.
    Ends,
    /// Back to the caller.
    Returns,
}

/// One register's part in one word.
#[derive(Clone, Copy, Default)]
struct Touch {
    /// Names by which it is read, a bit each.
    read: Writers,
    /// Bit of the name by which it is written.
    written: Option<Writers>,
}

impl Assembler<'_> {
    /// Notes that the statement uses a name of a register.
    pub(crate) fn use_name(&mut self, alias: usize, at: At) {
        self.name_uses.push(NameUse { alias, at, words: 0..0 });
    }

    /// Notes which words came of a statement that used names.
    pub(crate) fn place_uses(&mut self, first_use: usize, first_word: u32) {
        let words = first_word..self.program.words.len() as u32;
        self.name_uses[first_use..].iter_mut().for_each(|found| found.words = words.clone());
    }

    /// Warns of names that meet.
    pub(crate) fn report_meetings(&mut self, spans: &[AliasSpan]) {
        let uses = std::mem::take(&mut self.name_uses);
        let mut names: BTreeMap<Register, Vec<usize>> = BTreeMap::new();
        for found in &uses {
            let known = names.entry(spans[found.alias].register).or_default();
            if !known.contains(&found.alias) {
                known.push(found.alias);
            }
        }
        // Names of one register that are nowhere known together cannot meet.
        let overlaps = |a: usize, b: usize| {
            let (a, b) = (&spans[a].words, &spans[b].words);
            a.start < b.end && b.start < a.end
        };
        names.retain(|_, names| {
            names.len() <= MOST_NAMES && names.iter().any(|&a| names.iter().any(|&b| a != b && overlaps(a, b)))
        });
        if names.is_empty() || self.is_incomplete {
            return;
        }
        let decoded: Vec<Option<Instruction>> = self.program.words.iter().map(|&word| self.isa.decode(word)).collect();
        let flow = NameFlow { courses: courses(&decoded, self.isa), entry: self.program.entry as usize };
        let mut steps = MOST_STEPS;
        for (register, names) in names {
            let touches = touches(register, &names, &uses, &decoded, self.isa);
            let Some(before) = flow.writers(&touches, &mut steps) else { return };
            let mut seen = HashSet::new();
            let read_names = |touch: &Touch| {
                let read = touch.read;
                (0..names.len()).filter(move |own| read >> own & 1 == 1)
            };
            let reads = touches.iter().enumerate().flat_map(|(pc, touch)| read_names(touch).map(move |own| (pc, own)));
            for (pc, own) in reads {
                // A way on which the name itself was written last, or no name, may be the only one that is taken.
                let is_sure = before[pc] & (1 << own | UNNAMED | UNCHANGED) == 0;
                let bits = if is_sure { before[pc] & !REACHED } else { 0 };
                let own = names[own];
                for (number, &alias) in names.iter().enumerate().filter(|(number, _)| bits >> number & 1 == 1) {
                    if !spans[alias].words.contains(&(pc as u32)) || !seen.insert((own, alias)) {
                        continue;
                    }
                    // The write that is nearest before the read in the text tells most.
                    let writes = |pc: &usize| touches[*pc].written == Some(1 << number);
                    let write = (0..pc).rev().find(writes).or_else(|| (pc..touches.len()).find(writes));
                    let place = |pc: usize, alias: usize| {
                        uses.iter().find(|found| found.alias == alias && found.words.contains(&(pc as u32)))
                    };
                    let (file, digits) = register;
                    let (own_name, other_name) = (&spans[own].name, &spans[alias].name);
                    let Some(read) = place(pc, own) else { continue };
                    let message = format!("`{own_name}` is read where {file}{digits} holds `{other_name}`");
                    let mut problem = Problem::new(explain::MEETING, message, read.at, "read here")
                        .also(write.and_then(|pc| place(pc, alias)).map(|found| found.at), "written here")
                        .hint("two names that are known at once need registers of their own, or `.unreg`");
                    problem.severity = Severity::Warning;
                    self.messages.add(problem);
                }
            }
        }
    }
}

/// The part of a register in each word.
fn touches(
    register: Register,
    names: &[usize],
    uses: &[NameUse],
    decoded: &[Option<Instruction>],
    isa: &Isa,
) -> Vec<Touch> {
    let mut named: HashMap<u32, Writers> = HashMap::new();
    for found in uses {
        let Some(bit) = names.iter().position(|&name| name == found.alias) else { continue };
        found.words.clone().for_each(|pc| *named.entry(pc).or_default() |= 1 << bit);
    }
    let touch = |(pc, instruction): (usize, &Option<Instruction>)| {
        let mut touch = Touch::default();
        let Some(instruction) = instruction else { return touch };
        for operand in isa.definition(instruction.op).operands.iter() {
            let first = instruction.fields.get(operand.letter) as u8;
            let group = first..first.saturating_add(operand.kind.registers());
            if operand.kind.register_file() != Some(register.0) || !group.contains(&register.1) {
                continue;
            }
            if operand.is_read() {
                touch.read = named.get(&(pc as u32)).copied().unwrap_or(0);
            }
            if operand.is_written() {
                let name = named.get(&(pc as u32)).copied().filter(|bits| bits.count_ones() == 1);
                touch.written = Some(name.unwrap_or(UNNAMED));
            }
        }
        // A statement that reads and writes a register by two names says nothing about which is read.
        if touch.written == Some(UNNAMED) {
            touch.read = 0;
        }
        touch
    };
    decoded.iter().enumerate().map(touch).collect()
}

fn courses(decoded: &[Option<Instruction>], isa: &Isa) -> Vec<Course> {
    let course = |(pc, instruction): (usize, &Option<Instruction>)| {
        let Some(instruction) = instruction else { return Course::Ends };
        let definition = isa.definition(instruction.op);
        let distance = definition.operands.iter().find(|operand| operand.kind == Kind::Rel);
        let target = distance.map(|operand| pc as i64 + instruction.fields.get(operand.letter));
        let target = target.map(|target| usize::try_from(target).unwrap_or(usize::MAX));
        match (instruction.op, target) {
            (Op::halt | Op::trap, _) => Course::Ends,
            (Op::ret, _) => Course::Returns,
            // Where a register leads is not known; the function comes back as it is wont to.
            (Op::callr, _) | (_, None) => Course::On,
            (Op::call, Some(target)) => Course::Call(target),
            (_, Some(target)) if definition.outcomes.len() == 1 => Course::Jump(target),
            (_, Some(target)) => Course::Branch(target),
        }
    };
    decoded.iter().enumerate().map(course).collect()
}

struct NameFlow {
    courses: Vec<Course>,
    entry: usize,
}

impl NameFlow {
    /// Perhaps last writers of a register before each word; `None` when the program is too long to follow.
    fn writers(&self, touches: &[Touch], steps: &mut usize) -> Option<Vec<Writers>> {
        let calls = self.courses.iter().filter_map(|course| match course {
            Course::Call(target) if *target < self.courses.len() => Some(*target),
            _ => None,
        });
        let mut functions: Vec<usize> = calls.collect();
        functions.sort_unstable();
        functions.dedup();
        // First what each function leaves behind, until that of all functions together changes no more: sets only grow.
        let mut left: HashMap<usize, Writers> = functions.iter().map(|&function| (function, 0)).collect();
        let mut before = vec![0; self.courses.len()];
        loop {
            let mut is_done = true;
            for &function in &functions {
                let starts = &[(function, UNCHANGED)];
                let (reached, more) = self.follow(starts, touches, &left, false, &mut before, steps)?;
                reached.into_iter().for_each(|pc| before[pc] = 0);
                let known = left.get_mut(&function).expect("all functions are there");
                is_done &= *known | more == *known;
                *known |= more;
            }
            if is_done {
                break;
            }
        }
        // Then what comes to each word from the program's start, functions entered with what their callers had.
        let starts: Vec<(usize, Writers)> = [self.entry].iter().chain(&functions).map(|&start| (start, 0)).collect();
        self.follow(&starts, touches, &left, true, &mut before, steps)?;
        Some(before)
    }

    /// Adds the writers before each word from some starts on; yields the words that were reached, and the writers at returns.
    fn follow(
        &self,
        starts: &[(usize, Writers)],
        touches: &[Touch],
        left: &HashMap<usize, Writers>,
        enters_calls: bool,
        before: &mut [Writers],
        steps: &mut usize,
    ) -> Option<(Vec<usize>, Writers)> {
        let (mut reached, mut returned) = (Vec::new(), 0);
        let mut work: Vec<(usize, Writers)> = starts.to_vec();
        while let Some((pc, more)) = work.pop() {
            *steps = steps.checked_sub(1)?;
            let Some(&course) = self.courses.get(pc) else { continue };
            let known = before[pc];
            if known | more | REACHED == known {
                continue;
            }
            if known & REACHED == 0 {
                reached.push(pc);
            }
            before[pc] = known | more | REACHED;
            let after = touches[pc].written.unwrap_or(known | more) & !REACHED;
            match course {
                Course::On => work.push((pc + 1, after)),
                Course::Branch(target) => work.extend([(pc + 1, after), (target, after)]),
                Course::Jump(target) => work.push((target, after)),
                Course::Call(target) => {
                    if enters_calls {
                        work.push((target, after & !UNCHANGED));
                    }
                    // A function that has not come back yet leaves nothing to go on with.
                    match left.get(&target) {
                        Some(0) => {}
                        Some(&through) => {
                            let kept = if through & UNCHANGED == 0 { 0 } else { after };
                            work.push((pc + 1, through & !UNCHANGED | kept));
                        }
                        None => work.push((pc + 1, after)),
                    }
                }
                Course::Returns => returned |= after,
                Course::Ends => {}
            }
        }
        Some((reached, returned))
    }
}
