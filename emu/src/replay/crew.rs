//! Host threads that record the batches of a prerun together: the prerun's own, threads that do nothing else, and machines, which record as long as they
//! would wait for the next batch. How a work item is recorded, and how a machine replays it, is not said here.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

use super::budget::Budget;
use super::feed::Batch;
use super::record::Recorder;
use super::recording::{Portion, Reason};
use crate::profile::Observer;
use crate::semantics::{Message, Watch};

/// Batches that may wait for a machine.
const AHEAD: usize = 2;

/// Segments in a batch, at most; 128 MiB of them. What is longer is stepped.
const MOST_SEGMENTS: usize = 1 << 23;

/// Work items that a host thread takes at a time: a portion. Where portions begin decides what is recorded before a batch is given up, and so which
/// reason is told; it must not depend on the number of threads.
pub const AT_ONCE: usize = 32;

/// Reason that comes before all others.
pub const TOO_LONG: Reason = "the work items make too many transfers to be recorded";

/// Reason that nobody is told: a thread has panicked, and its panic goes on where that is joined.
const BROKEN_OFF: Reason = "a work item was not recorded to its end";

/// Work items of a batch that somebody records.
pub struct BatchWork {
    /// Numbers of cores, and the messages that they were sent.
    pub messages: Vec<(u32, Message)>,
    /// Number of the first item that nobody has taken.
    next: AtomicUsize,
    budget: Budget,
    found: Mutex<Vec<PortionFound>>,
}

/// Portion, or why there is none, by the number of its first item.
type PortionFound = (usize, Result<Arc<Portion>, Reason>);

impl BatchWork {
    /// A batch of which nothing is taken.
    pub fn new(messages: Vec<(u32, Message)>) -> BatchWork {
        let (next, found) = (AtomicUsize::new(0), Mutex::default());
        BatchWork { messages, next, budget: Budget::new(MOST_SEGMENTS), found }
    }

    /// True where there is something to be taken.
    fn is_open(&self) -> bool {
        !self.budget.is_full() && self.next.load(Ordering::Relaxed) < self.messages.len()
    }

    /// Records portions as long as there are some that nobody has taken: items differ much in length, so they go to whoever is free.
    fn work_off<T: Watch, O: Observer>(&self, recorder: &mut Recorder<T, O>) {
        let mut previous: Option<Arc<Portion>> = None;
        while !self.budget.is_full()
            && let at = self.next.fetch_add(AT_ONCE, Ordering::Relaxed)
            && let Some(rest) = self.messages.get(at..).filter(|rest| !rest.is_empty())
        {
            let mut portion = Portion::with_room(previous.as_deref());
            let mut messages = rest.iter().take(AT_ONCE).map(|(_, message)| *message);
            let recorded = messages.try_for_each(|message| recorder.record(message, &self.budget, &mut portion));
            let recorded = recorded.map(|()| portion.closed());
            previous = recorded.as_ref().ok().cloned();
            held(&self.found).push((at, recorded));
        }
    }

    /// The portions in the order of their messages, so that results do not depend on which thread was faster; or why there are none.
    fn recorded(&self) -> Batch {
        // Whether they are too many does not depend on who recorded what first; so this reason comes before others.
        if self.budget.is_full() {
            return Err(TOO_LONG);
        }
        let mut found = std::mem::take(&mut *held(&self.found));
        found.sort_unstable_by_key(|(at, _)| *at);
        found.into_iter().map(|(_, portion)| portion).collect()
    }
}

/// A lock, whoever has panicked with it: the panic goes on at its thread's end, before anybody uses a result.
fn held<D>(lock: &Mutex<D>) -> MutexGuard<'_, D> {
    lock.lock().unwrap_or_else(PoisonError::into_inner)
}

/// State that the threads of a crew share.
struct CrewState {
    /// The batch that is being recorded; none from when the prerun waits for the helpers of one up to the next.
    work: Option<Arc<BatchWork>>,
    /// Threads that record some of it beside that of the prerun.
    helpers: usize,
    /// One of them has panicked, so that the batch stays incomplete.
    is_broken: bool,
    /// There will be no more batches.
    is_closed: bool,
    /// The batches that wait for each machine; none for one that wants no more.
    ready: Vec<Option<VecDeque<Arc<Batch>>>>,
}

/// Monitor of that state: a lock, and a signal of its changes.
struct Monitor {
    state: Mutex<CrewState>,
    changed: Condvar,
}

impl Monitor {
    fn lock(&self) -> MutexGuard<'_, CrewState> {
        held(&self.state)
    }

    fn wait<'s>(&self, state: MutexGuard<'s, CrewState>) -> MutexGuard<'s, CrewState> {
        self.changed.wait(state).unwrap_or_else(PoisonError::into_inner)
    }

    /// Changes the state, and tells those who wait.
    fn change<R>(&self, change: impl FnOnce(&mut CrewState) -> R) -> R {
        let result = change(&mut self.lock());
        self.changed.notify_all();
        result
    }
}

/// Recorders, with what those share who use them.
pub struct Crew<'a, T, O> {
    /// A recorder a host thread; the first one is the prerun's.
    recorders: Vec<Mutex<Recorder<'a, T, O>>>,
    monitor: Monitor,
}

