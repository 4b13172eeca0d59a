//! Basic blocks as lists whose order may change, as far as what the instructions read and write allows.

use std::ops::Range;

use emu::timing::Timing;
use isa::{Instruction, Isa, Program};

use super::flow::{ProgramFlow, RegisterSet, registers};
use super::pattern::{Pattern, is_plain};
use super::source;

/// Longest sequence.
const LONGEST: usize = 12;

/// Most instructions among which the parts of a sequence lie.
const WIDEST: usize = 20;

/// Accesses of an instruction to the local buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum BufferAccess {
    None,
    Reads,
    Writes,
}

/// One instruction of a block.
#[derive(Clone, Debug)]
pub struct BlockItem {
    /// The words that it stands for.
    pub words: Vec<usize>,
    /// The line in their place, when it was made of them.
    pub made: Option<String>,
    reads: RegisterSet,
    writes: RegisterSet,
    buffer: BufferAccess,
    /// True where nothing may change places with it.
    is_fence: bool,
    /// True where it may become part of another one.
    is_plain: bool,
}

impl BlockItem {
    fn new(pc: usize, instruction: Option<&Instruction>, isa: &Isa) -> BlockItem {
        let words = vec![pc];
        let Some(instruction) = instruction else {
            let all = RegisterSet::MAX;
            return BlockItem {
                words,
                made: None,
                reads: all,
                writes: all,
                buffer: BufferAccess::Writes,
                is_fence: true,
                is_plain: false,
            };
        };
        let (row, is_plain) = (isa.definition(instruction.op), is_plain(instruction, isa));
        // Loads have a result, stores have none but the address.
        let buffer = match (&*row.room, row.operand(b'd')) {
            ("local", Some(_)) => BufferAccess::Reads,
            ("local", None) => BufferAccess::Writes,
            _ => BufferAccess::None,
        };
        let [reads, writes] = [false, true].map(|is_written| registers(instruction, isa, is_written));
        BlockItem { words, made: None, reads, writes, buffer, is_fence: !is_plain, is_plain }
    }

    /// True where two instructions must keep their order.
    fn conflicts(&self, other: &BlockItem) -> bool {
        self.is_fence
            || other.is_fence
            || self.writes & (other.reads | other.writes) != 0
            || self.reads & other.writes != 0
            || self.buffer.max(other.buffer) == BufferAccess::Writes
                && self.buffer.min(other.buffer) != BufferAccess::None
    }

    /// The registers that may be read before it, from those after it.
    fn live_before(&self, live: RegisterSet) -> RegisterSet {
        live & !self.writes | self.reads
    }
}

/// A sequence that could be one instruction.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// Key of sequences that the same instruction can take the place of.
    pub key: String,
    /// The instruction.
    pub pattern: Pattern,
    /// The registers of its operands.
    pub fields: Vec<u8>,
    /// From the first of its items to the last one.
    pub window: Range<usize>,
    /// True where other items stand between its own.
    pub is_apart: bool,
    picks: Vec<usize>,
    before: Vec<usize>,
    after: Vec<usize>,
}

/// A basic block, or the part of one that belongs to one region.
#[derive(Clone, Debug)]
pub struct Block {
    /// Words of the block.
    pub range: Range<usize>,
    /// The function that it belongs to.
    pub function: &'static str,
    /// Number of executions.
    pub count: u64,
    /// Instructions of the block.
    pub items: Vec<BlockItem>,
    /// Sequences in it; `None` when they have to be looked for again.
    pub candidates: Option<Vec<Candidate>>,
    /// Registers that may be read behind it.
    live: RegisterSet,
}

/// The blocks of a function, in their order; none where it is not in one piece.
pub fn blocks(program: &Program, flow: &ProgramFlow, isa: &Isa, function: &'static str, counts: &[u64]) -> Vec<Block> {
    let Some((_, range)) = source::range(program, function) else { return Vec::new() };
    let mut blocks: Vec<Block> = Vec::new();
    for pc in range {
        let item = BlockItem::new(pc, flow.instructions[pc].as_ref(), isa);
        let begins = flow.is_leader[pc] || pc != 0 && program.region_of[pc] != program.region_of[pc - 1];
        match blocks.last_mut().filter(|_| !begins) {
            Some(block) => {
                block.range.end = pc + 1;
                block.live = flow.live[pc];
                block.items.push(item);
            }
            None => blocks.push(Block {
                range: pc..pc + 1,
                function,
                count: counts.get(pc).copied().unwrap_or(0),
                items: vec![item],
                candidates: None,
                live: flow.live[pc],
            }),
        }
    }
    blocks
}

impl Block {
    /// Looks for sequences, unless that was done and nothing has changed since.
    pub fn search(&mut self, flow: &ProgramFlow, isa: &Isa, timing: &Timing) -> &[Candidate] {
        if self.candidates.is_none() {
            let mut found = Vec::new();
            if self.count != 0 {
                let ends = |first: usize| first + 1..self.items.len().min(first + WIDEST);
                for (first, last) in (0..self.items.len()).flat_map(|first| ends(first).map(move |last| (first, last)))
                {
                    found.extend(
                        self.choices(first, last)
                            .into_iter()
                            .filter_map(|picks| self.candidate(picks, flow, isa, timing)),
                    );
                }
            }
            self.candidates = Some(found);
        }
        self.candidates.as_deref().unwrap_or_default()
    }

