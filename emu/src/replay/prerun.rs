//! Finds out what work there will be: runs the main processor's program ahead with as many cores as it likes, which
//! answer at once. What it hands out is recorded on all host threads.

use std::collections::{HashSet, VecDeque};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::budget::Budget;
use super::feed::Batch;
use super::item::RecordLevel;
use super::record::Recorder;
use super::recording::{Portion, Reason};
use crate::code::Code;
use crate::code::octets::{Buffer, Memory};
use crate::code::tally::Tally;
use crate::code::trap::{Fault, Stop};
use crate::engine::{CoreId, Demand, EngineRunner, Pause, State, choose};
use crate::machine::Setup;
use crate::machine::kinds::Kinds;
use crate::profile::{ClockKeys, Observer, Profile, Unobserved};
use crate::semantics::{Link, Message, Watch, at_once};

/// Cores that the main processor sees, and so work items in a batch. With a quarter of them two host threads
/// were hardly faster than one, because a thread takes its time to begin.
const CORES: u32 = 1024;

/// Segments in a batch, at most; 128 MiB of them. What is longer is stepped.
const MOST_SEGMENTS: usize = 1 << 23;

/// Work items that a host thread takes at a time: a portion. Where portions begin decides what is recorded before a batch is given up, and so which
/// reason is told; it must not depend on the number of threads.
pub const AT_ONCE: usize = 32;

const TOO_MANY_PATHS: Reason = "functions call each other in too many ways to record their clocks";

const TOO_LONG: Reason = "the work items make too many transfers to be recorded";

/// Instructions that the main processor may take between two batches.
const MOST_STEPS: u64 = 1 << 32;

/// The main processor's link: cores that take everything and answer in the order of their work.
struct InstantCores {
    memory: Memory,
    work: Vec<(u32, Message)>,
    answers: VecDeque<(Message, u32)>,
}

impl Link for InstantCores {
    at_once! { self => self.memory }

    fn send(&mut self, to: i32, message: Message) -> Result<(), Stop> {
        let core = u32::try_from(to).ok().filter(|&to| to < CORES);
        let core = core.ok_or(Fault::NoSuchCore { number: to, largest: CORES })?;
        // A program that never receives would hand out work without end; a batch of this size is recorded first.
        if self.work.len() >= 2 * CORES as usize {
            return Err(Stop::Wait);
        }
        self.work.push((core, message));
        Ok(())
    }

    fn receive(&mut self) -> Result<(Message, u32), Stop> {
        self.answers.pop_front().ok_or(Stop::Wait)
    }

    fn barrier(&mut self) -> Result<(), Stop> {
        Err(Stop::Wait)
    }
}

/// Portion, or why there is none, by the number of its first item.
type PortionFound = (usize, Result<Arc<Portion>, Reason>);

/// Records work items on all host threads. The recordings are in the order of the messages, whoever made them.
fn record<T: Watch + Send, O: Observer + Send>(recorders: &mut [Recorder<T, O>], work: &[(u32, Message)]) -> Batch {
    let (next, budget) = (AtomicUsize::new(0), Budget::new(MOST_SEGMENTS));
    let mut found: Vec<Vec<PortionFound>> = Vec::new();
    found.resize_with(recorders.len(), Vec::new);
    let work_off = |recorder: &mut Recorder<T, O>, found: &mut Vec<PortionFound>| {
        let mut previous: Option<Arc<Portion>> = None;
        // Portions go to whoever is free: items differ much in length.
        while !budget.is_full()
            && let at = next.fetch_add(AT_ONCE, Ordering::Relaxed)
            && let Some(rest) = work.get(at..).filter(|rest| !rest.is_empty())
        {
            let mut portion = Portion::with_room(previous.as_deref());
            let mut messages = rest.iter().take(AT_ONCE).map(|(_, message)| *message);
            let recorded = messages.try_for_each(|message| recorder.record(message, &budget, &mut portion));
            let recorded = recorded.map(|()| portion.closed());
            previous = recorded.as_ref().ok().cloned();
            found.push((at, recorded));
        }
    };
    // Threads of their own: this may itself be a thread of a pool in which all others wait.
    std::thread::scope(|scope| {
        let mut pairs = recorders.iter_mut().zip(&mut found);
        let own = pairs.next();
        for (recorder, found) in pairs {
            scope.spawn(|| work_off(recorder, found));
        }
        if let Some((recorder, found)) = own {
            work_off(recorder, found);
        }
    });
    // Whether they are too many does not depend on who recorded what first; so this reason comes before others.
    if budget.is_full() {
        return Err(TOO_LONG);
    }
    if has_too_many_paths(recorders) {
        return Err(TOO_MANY_PATHS);
    }
    let mut found: Vec<_> = found.into_iter().flatten().collect();
    // The order of the messages, so that results do not depend on which thread was faster.
    found.sort_unstable_by_key(|(at, _)| *at);
    found.into_iter().map(|(_, portion)| portion).collect()
}

/// True where clocks are measured and there are more calling contexts than one recorder has room for, whichever of them have seen which.
fn has_too_many_paths<T: Watch, O: Observer>(recorders: &mut [Recorder<T, O>]) -> bool {
    let (mut all, mut most) = (HashSet::new(), usize::MAX);
    for recorder in recorders {
        if let Some((paths, room)) = recorder.paths() {
            all.extend(paths.cloned());
            most = room;
        }
    }
    // A full recorder may have turned a path away, so one that is just full counts as too small.
    all.len() >= most
}

