//! Stepped frames of the same programs on many machines, which share what is made of the programs. In which order processors are stepped is not
//! said here.

use std::sync::Arc;

use super::schedule::{self, Machine};
use super::worker::Executor;
use super::{Config, RunFailure, RunOutcome, Setup, check, on_arithmetic};
use crate::code::Code;
use crate::code::octets::{Buffer, Memory};
use crate::engine::{CoreId, Task};
use crate::profile::Observer;
use crate::semantics::Watch;

/// Stepped frames of the same programs on machines that compute alike: the programs are decoded, and compiled, once for all machines.
pub struct SteppedFrames<'a> {
    setup: Setup<'a>,
    codes: [Code<'a>; 2],
}

impl<'a> SteppedFrames<'a> {
    /// Frames of the programs of a setup, on machines that compute as its own.
    pub fn new(setup: &Setup<'a>) -> SteppedFrames<'a> {
        SteppedFrames { setup: setup.clone(), codes: setup.codes() }
    }

    /// A frame on one machine; for one that computes otherwise the programs are decoded again.
    ///
    /// # Errors
    /// A machine out of its ranges, a program whose initial buffer does not fit, or a trap.
    pub fn step(&self, config: &Config, memory: Memory) -> Result<RunOutcome, RunFailure> {
        let setup = Setup { config, ..self.setup.clone() };
        check(&setup)?;
        // Times of operations are part of what is decoded.
        let own = (!config.computes_like(self.setup.config)).then(|| setup.codes());
        let codes = own.as_ref().unwrap_or(&self.codes);
        on_arithmetic(&setup, StepTask { setup: &setup, codes, memory, progress: &mut |_| {} })
    }
}

/// Stepping of a frame, on the arithmetic and for the observer that its machine needs.
pub(crate) struct StepTask<'a> {
    pub setup: &'a Setup<'a>,
    pub codes: &'a [Code<'a>; 2],
    pub memory: Memory,
    pub progress: &'a mut dyn FnMut(u64),
}

impl Task for StepTask<'_> {
    type Result = Result<RunOutcome, RunFailure>;

    fn run<T: Watch + Clone + Send, O: Observer + Send>(self, arithmetic: &T) -> Self::Result {
        run_decoded::<T, O>(self.setup, self.codes, self.memory, arithmetic, self.progress)
    }
}

/// Runs a frame by stepping, with programs that were decoded for a machine that computes alike.
///
/// # Errors
/// A trap.
pub(crate) fn run_decoded<T: Watch, O: Observer>(
    setup: &Setup,
    [core_code, main_code]: &[Code; 2],
    memory: Memory,
    arithmetic: &T,
    progress: &mut dyn FnMut(u64),
) -> Result<RunOutcome, RunFailure> {
    let runner = schedule::runner_of::<T, O>(setup, core_code, arithmetic, setup.config.buffer_octets);
    let initial = Arc::new(Buffer::new(&setup.core.buffer, setup.config.buffer_octets));
    let core = |core: CoreId| {
        Executor::<T, O>::new(core_code, core, initial.clone(), runner.clone(), arithmetic, setup.level::<O>())
    };
    let main = schedule::main_worker(setup, main_code, arithmetic);
    Ok(Machine::new(setup, memory, [core_code, main_code], core, main, progress).run()?.frame)
}
