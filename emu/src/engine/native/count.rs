//! Counts of a core in generated code, and how they fold into passes and octets.

use super::context::{ContextFrame, CounterLayout};
use super::{AddOctets, Native, run};
use crate::code::tally::Tally;
use crate::engine::plan::{Plan, Step};

/// Counters of a core. Those that generated code changes stand in the frame.
#[derive(Clone, Debug)]
pub(super) struct Counters {
    pub frame: ContextFrame,
    /// Counts of runs that ended before each place.
    pub cut: Vec<u64>,
    /// Units by exit.
    pub units: Vec<u64>,
    /// Kinds of the data that each site has met last.
    pub kinds: Vec<u32>,
}

impl Counters {
    /// Nothing yet.
    pub fn new(layout: CounterLayout, plan: &Plan, sites: usize) -> Counters {
        Counters {
            frame: ContextFrame::new(layout),
            cut: vec![0; plan.steps().len()],
            units: vec![0; plan.exits()],
            kinds: vec![0; sites],
        }
    }
}

impl Native<'_> {
    /// Adds the passes to a tally of the same program, and the octets that were read inline by kind, and forgets them.
    ///
    /// Execution counts are reconstructed by flow conservation: through a place go all that came from the place before and all that began there,
    /// less those that stopped in front of it. Of ten that begin a loop's body at place 4, whose last row at 7 is a branch that was taken six
    /// times, four come to place 8.
    pub(super) fn fold_counters(&mut self, tally: &mut Tally, add_octets: AddOctets) {
        let Native { plan, shared, counters, .. } = self;
        let Some(counters) = counters else { return };
        let steps = &plan.steps()[..plan.end() as usize];
        let mut begun = std::mem::replace(&mut counters.cut, vec![0; plan.steps().len()]);
        for (begun, more) in begun.iter_mut().zip(counters.frame.begun()) {
            *begun = std::mem::take(more).wrapping_sub(*begun);
        }
        let exits = counters.frame.exits();
        // Behind instructions with a meaning in Rust a run was begun wherever they led.
        for step in steps.iter().filter(|step| step.exits != 0 && step.row != Step::UNIT) {
            if let Some(begun) = begun.get_mut(step.target as usize) {
                *begun = begun.wrapping_add(exits[step.exit as usize + usize::from(step.exits) - 1]);
            }
        }
        // How often control came from the place before.
        let mut count = 0u64;
        for (place, (step, begun)) in (0..).zip(steps.iter().zip(&begun)) {
            count = count.wrapping_add(*begun);
            let Some((first, others)) = exits[step.exit as usize..][..step.exits.into()].split_first_mut() else {
                continue;
            };
            *first = count - others.iter().sum::<u64>();
            if plan.is_run_end(place) {
                count = if plan.falls_through(place) { *first } else { 0 };
            }
        }
        let passes = tally.passes_mut();
        for (exit, (count, units)) in exits.iter_mut().zip(&mut counters.units).enumerate() {
            let (count, units) = (std::mem::take(count), std::mem::take(units));
            if let Some(pass) = plan.pass(exit) {
                passes[pass].count += count;
                passes[pass].units += units;
            }
        }
        let Some(Ok(code)) = shared.compiled.get() else { return };
        for (site, &place) in code.site_places.iter().enumerate() {
            let count = std::mem::take(&mut counters.frame.site(site)[1]);
            if count != 0 {
                add_octets(counters.kinds[site], count * run::octets(plan, &plan.steps()[place as usize]));
            }
        }
    }
}
