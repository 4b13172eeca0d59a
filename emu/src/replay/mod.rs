//! Replay of machines that differ in time only: work items run once, on all host threads, and each machine puts what they did
//! on its own clock. Whatever that cannot be done for is stepped, with the same result.

mod budget;
mod bus_cursor;
mod count;
mod crew;
mod cursor;
mod feed;
mod item;
mod kept;
mod main_cursor;
mod prerun;
mod record;
mod recorded;
mod recording;
pub mod weigh;

use std::cell::RefCell;
use std::panic::resume_unwind;
use std::rc::Rc;

use isa::Class;

pub use count::{FrameTotals, count};
pub use kept::RECORDING_FORMAT;
pub use recorded::{Recorded, Replays};
pub use recording::Reason;

use crate::code::Code;
use crate::code::octets::Memory;
use crate::code::quantity::Octets;
use crate::extension;
use crate::machine::finish::{self, EndedRun};
use crate::machine::outcome::Method;
use crate::machine::schedule::{self, Machine};
use crate::machine::stepped;
use crate::machine::{RunFailure, RunOutcome, Setup};
use crate::profile::{Observer, Unobserved};
use crate::semantics::Watch;
use crew::Subscription;
use cursor::{ItemCursor, Replayer};
use feed::Feed;
use item::RecordLevel;
use main_cursor::MainCursor;
use prerun::{ItemTotals, Prerun};
use record::{Prefix, Recorder};

/// Runs machines whose work items do the same in the same clocks of computing. `progress` is told of the first one.
pub fn run<T: Watch + Clone + Send, O: Observer + Send>(
    setups: &[Setup],
    memory: &Memory,
    arithmetic: &T,
    progress: &mut dyn FnMut(u64),
) -> Vec<Result<RunOutcome, RunFailure>> {
    let Some(first) = setups.first() else { return Vec::new() };
    // All machines share what is made of the programs, whichever way they go.
    let codes = first.codes();
    let step = |setup: &Setup, why: Reason, progress: &mut dyn FnMut(u64)| {
        let frame = stepped::run_decoded::<T, O>(setup, &codes, memory.clone(), arithmetic, progress)?;
        Ok(RunOutcome { method: Method::Stepped { why }, ..frame })
    };
    // One prefix serves all machines: they differ in time only, and the prefix asks nothing of others.
    let prefix = match prefix(first, memory, arithmetic) {
        Ok(prefix) => prefix,
        Err(why) => return setups.iter().map(|setup| step(setup, why, progress)).collect(),
    };
    let (totals, endings) = replay::<T, O>(setups, &codes, prefix, memory, arithmetic, progress);
    let mut results = Vec::with_capacity(setups.len());
    for (setup, ending) in setups.iter().zip(endings) {
        // A machine that could not use the recordings is stepped alone; the others keep their results.
        results.push(match ending {
            Ok(ended) => ended.map(|ended| with_counts(ended, &codes, &totals)),
            Err(why) => step(setup, why, progress),
        });
    }
    results
}

/// Prefix of every work item, before its message comes.
pub fn prefix<T: Watch + Clone>(setup: &Setup, memory: &Memory, arithmetic: &T) -> Result<Prefix, Reason> {
    let code = Code::new(setup.core, setup.isa, setup.config.timing());
    if extension::keeps_state(&code) {
        return Err("an instruction keeps its state from one work item to the next");
    }
    Recorder::<T, Unobserved>::new(0, &code, setup, memory, arithmetic.clone(), RecordLevel::Segments).prefix()
}

/// Outcome of one machine, or the reason for which it has to be stepped.
type Replayed = Result<Result<EndedRun, RunFailure>, Reason>;

