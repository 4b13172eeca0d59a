//! Counts of a walk: exits taken and runs begun where nothing else says so, and how they fold into passes.

use crate::code::tally::Tally;
use crate::engine::plan::{Plan, Step};
use crate::engine::taint::Taint;

/// Flow into and out of a place, beside its exits.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RunFlow {
    /// Number of runs begun here to which no exit led whose target is known.
    pub begun: u64,
    /// Number of runs that ended before this place.
    pub cut: u64,
}

/// Passes of a program, counted by the ways between its runs.
#[derive(Clone, Debug)]
pub struct FlowCounts {
    /// By place, and one behind the last one.
    pub(super) runs: Vec<RunFlow>,
    /// By exit: those of rows with several, the first one of branches left out, and of what always leads to the same place.
    pub(super) exits: Vec<u64>,
    units: Vec<u64>,
    /// Dependence on the number of cores is followed.
    pub(super) is_following: bool,
    /// Taint of the item.
    pub taint: Taint,
}

impl FlowCounts {
    /// Nothing yet, for a program; `is_following` where it is to be found out what depends on the number of cores.
    pub fn new(plan: &Plan, is_following: bool) -> FlowCounts {
        let exits = plan.exits();
        let runs = vec![RunFlow::default(); plan.steps().len()];
        FlowCounts { runs, exits: vec![0; exits], units: vec![0; exits], is_following, taint: Taint::default() }
    }

    /// A pass through an exit.
    #[inline(always)]
    pub(super) fn take_exit(&mut self, exit: usize) {
        debug_assert!(exit < self.exits.len());
        // SAFETY: rows only take exits of their steps, and there is a count for each exit of the plan.
        unsafe { *self.exits.get_unchecked_mut(exit) += 1 };
    }

    /// A pass through an exit had units.
    pub(super) fn add_units(&mut self, exit: usize, units: u32) {
        self.units[exit] += u64::from(units);
    }

    /// Adds the passes to a tally of the same program, and forgets them.
    ///
    /// Control is conserved: what comes to a place goes on from it. A loop of three words, `0: movi`, `1: isubi`, `2: bne 1`, that is begun once
    /// at 0 and goes back 4 times has counted `begun[0] = 1` and 4 for the taken outcome of `bne`. So 1 came to word 0, 1 + 4 to words 1 and 2,
    /// and 5 - 4 = 1 fell through at the end.
    pub fn fold(&mut self, plan: &Plan, tally: &mut Tally) {
        let steps = &plan.steps()[..plan.end() as usize];
        // Let what was taken begin runs where it leads
        // Behind instructions with a meaning in Rust a run was begun wherever they led.
        for step in steps.iter().filter(|step| step.exits != 0 && step.row != Step::UNIT) {
            if let Some(run) = self.runs.get_mut(step.target as usize) {
                run.begun += self.exits[step.exit as usize + usize::from(step.exits) - 1];
            }
        }
        // Go through the places with the number of times that control came from the one before
        let mut count = 0;
        for (place, (step, run)) in (0..).zip(steps.iter().zip(&mut self.runs)) {
            count = count + run.begun - run.cut;
            // The first outcome has what the others leave over, and so is not counted at all while the program runs.
            let Some((first, others)) = self.exits[step.exit as usize..][..step.exits.into()].split_first_mut() else {
                continue;
            };
            *first = count - others.iter().sum::<u64>();
            if plan.is_run_end(place) {
                count = if plan.falls_through(place) { *first } else { 0 };
            }
        }
        // Forget the runs, and hand the passes over
        for run in &mut self.runs {
            (run.begun, run.cut) = (0, 0);
        }
        let passes = tally.passes_mut();
        for (exit, (count, units)) in self.exits.iter_mut().zip(&mut self.units).enumerate() {
            let (count, units) = (std::mem::take(count), std::mem::take(units));
            if let Some(pass) = plan.pass(exit) {
                passes[pass].count += count;
                passes[pass].units += units;
            }
        }
    }
}
