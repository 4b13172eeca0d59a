//! Runs machines that differ in time only: work items run once, on all host threads, and each machine puts what they did
//! on its own clock. Whatever that cannot be done for is stepped, with the same result.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};

use isa::Class;

use super::ending::Ending;
use super::frame::Method;
use super::library::{Batch, Library};
use super::recorder::{Prefix, Recorder};
use super::recording::Reason;
use super::schedule;
use super::scout::{self, Survey};
use super::strands::Keeping;
use super::{Failure, Frame, Setup};
use crate::code::Code;
use crate::exec::Watch;
use crate::octets::Memory;
use crate::profile::{RunObserver, Unobserved};
use crate::quantity::Octets;

/// Batches that may wait for a machine.
const AHEAD: usize = 2;

/// Runs machines whose work items do the same in the same clocks of computing. `progress` is told of the first one.
pub fn run<T: Watch + Clone + Send, O: RunObserver + Send>(
    setups: &[Setup],
    memory: &Memory,
    arithmetic: &T,
    progress: &mut dyn FnMut(u64),
) -> Vec<Result<Frame, Failure>> {
    let Some(first) = setups.first() else { return Vec::new() };
    let step = |setup: &Setup, why: Reason, progress: &mut dyn FnMut(u64)| {
        let ending = schedule::run::<T, O>(setup, memory.clone(), arithmetic, None, progress);
        ending.map(|frame| Frame { method: Method::Stepped { why }, ..frame }).map_err(|ending| match ending {
            Ending::Failure(failure) => failure,
            Ending::Lost(_) => unreachable!("what is stepped cannot lose a recording"),
        })
    };
    let prefix = match prefix(first, memory, arithmetic) {
        Ok(prefix) => prefix,
        Err(why) => return setups.iter().map(|setup| step(setup, why, progress)).collect(),
    };
    let (survey, endings) = replay::<T, O>(setups, prefix, memory, arithmetic, progress);
    let mut results = Vec::with_capacity(setups.len());
    for (setup, ending) in setups.iter().zip(endings) {
        results.push(match ending {
            Ok(frame) => Ok(with_counts(frame, setup, &survey)),
            Err(Ending::Failure(failure)) => Err(failure),
            Err(Ending::Lost(why)) => step(setup, why, progress),
        });
    }
    results
}

/// What every work item does before its message comes.
pub fn prefix<T: Watch + Clone>(setup: &Setup, memory: &Memory, arithmetic: &T) -> Result<Prefix, Reason> {
    let code = Code::new(setup.core, setup.isa, setup.config.timing());
    if code.keeps_state() {
        return Err("an instruction keeps its state from one work item to the next");
    }
    Recorder::<T, Unobserved>::new(&code, setup, memory, arithmetic.clone(), Keeping::Segments).prefix()
}

/// The scout on a thread of its own, the first machine on this one, each other one on another.
fn replay<T: Watch + Clone + Send, O: RunObserver + Send>(
    setups: &[Setup],
    prefix: Prefix,
    memory: &Memory,
    arithmetic: &T,
    progress: &mut dyn FnMut(u64),
) -> (Survey, Vec<Result<Frame, Ending>>) {
    let (senders, receivers): (Vec<SyncSender<Arc<Batch>>>, Vec<_>) =
        setups.iter().map(|_| sync_channel(AHEAD)).unzip();
    let recorded_cores = setups[0].config.cores;
    let library = |setup: &Setup, batches: Receiver<Arc<Batch>>| {
        Library::new(prefix, recorded_cores, setup.config.cores, batches)
    };
    std::thread::scope(|scope| {
        let own = arithmetic.clone();
        let scout = scope.spawn(move || {
            scout::run::<T, O>(&setups[0], memory, own, Keeping::Segments, &mut |batch| {
                senders.iter().filter(|sender| sender.send(batch.clone()).is_ok()).count() != 0
            })
        });
        let mut machines = setups.iter().zip(receivers);
        let (first, batches) = machines.next().expect("there is a machine");
        let others: Vec<_> = machines
            .map(|(setup, batches)| {
                let (own, library) = (arithmetic.clone(), library(setup, batches));
                scope.spawn(move || schedule::run::<T, O>(setup, memory.clone(), &own, Some(library), &mut |_| {}))
            })
            .collect();
        let library = library(first, batches);
        let mut endings = vec![schedule::run::<T, O>(first, memory.clone(), arithmetic, Some(library), progress)];
        let panicless = "a machine does not panic";
        endings.extend(others.into_iter().map(|other| other.join().expect(panicless)));
        (scout.join().expect("the scout does not panic"), endings)
    })
}

/// The frame with what the cores counted, which the replay does not know.
pub fn with_counts(frame: Frame, setup: &Setup, survey: &Survey) -> Frame {
    let timing = setup.config.timing();
    let code = Code::new(setup.core, setup.isa, timing);
    let main_code = Code::new(setup.main, setup.isa, timing);
    let counts = survey.tally.counts(&code) + frame.main_tally.counts(&main_code);
    let mut kinds = survey.kinds.clone();
    kinds.merge(&frame.kinds);
    Frame {
        method: Method::Replayed,
        tally: survey.tally.clone(),
        profile: survey.profile.clone(),
        asked: Octets(counts[Class::Octet]),
        kinds: kinds.into_totals(),
        ..frame
    }
}
