//! Recorded work items on their way from those who run them to a machine that replays them, a batch at a time.

use std::collections::VecDeque;
use std::sync::Arc;

use super::record::Prefix;
use super::recording::{Portion, Reason, RecordedItem};
use crate::semantics::Message;

/// Portions of recordings, or why there are no more.
pub type Batch = Result<Vec<Arc<Portion>>, Reason>;

/// Recordings that a machine holds at once, at most; each keeps the others of its portion.
const MOST_HELD: usize = 1 << 14;

/// The recordings of one machine, each of which it uses once.
pub struct Feed<'a> {
    /// Prefix of every work item, before its message comes.
    pub prefix: Prefix,
    /// Number of cores that the items were recorded with.
    recorded_cores: u32,
    /// Number of cores of this machine.
    cores: u32,
    /// Yields the next batch; none when there are no more.
    next_batch: Box<dyn FnMut() -> Option<Arc<Batch>> + 'a>,
    /// In the order in which they were recorded.
    held: VecDeque<RecordedItem>,
    /// Reason for which the replay is worth nothing.
    pub lost: Option<Reason>,
}

impl<'a> Feed<'a> {
    /// The recordings that somebody yields, batch by batch.
    pub fn new(
        prefix: Prefix,
        recorded_cores: u32,
        cores: u32,
        next_batch: impl FnMut() -> Option<Arc<Batch>> + 'a,
    ) -> Feed<'a> {
        Feed { prefix, recorded_cores, cores, next_batch: Box::new(next_batch), held: VecDeque::new(), lost: None }
    }

    /// Takes the recording of the work item that begins with a message; `None` when the replay is lost.
    pub fn take(&mut self, message: &Message) -> Option<RecordedItem> {
        // What is lost needs no more recordings.
        if self.lost.is_some() {
            return None;
        }
        // Mostly it is the first: work is handed out in the order in which it was recorded.
        let mut from = 0;
        loop {
            let is_it = |recording: &RecordedItem| recording.message == *message;
            if let Some(place) = self.held.range(from..).position(is_it) {
                return self.held.remove(from + place);
            }
            // What was looked at does not match; only the next batch can have it.
            from = self.held.len();
            let batch = if from < MOST_HELD { (self.next_batch)() } else { None };
            match batch.as_deref() {
                Some(Ok(batch)) => self.hold(batch)?,
                Some(Err(reason)) => return self.lose(reason),
                None => return self.lose("the main processor's messages depend on time or on the number of cores"),
            }
        }
    }

    fn hold(&mut self, batch: &[Arc<Portion>]) -> Option<()> {
        // On as many cores as it was recorded with, an item may depend on their number.
        if self.recorded_cores != self.cores
            && batch.iter().flat_map(|portion| &portion.items).any(|item| item.depends_on_cores)
        {
            return self.lose("the work items depend on the number of cores");
        }
        self.held.extend(batch.iter().flat_map(RecordedItem::all));
        Some(())
    }

    /// Notes that the replay is worth nothing, and gives nothing.
    pub fn lose<R>(&mut self, reason: Reason) -> Option<R> {
        self.lost.get_or_insert(reason);
        None
    }

    /// True where each recording was used; waits for the last one.
    pub fn is_used_up(&mut self) -> bool {
        self.held.is_empty() && (self.next_batch)().is_none()
    }
}
