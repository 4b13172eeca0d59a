//! Counts of a core in generated code, and how they fold into passes, calling contexts and octets.

use isa::{Counts, InstructionDef, Op};

use super::context::{ContextFrame, CounterLayout};
use super::{AddOctets, Native, blocks, run};
use crate::code::Turns;
use crate::code::quantity::Clocks;
use crate::code::tally::{Losses, Tally};
use crate::engine::plan::{Plan, Step};
use crate::profile::{ContextPasses, Profiler};

/// Counters of a core. Those that generated code changes stand in the frame.
#[derive(Clone, Debug)]
pub(super) struct Counters {
    pub frame: ContextFrame,
    /// Units by calling context and number; passes are counted in the frame.
    units: Vec<UnitCounter>,
    /// The exits that may have units; their places here are the numbers.
    unit_exits: Vec<u32>,
    /// By exit: its number among those.
    unit_numbers: Vec<u32>,
    /// Losses of results by slot, where those are counted.
    pub losses: Vec<Losses>,
    /// Kinds of the data that each site has met last.
    pub kinds: Vec<u32>,
}

impl Counters {
    /// Nothing yet.
    pub fn new(layout: CounterLayout, plan: &Plan, sites: usize, has_contexts: bool) -> Counters {
        let unit_steps = plan.steps()[..plan.end() as usize].iter().filter(|step| has_units(plan, step));
        let unit_exits: Vec<u32> = unit_steps.flat_map(|step| (step.exit..).take(step.exits.into())).collect();
        let mut unit_numbers = vec![u32::MAX; plan.exits()];
        for (number, &exit) in (0..).zip(&unit_exits) {
            unit_numbers[exit as usize] = number;
        }
        Counters {
            frame: ContextFrame::new(layout, has_contexts),
            units: unit_exits.iter().map(|&exit| UnitCounter::new(plan, exit as usize)).collect(),
            unit_exits,
            unit_numbers,
            losses: vec![Losses::default(); plan.slots().len()],
            kinds: vec![0; sites],
        }
    }

    /// The counter of an exit that may have units in a calling context, which is 0 where functions are not measured.
    #[inline]
    pub fn unit_counter(&mut self, context: u32, exit: usize) -> &mut UnitCounter {
        let at = context as usize * self.unit_exits.len() + self.unit_numbers[exit] as usize;
        if at >= self.units.len() {
            self.make_room(context);
        }
        &mut self.units[at]
    }

    #[cold]
    fn make_room(&mut self, context: u32) {
        let kinds = self.unit_exits.len();
        let new: Vec<_> = self.units[..kinds].iter().map(UnitCounter::emptied).collect();
        while self.units.len() < (context as usize + 1) * kinds {
            self.units.extend_from_slice(&new);
        }
    }
}

/// True where a step may end with units: its row says so, or its meaning is in Rust.
pub(super) fn has_units(plan: &Plan, step: &Step) -> bool {
    let has_some = |row: &InstructionDef| row.outcomes.iter().any(|exit| exit.each != Counts::ZERO);
    step.row == Step::UNIT || plan.code.slot_row(step.slot).is_some_and(has_some)
}

/// Units of an exit, with what they cost beside the sums: one look at memory is all that counting them takes.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct UnitCounter {
    units: u64,
    clocks: u64,
    /// Cost of the units, where one takes as long as another.
    pub turns: Option<Turns>,
}

impl UnitCounter {
    fn new(plan: &Plan, exit: usize) -> UnitCounter {
        let turns = plan.pass(exit).and_then(|pass| {
            let cost = plan.code.costs()[pass];
            if cost.has_busy_units { cost.turns } else { Some(Turns::FREE) }
        });
        UnitCounter { units: 0, clocks: 0, turns }
    }

    fn emptied(&self) -> UnitCounter {
        UnitCounter { units: 0, clocks: 0, ..*self }
    }

    /// Counts units that take so many clocks together.
    #[inline]
    pub fn add(&mut self, units: u32, clocks: Clocks) {
        self.units += u64::from(units);
        self.clocks += clocks.0;
    }

    /// What was counted, which is forgotten.
    fn take(&mut self) -> ContextPasses {
        let passes = ContextPasses { count: 0, units: self.units, unit_clocks: self.clocks };
        *self = self.emptied();
        passes
    }
}

