//! Work items that were recorded once and are kept, to be replayed as often as one likes. Where memory must stay
//! bounded, [`crate::run_all`] streams them instead.

use std::sync::Arc;

use super::feed::{Batch, Feed};
use super::item::RecordLevel;
use super::prerun::{self, ItemTotals, PrerunTotals};
use super::record::Prefix;
use super::recording::Reason;
use crate::code::Code;
use crate::code::octets::Memory;
use crate::engine::{Pause, Task};
use crate::machine::{Config, RunFailure, RunOutcome, Setup, check, on_arithmetic};
use crate::profile::Observer;
use crate::semantics::Watch;

/// All work items of a frame.
pub struct Recorded {
    pub(super) prefix: Prefix,
    /// Number of cores that they were recorded with.
    pub(super) cores: u32,
    pub(super) batches: Vec<Arc<Batch>>,
    pub(super) totals: ItemTotals,
    /// The main processor's program came to its end, so these are all there are.
    pub(super) is_whole: bool,
}

impl Recorded {
    /// Runs the work items on all host threads.
    ///
    /// # Errors
    /// Why they cannot be replayed; a machine that cannot be used is one of the reasons.
    pub fn new(setup: &Setup, memory: &Memory) -> Result<Recorded, Reason> {
        check(setup).map_err(|_| "the machine cannot be used")?;
        on_arithmetic(setup, RecordTask { setup, memory })
    }

    /// Segments of all work items: computing, then a transfer or a message.
    pub fn segments(&self) -> usize {
        let batches = self.batches.iter().filter_map(|batch| batch.as_ref().as_ref().ok());
        batches.flatten().map(|portion| portion.track.segments.len()).sum()
    }

    /// Replays them on a machine that computes as the one that they were recorded for.
    ///
    /// # Errors
    /// As [`crate::run()`]; the inner error says why this machine would not do what was recorded.
    pub fn replay(&self, setup: &Setup, memory: Memory) -> Result<Result<RunOutcome, Reason>, RunFailure> {
        self.replays(setup).replay(setup.config, memory)
    }

    /// Replays them, and tells `progress` the number of work items finished, each time one is.
    ///
    /// # Errors
    /// As [`Recorded::replay`].
    pub fn replay_with(
        &self,
        setup: &Setup,
        memory: Memory,
        progress: &mut dyn FnMut(u64),
    ) -> Result<Result<RunOutcome, Reason>, RunFailure> {
        self.replays(setup).replay_on(setup, memory, progress)
    }

    /// Replays of them on many machines, of which this is one, all with its programs and its options.
    pub fn replays<'a>(&'a self, setup: &Setup<'a>) -> Replays<'a> {
        Replays { recorded: self, setup: setup.clone(), codes: setup.codes() }
    }
}

/// Replays of recorded work items on machines that compute alike: their programs are decoded, and compiled, once for all machines.
pub struct Replays<'a> {
    recorded: &'a Recorded,
    setup: Setup<'a>,
    codes: [Code<'a>; 2],
}

impl Replays<'_> {
    /// A replay on one machine.
    ///
    /// # Errors
    /// As [`Recorded::replay`].
    pub fn replay(&self, config: &Config, memory: Memory) -> Result<Result<RunOutcome, Reason>, RunFailure> {
        if !config.computes_like(self.setup.config) {
            return Ok(Err("the machine computes otherwise than the one that was recorded"));
        }
        self.replay_on(&Setup { config, ..self.setup.clone() }, memory, &mut |_| {})
    }

    /// A replay on one machine that computes as the one of the recordings, with options of its own; `progress` is told the number of work items
    /// finished, each time one is.
    ///
    /// # Errors
    /// As [`Recorded::replay`].
    pub(crate) fn replay_on(
        &self,
        setup: &Setup,
        memory: Memory,
        progress: &mut dyn FnMut(u64),
    ) -> Result<Result<RunOutcome, Reason>, RunFailure> {
        check(setup)?;
        let Replays { recorded, codes, .. } = self;
        match on_arithmetic(setup, ReplayTask { recorded, codes, setup, memory, progress }) {
            Ok(ended) => Ok(Ok(super::with_counts(ended?, codes, &recorded.totals))),
            Err(reason) => Ok(Err(reason)),
        }
    }
}

struct RecordTask<'a> {
    setup: &'a Setup<'a>,
    memory: &'a Memory,
}

impl Task for RecordTask<'_> {
    type Result = Result<Recorded, Reason>;

    fn run<T: Watch + Clone + Send, O: Observer + Send>(self, arithmetic: &T) -> Self::Result {
        let RecordTask { setup, memory } = self;
        let prefix = super::prefix(setup, memory, arithmetic)?;
        let mut batches = Vec::new();
        let totals = prerun::run::<T, O>(setup, memory, arithmetic.clone(), RecordLevel::Segments, &mut |batch| {
            batches.push(batch);
            true
        });
        // A reason ends the prerun, so only the last batch can be one.
        if let Some(Err(reason)) = batches.last().map(AsRef::as_ref) {
            return Err(reason);
        }
        let PrerunTotals { items: totals, end, .. } = totals;
        Ok(Recorded { prefix, cores: setup.config.cores, batches, totals, is_whole: end == Pause::Halt })
    }
}

struct ReplayTask<'a> {
    recorded: &'a Recorded,
    codes: &'a [Code<'a>; 2],
    setup: &'a Setup<'a>,
    memory: Memory,
    progress: &'a mut dyn FnMut(u64),
}

impl Task for ReplayTask<'_> {
    type Result = super::Replayed;

    fn run<T: Watch + Clone + Send, O: Observer + Send>(self, arithmetic: &T) -> Self::Result {
        let mut batches = self.recorded.batches.iter().cloned();
        let Recorded { prefix, cores, .. } = *self.recorded;
        let feed = Feed::new(prefix, cores, self.setup.config.cores, || batches.next());
        super::on_clock::<T, O>(self.setup, self.codes, self.memory, arithmetic, feed, self.progress)
    }
}
