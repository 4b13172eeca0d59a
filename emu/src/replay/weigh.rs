//! Weights of work items one by one: what each of them did, pass by pass, times a weight for each pass of the program. Clocks play no part.

use isa::number::Vector;

use super::budget::Budget;
use super::item::RecordLevel;
use super::prerun;
use super::record::Recorder;
use super::recording::{Portion, Reason};
use crate::code::Code;
use crate::code::octets::Memory;
use crate::code::tally::Tally;
use crate::engine::{Pause, Task};
use crate::machine::{RunFailure, Setup, check, on_arithmetic};
use crate::profile::{Observer, Unobserved};
use crate::semantics::{Message, Watch};

/// Segments that an item may leave behind, at most; they are dropped at once.
const MOST_SEGMENTS: usize = 1 << 23;

/// Weights of the passes of a program, by number, and of each of their units.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PassWeights {
    /// Of a pass.
    pub passes: Vec<u64>,
    /// Of a unit of a pass.
    pub units: Vec<u64>,
}

impl PassWeights {
    /// Weight of a tally; saturates.
    pub fn of(&self, tally: &Tally) -> u64 {
        let weights = self.passes.iter().zip(&self.units);
        let of_pass = |(passes, (once, each)): (&crate::code::tally::Passes, (&u64, &u64))| {
            passes.count.saturating_mul(*once).saturating_add(passes.units.saturating_mul(*each))
        };
        tally.all().iter().zip(weights).map(of_pass).fold(0, u64::saturating_add)
    }
}

/// A work item and its weight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WeighedItem {
    /// First vector of its message: what it is about.
    pub subject: Vector,
    /// Sum of the weights of its passes.
    pub weight: u64,
}

/// Weighs the work items of a frame by weights for the passes of the cores' program, in the order in which they are handed out.
///
/// # Errors
/// A machine out of its ranges, or a program whose initial buffer does not fit. The inner error says why items cannot be weighed: the frame
/// traps, or what they do depends on time.
pub fn weigh(
    setup: &Setup,
    memory: &Memory,
    weights: &PassWeights,
) -> Result<Result<Vec<WeighedItem>, Reason>, RunFailure> {
    check(setup)?;
    Ok(on_arithmetic(setup, WeighTask { setup, memory, weights }))
}

struct WeighTask<'a> {
    setup: &'a Setup<'a>,
    memory: &'a Memory,
    weights: &'a PassWeights,
}

impl Task for WeighTask<'_> {
    type Result = Result<Vec<WeighedItem>, Reason>;

    fn run<T: Watch + Clone + Send, O: Observer + Send>(self, arithmetic: &T) -> Self::Result {
        let WeighTask { setup, memory, weights } = self;
        super::prefix(setup, memory, arithmetic)?;
        // Find out what work there is
        let (mut messages, mut unfit) = (Vec::new(), None);
        let totals = prerun::run::<T, O>(setup, memory, arithmetic.clone(), RecordLevel::Passes, &mut |batch| {
            match batch.as_ref() {
                Err(reason) => unfit = Some(*reason),
                Ok(batch) if batch.iter().flat_map(|portion| &portion.items).any(|item| item.end != Pause::Halt) => {
                    unfit = Some("a work item traps")
                }
                Ok(batch) => {
                    messages.extend(batch.iter().flat_map(|portion| &portion.items).map(|item| item.message));
                }
            }
            unfit.is_none()
        });
        if totals.end != Pause::Halt {
            unfit.get_or_insert("the main processor does not come to its end");
        }
        if let Some(reason) = unfit {
            return Err(reason);
        }
        // Run each item once more by itself, so that the passes of each are known apart
        let code = Code::new(setup.core, setup.isa, setup.config.timing());
        let each = messages.len().div_ceil(rayon::current_num_threads()).max(1);
        let part = |messages: &[Message], arithmetic: T| -> Result<Vec<WeighedItem>, Reason> {
            let mut recorder = Recorder::<T, Unobserved>::new(0, &code, setup, memory, arithmetic, RecordLevel::Passes);
            let one = |&message: &Message| {
                recorder.record(message, &Budget::new(MOST_SEGMENTS), &mut Portion::default())?;
                Ok(WeighedItem { subject: message.first(), weight: weights.of(&recorder.take_tally()) })
            };
            messages.iter().map(one).collect()
        };
        // Parts come back in their order, so the result does not depend on the number of threads.
        std::thread::scope(|scope| {
            let part = &part;
            let threads: Vec<_> = messages
                .chunks(each)
                .map(|messages| {
                    let arithmetic = arithmetic.clone();
                    scope.spawn(move || part(messages, arithmetic))
                })
                .collect();
            let mut items = Vec::with_capacity(messages.len());
            for thread in threads {
                items.extend(thread.join().expect("recording does not panic")?);
            }
            Ok(items)
        })
    }
}
