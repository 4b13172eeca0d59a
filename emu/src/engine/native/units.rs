//! Units of instructions that do several of something, such as the triangles of a packet or the nodes of a walk: which exits have counters for them,
//! and what they cost.

use isa::{Counts, InstructionDef};

use crate::code::Turns;
use crate::engine::plan::{Plan, Step};

/// All exits of steps that may end with units. They are numbered, since they are few.
#[derive(Clone, Debug)]
pub(super) struct UnitExits {
    exits: Vec<u32>,
    /// By exit: its number; `u32::MAX` for others.
    numbers: Vec<u32>,
    /// Cost of the units by number, where one takes as long as another.
    turns: Vec<Option<Turns>>,
}

impl UnitExits {
    /// The exits of a plan.
    pub fn new(plan: &Plan) -> UnitExits {
        let steps = plan.steps()[..plan.end() as usize].iter().filter(|step| has_units(plan, step));
        let exits: Vec<u32> = steps.flat_map(|step| (step.exit..).take(step.exits.into())).collect();
        let mut numbers = vec![u32::MAX; plan.exits()];
        for (number, &exit) in (0..).zip(&exits) {
            numbers[exit as usize] = number;
        }
        let turns = |&exit: &u32| {
            let cost = plan.code.costs()[plan.pass(exit as usize)?];
            if cost.has_busy_units { cost.turns } else { Some(Turns::FREE) }
        };
        UnitExits { turns: exits.iter().map(turns).collect(), numbers, exits }
    }

    /// The exits, by number.
    pub fn exits(&self) -> &[u32] {
        &self.exits
    }

    /// The number of one of these exits.
    #[inline]
    pub fn number(&self, exit: usize) -> usize {
        self.numbers[exit] as usize
    }

    /// Cost of the units of an exit by its number, where one takes as long as another.
    #[inline]
    pub fn turns(&self, number: usize) -> Option<Turns> {
        self.turns[number]
    }

    /// The number of a step's first exit, and the cost of the units of all of them, where that is the same.
    pub fn even_turns(&self, step: &Step) -> Option<(usize, Turns)> {
        let first = self.number(step.exit as usize);
        let all = self.turns.get(first..)?.get(..step.exits.into())?;
        let turns = (*all.first()?)?;
        all.iter().all(|&other| other == Some(turns)).then_some((first, turns))
    }
}

/// True where a step may end with units: its row says so, or its meaning is in Rust.
pub(super) fn has_units(plan: &Plan, step: &Step) -> bool {
    let has_some = |row: &InstructionDef| row.outcomes.iter().any(|exit| exit.each != Counts::ZERO);
    step.row == Step::UNIT || plan.code.slot_row(step.slot).is_some_and(has_some)
}