impl<'a, T: Watch, O: Observer> Crew<'a, T, O> {
    /// A crew of these recorders, whose batches nobody wants yet.
    pub fn new(recorders: impl Iterator<Item = Recorder<'a, T, O>>) -> Crew<'a, T, O> {
        let state = CrewState { work: None, helpers: 0, is_broken: false, is_closed: false, ready: Vec::new() };
        let monitor = Monitor { state: Mutex::new(state), changed: Condvar::new() };
        Crew { recorders: recorders.map(Mutex::new).collect(), monitor }
    }

    /// Records a batch, for the prerun: yields it when all have done their part.
    pub fn record(&self, work: &Arc<BatchWork>) -> Batch {
        if self.recorders.len() > 1 {
            self.monitor.change(|state| state.work = Some(work.clone()));
        }
        work.work_off(&mut held(&self.recorders[0]));
        let mut state = self.monitor.lock();
        state.work = None;
        while state.helpers != 0 {
            state = self.monitor.wait(state);
        }
        if state.is_broken { Err(BROKEN_OFF) } else { work.recorded() }
    }

    /// Asks each recorder something, between two batches.
    pub fn each_recorder(&self, mut ask: impl FnMut(&mut Recorder<'a, T, O>)) {
        self.recorders.iter().for_each(|recorder| ask(&mut held(recorder)));
    }

    /// Gives a batch to the machines, as soon as all of them have room for it; false where none wants it.
    pub fn publish(&self, batch: &Arc<Batch>) -> bool {
        let mut state = self.monitor.lock();
        while state.ready.iter().flatten().any(|ready| ready.len() >= AHEAD) {
            state = self.monitor.wait(state);
        }
        state.ready.iter_mut().flatten().for_each(|ready| ready.push_back(batch.clone()));
        self.monitor.changed.notify_all();
        state.ready.iter().any(Option::is_some)
    }

    /// Records until there are no more batches.
    pub fn help(&self) {
        let mut state = self.monitor.lock();
        while !state.is_closed {
            state = self.help_or_wait(state);
        }
    }

    /// Records some of the batch with a recorder that nobody uses, until nothing of it can be taken; waits where there is no such thing.
    fn help_or_wait<'s>(&'s self, mut state: MutexGuard<'s, CrewState>) -> MutexGuard<'s, CrewState> {
        let work = state.work.clone().filter(|work| work.is_open());
        let free = || self.recorders[1..].iter().find_map(|recorder| recorder.try_lock().ok());
        let Some((work, mut recorder)) = work.and_then(|work| Some((work, free()?))) else {
            return self.monitor.wait(state);
        };
        state.helpers += 1;
        drop(state);
        let helping = Helping(&self.monitor);
        work.work_off(&mut recorder);
        drop((recorder, helping));
        self.monitor.lock()
    }

    /// The subscription of one more machine. All have to be there before the first batch is published.
    pub fn subscribe(&self) -> Subscription<'_, 'a, T, O> {
        let mut state = self.monitor.lock();
        state.ready.push(Some(VecDeque::new()));
        Subscription { crew: self, number: state.ready.len() - 1 }
    }

    /// Says that there will be no more batches when it is dropped, in a panic as well: to be had before anybody waits for one.
    pub fn closing(&self) -> Closing<'_> {
        Closing(&self.monitor)
    }

    /// All recorders, when nobody uses them any more.
    pub fn into_recorders(self) -> impl Iterator<Item = Recorder<'a, T, O>> {
        self.recorders.into_iter().map(|recorder| recorder.into_inner().unwrap_or_else(PoisonError::into_inner))
    }
}

/// Help with a batch, up to its end or a panic.
struct Helping<'c>(&'c Monitor);

impl Drop for Helping<'_> {
    fn drop(&mut self) {
        let mut state = self.0.lock();
        state.helpers -= 1;
        state.is_broken |= std::thread::panicking();
        // Only the prerun waits for that, and for all of them.
        if state.helpers == 0 {
            self.0.changed.notify_all();
        }
    }
}

/// Promise to say when there will be no more batches.
pub struct Closing<'c>(&'c Monitor);

impl Drop for Closing<'_> {
    fn drop(&mut self) {
        self.0.change(|state| state.is_closed = true);
    }
}

/// Subscription of a machine, which wants batches as long as it has it.
pub struct Subscription<'c, 'a, T: Watch, O: Observer> {
    crew: &'c Crew<'a, T, O>,
    number: usize,
}

impl<T: Watch, O: Observer> Subscription<'_, '_, T, O> {
    /// The next batch, for which the machine records meanwhile; `None` when there are no more.
    pub fn take(&self) -> Option<Arc<Batch>> {
        let mut state = self.crew.monitor.lock();
        loop {
            let ready = state.ready[self.number].as_mut()?;
            let was_full = ready.len() == AHEAD;
            if let Some(batch) = ready.pop_front() {
                // Only a prerun that has found no room waits for some.
                if was_full {
                    self.crew.monitor.changed.notify_all();
                }
                return Some(batch);
            }
            if state.is_closed {
                return None;
            }
            state = self.crew.help_or_wait(state);
        }
    }
}

impl<T: Watch, O: Observer> Drop for Subscription<'_, '_, T, O> {
    fn drop(&mut self) {
        self.crew.monitor.change(|state| state.ready[self.number] = None);
    }
}
