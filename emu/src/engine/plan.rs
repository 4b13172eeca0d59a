//! A program cut into runs: where each ends, and what it takes. What the instructions do is not known here. Words, and what
//! bodies of extensions have beside them, stand in one [`Order`]; where there are no bodies, a place in it is a word.

use isa::{Fields, InstructionDef, Kind, Op};

use super::cost::Cost;
use crate::code::layout::{Order, Stage};
use crate::code::registers::Registers;
use crate::code::{Code, OutcomeCost, Slot};
use crate::engine::taint::TaintEffect;

/// A decoded word, or a step of a body, laid out for an engine that looks at one after the other.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// Place of the row in the table, [`Step::HOP`], [`Step::UNIT`], or [`Step::BAILOUT`].
    pub row: u8,
    /// Number of its exits.
    pub exits: u8,
    /// The exits take different times or numbers of operations.
    pub is_uneven: bool,
    /// Operands.
    pub fields: Fields,
    /// Number of its first exit: see [`Plan::pass`].
    pub exit: u32,
    /// Slot of the step; of a hop that to which it leads.
    pub slot: u32,
    /// The place to which a control row branches; one behind the program where that is not known.
    pub target: u32,
    /// Number of the instruction whose meaning is in Rust.
    pub unit: u16,
}

impl Step {
    /// Row of the way to a place that does not stand behind.
    pub const HOP: u8 = Op::BUILT_IN.len() as u8;
    /// Row of instructions whose meaning is in Rust.
    pub const UNIT: u8 = Step::HOP + 1;
    /// Row of what is for the interpreter, and of what stands behind the program.
    pub const BAILOUT: u8 = Step::UNIT + 1;
}

/// Number of a pass that belongs to no exit of the program: that through a hop.
const NO_PASS: u32 = u32::MAX;

/// A program as runs. A run begins anywhere and ends behind a control row, or at the end of the program.
#[derive(Clone, Debug)]
pub struct Plan<'a> {
    /// The program.
    pub code: &'a Code<'a>,
    order: Order,
    /// Costs of the places up to each, and up to the end, without what depends on exits: differences are those of runs.
    before: Vec<Cost>,
    /// By exit: the pass of the program.
    passes: Vec<u32>,
    /// Number of words.
    pub words: u32,
    /// Places of words are their numbers.
    is_in_order: bool,
    /// By exit: what it adds to the cost of its run; 0 where all exits of the slot take the same.
    extra: Vec<Cost>,
    effects: Vec<TaintEffect>,
    /// The steps, and one behind them.
    steps: Vec<Step>,
    /// By place: the end of the run that begins there, behind the next control row or in front of the end of the program.
    run_ends: Vec<u32>,
}