/// Recordings and replays of machines that are alike: of one machine on one host thread in turns, batch by batch; else with the prerun on a thread of
/// its own, the first machine on this one, each other one on another, and threads that do nothing but record where the host has still more.
fn replay<T: Watch + Clone + Send, O: Observer + Send>(
    setups: &[Setup],
    codes: &[Code; 2],
    prefix: Prefix,
    memory: &Memory,
    arithmetic: &T,
    progress: &mut dyn FnMut(u64),
) -> (ItemTotals, Vec<Replayed>) {
    let (first, cores, threads) = (&setups[0], setups[0].config.cores, rayon::current_num_threads());
    let is_alone = setups.len() == 1 && threads == 1;
    // Beside machines it has programs of its own, so that it does not wait while a machine compiles those.
    let own_codes = (!is_alone).then(|| first.codes());
    let [core_code, main_code] = own_codes.as_ref().unwrap_or(codes);
    let crew = prerun::crew::<T, O>(first, core_code, memory, arithmetic, RecordLevel::Segments, threads);
    if is_alone {
        let mut prerun = Prerun::new(first, main_code, memory, arithmetic.clone(), &crew);
        let feed = Feed::new(prefix, cores, cores, || prerun.next_batch());
        let ending = on_clock::<T, O>(first, codes, memory.clone(), arithmetic, feed, progress);
        return (ItemTotals::of(crew, first, core_code), vec![ending]);
    }
    // Threads of their own: this may itself be a thread of a pool in which all others wait.
    let endings = std::thread::scope(|scope| {
        let (own, crew) = (arithmetic.clone(), &crew);
        // Whatever goes wrong from here on, nobody waits for ever for batches, nor for somebody who would take one.
        let closing = crew.closing();
        let subscriptions: Vec<_> = setups.iter().map(|_| crew.subscribe()).collect();
        let prerun = scope.spawn(move || {
            let _closing = closing;
            Prerun::new(first, main_code, memory, own, crew).run(&mut |batch| crew.publish(&batch));
        });
        // The prerun and the machines record as well.
        let helpers = (1 + setups.len()..threads).map(|_| scope.spawn(|| crew.help()));
        let mut others: Vec<_> = helpers.collect();
        let play = move |setup: &Setup, subscription: Subscription<T, O>, own: &T, progress: &mut dyn FnMut(u64)| {
            let feed = Feed::new(prefix, cores, setup.config.cores, move || subscription.take());
            let ending = on_clock::<T, O>(setup, codes, memory.clone(), own, feed, progress);
            // Other machines may go on where this one has trapped.
            crew.help();
            ending
        };
        let mut machines = setups.iter().zip(subscriptions);
        let (first, subscription) = machines.next().expect("there is a machine");
        let machines: Vec<_> = machines
            .map(|(setup, subscription)| {
                let own = arithmetic.clone();
                scope.spawn(move || play(setup, subscription, &own, &mut |_| {}))
            })
            .collect();
        // The first machine stays on this thread, because only that may call `progress`.
        let mut endings = vec![play(first, subscription, arithmetic, progress)];
        // An instruction in Rust may panic: that goes on here, with its own message; of several, with that of the first of these threads.
        endings.extend(machines.into_iter().map(|machine| machine.join().unwrap_or_else(|panic| resume_unwind(panic))));
        others.push(prerun);
        others.into_iter().for_each(|other| other.join().unwrap_or_else(|panic| resume_unwind(panic)));
        endings
    });
    (ItemTotals::of(crew, first, core_code), endings)
}

/// Puts recorded work items on a machine's clock. The counts of the cores are then missing from the frame.
///
/// # Errors
/// Reason for which the machine does not do what was recorded; the inner error is a trap.
fn on_clock<T: Watch, O: Observer>(
    setup: &Setup,
    [core_code, main_code]: &[Code; 2],
    memory: Memory,
    arithmetic: &T,
    feed: Feed,
    progress: &mut dyn FnMut(u64),
) -> Replayed {
    let feed = Rc::new(RefCell::new(feed));
    let core = |core| Replayer::Core(ItemCursor::new(core_code, core, feed.clone(), setup.level::<O>()));
    let main = schedule::main_worker::<T, O>(setup, main_code, arithmetic);
    let main = Replayer::Main(Box::new(MainCursor::new(setup, main)));
    let done = Machine::new(setup, memory, [core_code, main_code], core, main, progress).run();
    let mut feed = feed.borrow_mut();
    // Recordings that nobody asked for mean that the prerun was given other work than this machine.
    if done.is_ok() && feed.lost.is_none() && !feed.is_used_up() {
        feed.lose::<()>("the main processor hands out other work than it would to many cores");
    }
    match feed.lost {
        Some(reason) => Err(reason),
        None => Ok(done),
    }
}

/// The frame with what the cores counted, which the replay does not know.
fn with_counts(EndedRun { frame, logs }: EndedRun, [code, main_code]: &[Code; 2], totals: &ItemTotals) -> RunOutcome {
    let counts = totals.tally.counts(code) + frame.main_tally.counts(main_code);
    let mut kinds = totals.kinds.clone();
    kinds.merge(&frame.kinds);
    let mut profile = totals.profile.clone();
    let clocks = logs.iter().filter_map(|log| finish::add_clocks(log, &totals.keys, code, &mut profile));
    RunOutcome {
        method: Method::Replayed,
        tally: totals.tally.clone(),
        core_clocks: clocks.collect(),
        profile,
        asked: Octets(counts[Class::Octet]),
        kinds: kinds.into_totals(),
        ..frame
    }
}
