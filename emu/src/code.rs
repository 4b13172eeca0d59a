//! A program decoded once, with what each exit of each word costs. Counting happens elsewhere.

use isa::{Counts, Fields, Isa, Op, Program, Row};

use crate::quantity::Clocks;
use crate::timing::Timing;

/// One word, decoded.
#[derive(Clone, Copy, Debug)]
pub struct Slot {
    /// The instruction; `None` for a word that is none, which traps when it is executed.
    pub op: Option<Op>,
    /// Its operands.
    pub fields: Fields,
    /// Number of its first exit among all exits of the program.
    pub first_exit: u32,
}

/// What one exit of one word adds to a run, apart from its units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ExitCost {
    /// Time.
    pub clocks: u32,
    /// Elementary operations: add, sub, mul, div and cmp.
    pub elementary: u32,
    /// Whether its units take clocks or elementary operations; octets do not, as long as the bus accounts for them.
    pub has_busy_units: bool,
}

/// A decoded program.
#[derive(Clone, Debug)]
pub struct Code<'a> {
    /// The program.
    pub program: &'a Program,
    /// Where its rows come from.
    pub isa: &'a Isa,
    /// What operations take.
    pub timing: Timing,
    slots: Vec<Slot>,
    costs: Vec<ExitCost>,
}

impl<'a> Code<'a> {
    /// Decodes a program.
    pub fn new(program: &'a Program, isa: &'a Isa, timing: Timing) -> Code<'a> {
        let mut code = Code { program, isa, timing, slots: Vec::with_capacity(program.words.len()), costs: Vec::new() };
        for &word in &program.words {
            let instruction = isa.decode(word);
            let first_exit = code.costs.len() as u32;
            let slot = match instruction {
                Some(instruction) => Slot { op: Some(instruction.op), fields: instruction.fields, first_exit },
                None => Slot { op: None, fields: Fields::default(), first_exit },
            };
            if let Some(op) = slot.op {
                let fit = |number: u64| u32::try_from(number).unwrap_or(u32::MAX);
                code.costs.extend(isa.row(op).exits.iter().map(|exit| ExitCost {
                    clocks: fit(timing.clocks(&exit.cost).0),
                    elementary: fit(exit.cost.elementary()),
                    has_busy_units: timing.clocks(&exit.each).0 != 0 || exit.each.elementary() != 0,
                }));
            }
            code.slots.push(slot);
        }
        code
    }

    /// The decoded words.
    #[inline]
    pub fn slots(&self) -> &[Slot] {
        &self.slots
    }

    /// The row of a word; `None` for a word that is no instruction.
    pub fn row(&self, pc: u32) -> Option<&Row> {
        Some(self.isa.row(self.slots.get(pc as usize)?.op?))
    }

    /// What the exits cost, in the order of [`Slot::first_exit`].
    pub fn costs(&self) -> &[ExitCost] {
        &self.costs
    }

    /// Clocks and elementary operations that `units` units add to an exit of a word.
    pub fn unit_cost(&self, pc: u32, exit: usize, units: u32) -> (Clocks, u64) {
        let Some(exit) = self.row(pc).and_then(|row| row.exits.get(exit)) else { return (Clocks(0), 0) };
        let each = exit.each.times(units.into());
        (self.timing.clocks(&(exit.cost + each)) - self.timing.clocks(&exit.cost), each.elementary())
    }

    /// What `count` passes through an exit of a word with `units` units together cost.
    pub fn cost(&self, pc: u32, exit: usize, count: u64, units: u64) -> Counts {
        match self.row(pc).and_then(|row| row.exits.get(exit)) {
            Some(exit) => exit.cost.times(count) + exit.each.times(units),
            None => Counts::ZERO,
        }
    }
}
