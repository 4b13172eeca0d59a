//! Faults of grants: the whole machine with work items that are replayed, and two cores on the bus at once.

use std::collections::HashMap;

use random::SplitMix64;

use super::flip::BitFlip;
use super::frame::{FrameFault, HangLimit, frame_end};
use super::golden::GoldenFrame;
use super::injector::{InjectedEnd, InjectedFlip, Injector};
use super::item::FlipHit;
use super::protection::RETRY_CLOCKS;
use super::{FaultKind, Protection};
use crate::code::quantity::Clocks;
use crate::code::trap::{Fault, Trap};
use crate::machine::{GrantFault, GrantFaultKind, RunFailure, RunOptions, RunOutcome, Setup};
use crate::replay::{Recorded, Replays};
use crate::run;
use crate::semantics::Watch;

/// The machine without a fault.
pub(super) struct GrantRuns {
    /// Work items to be replayed; `None` where the machine has to be stepped.
    recorded: Option<Recorded>,
    /// Length of the frame.
    clocks: Clocks,
}

impl GoldenFrame<'_> {
    /// The machine without a fault, which is run when this is asked first.
    pub(super) fn grant_runs(&self) -> Result<&GrantRuns, &RunFailure> {
        let begun = || {
            let recorded = Recorded::new(&plain(self.setup, None), &self.image).ok();
            let runs = GrantRuns { recorded, clocks: Clocks(0) };
            let clocks = runs.run(self, None, runs.replays(self).as_ref()).0?.clocks;
            Ok(GrantRuns { clocks, ..runs })
        };
        self.grants.get_or_init(begun).as_ref()
    }

    /// Clocks of the frame on the whole machine, in which faults of grants are put; it is run when this is asked first.
    ///
    /// # Errors
    /// A machine that does not come to its end without a fault: a trap, or processors that all wait.
    pub fn clocks(&self) -> Result<Clocks, RunFailure> {
        self.grant_runs().map(|runs| runs.clocks).map_err(RunFailure::clone)
    }
}

/// End of a frame on a machine that stopped before its end: one on which nobody can go on hangs, and so does a program at its limit of steps.
fn machine_end(trap: &Trap, cores: u32, steps: u64, protection: Protection) -> InjectedEnd {
    let hang = |limit| InjectedEnd::Hang { limit, steps };
    match trap.kind {
        Fault::Deadlock if protection == Protection::Watchdog => InjectedEnd::Detected,
        Fault::Deadlock => hang(HangLimit::MachineWait),
        Fault::StepLimit(_) if trap.core == cores => hang(HangLimit::MainSteps),
        Fault::StepLimit(_) => hang(HangLimit::ItemSteps),
        fault => InjectedEnd::Trap { fault, core: trap.core, pc: trap.pc },
    }
}

fn plain<'a>(setup: &Setup<'a>, grant_fault: Option<GrantFault>) -> Setup<'a> {
    Setup { options: RunOptions { grant_fault, ..RunOptions::default() }, ..setup.clone() }
}

impl GrantRuns {
    /// Replays of the work items, for machines with a fault each.
    fn replays<'r>(&'r self, golden: &'r GoldenFrame) -> Option<Replays<'r>> {
        self.recorded.as_ref().map(|recorded| recorded.replays(&plain(golden.setup, None)))
    }

    /// Runs the machine, and yields the number of work items that were finished beside its outcome.
    fn run(
        &self,
        golden: &GoldenFrame,
        fault: Option<GrantFault>,
        replays: Option<&Replays>,
    ) -> (Result<RunOutcome, RunFailure>, u64) {
        let setup = plain(golden.setup, fault);
        let mut finished = 0;
        let replayed =
            replays.map(|replays| replays.replay_on(&setup, golden.image.clone(), &mut |items| finished = items));
        let outcome = match replayed {
            Some(Ok(Ok(outcome))) => Ok(outcome),
            Some(Err(failure)) => Err(failure),
            Some(Ok(Err(_))) | None => run::step(&setup, golden.image.clone(), &mut |items| finished = items),
        };
        (outcome, finished)
    }
}

