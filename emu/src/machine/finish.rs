//! End of a schedule: a frame or a trap.

use isa::Class;

use super::RunFailure;
use super::cache::Cache;
use super::kinds::Kinds;
use super::outcome::{Method, RunOutcome};
use super::processor::ProcessorState;
use super::schedule::Machine;
use super::trace::Spans;
use super::worker::{Worker, WorkerCounts};
use crate::code::Code;
use crate::code::quantity::{Clocks, Octets};
use crate::code::tally::Tally;
use crate::code::trap::{Fault, Trap};
use crate::profile::{ClockKeys, ClockLog, Profile, ProgramClocks};

/// A run that has ended.
pub(crate) struct EndedRun {
    /// Outcome of the run.
    pub frame: RunOutcome,
    /// Clocks of functions of replaying cores: what their numbers mean, only those who recorded know.
    pub logs: Vec<ClockLog>,
}

/// Adds waits and transfers of a core to the profile of its program, and yields the clocks of its functions; `None` without a profile.
pub(crate) fn add_clocks(
    log: &ClockLog,
    keys: &[ClockKeys],
    code: &Code,
    profile: &mut Option<Profile>,
) -> Option<ProgramClocks> {
    Some(log.fold(keys, code, profile.as_mut()?.clocks.as_mut()?))
}

impl<W: Worker> Machine<'_, W> {
    /// The trap of a processor that stopped.
    pub(super) fn trap(&self, number: usize) -> Trap {
        let processor = &self.processors[number];
        let kind = processor.fault.unwrap_or(Fault::Deadlock);
        let trap = Trap::new(kind, number as u32, processor.worker.progress().pc, processor.code);
        match processor.work.message.map(|message| message.first()) {
            Some([x, y, z]) => {
                trap.with_detail(format!("in the work item whose first message began with {x}, {y}, {z}"))
            }
            None => trap,
        }
    }

    /// Takes back what masters of the bus still have, which are those that it will never serve, so that processors can say what they wait for.
    fn recall(&mut self) {
        /// A clock behind all others.
        const END: Clocks = Clocks(1 << 62);
        let masters = self.masters.iter_mut().flat_map(|masters| &mut masters.all);
        for (processor, master) in self.processors.iter_mut().zip(masters) {
            if processor.state == ProcessorState::Asks {
                processor.take_back(master, END);
            }
        }
    }

    /// Check that everybody has done what was begun.
    pub(super) fn check_end(&mut self) -> Result<(), RunFailure> {
        self.recall();
        let is_stuck = |number: usize| {
            let processor = &self.processors[number];
            match processor.state {
                ProcessorState::Rests | ProcessorState::Asleep => false,
                // A core that waits without having received anything is out of work once the main processor is done.
                ProcessorState::Listens | ProcessorState::Blocked { .. } if number != self.main() => {
                    !self.has_main_halted || processor.work.message.is_some()
                }
                _ => true,
            }
        };
        let mut stuck = (0..self.processors.len()).filter(|&number| is_stuck(number));
        let Some(first) = stuck.next() else { return Ok(()) };
        let others: Vec<String> =
            std::iter::once(first).chain(stuck).map(|number| self.processors[number].waits_for()).collect();
        Err(self.trap(first).with_detail(others.join(", ")).into())
    }

    /// The outcome of a run that has ended.
    pub(super) fn finish(mut self) -> EndedRun {
        let clocks = self.processors.iter().map(|processor| processor.clock).max().unwrap_or_default();
        for processor in &mut self.processors {
            // All end at the same clock, so that busy, waiting and idle of each add up to the whole time.
            processor.idle_until(clocks);
        }
        // Items ended in the order of clocks; they are listed by when they began. Their keys are sorted apart, since an item is large.
        self.items.sort_by_cached_key(|item| (item.start, item.core));
        let caches = self.processors.iter().filter_map(|processor| processor.cache.as_ref());
        let cache = caches.map(Cache::used).sum();
        let used = self.processors.iter().map(|processor| processor.used).collect();
        let spans =
            self.processors.iter_mut().map(|processor| processor.spans.take().map_or(Vec::new(), Spans::into_list));
        let spans = spans.collect();
        let trace = self.bus_watch.map(|watch| watch.into_trace(spans));
        let main = self.processors.pop().expect("a machine has a main processor");
        let main_code = main.code;
        let WorkerCounts { tally: main_tally, profile: mut main_profile, clocks: log, keys, kinds } =
            main.worker.into_counts();
        self.kinds.merge(kinds.as_ref().map_or(&[], Kinds::totals));
        if let (Some(log), Some(keys)) = (log, keys) {
            add_clocks(&log, &[keys], main_code, &mut main_profile);
        }
        // All cores have one program, so their tallies can be added up.
        let core_code = self.processors.first().map_or(main_code, |core| core.code);
        let mut tally = Tally::new(core_code);
        let mut profile: Option<Profile> = None;
        let (mut core_clocks, mut logs) = (Vec::new(), Vec::new());
        for processor in self.processors {
            let WorkerCounts { tally: more, profile: mut observed, clocks: log, keys, .. } =
                processor.worker.into_counts();
            tally.merge(&more);
            match (log, keys) {
                (Some(log), Some(keys)) => core_clocks.extend(add_clocks(&log, &[keys], core_code, &mut observed)),
                (log, _) => logs.extend(log),
            }
            match (&mut profile, observed) {
                (Some(profile), Some(more)) => profile.merge(&more),
                (profile, more) => *profile = more,
            }
        }
        let asked = tally.counts(core_code)[Class::Octet] + main_tally.counts(main_code)[Class::Octet];
        let frame = RunOutcome {
            method: Method::Stepped { why: "" },
            clocks,
            processors: used,
            bus: self.bus.used(),
            waits: self.bus.waits().to_vec(),
            cache,
            asked: Octets(asked),
            bypassed: self.bypassed,
            kinds: self.kinds.into_totals(),
            memory: self.shared.memory,
            tally,
            main_profile,
            main_tally,
            profile,
            core_clocks,
            trace,
            course: self.course,
            items: self.items,
            item_count: self.item_count,
        };
        EndedRun { frame, logs }
    }
}