/// Totals of all work items together.
pub struct ItemTotals {
    /// Their passes.
    pub tally: Tally,
    /// Their octets by kind.
    pub kinds: Kinds,
    /// Their functions and regions.
    pub profile: Option<Profile>,
    /// Meaning of the numbers in recordings, by recorder, where clocks were measured.
    pub keys: Vec<ClockKeys>,
}

/// Totals of a prerun, and how it ended.
pub struct PrerunTotals {
    /// Totals of all work items.
    pub items: ItemTotals,
    /// Global memory, with all answers in it where all of them came.
    pub memory: Memory,
    /// End of the main processor's program.
    pub end: Pause,
}

/// A main processor that runs ahead, and those who record what it hands out.
pub struct Prerun<'a, T, O> {
    setup: &'a Setup<'a>,
    codes: &'a [Code<'a>; 2],
    arithmetic: T,
    /// A recorder a host thread, kept for all batches: engines and buffers are made once.
    recorders: Vec<Recorder<'a, T, O>>,
    cores: InstantCores,
    state: State,
    tally: Tally,
    runner: EngineRunner<'a>,
    /// Pause of the main processor after which there are no more batches; none while there may be some.
    end: Option<Pause>,
}

impl<'a, T: Watch + Clone + Send, O: Observer + Send> Prerun<'a, T, O> {
    /// A main processor that has handed out nothing, whose work is recorded on so many host threads; codes are those of the cores and of its own.
    pub fn new(
        setup: &'a Setup<'a>,
        codes: &'a [Code<'a>; 2],
        memory: &'a Memory,
        arithmetic: T,
        level: RecordLevel,
        threads: usize,
    ) -> Prerun<'a, T, O> {
        let ([core_code, main_code], main) = (codes, &setup.config.main);
        let recorder = |number| Recorder::new(number, core_code, setup, memory, arithmetic.clone(), level);
        let demand = Demand::new(main_code, setup.options.wish(), arithmetic.computes(), main.buffer_octets);
        Prerun {
            recorders: (0..threads as u32).map(recorder).collect(),
            cores: InstantCores { memory: memory.clone(), work: Vec::new(), answers: VecDeque::new() },
            state: State::new(main_code, Buffer::new(&setup.main.buffer, main.buffer_octets)),
            tally: Tally::new(main_code),
            runner: choose(&demand),
            end: None,
            setup,
            codes,
            arithmetic,
        }
    }

    /// Lets the main processor hand out work until it waits, records all of that, and answers it; `None` when there is no more work.
    pub fn next_batch(&mut self) -> Option<Arc<Batch>> {
        if self.end.is_some() {
            return None;
        }
        let most = self.setup.config.main.step_limit;
        let id =
            CoreId { core: CORES, cores: CORES, step_limit: most.min(self.state.steps.saturating_add(MOST_STEPS)) };
        let (cores, nobody) = (&mut self.cores, &mut Unobserved);
        let pause = self.runner.run(id, &mut self.state, &self.arithmetic, cores, &mut self.tally, nobody);
        if cores.work.is_empty() {
            self.end = Some(pause);
            return None;
        }
        let batch = record(&mut self.recorders, &cores.work);
        // Answers come in the order of the work, which is as if all cores had taken equally long.
        if let Ok(batch) = &batch {
            let items = batch.iter().flat_map(|portion| portion.items.iter().map(|item| portion.sent(item)));
            for (&(core, _), sent) in cores.work.iter().zip(items) {
                cores.answers.extend(sent.iter().map(|&message| (message, core)));
            }
        }
        cores.work.clear();
        if batch.is_err() || pause != Pause::Wait {
            self.end = Some(pause);
        }
        Some(Arc::new(batch))
    }

    /// Hands over all batches, as long as somebody wants them, and yields the totals.
    pub fn run(mut self, hand_over: &mut dyn FnMut(Arc<Batch>) -> bool) -> PrerunTotals {
        while let Some(batch) = self.next_batch() {
            if !hand_over(batch) {
                break;
            }
        }
        self.into_totals()
    }

    /// Totals of what all host threads counted; sums do not depend on who recorded what.
    pub fn into_totals(self) -> PrerunTotals {
        let code = &self.codes[0];
        let (tally, kinds, keys) = (Tally::new(code), Kinds::new(&self.setup.kinds), Vec::new());
        let mut items = ItemTotals { tally, kinds, profile: None, keys };
        for mut recorder in self.recorders {
            let tally = recorder.take_tally();
            items.tally.merge(&tally);
            items.kinds.merge(recorder.kinds.totals());
            items.keys.extend(recorder.clock_keys());
            match (&mut items.profile, recorder.observer.into_profile(code, &tally)) {
                (Some(profile), Some(more)) => profile.merge(&more),
                (profile, more) => *profile = more,
            }
        }
        PrerunTotals { items, memory: self.cores.memory, end: self.end.unwrap_or(Pause::Wait) }
    }
}

/// Runs ahead on all host threads and hands over what it records, batch by batch, until all work is done or nobody wants it any more.
pub fn run<T: Watch + Clone + Send, O: Observer + Send>(
    setup: &Setup,
    memory: &Memory,
    arithmetic: T,
    level: RecordLevel,
    hand_over: &mut dyn FnMut(Arc<Batch>) -> bool,
) -> PrerunTotals {
    let (codes, threads) = (setup.codes(), rayon::current_num_threads());
    Prerun::<T, O>::new(setup, &codes, memory, arithmetic, level, threads).run(hand_over)
}
