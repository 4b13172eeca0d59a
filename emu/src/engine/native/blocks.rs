//! A plan cut into the blocks of generated code: where control may come from elsewhere, where blocks end, and which ways in have to look at
//! the sums.

use isa::Op;

use super::Recipe;
use super::profiling::Profiling;
use crate::engine::cost::Cost;
use crate::engine::plan::{Plan, Step};

/// Facts about the places of a program, before code is generated. The place behind the last one is one of them.
pub(super) struct Blocks {
    /// Places at which generated code can be entered, and to which branches lead.
    pub is_join: Vec<bool>,
    /// End of the block in which a place lies: the place behind its last one.
    pub end: Vec<u32>,
    /// Joins at which the sums have to be looked at wherever control comes from, because more might be added than there is room for.
    pub is_watched: Vec<bool>,
    /// Places behind calls that keep where they return to in a register, by register.
    pub returns: Vec<Vec<u32>>,
}

/// The instruction at a place; `None` for what is none of the table's, or is for the interpreter.
pub(super) fn op(plan: &Plan, step: &Step) -> Option<Op> {
    match step.row {
        Step::HOP | Step::UNIT | Step::BAILOUT => None,
        _ => plan.slots()[step.slot as usize].op,
    }
}

/// A row asks the machine for something, so that it may have to be tried again.
pub(super) fn asks(plan: &Plan, step: &Step) -> bool {
    op(plan, step).is_some_and(|_| plan.code.slot_row(step.slot).is_some_and(|row| row.room == "bus"))
}

impl Blocks {
    /// Looks at a plan.
    pub fn new(plan: &Plan, recipe: &Recipe, profiling: Option<&Profiling>) -> Blocks {
        let (steps, end) = (plan.steps(), plan.end());
        let mut blocks = Blocks {
            is_join: vec![false; end as usize + 1],
            end: vec![end; end as usize + 1],
            is_watched: vec![false; end as usize + 1],
            returns: vec![Vec::new(); 1 << 8],
        };
        blocks.is_join[plan.place_of(plan.code.program.entry) as usize] = true;
        // Where addresses of instructions are computed, any word may be called.
        let calls_anywhere = steps.iter().any(|step| op(plan, step) == Some(Op::callr));
        for (place, step) in (0..end).zip(steps) {
            if step.target <= end {
                blocks.is_join[step.target as usize] = true;
            }
            let is_word = step.slot < plan.words && step.row != Step::HOP;
            let may_wait = asks(plan, step) || step.row == Step::UNIT;
            blocks.is_join[place as usize] |= may_wait && recipe.is_stepped();
            blocks.is_join[place as usize] |= calls_anywhere && is_word;
            match op(plan, step) {
                Some(Op::call | Op::callr) => {
                    blocks.is_join[place as usize + 1] = true;
                    blocks.returns[usize::from(step.fields.d)].push(place + 1);
                }
                Some(Op::rstep) => {
                    // Each of its ways goes on by itself, past branches that it decides.
                    blocks.is_join[place as usize + 1] = true;
                    let behind = steps[place as usize + 1..].iter().zip(place + 2..);
                    let decided = behind.take_while(|(next, _)| compares_with_zero(plan, next, step.fields.e));
                    decided.for_each(|(_, next)| blocks.is_join[next as usize] = true);
                }
                _ => {}
            }
        }
        // Who measures each call is told of borders at the ends of blocks, and another calling context begins there where functions are left.
        let is_border = |place: &u32| profiling.is_some_and(|profiling| profiling.ends_block(place - 1, *place));
        for place in (1..end).filter(is_border) {
            blocks.is_join[place as usize] = true;
        }
        blocks.watch(plan);
        for place in (0..end).rev() {
            let next = place as usize + 1;
            let is_last = blocks.is_join[next] || plan.is_run_end(place);
            blocks.end[place as usize] = if is_last { place + 1 } else { blocks.end[next] };
        }
        blocks
    }

    /// Finds the places that have to be watched though nothing leads back there, and makes them joins.
    ///
    /// Sums are looked at where control goes back and behind returns. From there on they are below half of the room of each field, so that up
    /// to the next look another half may be added. With half = 100, three runs in a row that take 40 each, and no way back: the first two
    /// come to 80, and a third one would to 120, so its beginning is watched, and counts from 0 again.
    fn watch(&mut self, plan: &Plan) {
        let steps = plan.steps();
        let end = plan.end() as usize;
        let most: Vec<Cost> = steps[..end].iter().map(|step| most(plan, step)).collect();
        let mut of_run = vec![Cost::default(); end + 1];
        for place in (0..end).rev() {
            let behind = if plan.is_run_end(place as u32) { Cost::default() } else { of_run[place + 1] };
            of_run[place] = behind.plus(most[place]);
        }
        // The most that may have been added before a place, by ways that are not looked at.
        let mut before = vec![Cost::default(); end + 1];
        let mut here = Cost::default();
        for place in 0..end {
            let begins_run = place == 0 || plan.is_run_end(place as u32 - 1);
            if self.is_join[place] || begins_run {
                here = here.max(before[place]);
                if !here.plus(of_run[place]).is_below_half() {
                    (self.is_join[place], self.is_watched[place], here) = (true, true, Cost::default());
                }
            }
            here = here.plus(most[place]);
            let target = steps[place].target as usize;
            if target > place && target <= end {
                before[target] = before[target].max(here);
            }
        }
    }
}

/// The most that a step takes, through whatever exit.
fn most(plan: &Plan, step: &Step) -> Cost {
    let passes = (0..usize::from(step.exits)).filter_map(|exit| plan.pass(step.exit as usize + exit));
    passes.map(|pass| Cost::new(&plan.code.costs()[pass])).fold(Cost::default(), Cost::max)
}

/// A step is a branch that compares a scalar with 0, in that order.
pub(super) fn compares_with_zero(plan: &Plan, step: &Step, scalar: u8) -> bool {
    let is_branch = step.exits == 2 && step.target <= plan.end();
    let compares = matches!(op(plan, step), Some(Op::beq | Op::bne | Op::blt | Op::bge));
    is_branch && compares && step.fields.a == scalar && step.fields.b == 0
}
