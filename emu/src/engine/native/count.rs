//! Counts of a core in generated code, and how they fold into passes, calling contexts and octets.

use isa::Op;

use super::context::{ContextFrame, CounterLayout};
use super::{AddOctets, Native, blocks, run};
use crate::code::tally::{Losses, Tally};
use crate::engine::plan::{Plan, Step};
use crate::profile::{ContextPasses, Profiler};

/// Counters of a core. Those that generated code changes stand in the frame.
#[derive(Clone, Debug)]
pub(super) struct Counters {
    pub frame: ContextFrame,
    /// Losses of results by slot, where those are counted.
    pub losses: Vec<Losses>,
    /// Kinds of the data that each site has met last.
    pub kinds: Vec<u32>,
}

impl Counters {
    /// Nothing yet.
    pub fn new(layout: CounterLayout, plan: &Plan, sites: usize, has_contexts: bool) -> Counters {
        Counters {
            frame: ContextFrame::new(layout, has_contexts),
            losses: vec![Losses::default(); plan.slots().len()],
            kinds: vec![0; sites],
        }
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
            for (&exit, units) in code.unit_exits.exits().iter().zip(node.units) {
                let [units, unit_clocks] = std::mem::take(units);
                let Some(pass) = plan.pass(exit as usize).filter(|_| units != 0) else { continue };
                passes[pass].units += units;
                passes[pass].unit_clocks += unit_clocks;
                if let Some(profiler) = &mut profiler {
                    profiler.contexts.add_passes(context, pass, ContextPasses { count: 0, units, unit_clocks });
                }
            }
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