/// Draws a clock of the frame, and the master that it concerns.
pub(super) fn draw_grant(golden: &GoldenFrame, target: FaultKind, series: &mut SplitMix64) -> BitFlip {
    let config = golden.setup.config;
    // Only cores stop; an arbiter may be stuck at the main processor as well.
    let masters = config.cores + u32::from(config.main.traffic && target == FaultKind::StuckArbiter);
    let clocks = golden.grant_runs().map_or(Clocks(0), |runs| runs.clocks);
    let moment = series.below(clocks.0.max(1));
    BitFlip { target, item: 0, moment, word: series.below(masters.into()) as u32, mask: 0 }
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
        let steps = |finished: u64| golden.items.iter().take(finished as usize).map(|item| item.run.ticks).sum();
        let unharmed = InjectedEnd::Frame { counts_differ: false, memory: None };
        let stopped = |failure: &RunFailure, finished| match failure {
            RunFailure::Trap(trap) => machine_end(trap, golden.setup.config.cores, steps(finished), protection),
            // The machine has been checked, so that nothing is wrong with it.
            RunFailure::Setup(_) => unharmed.clone(),
        };
        let runs = match golden.grant_runs() {
            Ok(runs) => runs,
            // A machine that stops without a fault stops with one.
            Err(failure) => return stopped(failure, 0),
        };
        let fault = GrantFault { kind, at: Clocks(flip.moment), master: flip.word };
        if self.replays.is_none() {
            self.replays = runs.replays(golden);
        }
        match runs.run(golden, Some(fault), self.replays.as_ref()) {
            (Ok(outcome), _) => {
                let memory = (outcome.memory != golden.memory).then_some(outcome.memory);
                InjectedEnd::Frame { counts_differ: outcome.clocks != runs.clocks, memory }
            }
            (Err(failure), finished) => stopped(&failure, finished),
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

#[cfg(test)]
mod tests {
    use isa::{Isa, Op, Program};
    use programs::builder::{ProgramBuilder, program};

    use super::*;
    use crate::code::octets::Memory;
    use crate::inject::inject_at;
    use crate::machine::Config;

    /// Calls with a frame of one work item on two cores, which the first of them does.
    fn with_frame(end: impl FnOnce(&mut ProgramBuilder), check: impl FnOnce(&GoldenFrame)) {
        let core = program(|p| {
            p.emit(Op::recv5, &[0, 20]).emit(Op::cores, &[3]).emit(Op::send2, &[3, 0]).emit(Op::halt, &[]);
        });
        let main: Program = program(|p| {
            p.emit(Op::cores, &[3]).emit(Op::send5, &[0, 0]).emit(Op::recv2, &[10, 20]);
            end(p);
            p.emit(Op::halt, &[]);
        });
        let (config, isa) = (Config { cores: 2, ..Config::default() }, Isa::base());
        let options = RunOptions::default();
        let setup = Setup { config: &config, isa: &isa, core: &core, main: &main, kinds: Vec::new(), options };
        check(&GoldenFrame::new(&setup, &Memory::new(vec![0; 400])).expect("the items are independent"));
    }

    #[test]
    fn an_arbiter_that_is_stuck_and_a_core_that_stopped_hang_where_they_are_needed() {
        with_frame(
            |_| {},
            |golden| {
                let end = |target, moment, word| {
                    inject_at(golden, &[BitFlip { target, item: 0, moment, word, mask: 0 }])[0].end.clone()
                };
                let hang = InjectedEnd::Hang { limit: HangLimit::MachineWait, steps: 0 };
                let unharmed = InjectedEnd::Frame { counts_differ: false, memory: None };
                let last = golden.clocks().expect("it comes to its end").0 - 1;
                // Stuck at a core the bus lets no message to it; stuck at the main processor it lets no answer to that.
                assert_eq!(end(FaultKind::StuckArbiter, 0, 0), hang);
                assert_eq!(end(FaultKind::StuckArbiter, 0, 2), hang);
                assert_eq!(end(FaultKind::StuckArbiter, last, 0), unharmed);
                assert_eq!(end(FaultKind::StoppedCore, 0, 0), hang);
                assert_eq!(end(FaultKind::StoppedCore, 0, 1), unharmed, "it has nothing to do");
                assert_eq!(end(FaultKind::StoppedCore, last, 0), unharmed);
            },
        );
    }

    #[test]
    fn a_machine_that_stops_without_a_fault_says_why() {
        // Its own mailbox holds one message, so that it waits with the second for ever.
        with_frame(
            |p| {
                p.emit(Op::send2, &[3, 0]).emit(Op::send2, &[3, 0]).emit(Op::recv2, &[10, 20]);
            },
            |golden| {
                let failure = golden.clocks().expect_err("it waits for ever");
                assert!(matches!(&failure, RunFailure::Trap(trap) if trap.kind == Fault::Deadlock), "{failure}");
            },
        );
    }

    #[test]
    fn limits_of_steps_are_hangs_and_faults_are_traps() {
        with_frame(
            |_| {},
            |golden| {
                let end =
                    |fault, core, protection| machine_end(&Trap::new(fault, core, 0, &golden.code), 2, 7, protection);
                let none = Protection::Unprotected;
                let hang = |limit| InjectedEnd::Hang { limit, steps: 7 };
                assert_eq!(end(Fault::StepLimit(9), 1, none), hang(HangLimit::ItemSteps));
                assert_eq!(end(Fault::StepLimit(9), 2, none), hang(HangLimit::MainSteps));
                assert_eq!(end(Fault::Deadlock, 0, none), hang(HangLimit::MachineWait));
                assert_eq!(end(Fault::Deadlock, 0, Protection::Watchdog), InjectedEnd::Detected);
                let trap = InjectedEnd::Trap { fault: Fault::DivisionByZero, core: 1, pc: 0 };
                assert_eq!(end(Fault::DivisionByZero, 1, none), trap);
            },
        );
    }
}
