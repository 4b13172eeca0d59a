//! Crew of a prerun: recorders, and whoever has nothing else to do. A batch is worked off portion by portion by the prerun's thread, by threads that do
//! nothing else, and by machines that wait for it; so no host thread waits as long as there is work.

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

const TOO_LONG: Reason = "the work items make too many transfers to be recorded";
const BROKEN_OFF: Reason = "a work item was not recorded to its end";

/// Work items of a batch that somebody records.
pub struct Work {
    /// Numbers of cores, and the messages that they were sent.
    pub messages: Vec<(u32, Message)>,
    /// Number of the first item that nobody has taken.
    next: AtomicUsize,
    budget: Budget,
    found: Mutex<Vec<PortionFound>>,
}

/// Portion, or why there is none, by the number of its first item.
type PortionFound = (usize, Result<Arc<Portion>, Reason>);

impl Work {
    /// Work of which nothing is taken.
    pub fn new(messages: Vec<(u32, Message)>) -> Work {
        let (next, found) = (AtomicUsize::new(0), Mutex::default());
        Work { messages, next, budget: Budget::new(MOST_SEGMENTS), found }
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

/// A lock on what stays whole if somebody panics who holds it.
fn held<D>(lock: &Mutex<D>) -> MutexGuard<'_, D> {
    lock.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Desk at which all meet: what is to be done, and what is ready.
struct Desk {
    /// The batch that is worked on.
    work: Option<Arc<Work>>,
    /// Threads that work on it beside that of the prerun.
    helpers: usize,
    /// One of them has panicked, so that the batch stays incomplete.
    is_broken: bool,
    /// There will be no more batches.
    is_closed: bool,
    /// The batches that wait for each machine; none for one that wants no more.
    ready: Vec<Option<VecDeque<Arc<Batch>>>>,
}

/// Recorders, a host thread each at most, with the desk at which those meet who use them.
pub struct Crew<'a, T, O> {
    /// The first one is the prerun's.
    recorders: Vec<Mutex<Recorder<'a, T, O>>>,
    desk: Mutex<Desk>,
    /// Something at the desk is otherwise than it was.
    changed: Condvar,
}

impl<'a, T: Watch, O: Observer> Crew<'a, T, O> {
    /// A crew of these recorders, whose batches so many machines want.
    pub fn new(recorders: impl Iterator<Item = Recorder<'a, T, O>>, machines: usize) -> Crew<'a, T, O> {
        let ready = (0..machines).map(|_| Some(VecDeque::new())).collect();
        let desk = Desk { work: None, helpers: 0, is_broken: false, is_closed: false, ready };
        Crew { recorders: recorders.map(Mutex::new).collect(), desk: Mutex::new(desk), changed: Condvar::new() }
    }

    /// Records a batch, for the prerun: yields it when all have done their part.
    pub fn record(&self, work: &Arc<Work>) -> Batch {
        if self.recorders.len() > 1 {
            held(&self.desk).work = Some(work.clone());
            self.changed.notify_all();
        }
        work.work_off(&mut held(&self.recorders[0]));
        let mut desk = held(&self.desk);
        desk.work = None;
        while desk.helpers != 0 {
            desk = self.wait(desk);
        }
        if desk.is_broken { Err(BROKEN_OFF) } else { work.recorded() }
    }

    /// Asks each recorder something, between two batches.
    pub fn each_recorder(&self, mut ask: impl FnMut(&mut Recorder<'a, T, O>)) {
        self.recorders.iter().for_each(|recorder| ask(&mut held(recorder)));
    }

    /// Lays a batch before the machines, as soon as all of them have room for it; false where none wants it.
    pub fn hand_over(&self, batch: &Arc<Batch>) -> bool {
        let mut desk = held(&self.desk);
        while desk.ready.iter().flatten().any(|ready| ready.len() >= AHEAD) {
            desk = self.wait(desk);
        }
        desk.ready.iter_mut().flatten().for_each(|ready| ready.push_back(batch.clone()));
        self.changed.notify_all();
        desk.ready.iter().any(Option::is_some)
    }

    /// Lends a hand until there are no more batches.
    pub fn help(&self) {
        let mut desk = held(&self.desk);
        while !desk.is_closed {
            desk = self.help_or_wait(desk);
        }
    }

    /// The next batch of a machine, which lends a hand meanwhile; `None` when there are no more.
    fn take(&self, machine: usize) -> Option<Arc<Batch>> {
        let mut desk = held(&self.desk);
        loop {
            if let Some(batch) = desk.ready[machine].as_mut()?.pop_front() {
                self.changed.notify_all();
                return Some(batch);
            }
            if desk.is_closed {
                return None;
            }
            desk = self.help_or_wait(desk);
        }
    }

    fn wait<'d>(&self, desk: MutexGuard<'d, Desk>) -> MutexGuard<'d, Desk> {
        self.changed.wait(desk).unwrap_or_else(PoisonError::into_inner)
    }

    /// Works on the batch at the desk with a recorder that nobody uses, until nothing of it can be taken; waits where there is no such thing.
    fn help_or_wait<'d>(&'d self, mut desk: MutexGuard<'d, Desk>) -> MutexGuard<'d, Desk> {
        let work = desk.work.clone().filter(|work| work.is_open());
        let free = || self.recorders[1..].iter().find_map(|recorder| recorder.try_lock().ok());
        let Some((work, mut recorder)) = work.and_then(|work| Some((work, free()?))) else { return self.wait(desk) };
        desk.helpers += 1;
        drop(desk);
        let helping = Helping(&self.desk, &self.changed);
        work.work_off(&mut recorder);
        drop((recorder, helping));
        held(&self.desk)
    }

    /// The place of a machine at the desk.
    pub fn seat(&self, machine: usize) -> Seat<'_, 'a, T, O> {
        Seat { crew: self, machine }
    }

    /// Says that there will be no more batches when it is dropped, in a panic as well.
    pub fn closing(&self) -> Closing<'_> {
        Closing(&self.desk, &self.changed)
    }

    /// All recorders, when nobody uses them any more.
    pub fn into_recorders(self) -> impl Iterator<Item = Recorder<'a, T, O>> {
        self.recorders.into_iter().map(|recorder| recorder.into_inner().unwrap_or_else(PoisonError::into_inner))
    }
}

/// Help with a batch, up to its end or a panic.
struct Helping<'c>(&'c Mutex<Desk>, &'c Condvar);

impl Drop for Helping<'_> {
    fn drop(&mut self) {
        let mut desk = held(self.0);
        desk.helpers -= 1;
        desk.is_broken |= std::thread::panicking();
        self.1.notify_all();
    }
}

/// Promise of a prerun to say when there will be no more batches.
pub struct Closing<'c>(&'c Mutex<Desk>, &'c Condvar);

impl Drop for Closing<'_> {
    fn drop(&mut self) {
        held(self.0).is_closed = true;
        self.1.notify_all();
    }
}

/// Seat of a machine, which wants batches as long as it has it.
pub struct Seat<'c, 'a, T: Watch, O: Observer> {
    crew: &'c Crew<'a, T, O>,
    machine: usize,
}

impl<T: Watch, O: Observer> Seat<'_, '_, T, O> {
    /// The next batch; `None` when there are no more.
    pub fn take(&self) -> Option<Arc<Batch>> {
        self.crew.take(self.machine)
    }
}

impl<T: Watch, O: Observer> Drop for Seat<'_, '_, T, O> {
    fn drop(&mut self) {
        held(&self.crew.desk).ready[self.machine] = None;
        self.crew.changed.notify_all();
    }
}
