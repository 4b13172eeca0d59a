//! A frame without clocks: what the work items answer and count, for those who ask nothing of time.

use super::item::RecordLevel;
use super::prerun;
use super::recording::Reason;
use crate::code::octets::Memory;
use crate::code::tally::Tally;
use crate::engine::{Pause, Task};
use crate::machine::kinds::Kinds;
use crate::machine::{RunFailure, Setup, check, on_arithmetic};
use crate::profile::{Observer, Profile};
use crate::semantics::Watch;

/// Totals of a frame: what it computes and counts, whatever the time it takes.
#[derive(Clone, Debug)]
pub struct FrameTotals {
    /// Global memory at the end.
    pub memory: Memory,
    /// Passes of all cores.
    pub tally: Tally,
    /// Functions and regions of the cores' program, where a profile was asked for.
    pub profile: Option<Profile>,
    /// Octets that the cores moved, by kind.
    pub kinds: Kinds,
    /// Number of work items.
    pub item_count: u64,
}

/// Runs the work items of a frame on all host threads and puts nothing on a clock.
///
/// # Errors
/// A machine out of its ranges, or a program whose initial buffer does not fit. The inner error says why there is no such
/// result: the frame traps, or what its work items do depends on time, which [`crate::run()`] finds out about.
pub fn count(setup: &Setup, memory: &Memory) -> Result<Result<FrameTotals, Reason>, RunFailure> {
    check(setup)?;
    Ok(on_arithmetic(setup, CountTask { setup, memory }))
}

struct CountTask<'a> {
    setup: &'a Setup<'a>,
    memory: &'a Memory,
}

impl Task for CountTask<'_> {
    type Result = Result<FrameTotals, Reason>;

    fn run<T: Watch + Clone + Send, O: Observer + Send>(self, arithmetic: &T) -> Self::Result {
        let CountTask { setup, memory } = self;
        super::prefix(setup, memory, arithmetic)?;
        let (mut item_count, mut unfit) = (0, None);
        let totals = prerun::run::<T, O>(setup, memory, arithmetic.clone(), RecordLevel::Passes, &mut |batch| {
            match batch.as_ref() {
                Err(reason) => unfit = Some(*reason),
                Ok(batch) => {
                    item_count += batch.iter().map(|portion| portion.items.len() as u64).sum::<u64>();
                    // A trap stops a machine at a clock, and what others have done by then only a run on the clock knows.
                    if batch.iter().flat_map(|portion| &portion.items).any(|item| item.end != Pause::Halt) {
                        unfit = Some("a work item traps");
                    }
                }
            }
            unfit.is_none()
        });
        if totals.end != Pause::Halt {
            unfit.get_or_insert("the main processor does not come to its end");
        }
        match unfit {
            Some(reason) => Err(reason),
            None => Ok(FrameTotals {
                memory: totals.memory,
                tally: totals.items.tally,
                profile: totals.items.profile,
                kinds: totals.items.kinds,
                item_count,
            }),
        }
    }
}
