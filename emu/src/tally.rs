//! How often each exit of each word was taken, and what that folds into: classes, lines. Engines only add to it.

use std::collections::BTreeMap;

use isa::Counts;
use isa::program::Line;

use crate::code::{Code, ExitCost};

/// Passes through one exit of one word, beside what one pass takes: an engine looks at both for each instruction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Passes {
    /// How often.
    pub count: u64,
    /// Units of the per-unit cost, summed.
    pub units: u64,
    /// What one pass takes, its units left out.
    pub cost: ExitCost,
}

/// Passes by exit, in the order of the program's exits.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    passes: Vec<Passes>,
}

/// What one source line took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LineCount {
    /// Instructions executed.
    pub instructions: u64,
    /// Their operations.
    pub counts: Counts,
}

impl Tally {
    /// Nothing yet, for a program.
    pub fn new(code: &Code) -> Tally {
        let none_yet = |&cost: &ExitCost| Passes { count: 0, units: 0, cost };
        Tally { passes: code.costs().iter().map(none_yet).collect() }
    }

    /// All passes, in the order of [`crate::code::Slot::first_exit`].
    #[inline]
    pub fn passes_mut(&mut self) -> &mut [Passes] {
        &mut self.passes
    }

    /// The passes through exit number `exit` of a word.
    pub fn passes(&self, code: &Code, pc: u32, exit: usize) -> Passes {
        let first = code.slots().get(pc as usize).map_or(usize::MAX, |slot| slot.first_exit as usize);
        first.checked_add(exit).and_then(|at| self.passes.get(at)).copied().unwrap_or_default()
    }

    /// Adds another tally of the same program.
    pub fn merge(&mut self, other: &Tally) {
        for (passes, more) in self.passes.iter_mut().zip(&other.passes) {
            passes.count += more.count;
            passes.units += more.units;
        }
    }

    /// Instructions executed.
    pub fn instructions(&self) -> u64 {
        self.passes.iter().map(|passes| passes.count).sum()
    }

    /// Instructions and operations of one word.
    pub fn word(&self, code: &Code, pc: u32) -> LineCount {
        let mut total = LineCount::default();
        for exit in 0..code.row(pc).map_or(0, |row| row.exits.len()) {
            let passes = self.passes(code, pc, exit);
            if passes.count != 0 {
                total.instructions += passes.count;
                total.counts += code.cost(pc, exit, passes.count, passes.units);
            }
        }
        total
    }

    /// Operations by class.
    pub fn counts(&self, code: &Code) -> Counts {
        let mut total = Counts::ZERO;
        for pc in 0..code.slots().len() as u32 {
            total += self.word(code, pc).counts;
        }
        total
    }

    /// What each source line took, for lines that were executed.
    pub fn lines(&self, code: &Code) -> BTreeMap<Line, LineCount> {
        let mut lines: BTreeMap<Line, LineCount> = BTreeMap::new();
        for (pc, &line) in code.program.lines.iter().enumerate() {
            let word = self.word(code, pc as u32);
            if word.instructions != 0 {
                let total = lines.entry(line).or_default();
                total.instructions += word.instructions;
                total.counts += word.counts;
            }
        }
        lines
    }
}