impl Native<'_> {
    /// Adds the passes to a tally of the same program and to its profiler, and the octets that were read inline by kind, and forgets them.
    ///
    /// Execution counts are reconstructed by flow conservation: through a place go all that came from the place before and all that began there,
    /// less those that stopped in front of it. Of ten that begin a loop's body at place 4, whose last row at 7 is a branch that was taken six
    /// times, four come to place 8. Where functions are measured, this holds in each calling context by itself, and a call goes on in another one. So
    /// does what leaves a function by a jump or by running on, but that was counted where it began.
    pub(super) fn fold_counters(
        &mut self,
        tally: &mut Tally,
        add_octets: AddOctets,
        mut profiler: Option<&mut Profiler>,
    ) {
        let Native { plan, shared, counters, .. } = self;
        let (Some(counters), Some(Ok(code))) = (counters, shared.compiled.get()) else { return };
        let steps = &plan.steps()[..plan.end() as usize];
        let profiling = code.profiling.as_ref();
        let contexts = profiler.is_some().into()..counters.frame.count();
        let changes = |from, to| profiling.is_some_and(|profiling| profiling.change(from, to).is_some());
        // Let what was taken begin runs where it leads. Behind instructions with a meaning in Rust a run was begun wherever they led.
        for context in contexts.clone() {
            let branches = (0..)
                .zip(steps)
                .filter(|(_, step)| step.exits != 0 && step.row != Step::UNIT && step.target <= plan.end());
            for (place, step) in branches {
                let node = counters.frame.node(context);
                let taken = node.exits[step.exit as usize + usize::from(step.exits) - 1];
                let is_call = blocks::op(plan, step) == Some(Op::call);
                if !is_call && changes(place, step.target) {
                    continue;
                }
                let mut to = context;
                if let (Some(profiler), Some(profiling)) = (&mut profiler, profiling)
                    && taken != 0
                {
                    let entered = match is_call {
                        true => profiling.around(step.target),
                        false => profiling.entered(place, step.target),
                    };
                    entered.iter().for_each(|&region| profiler.contexts.add_entered(region, taken));
                    to = if is_call {
                        profiler.contexts.known_callee(context, profiling.caller(place))
                    } else {
                        context
                    };
                }
                let begun = &mut counters.frame.node(to).begun[step.target as usize];
                *begun = begun.wrapping_add(taken);
            }
        }
        // Go through the places with the number of times that control came from the one before
        let passes = tally.passes_mut();
        for context in contexts {
            let node = counters.frame.node(context);
            let mut count = 0u64;
            for (place, (step, begun)) in (0..).zip(steps.iter().zip(&mut *node.begun)) {
                count = count.wrapping_add(std::mem::take(begun));
                let mut through = count;
                if let Some((first, others)) = node.exits[step.exit as usize..][..step.exits.into()].split_first_mut() {
                    *first = count.wrapping_sub(others.iter().sum());
                    through = if plan.falls_through(place) && plan.is_run_end(place) { *first } else { count };
                }
                let ends = plan.is_run_end(place) && !plan.falls_through(place);
                count = if ends || changes(place, place + 1) { 0 } else { through };
                if let (Some(profiler), Some(profiling)) = (&mut profiler, profiling)
                    && count != 0
                    && place + 1 < plan.end()
                {
                    let entered = profiling.entered(place, place + 1).iter();
                    entered.for_each(|&region| profiler.contexts.add_entered(region, count));
                }
            }
            node.begun.fill(0);
            for (exit, count) in node.exits.iter_mut().map(std::mem::take).enumerate().filter(|(_, count)| *count != 0)
            {
                let Some(pass) = plan.pass(exit) else { continue };
                passes[pass].count += count;
                if let Some(profiler) = &mut profiler {
                    profiler.contexts.add_passes(context, pass, ContextPasses { count, ..ContextPasses::default() });
                }
            }
            if let Some(profiler) = &mut profiler {
                for (region, times) in (0..).zip(node.entered.iter_mut().map(std::mem::take)) {
                    profiler.contexts.add_entered(region, times);
                }
            }
        }
        let exits = &counters.unit_exits;
        for (at, more) in
            counters.units.iter_mut().map(UnitCounter::take).enumerate().filter(|(_, more)| more.units != 0)
        {
            let Some(pass) = plan.pass(exits[at % exits.len()] as usize) else { continue };
            passes[pass].units += more.units;
            passes[pass].unit_clocks += more.unit_clocks;
            if let (Some(profiler), Some(_)) = (&mut profiler, profiling) {
                profiler.contexts.add_passes((at / exits.len()) as u32, pass, more);
            }
        }
        for (losses, more) in tally.parts_mut().1.iter_mut().zip(&mut counters.losses) {
            losses.add(std::mem::take(more));
        }
        for (site, &place) in code.site_places.iter().enumerate() {
            let count = std::mem::take(&mut counters.frame.site(site)[1]);
            if count != 0 {
                add_octets(counters.kinds[site], count * run::octets(plan, &plan.steps()[place as usize]));
            }
        }
    }
}
