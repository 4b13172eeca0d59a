//! Tally of passes: how often each outcome of each word was taken, folded into classes and lines afterwards. Engines only add to it.

use std::collections::BTreeMap;

use isa::Counts;
use isa::program::Line;

use crate::code::{Code, OutcomeCost};

/// Passes through one exit of one word, beside what one pass takes: an engine looks at both for each instruction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Passes {
    /// Number of passes.
    pub count: u64,
    /// Units of the per-unit cost, summed.
    pub units: u64,
    /// Clocks of those, which are not always in proportion: 9 triangles on 4 lanes take three turns.
    pub unit_clocks: u64,
    /// Cost of one pass, its units left out.
    pub cost: OutcomeCost,
}

/// Losses of numeric results on their way into words: the flags of IEEE 1666, counted. A vector has three results.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Losses {
    /// Results that lost bits below the last place.
    pub quantized: u64,
    /// Results that did not fit.
    pub overflowed: u64,
}

impl Losses {
    /// Adds others.
    #[inline]
    pub fn add(&mut self, more: Losses) {
        self.quantized += more.quantized;
        self.overflowed += more.overflowed;
    }
}

/// Passes by exit, in the order of the program's exits, and what results lost.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    passes: Vec<Passes>,
    /// By slot.
    losses: Vec<Losses>,
}

/// Cost of one source line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LineCount {
    /// Instructions executed.
    pub instructions: u64,
    /// Their operations.
    pub counts: Counts,
    /// Clocks of computing them.
    pub busy: u64,
}

impl Tally {
    /// Nothing yet, for a program.
    pub fn new(code: &Code) -> Tally {
        let none_yet = |&cost: &OutcomeCost| Passes { cost, ..Passes::default() };
        Tally {
            passes: code.costs().iter().map(none_yet).collect(),
            losses: vec![Losses::default(); code.slots().len()],
        }
    }

    /// All passes, by number: see [`crate::code::Slot::first_outcome`].
    #[inline]
    pub fn passes_mut(&mut self) -> &mut [Passes] {
        &mut self.passes
    }

    /// All passes, and what the results of each slot lost, where the arithmetic counts that.
    #[inline]
    pub fn parts_mut(&mut self) -> (&mut [Passes], &mut [Losses]) {
        (&mut self.passes, &mut self.losses)
    }

    /// All passes, by number.
    pub fn all(&self) -> &[Passes] {
        &self.passes
    }

    /// Losses of the results of each slot.
    pub fn slot_losses(&self) -> &[Losses] {
        &self.losses
    }

    /// Losses of the results of each word, those of its body included.
    pub fn losses(&self, code: &Code) -> Vec<Losses> {
        let mut words = vec![Losses::default(); code.words() as usize];
        for (slot, &losses) in (0..).zip(&self.losses) {
            if let Some(word) = words.get_mut(code.word(slot) as usize) {
                word.add(losses);
            }
        }
        words
    }

    /// The passes through exit number `exit` of a word. Those of an extension instruction that costs what its body does have the cost of
    /// the body's last step.
    pub fn passes(&self, code: &Code, word: u32, exit: usize) -> Passes {
        let mut total = Passes::default();
        for number in code.passes_of(word).filter(|&number| code.passes()[number].exit == Some(exit as u8)) {
            let Some(passes) = self.passes.get(number) else { continue };
            total.count += passes.count;
            total.units += passes.units;
            total.unit_clocks += passes.unit_clocks;
            total.cost = passes.cost;
        }
        total
    }

    /// Adds another tally of the same program.
    pub fn merge(&mut self, other: &Tally) {
        for (passes, more) in self.passes.iter_mut().zip(&other.passes) {
            passes.count += more.count;
            passes.units += more.units;
            passes.unit_clocks += more.unit_clocks;
        }
        for (losses, &more) in self.losses.iter_mut().zip(&other.losses) {
            losses.add(more);
        }
    }

    /// Instructions executed; the steps of a body are none.
    pub fn instructions(&self) -> u64 {
        self.passes.iter().filter(|passes| !passes.cost.is_inner).map(|passes| passes.count).sum()
    }

    /// Instructions and operations of one word, those of the body that it stands for included.
    pub fn word(&self, code: &Code, word: u32) -> LineCount {
        let mut total = LineCount::default();
        for number in code.passes_of(word) {
            let Some(passes) = self.passes.get(number).filter(|passes| passes.count != 0) else { continue };
            // Steps of a body cost, but the program has written one instruction.
            if !passes.cost.is_inner {
                total.instructions += passes.count;
            }
            let (cost, each) = code.pass_cost(number);
            total.counts += cost.times(passes.count) + each.times(passes.units);
            total.busy += passes.count * u64::from(passes.cost.clocks) + passes.unit_clocks;
        }
        total
    }

    /// Operations by class.
    pub fn counts(&self, code: &Code) -> Counts {
        let mut total = Counts::ZERO;
        for word in 0..code.words() {
            total += self.word(code, word).counts;
        }
        total
    }

    /// Costs of the source lines that were executed.
    pub fn lines(&self, code: &Code) -> BTreeMap<Line, LineCount> {
        let mut lines: BTreeMap<Line, LineCount> = BTreeMap::new();
        for (pc, &line) in code.program.lines.iter().enumerate() {
            let word = self.word(code, pc as u32);
            if word.instructions != 0 {
                let total = lines.entry(line).or_default();
                total.instructions += word.instructions;
                total.counts += word.counts;
                total.busy += word.busy;
            }
        }
        lines
    }
}
