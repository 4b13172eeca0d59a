//! Finds out what work there will be: runs the main processor's program ahead with as many cores as it likes, which
//! answer at once. What it hands out is recorded on all host threads.

use std::collections::{HashSet, VecDeque};
use std::panic::resume_unwind;
use std::sync::Arc;

use super::crew::{BatchWork, Crew, TOO_LONG};
use super::feed::Batch;
use super::item::RecordLevel;
use super::record::Recorder;
use super::recording::Reason;
use crate::code::Code;
use crate::code::octets::{Buffer, Memory};
use crate::code::tally::Tally;
use crate::code::trap::{Fault, Stop};
use crate::engine::{CoreId, Demand, EngineRunner, Pause, State, choose};
use crate::machine::Setup;
use crate::machine::kinds::Kinds;
use crate::profile::{ClockKeys, Observer, Profile, Unobserved};
use crate::semantics::{Link, Message, Watch, at_once};

/// Cores that the main processor sees, and so work items in a batch. With an eighth of them to this many a picture takes about as long, on one host
/// thread and on two.
const CORES: u32 = 1024;

const TOO_MANY_PATHS: Reason = "functions call each other in too many ways to record their clocks";

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

/// True where clocks are measured and there are more calling contexts than one recorder has room for, whichever of them have seen which.
fn has_too_many_paths<T: Watch, O: Observer>(crew: &Crew<T, O>) -> bool {
    let (mut all, mut most) = (HashSet::new(), usize::MAX);
    crew.each_recorder(|recorder| {
        if let Some((paths, room)) = recorder.paths() {
            all.extend(paths.cloned());
            most = room;
        }
    });
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

impl ItemTotals {
    /// Totals of all recorders of a crew; sums do not depend on who recorded what.
    pub fn of<T: Watch, O: Observer>(crew: Crew<T, O>, setup: &Setup, code: &Code) -> ItemTotals {
        let (tally, kinds, keys) = (Tally::new(code), Kinds::new(&setup.kinds), Vec::new());
        let mut items = ItemTotals { tally, kinds, profile: None, keys };
        for mut recorder in crew.into_recorders() {
            let tally = recorder.take_tally();
            items.tally.merge(&tally);
            items.kinds.merge(recorder.kinds.totals());
            items.keys.extend(recorder.clock_keys());
            match (&mut items.profile, recorder.observer.into_profile(code, &tally)) {
                (Some(profile), Some(more)) => profile.merge(&more),
                (profile, more) => *profile = more,
            }
        }
        items
    }
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

/// The crew of a machine's prerun: a recorder a host thread, kept for all batches, since engines and buffers are made once.
pub fn crew<'a, T: Watch + Clone, O: Observer>(
    setup: &Setup,
    core_code: &'a Code<'a>,
    memory: &'a Memory,
    arithmetic: &T,
    level: RecordLevel,
    threads: usize,
) -> Crew<'a, T, O> {
    let recorder = |number| Recorder::new(number, core_code, setup, memory, arithmetic.clone(), level);
    Crew::new((0..threads as u32).map(recorder))
}

/// A main processor that runs ahead, and the crew that records what it hands out.
pub struct Prerun<'c, 'a, T, O> {
    crew: &'c Crew<'a, T, O>,
    arithmetic: T,
    step_limit: u64,
    cores: InstantCores,
    state: State,
    tally: Tally,
    runner: EngineRunner<'a>,
    /// Pause of the main processor after which there are no more batches; none while there may be some.
    end: Option<Pause>,
}

impl<'c, 'a, T: Watch, O: Observer> Prerun<'c, 'a, T, O> {
    /// A main processor that has handed out nothing.
    pub fn new(
        setup: &Setup,
        main_code: &'a Code<'a>,
        memory: &Memory,
        arithmetic: T,
        crew: &'c Crew<'a, T, O>,
    ) -> Prerun<'c, 'a, T, O> {
        let main = &setup.config.main;
        let demand = Demand::new(main_code, setup.options.wish(), arithmetic.computes(), main.buffer_octets);
        Prerun {
            cores: InstantCores { memory: memory.clone(), work: Vec::new(), answers: VecDeque::new() },
            state: State::new(main_code, Buffer::new(&setup.main.buffer, main.buffer_octets)),
            tally: Tally::new(main_code),
            runner: choose(&demand),
            step_limit: main.step_limit,
            end: None,
            arithmetic,
            crew,
        }
    }

    /// Lets the main processor hand out work until it waits, has all of that recorded, and answers it; `None` when there is no more work.
    pub fn next_batch(&mut self) -> Option<Arc<Batch>> {
        if self.end.is_some() {
            return None;
        }
        let step_limit = self.step_limit.min(self.state.steps.saturating_add(MOST_STEPS));
        let id = CoreId { core: CORES, cores: CORES, step_limit };
        let (cores, nobody) = (&mut self.cores, &mut Unobserved);
        let pause = self.runner.run(id, &mut self.state, &self.arithmetic, cores, &mut self.tally, nobody);
        if cores.work.is_empty() {
            self.end = Some(pause);
            return None;
        }
        let work = Arc::new(BatchWork::new(std::mem::take(&mut cores.work)));
        let batch = match self.crew.record(&work) {
            Err(TOO_LONG) => Err(TOO_LONG),
            _ if has_too_many_paths(self.crew) => Err(TOO_MANY_PATHS),
            batch => batch,
        };
        // Answers come in the order of the work, which is as if all cores had taken equally long.
        if let Ok(batch) = &batch {
            let items = batch.iter().flat_map(|portion| portion.items.iter().map(|item| portion.sent(item)));
            for (&(core, _), sent) in work.messages.iter().zip(items) {
                cores.answers.extend(sent.iter().map(|&message| (message, core)));
            }
        }
        if batch.is_err() || pause != Pause::Wait {
            self.end = Some(pause);
        }
        Some(Arc::new(batch))
    }

    /// Hands over all batches, as long as somebody wants them, and yields the pause of the main processor after which there were no more, and
    /// global memory.
    pub fn run(mut self, hand_over: &mut dyn FnMut(Arc<Batch>) -> bool) -> (Pause, Memory) {
        while let Some(batch) = self.next_batch() {
            if !hand_over(batch) {
                break;
            }
        }
        (self.end.unwrap_or(Pause::Wait), self.cores.memory)
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
    let ([core_code, main_code], threads) = (&setup.codes(), rayon::current_num_threads());
    let crew = crew::<T, O>(setup, core_code, memory, &arithmetic, level, threads);
    // Threads of their own: this may itself be a thread of a pool in which all others wait.
    let (end, memory) = std::thread::scope(|scope| {
        let closing = crew.closing();
        let helpers: Vec<_> = (1..threads).map(|_| scope.spawn(|| crew.help())).collect();
        let ended = Prerun::new(setup, main_code, memory, arithmetic, &crew).run(hand_over);
        drop(closing);
        helpers.into_iter().for_each(|helper| helper.join().unwrap_or_else(|panic| resume_unwind(panic)));
        ended
    });
    PrerunTotals { items: ItemTotals::of(crew, setup, core_code), memory, end }
}