impl<'a> Plan<'a> {
    /// Finds the runs; `None` for timings with which an instruction takes so long that costs do not fit.
    ///
    /// Clocks of three words at 1 clock each, of which the last one branches and takes 2 clocks more when it does:
    ///
    /// | word | `before` | `extra` of its outcomes | run |
    /// | --- | --- | --- | --- |
    /// | 0 `iadd` | 0 | 0 | ends at 3, takes 2 clocks |
    /// | 1 `imul` | 1 | 0 | ends at 3, takes 1 |
    /// | 2 `beq` | 2 | 1 fallen through, 3 taken | ends at 3, takes 0, and what the outcome adds |
    /// | end | 2 | | |
    ///
    /// What a run takes is a difference of two of `before`, wherever it begins. A word whose outcomes differ puts all of its cost into `extra`
    /// but the step itself.
    pub fn new(code: &'a Code<'a>) -> Option<Plan<'a>> {
        let order = Order::new(code);
        let stages = order.stages();
        // Number the outcomes in the order of the places
        let mut passes = Vec::with_capacity(code.costs().len());
        let mut firsts = Vec::with_capacity(stages.len());
        for &stage in stages {
            firsts.push(passes.len());
            match stage {
                Stage::Slot(slot) => {
                    let first = code.slots()[slot as usize].first_outcome;
                    passes.extend((first..).take(code.slot_row(slot).map_or(0, |row| row.outcomes.len())));
                }
                Stage::Hop(_) => passes.push(NO_PASS),
            }
        }
        firsts.push(passes.len());
        // Add up what all take, and set aside what depends on outcomes
        let mut sums = Vec::with_capacity(stages.len() + 1);
        let mut extra = vec![Cost::default(); passes.len()];
        let mut before = Cost::default();
        let mut most = vec![Cost::default(); stages.len()];
        for (place, stage) in stages.iter().enumerate() {
            sums.push(before);
            // A slot without an instruction has no outcomes: its range is empty, and it takes the bare step.
            let exits = firsts[place]..firsts[place + 1];
            if let Stage::Hop(_) = stage {
                continue;
            }
            let costs: Vec<OutcomeCost> =
                passes[exits.clone()].iter().map(|&pass| code.costs()[pass as usize]).collect();
            let is_alike = costs.iter().all(|cost| cost == &costs[0]);
            let bare = Cost::step(costs.first().is_some_and(|cost| cost.is_inner));
            let whole = if is_alike { costs.first().map_or(bare, Cost::new) } else { bare };
            most[place] = whole;
            for (exit, cost) in exits.zip(&costs) {
                // The dearest outcome counts for the room of a sum, whichever is taken.
                most[place] = most[place].max(Cost::new(cost));
                if !is_alike {
                    extra[exit] = Cost(Cost::new(cost).0 - bare.0);
                }
            }
            // Differences of sums that wrap are still right.
            before = Cost(before.0.wrapping_add(whole.0));
        }
        sums.push(before);
        // Find the ends of runs from behind, and refuse those that a sum has no room for
        let mut run_ends = vec![stages.len() as u32; stages.len() + 1];
        let mut of_run = Cost::default();
        for place in (0..stages.len()).rev() {
            let is_end = ends_run(code, stages[place]);
            run_ends[place] = if is_end { place as u32 + 1 } else { run_ends[place + 1] };
            of_run = if is_end { most[place] } else { of_run.plus(most[place]) };
            if !of_run.is_small() {
                return None;
            }
        }
        let effect = |stage: &Stage| match stage {
            Stage::Slot(slot) => TaintEffect::new(code, *slot),
            Stage::Hop(_) => TaintEffect::default(),
        };
        let effects: Vec<TaintEffect> = stages.iter().map(effect).collect();
        // Lay out a step for each place
        let words = code.words();
        // Steps need the plan's own sums and ends, so they come when those are in place.
        let mut plan = Plan {
            code,
            is_in_order: order.stages().len() == words as usize,
            order,
            before: sums,
            passes,
            words,
            extra,
            effects,
            steps: Vec::new(),
            run_ends,
        };
        plan.steps = (0..).zip(&firsts).map(|(place, &first)| plan.new_step(place, first)).collect();
        Some(plan)
    }

    fn new_step(&self, place: u32, first: usize) -> Step {
        let code = self.code;
        let slot = self.order.slot(place);
        let mut step = Step {
            row: Step::BAILOUT,
            exits: 0,
            is_uneven: false,
            fields: Fields::default(),
            exit: first as u32,
            slot,
            target: self.end() + 1,
            unit: 0,
        };
        // Behind the last place stands a step that hands over to the interpreter, which traps there.
        let Some(&stage) = self.order.stages().get(place as usize) else { return step };
        let target = target(code, &self.order, stage);
        step.target = target.unwrap_or(self.end() + 1);
        if let Stage::Hop(_) = stage {
            return Step { row: Step::HOP, exits: 1, ..step };
        }
        let Some((op, row)) = code.slots()[slot as usize].op.zip(code.slot_row(slot)) else { return step };
        step.exits = row.outcomes.len() as u8;
        let extra = &self.extra[first..first + row.outcomes.len()];
        step.is_uneven = extra.iter().any(|extra| *extra != Cost::default());
        // What is written to s0 goes where nobody reads it. What is read there as well is left to the interpreter, and so is what leads out.
        step.fields = code.slots()[slot as usize].fields;
        let mut is_odd = target.is_none() && branches(row);
        // Meanings in Rust may ask for what they write, and keep s0 zero.
        let is_unit = matches!(op, Op::Ext(_));
        for operand in row.operands.iter().filter(|operand| operand.kind == Kind::S && operand.is_written()) {
            if !is_unit && step.fields.get(operand.letter) == 0 {
                is_odd |= operand.is_read();
                step.fields.set(operand.letter, Registers::NOWHERE.into());
            }
        }
        (step.row, step.unit) = match op {
            _ if is_odd => (Step::BAILOUT, 0),
            Op::Ext(number) => (Step::UNIT, number),
            _ => (op.index() as u8, 0),
        };
        step
    }

    /// The place behind the program.
    #[inline(always)]
    pub fn end(&self) -> u32 {
        self.before.len() as u32 - 1
    }

    /// The place of a slot; that behind the program for what is none.
    #[inline(always)]
    pub fn place_of(&self, slot: u32) -> u32 {
        if self.is_in_order { slot.min(self.words) } else { self.order.place(slot) }
    }

    /// Cost that an outcome adds to that of its run.
    #[inline(always)]
    pub fn extra(&self, exit: usize) -> Cost {
        self.extra[exit]
    }

    /// The pass of the program that an exit is; the exits of words and hops are numbered in their order.
    #[inline(always)]
    pub fn pass(&self, exit: usize) -> Option<usize> {
        self.passes.get(exit).filter(|&&pass| pass != NO_PASS).map(|&pass| pass as usize)
    }

    /// Number of exits.
    pub fn exits(&self) -> usize {
        self.passes.len()
    }

    /// Taint effect of a place.
    pub fn effect(&self, place: u32) -> TaintEffect {
        self.effects[place as usize]
    }

    /// The steps by their places, and one behind them.
    #[inline(always)]
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// True where a run ends behind a place.
    pub fn is_run_end(&self, place: u32) -> bool {
        self.run_end(place) == place + 1
    }

    /// True where control that leaves a run by the first exit of its last step goes on behind that, with no other sign of it.
    pub fn falls_through(&self, place: u32) -> bool {
        let step = &self.steps[place as usize];
        step.row != Step::UNIT && step.exits > 1
    }

    /// End of the run that begins at a place, or at the end of the program.
    #[inline(always)]
    pub fn run_end(&self, place: u32) -> u32 {
        self.run_ends[place as usize]
    }

    /// Cost of the places from one to before another one of the same run, without what depends on exits.
    #[inline(always)]
    pub fn cost(&self, from: u32, to: u32) -> Cost {
        let [from, to] = [from, to].map(|place| self.before[place as usize].0);
        Cost(to.wrapping_sub(from))
    }

    /// The decoded words.
    #[inline(always)]
    pub fn slots(&self) -> &[Slot] {
        self.code.slots()
    }
}

