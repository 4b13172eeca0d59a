//! How often exits were taken and runs begun where nothing else says so: what is counted while a program runs, and how it folds into passes.

use crate::fast::plan::Plan;
use crate::independence::Origin;
use crate::tally::Tally;

/// What is counted of a word beside its exits.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Run {
    /// What a run takes that begins here, flagged.
    pub toll: u64,
    /// How often a run was begun here that no exit led to whose target is known.
    pub begun: u64,
    /// How often a run ended before this word.
    pub cut: u64,
}

/// Passes of a program, counted by the ways between its runs.
#[derive(Clone, Debug)]
pub struct Count {
    /// By word, and one behind the last word.
    pub(super) runs: Vec<Run>,
    /// By exit: those of rows with several, the first one of branches left out, and of rows that always branch to the same word.
    pub(super) exits: Vec<u64>,
    units: Vec<u64>,
    /// Whether it is to be found out what depends on the number of cores.
    pub(super) is_following: bool,
    /// What the item has learned of the cores.
    pub origin: Origin,
}

impl Count {
    /// Nothing yet, for a program; `is_following` where it is to be found out what depends on the number of cores.
    pub fn new(plan: &Plan, is_following: bool) -> Count {
        let exits = plan.code.costs().len();
        let run = |pc| Run { toll: plan.flagged_toll(pc), begun: 0, cut: 0 };
        let runs = (0..=plan.code.words()).map(run).collect();
        Count { runs, exits: vec![0; exits], units: vec![0; exits], is_following, origin: Origin::default() }
    }

    /// A pass through an exit of the program.
    #[inline(always)]
    pub(super) fn take_exit(&mut self, exit: usize) {
        debug_assert!(exit < self.exits.len());
        // SAFETY: rows only take exits of their steps, and there is a count for each exit of the program.
        unsafe { *self.exits.get_unchecked_mut(exit) += 1 };
    }

    /// A pass through an exit had units.
    pub(super) fn add_units(&mut self, exit: usize, units: u32) {
        self.units[exit] += u64::from(units);
    }

    /// Adds the passes to a tally of the same program, and forgets them.
    pub fn fold(&mut self, plan: &Plan, tally: &mut Tally) {
        for (pc, step) in (0..plan.code.words()).zip(plan.steps()) {
            let exits = plan.code.row(pc).map_or(0, |row| row.exits.len());
            if let Some(run) = self.runs[..plan.code.words() as usize].get_mut(step.target as usize) {
                run.begun += self.exits[step.exit as usize + exits - 1];
            }
        }
        // How often control came from the word before.
        let mut count = 0;
        for (pc, run) in (0..plan.code.words()).zip(&mut self.runs) {
            count = count + run.begun - run.cut;
            let Some(row) = plan.code.row(pc) else { continue };
            let first = plan.steps()[pc as usize].exit as usize;
            let others: u64 = (1..row.exits.len()).map(|exit| self.exits[first + exit]).sum();
            self.exits[first] = count - others;
            if plan.run_end(pc) == pc + 1 {
                // Only branches fall through; behind other rows a run is begun.
                count = if row.exits.len() > 1 { count - others } else { 0 };
            }
        }
        for run in &mut self.runs {
            (run.begun, run.cut) = (0, 0);
        }
        let passes = tally.passes_mut();
        for (pass, (count, units)) in passes.iter_mut().zip(self.exits.iter_mut().zip(&mut self.units)) {
            pass.count += std::mem::take(count);
            pass.units += std::mem::take(units);
        }
    }
}
