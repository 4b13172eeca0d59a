//! The front door: runs frames on machines, by replay where that can be done, else by stepping.

use crate::code::octets::Memory;
use crate::engine::Task;
use crate::machine::stepped::StepTask;
use crate::machine::{Config, RunFailure, RunOutcome, Setup, check, on_arithmetic};
use crate::profile::Observer;
use crate::replay;
use crate::semantics::Watch;

/// Runs a frame on a memory image: until the main processor has halted and no core has anything more to do. `progress`
/// is called with the number of work items finished, each time one is.
///
/// Work items that only take a message, read global memory and send messages to the main processor run once, on all host
/// threads, and are then replayed in the order of the machine's clocks; anything else is stepped in that order. The
/// result is the same, but for [`RunOutcome::method`].
///
/// # Errors
/// A machine out of its ranges, a program whose initial buffer does not fit, or a trap.
pub fn run(setup: &Setup, memory: Memory, progress: &mut dyn FnMut(u64)) -> Result<RunOutcome, RunFailure> {
    check(setup)?;
    let results = run_alike(std::slice::from_ref(setup), &memory, progress);
    results.into_iter().next().expect("a machine has a result")
}

/// Runs a frame by stepping, also where it could be replayed.
///
/// # Errors
/// As [`run`].
pub fn step(setup: &Setup, memory: Memory, progress: &mut dyn FnMut(u64)) -> Result<RunOutcome, RunFailure> {
    check(setup)?;
    on_arithmetic(setup, StepTask { setup, codes: &setup.codes(), memory, progress })
}

/// Runs the same frame on several machines. Those that compute alike (in the same clocks, with the same arithmetic and
/// buffer) and differ only in cores, bus, caches and main processor share one run of the work items. `progress` is told of the first
/// of those that share one.
pub fn run_all(
    setup: &Setup,
    machines: &[Config],
    memory: &Memory,
    progress: &mut dyn FnMut(u64),
) -> Vec<Result<RunOutcome, RunFailure>> {
    let setups: Vec<Setup> = machines.iter().map(|config| Setup { config, ..setup.clone() }).collect();
    let mut results: Vec<Option<Result<RunOutcome, RunFailure>>> = setups.iter().map(|_| None).collect();
    for first in 0..setups.len() {
        if results[first].is_some() {
            continue;
        }
        if let Err(failure) = check(&setups[first]) {
            results[first] = Some(Err(failure));
            continue;
        }
        // A group begins with the first machine that has no result, and takes later ones that can share its recordings.
        let is_alike = |at: &usize| {
            results[*at].is_none() && machines[*at].computes_like(&machines[first]) && check(&setups[*at]).is_ok()
        };
        // A machine that cannot run has its own failure and must not fail the group.
        let alike: Vec<usize> = (first..setups.len()).filter(is_alike).take(machines_at_once(memory)).collect();
        let group: Vec<Setup> = alike.iter().map(|&at| setups[at].clone()).collect();
        for (&at, result) in alike.iter().zip(run_alike(&group, memory, progress)) {
            results[at] = Some(result);
        }
    }
    results.into_iter().flatten().collect()
}

/// Machines that share a run of the work items, at most: each has a thread, and of global memory what it writes, which may be all of it.
pub fn machines_at_once(memory: &Memory) -> usize {
    const OCTETS: usize = 256 << 20;
    (OCTETS / memory.size().max(1)).clamp(1, 64)
}

/// Runs machines that compute alike.
fn run_alike(setups: &[Setup], memory: &Memory, progress: &mut dyn FnMut(u64)) -> Vec<Result<RunOutcome, RunFailure>> {
    let Some(first) = setups.first() else { return Vec::new() };
    on_arithmetic(first, RunTask { setups, memory, progress })
}

struct RunTask<'a> {
    setups: &'a [Setup<'a>],
    memory: &'a Memory,
    progress: &'a mut dyn FnMut(u64),
}

impl Task for RunTask<'_> {
    type Result = Vec<Result<RunOutcome, RunFailure>>;

    fn run<T: Watch + Clone + Send, O: Observer + Send>(self, arithmetic: &T) -> Self::Result {
        replay::run::<T, O>(self.setups, self.memory, arithmetic, self.progress)
    }
}