/// True for an instruction that says how far away control may go.
fn branches(row: &InstructionDef) -> bool {
    row.operands.iter().any(|operand| operand.kind == Kind::Rel)
}

/// True where control may go elsewhere than to the next place.
fn ends_run(code: &Code, stage: Stage) -> bool {
    let Stage::Slot(slot) = stage else { return true };
    let Some(row) = code.slot_row(slot) else { return true };
    match code.slots()[slot as usize].op {
        Some(Op::Ext(_)) => branches(row),
        _ => row.room == "control",
    }
}

/// The place to which a branch or a hop leads; `None` for what is neither, and outside the program.
fn target(code: &Code, order: &Order, stage: Stage) -> Option<u32> {
    let slot = match stage {
        Stage::Hop(slot) => return Some(order.place(slot)),
        Stage::Slot(slot) => slot,
    };
    let (row, decoded) = (code.slot_row(slot)?, code.slots()[slot as usize]);
    let distance = row.operands.iter().find(|operand| operand.kind == Kind::Rel)?;
    if let Some(Op::Ext(_)) = decoded.op {
        return Some(order.place(code.distant(slot)));
    }
    let target = slot.wrapping_add_signed(decoded.fields.get(distance.letter) as i32);
    (!code.is_outside(slot, target)).then(|| order.place(target))
}
