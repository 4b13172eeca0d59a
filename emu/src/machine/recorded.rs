//! Work items that were recorded once and are kept, to be replayed as often as one likes. Where memory must stay
//! bounded, [`super::run_all`] streams them instead.

use std::sync::Arc;
use std::sync::mpsc::channel;

use super::ending::Ending;
use super::library::{Batch, Library};
use super::recorder::Prefix;
use super::recording::Reason;
use super::scout::{self, Survey};
use super::strands::Keeping;
use super::{Failure, Frame, Setup, check, on_arithmetic, replay, schedule};
use crate::engine::Task;
use crate::exec::Watch;
use crate::octets::Memory;
use crate::profile::RunObserver;

/// All work items of a frame.
pub struct Recorded {
    prefix: Prefix,
    cores: u32,
    batches: Vec<Arc<Batch>>,
    survey: Survey,
}

impl Recorded {
    /// Runs the work items on all host threads.
    ///
    /// # Errors
    /// Why they cannot be replayed; a machine that cannot be used is one of the reasons.
    pub fn new(setup: &Setup, memory: &Memory) -> Result<Recorded, Reason> {
        check(setup).map_err(|_| "the machine cannot be used")?;
        on_arithmetic(setup, Recording { setup, memory })
    }

    /// Segments of all work items: computing, then a transfer or a message.
    pub fn segments(&self) -> usize {
        let batches = self.batches.iter().filter_map(|batch| batch.as_ref().as_ref().ok());
        batches.flatten().map(|recording| recording.segments.len()).sum()
    }

    /// Replays them on a machine that computes as the one that they were recorded for.
    ///
    /// # Errors
    /// As [`super::run`]; the inner error says why this machine would not do what was recorded.
    pub fn replay(&self, setup: &Setup, memory: Memory) -> Result<Result<Frame, Reason>, Failure> {
        check(setup)?;
        match on_arithmetic(setup, Replaying { recorded: self, setup, memory }) {
            Ok(frame) => Ok(Ok(replay::with_counts(frame, setup, &self.survey))),
            Err(Ending::Lost(reason)) => Ok(Err(reason)),
            Err(Ending::Failure(failure)) => Err(failure),
        }
    }
}

struct Recording<'a> {
    setup: &'a Setup<'a>,
    memory: &'a Memory,
}

impl Task for Recording<'_> {
    type Result = Result<Recorded, Reason>;

    fn run<T: Watch + Clone + Send, O: RunObserver + Send>(self, arithmetic: &T) -> Self::Result {
        let Recording { setup, memory } = self;
        let prefix = replay::prefix(setup, memory, arithmetic)?;
        let mut batches = Vec::new();
        let survey = scout::run::<T, O>(setup, memory, arithmetic.clone(), Keeping::Segments, &mut |batch| {
            batches.push(batch);
            true
        });
        if let Some(Err(reason)) = batches.last().map(AsRef::as_ref) {
            return Err(reason);
        }
        Ok(Recorded { prefix, cores: setup.config.cores, batches, survey })
    }
}

struct Replaying<'a> {
    recorded: &'a Recorded,
    setup: &'a Setup<'a>,
    memory: Memory,
}

impl Task for Replaying<'_> {
    type Result = Result<Frame, Ending>;

    fn run<T: Watch + Clone + Send, O: RunObserver + Send>(self, arithmetic: &T) -> Self::Result {
        let (sender, receiver) = channel();
        for batch in &self.recorded.batches {
            sender.send(batch.clone()).expect("the receiver is below");
        }
        drop(sender);
        let Recorded { prefix, cores, .. } = *self.recorded;
        let library = Library::new(prefix, cores, self.setup.config.cores, receiver);
        schedule::run::<T, O>(self.setup, self.memory, arithmetic, Some(library), &mut |_| {})
    }
}
