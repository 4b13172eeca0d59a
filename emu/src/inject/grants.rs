//! Faults of grants: the whole machine with work items that are replayed, and two cores on the bus at once.

use std::collections::HashMap;

use random::SplitMix64;

use super::flip::{BitFlip, FaultKind};
use super::frame::{FrameFault, HangLimit, frame_end};
use super::golden::GoldenFrame;
use super::injector::{InjectedEnd, InjectedFlip, Injector};
use super::item::FlipHit;
use super::protection::{Protection, RETRY_CLOCKS};
use crate::code::quantity::Clocks;
use crate::code::trap::Fault;
use crate::machine::{GrantFault, GrantFaultKind, RunFailure, RunOptions, RunOutcome, Setup};
use crate::replay::Recorded;
use crate::run;
use crate::semantics::Watch;

/// The machine without a fault.
pub(super) struct GrantRuns {
    /// Work items to be replayed; `None` where the machine has to be stepped.
    recorded: Option<Recorded>,
    /// Length of the frame; none where the machine does not come to its end without a fault.
    clocks: Clocks,
}

impl GoldenFrame<'_> {
    /// The machine without a fault, which is run when this is asked first.
    pub(super) fn grant_runs(&self) -> &GrantRuns {
        self.grants.get_or_init(|| {
            let recorded = Recorded::new(&plain(self.setup, None), &self.image).ok();
            let mut runs = GrantRuns { recorded, clocks: Clocks(0) };
            runs.clocks = runs.run(self, None).0.map_or(Clocks(0), |outcome| outcome.clocks);
            runs
        })
    }
}

fn plain<'a>(setup: &Setup<'a>, grant_fault: Option<GrantFault>) -> Setup<'a> {
    Setup { options: RunOptions { grant_fault, ..RunOptions::default() }, ..setup.clone() }
}

impl GrantRuns {
    /// Runs the machine, and yields the number of work items that were finished beside its outcome.
    fn run(&self, golden: &GoldenFrame, fault: Option<GrantFault>) -> (Result<RunOutcome, RunFailure>, u64) {
        let setup = plain(golden.setup, fault);
        let mut finished = 0;
        let replayed = self
            .recorded
            .as_ref()
            .map(|recorded| recorded.replay_with(&setup, golden.image.clone(), &mut |items| finished = items));
        let outcome = match replayed {
            Some(Ok(Ok(outcome))) => Ok(outcome),
            Some(Err(failure)) => Err(failure),
            Some(Ok(Err(_))) | None => run::step(&setup, golden.image.clone(), &mut |items| finished = items),
        };
        (outcome, finished)
    }

    /// Draws a clock of the frame, and the master that it concerns.
    pub(super) fn draw(&self, golden: &GoldenFrame, target: FaultKind, series: &mut SplitMix64) -> BitFlip {
        let config = golden.setup.config;
        // Only cores stop; an arbiter may be stuck at the main processor as well.
        let masters = config.cores + u32::from(config.main.traffic && target == FaultKind::StuckArbiter);
        let moment = series.below(self.clocks.0.max(1));
        BitFlip { target, item: 0, moment, word: series.below(masters.into()) as u32, mask: 0 }
    }
}

impl<T: Watch> Injector<'_, T> {
    /// A fault that flips no bits of a word.
    pub(super) fn fault(&mut self, flip: BitFlip, protection: Protection) -> InjectedFlip {
        self.items = 0;
        let hit = FlipHit::default();
        let end = if flip.target.is_of_clocks() { self.grant(&flip, protection) } else { self.collision(&flip) };
        InjectedFlip { flip, hit, end, items: self.items }
    }

    /// A fault of the machine's grants from a clock on.
    fn grant(&mut self, flip: &BitFlip, protection: Protection) -> InjectedEnd {
        let golden = self.golden;
        let kind = match (flip.target, protection) {
            (FaultKind::StuckArbiter, _) => GrantFaultKind::Stuck,
            (FaultKind::StoppedCore, _) => GrantFaultKind::Stopped,
            (_, Protection::Retry) => GrantFaultKind::Lost { retry: Clocks(RETRY_CLOCKS) },
            _ => GrantFaultKind::Lost { retry: Clocks(0) },
        };
        let runs = golden.grant_runs();
        let fault = GrantFault { kind, at: Clocks(flip.moment), master: flip.word };
        match runs.run(golden, Some(fault)) {
            (Ok(outcome), _) => {
                let memory = (outcome.memory != golden.memory).then_some(outcome.memory);
                InjectedEnd::Frame { counts_differ: outcome.clocks != runs.clocks, memory }
            }
            (Err(RunFailure::Trap(trap)), finished) if trap.kind == Fault::Deadlock => {
                if protection == Protection::Watchdog {
                    return InjectedEnd::Detected;
                }
                let steps = golden.items.iter().take(finished as usize).map(|item| item.run.ticks).sum();
                InjectedEnd::Hang { limit: HangLimit::MachineWait, steps }
            }
            (Err(RunFailure::Trap(trap)), _) => InjectedEnd::Trap { fault: trap.kind, core: trap.core, pc: trap.pc },
            // The machine has run without a fault, so that nothing is wrong with it.
            (Err(RunFailure::Setup(_)), _) => InjectedEnd::Frame { counts_differ: false, memory: None },
        }
    }

    /// Two cores have the bus at once: a transfer of a work item, and one of another item that may be at work beside it. A wire has a 1 where
    /// either drives one, so each gets the data of both.
    ///
    /// Words 12 and 5 on the bus become 13, for both: the first has bit 0 flipped, the second bit 3.
    fn collision(&mut self, flip: &BitFlip) -> InjectedEnd {
        let golden = self.golden;
        let (cores, items) = (golden.setup.config.cores as usize, golden.items.len());
        let unharmed = InjectedEnd::Frame { counts_differ: false, memory: None };
        let mut series = SplitMix64::new(flip.word.into());
        let first = flip.item as usize;
        // As many items as there are other cores are at work beside it.
        let beside: Vec<usize> =
            (first.saturating_sub(cores - 1)..(first + cores).min(items)).filter(|&item| item != first).collect();
        if beside.is_empty() || first >= items {
            return unharmed;
        }
        let second = beside[series.below(beside.len() as u64) as usize];
        let words = golden.items[second].run.traffic.words;
        let moment = series.below(words.max(1));
        let (one, other) = (
            self.item_on_bus(first, Vec::new(), Some(flip.moment)),
            self.item_on_bus(second, Vec::new(), Some(moment)),
        );
        let (Some((one_at, one)), Some((other_at, other))) = (one.kept, other.kept) else { return unharmed };
        let mix = |at: u64, own: &[u32], foreign: &[u32]| -> Vec<(u64, u32)> {
            let masks = own.iter().zip(foreign).map(|(own, foreign)| foreign & !own);
            (at..).zip(masks).filter(|(_, mask)| *mask != 0).collect()
        };
        let mut known = HashMap::new();
        for (number, flips) in [(first, mix(one_at, &one, &other)), (second, mix(other_at, &other, &one))] {
            let run = self.item_on_bus(number, flips, None);
            if let Some(end) = frame_end(&run, golden.items[number].core) {
                return end;
            }
            known.insert(number, run);
        }
        let is_same =
            known.iter().all(|(&number, run)| run.sent == golden.items[number].run.sent && run.writes.is_empty());
        let fault = FrameFault::gone(golden, flip, known);
        match is_same {
            true => InjectedEnd::Frame { counts_differ: fault.counts_differ(), memory: None },
            false => self.frame(fault),
        }
    }
}
