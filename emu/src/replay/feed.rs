//! Recorded work items on their way from those who run them to a machine that replays them, a batch at a time.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::mpsc::Receiver;

use super::record::Prefix;
use super::recording::{Reason, Recording};
use crate::semantics::Message;

/// Recordings, or why there are no more.
pub type Batch = Result<Vec<Arc<Recording>>, Reason>;

/// Recordings that a machine holds at once, at most.
const MOST_HELD: usize = 1 << 14;

/// The recordings of one machine, each of which it uses once.
#[derive(Debug)]
pub struct Feed {
    /// Prefix of every work item, before its message comes.
    pub prefix: Prefix,
    /// Number of cores that the items were recorded with.
    recorded_cores: u32,
    /// Number of cores of this machine.
    cores: u32,
    batches: Receiver<Arc<Batch>>,
    /// In the order in which they were recorded.
    held: VecDeque<Arc<Recording>>,
    /// Reason for which the replay is worth nothing.
    pub lost: Option<Reason>,
}

impl Feed {
    /// The recordings that come through a channel.
    pub fn new(prefix: Prefix, recorded_cores: u32, cores: u32, batches: Receiver<Arc<Batch>>) -> Feed {
        Feed { prefix, recorded_cores, cores, batches, held: VecDeque::new(), lost: None }
    }

    /// Takes the recording of the work item that begins with a message; `None` when the replay is lost.
    pub fn take(&mut self, message: &Message) -> Option<Arc<Recording>> {
        // Mostly it is the first: work is handed out in the order in which it was recorded.
        let mut from = 0;
        loop {
            let is_it = |recording: &Arc<Recording>| recording.message == *message;
            if let Some(place) = self.held.range(from..).position(is_it) {
                return self.held.remove(from + place);
            }
            // What was looked at does not match; only the next batch can have it.
            from = self.held.len();
            let batch = self.batches.recv().ok().filter(|_| from < MOST_HELD);
            match batch.as_deref() {
                Some(Ok(batch)) => self.hold(batch)?,
                Some(Err(reason)) => return self.lose(reason),
                None => return self.lose("the main processor's messages depend on time or on the number of cores"),
            }
        }
    }

    fn hold(&mut self, batch: &[Arc<Recording>]) -> Option<()> {
        // On as many cores as it was recorded with, an item may depend on their number.
        if self.recorded_cores != self.cores && batch.iter().any(|recording| recording.depends_on_cores) {
            return self.lose("the work items depend on the number of cores");
        }
        self.held.extend(batch.iter().cloned());
        Some(())
    }

    /// Notes that the replay is worth nothing, and gives nothing.
    pub fn lose<R>(&mut self, reason: Reason) -> Option<R> {
        self.lost.get_or_insert(reason);
        None
    }

    /// True where each recording was used; waits for the last one.
    pub fn is_used_up(&mut self) -> bool {
        self.held.is_empty() && self.batches.recv().is_err()
    }
}
