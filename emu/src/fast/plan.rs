//! A program cut into basic blocks: where each ends, and what it takes. What the instructions do is not known here.

use std::ops::Range;

use isa::{Kind, Op, Row};

use crate::code::{Code, Slot};
use crate::independence::Mark;

/// Bits of a field of a [`Toll`].
const FIELD: u32 = 21;

/// Largest number of a field that one block may need, so that many fit before [`Toll`]s have to be emptied.
const MOST: u64 = 1 << 16;

/// Instructions, clocks and elementary operations in one number of three fields, so that a lane adds up all three at once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Toll(pub u64);

impl Toll {
    /// The toll of an instruction; a number beyond [`MOST`] counts as that, and the plan is refused.
    fn new(steps: u64, clocks: u64, elementary: u64) -> Toll {
        Toll(steps | clocks.min(MOST) << FIELD | elementary.min(MOST) << (2 * FIELD))
    }

    /// Instructions.
    #[inline(always)]
    pub const fn steps(self) -> u64 {
        self.0 & ((1 << FIELD) - 1)
    }

    /// Clocks.
    #[inline(always)]
    pub const fn clocks(self) -> u64 {
        self.0 >> FIELD & ((1 << FIELD) - 1)
    }

    /// Elementary operations.
    #[inline(always)]
    pub const fn elementary(self) -> u64 {
        self.0 >> (2 * FIELD)
    }

    /// The largest of the three.
    fn largest(self) -> u64 {
        self.steps().max(self.clocks()).max(self.elementary())
    }
}

/// What the engine knows of a word beside its slot.
#[derive(Clone, Copy, Debug, Default)]
pub struct Place {
    /// End of the block that begins here: the word after its last one.
    pub end: u32,
    /// Largest field of a toll that the block may add.
    pub most: u32,
    /// Tolls of the words up to here, without what depends on exits: differences are those of blocks.
    pub before: Toll,
}

/// A program as blocks. A block begins at any word and ends behind a control row, or before a word that a branch leads to.
#[derive(Clone, Debug)]
pub struct Plan<'a> {
    /// The program.
    pub code: &'a Code<'a>,
    places: Vec<Place>,
    /// By exit: what it adds to the block's toll; 0 where all exits of the word take the same.
    extra: Vec<Toll>,
    marks: Vec<Mark>,
    /// How many words up to here ask for numbers of cores, or send.
    asking: Vec<u32>,
}

impl<'a> Plan<'a> {
    /// Finds the blocks; `None` for programs with instructions of extensions, and for timings with which an instruction takes so long that tolls
    /// do not fit.
    pub fn new(code: &'a Code<'a>) -> Option<Plan<'a>> {
        if (0..code.words()).any(|word| matches!(code.op(word), Some(Op::Ext(_)))) {
            return None;
        }
        let slots = &code.slots()[..code.words() as usize];
        let mut is_target = vec![false; slots.len() + 1];
        for (pc, slot) in slots.iter().enumerate() {
            if ends_block(code.row(pc as u32)) {
                is_target[pc + 1] = true;
            }
            if let Some(at) = branch_target(code, pc, slot).filter(|&at| at < slots.len()) {
                is_target[at] = true;
            }
        }
        let mut places = vec![Place::default(); slots.len() + 1];
        let mut extra = vec![Toll::default(); code.costs().len()];
        let mut before = Toll::default();
        let mut most = vec![0; slots.len()];
        for (pc, slot) in slots.iter().enumerate() {
            places[pc].before = before;
            let exits = code.row(pc as u32).map_or(0, |row| row.exits.len());
            let first = slot.first_exit as usize;
            let costs = &code.costs()[first..first + exits];
            let toll = |steps: u64, at: usize| Toll::new(steps, costs[at].clocks.into(), costs[at].elementary.into());
            let is_alike = costs.iter().all(|cost| cost == &costs[0] && !cost.has_busy_units);
            let whole = if is_alike && exits != 0 { toll(1, 0) } else { Toll::new(1, 0, 0) };
            most[pc] = whole.largest();
            for at in 0..exits {
                most[pc] = most[pc].max(toll(1, at).largest());
                if !is_alike {
                    extra[first + at] = toll(0, at);
                }
            }
            // Differences of sums that wrap are still right.
            before = Toll(before.0.wrapping_add(whole.0));
        }
        places[slots.len()].before = before;
        let mut is_fit = true;
        for pc in (0..slots.len()).rev() {
            let is_last = is_target[pc + 1] || pc + 1 == slots.len();
            let (end, after) = if is_last { (pc + 1, 0) } else { (places[pc + 1].end as usize, places[pc + 1].most) };
            places[pc].end = end as u32;
            let sum = most[pc] + u64::from(after);
            is_fit &= sum < MOST;
            places[pc].most = sum.min(MOST) as u32;
        }
        let marks: Vec<Mark> = (0..slots.len() as u32).map(|pc| Mark::new(code, pc)).collect();
        let mut asking = vec![0];
        for mark in &marks {
            asking.push(asking.last().copied().unwrap_or(0) + u32::from(mark.asks()));
        }
        is_fit.then_some(Plan { code, places, extra, marks, asking })
    }

    /// What is known of a word; `None` outside the program.
    #[inline(always)]
    pub fn place(&self, pc: u32) -> Option<&Place> {
        self.places[..self.code.words() as usize].get(pc as usize)
    }

    /// Toll of the words from one to before another one of the same block, without what depends on exits.
    #[inline(always)]
    pub fn toll(&self, from: u32, to: u32) -> Toll {
        Toll(self.places[to as usize].before.0.wrapping_sub(self.places[from as usize].before.0))
    }

    /// What an exit adds to the toll of its block.
    #[inline(always)]
    pub fn extra(&self, exit: usize) -> Toll {
        self.extra[exit]
    }

    /// Whether one of some words asks for numbers of cores, or sends.
    #[inline(always)]
    pub fn asks(&self, words: &Range<u32>) -> bool {
        self.asking[words.start as usize] != self.asking[words.end as usize]
    }

    /// What a word does with numbers of cores.
    pub fn mark(&self, pc: u32) -> Mark {
        self.marks[pc as usize]
    }

    /// The decoded words.
    #[inline(always)]
    pub fn slots(&self) -> &[Slot] {
        self.code.slots()
    }
}

/// Whether control may go elsewhere than to the next word.
fn ends_block(row: Option<&Row>) -> bool {
    row.is_none_or(|row| row.room == "control")
}

/// Where a branch leads to.
fn branch_target(code: &Code, pc: usize, slot: &Slot) -> Option<usize> {
    let relative = code.row(pc as u32)?.operands.iter().find(|operand| operand.kind == Kind::Rel)?;
    usize::try_from(pc as i64 + slot.fields.get(relative.letter)).ok()
}
