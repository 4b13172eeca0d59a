//! A program cut into basic blocks: where each ends, and what it takes. What the instructions do is not known here.

use std::ops::Range;

use isa::{Fields, Kind, Op, Row};

use crate::code::{Code, Slot};
use crate::independence::Mark;
use crate::registers::Registers;

/// Bits of a field of a [`Toll`].
pub(super) const FIELD: u32 = 21;

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

/// A decoded word, laid out for an engine that looks at one after the other.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub struct Step {
    /// Place of the row in the table; the number of rows for a word that is none of them, and behind the last word.
    pub row: u8,
    /// Its operands.
    pub fields: Fields,
    /// Number of the pass through its first exit.
    pub exit: u32,
    /// Whether its exits take different times or numbers of operations.
    pub is_uneven: bool,
    /// Of a control row: what the exit that falls through and the run behind it take, then the same of the other exit, where its target is
    /// known; what has to be looked at has the [`FLAG`].
    pub edges: [u64; 2],
    /// Where a control row branches to; a word outside the program where that is not known or not there.
    pub target: u32,
}

/// The bit that no toll has: a run has to be looked at before it begins.
pub const FLAG: u64 = 1 << 63;

/// A table by [`Step::row`]: what stands last is for all numbers behind it as well.
pub(super) const fn padded<T: Copy, const N: usize>(rows: [T; N]) -> [T; 256] {
    const { assert!(N <= 256 && N == Op::BUILT_IN.len() + 1) };
    let mut padded = [rows[N - 1]; 256];
    let mut row = 0;
    while row < N {
        padded[row] = rows[row];
        row += 1;
    }
    padded
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
    steps: Vec<Step>,
    /// By word: the end of the run that begins there, behind the next control row or in front of the end of the program.
    run_ends: Vec<u32>,
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
        let mut run_ends = vec![slots.len() as u32; slots.len() + 1];
        let mut longest = 0;
        for pc in (0..slots.len()).rev() {
            let is_last = is_target[pc + 1] || pc + 1 == slots.len();
            let (end, after) = if is_last { (pc + 1, 0) } else { (places[pc + 1].end as usize, places[pc + 1].most) };
            places[pc].end = end as u32;
            let sum = most[pc] + u64::from(after);
            is_fit &= sum < MOST;
            places[pc].most = sum.min(MOST) as u32;
            let ends_run = ends_block(code.row(pc as u32));
            run_ends[pc] = if ends_run { pc as u32 + 1 } else { run_ends[pc + 1] };
            longest = if ends_run { most[pc] } else { longest + most[pc] };
            is_fit &= longest < MOST;
        }
        let marks: Vec<Mark> = (0..slots.len() as u32).map(|pc| Mark::new(code, pc)).collect();
        let mut asking = vec![0];
        for mark in &marks {
            asking.push(asking.last().copied().unwrap_or(0) + u32::from(mark.asks()));
        }
        let mut plan = Plan { code, places, extra, marks, steps: Vec::new(), run_ends, asking };
        plan.steps = (0..=code.words()).map(|pc| plan.new_step(pc)).collect();
        is_fit.then_some(plan)
    }

    /// The same for those who do not ask what depends on the number of cores.
    pub fn regardless_of_cores(mut self) -> Plan<'a> {
        self.asking.fill(0);
        self.steps = (0..=self.code.words()).map(|pc| self.new_step(pc)).collect();
        self
    }

    /// What a run takes, with the [`FLAG`] where it has to be looked at.
    pub fn flagged_toll(&self, pc: u32) -> u64 {
        match pc <= self.code.words() {
            true if self.asks(&(pc..self.run_end(pc))) => FLAG | self.run_toll(pc).0,
            true => self.run_toll(pc).0,
            false => FLAG,
        }
    }

    fn new_step(&self, pc: u32) -> Step {
        let code = self.code;
        let Some((slot, op)) = code.slots().get(pc as usize).filter(|_| pc < code.words()).map(|slot| (slot, slot.op))
        else {
            let row = Op::BUILT_IN.len() as u8;
            return Step {
                row,
                fields: Fields::default(),
                exit: 0,
                is_uneven: false,
                edges: [FLAG; 2],
                target: u32::MAX,
            };
        };
        let exits = code.row(pc).map_or(0, |row| row.exits.len());
        let extra = &self.extra[slot.first_exit as usize..slot.first_exit as usize + exits];
        let target = branch_target(code, pc as usize, slot).and_then(|target| u32::try_from(target).ok());
        let target = target.filter(|&target| target < code.words()).unwrap_or(u32::MAX);
        let extra_of = |exit: usize| extra.get(exit).map_or(0, |extra| extra.0);
        // What is written to s0 goes where nobody reads it. What is read there as well is left to the interpreter.
        let (mut fields, mut is_odd) = (slot.fields, false);
        let zeros = code.row(pc).into_iter().flat_map(|row| row.operands.iter());
        for operand in zeros.filter(|operand| operand.kind == Kind::S && operand.is_written()) {
            if slot.fields.get(operand.letter) == 0 {
                is_odd |= operand.is_read();
                fields.set(operand.letter, Registers::NOWHERE.into());
            }
        }
        let number = op.filter(|_| !is_odd).map_or(Op::BUILT_IN.len(), Op::index);
        Step {
            row: number.min(Op::BUILT_IN.len()) as u8,
            fields,
            exit: slot.first_exit,
            is_uneven: extra.iter().any(|extra| *extra != Toll::default()),
            edges: [
                self.flagged_toll(pc + 1) + extra_of(0),
                self.flagged_toll(target) + extra_of(exits.saturating_sub(1)),
            ],
            target,
        }
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

    /// The decoded words and one behind them.
    #[inline(always)]
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// End of the run that begins at a word, or at the end of the program.
    #[inline(always)]
    pub fn run_end(&self, pc: u32) -> u32 {
        self.run_ends[pc as usize]
    }

    /// What a run takes, without what depends on exits.
    #[inline(always)]
    pub fn run_toll(&self, pc: u32) -> Toll {
        self.toll(pc, self.run_end(pc))
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