    /// Items between two, both included, that could be one instruction: all of them, those that the last one needs, those that share
    /// results with it.
    fn choices(&self, first: usize, last: usize) -> Vec<Vec<usize>> {
        let items = &self.items;
        if !items[first].is_plain || !items[last].is_plain {
            return Vec::new();
        }
        // All of the window, where nothing in it keeps it from being one instruction.
        let mut choices: Vec<Vec<usize>> = Vec::new();
        if items[first..=last].iter().all(|item| item.is_plain) {
            choices.push((first..=last).collect());
        }
        let mut needed = vec![last];
        let mut related = vec![last];
        // The instructions before that wrote what this one reads.
        let sources = |of: usize| {
            let mut rest = items[of].reads;
            let writers = (first..of).rev().filter(move |&at| {
                let is_source = items[at].writes & rest != 0;
                rest &= !items[at].writes;
                is_source
            });
            writers.filter(|&at| items[at].is_plain)
        };
        // Follow the last instruction's operands to what made them, until nothing new comes.
        let mut at = 0;
        while at < needed.len() {
            let new: Vec<usize> = sources(needed[at]).filter(|source| !needed.contains(source)).collect();
            needed.extend(new);
            at += 1;
        }
        // The same in both directions: what made an operand, and what else uses a result.
        let mut at = 0;
        while at < related.len() {
            let here = related[at];
            let users =
                (here + 1..=last).filter(|&user| items[user].is_plain && sources(user).any(|from| from == here));
            let new: Vec<usize> = sources(here).chain(users).filter(|other| !related.contains(other)).collect();
            related.extend(new);
            at += 1;
        }
        // A choice counts in the window of its own first instruction alone, so that none is found twice.
        for mut picks in [needed, related] {
            picks.sort_unstable();
            picks.dedup();
            if picks[0] == first && !choices.contains(&picks) {
                choices.push(picks);
            }
        }
        choices.retain(|picks| (2..=LONGEST).contains(&picks.len()));
        choices
    }

    /// The items that have to come before and after the instruction for some items, of those between; `None` where the order does not allow it.
    fn arrange(&self, picks: &[usize]) -> Option<(Vec<usize>, Vec<usize>)> {
        let (mut before, mut after): (Vec<usize>, Vec<usize>) = (Vec::new(), Vec::new());
        for at in picks[0]..=*picks.last()? {
            let item = &self.items[at];
            let follows = |others: &[usize]| others.iter().any(|&other| self.items[other].conflicts(item));
            // A part of the sequence moves to the place of the instruction, so it must not depend on anything put behind it.
            if picks.contains(&at) {
                if follows(&after) {
                    return None;
                }
                continue;
            }
            // Another item goes behind the instruction when it depends on a part of it or on something behind it already.
            let earlier = &picks[..picks.partition_point(|&pick| pick < at)];
            if follows(earlier) || follows(&after) { after.push(at) } else { before.push(at) }
        }
        Some((before, after))
    }

    fn candidate(&self, picks: Vec<usize>, flow: &ProgramFlow, isa: &Isa, timing: &Timing) -> Option<Candidate> {
        let (before, after) = self.arrange(&picks)?;
        let window = picks[0]..picks.last()? + 1;
        // Registers that are read after the window, or by what is moved behind the instruction.
        let behind = self.items[window.end..].iter();
        let live = behind.rev().fold(self.live, |live, item| item.live_before(live));
        let live = after.iter().rev().fold(live, |live, &at| self.items[at].live_before(live));
        let words = picks.iter().flat_map(|&at| &self.items[at].words);
        let instructions: Option<Vec<Instruction>> = words.map(|&pc| flow.instructions[pc]).collect();
        let (pattern, fields) = Pattern::new(&instructions?, live, isa, timing)?;
        let key = format!("{:?} {:?}", pattern.operands, pattern.lines);
        let is_apart = window.len() != picks.len();
        Some(Candidate { key, pattern, fields, window, is_apart, picks, before, after })
    }

    /// Puts an instruction in the place of a sequence.
    pub fn replace(&mut self, candidate: &Candidate, line: String) {
        let Candidate { pattern, fields, window, picks, before, after, .. } = candidate;
        let parts = || picks.iter().map(|&at| &self.items[at]);
        let (reads, writes) = pattern.registers(fields);
        // The new instruction takes the words, registers and buffer accesses of its parts together.
        let made = BlockItem {
            words: parts().flat_map(|item| item.words.clone()).collect(),
            made: Some(line),
            reads,
            writes,
            buffer: parts().map(|item| item.buffer).max().unwrap_or(BufferAccess::None),
            is_fence: false,
            is_plain: false,
        };
        let at = |places: &[usize]| -> Vec<BlockItem> { places.iter().map(|&at| self.items[at].clone()).collect() };
        let order: Vec<BlockItem> = at(before).into_iter().chain([made]).chain(at(after)).collect();
        self.items.splice(window.clone(), order);
        self.candidates = None;
    }
}
