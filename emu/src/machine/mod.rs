//! The machine: cores, the main processor that feeds them, global memory and the bus between them, stepped in the order
//! of their clocks. A processor's work is done by a `Worker`, which executes a program or replays what one has done.

pub mod arbiter;
pub mod bus;
pub mod cache;
pub mod config;
pub mod course;
mod fault_kind;
pub(crate) mod finish;
mod grant_fault;
pub(crate) mod kinds;
pub mod mailbox;
mod muted;
pub mod one_core;
pub mod outcome;
pub(crate) mod port;
pub mod preset;
mod processor;
pub(crate) mod request;
pub(crate) mod schedule;
pub(crate) mod stepped;
mod sync;
pub mod trace;
pub mod waits;
pub(crate) mod worker;

use std::fmt;
use std::ops::Range;

use isa::{Isa, Program};
use messages::{Diagnostic, Report, did_you_mean};

pub use config::Config;
pub use fault_kind::{FaultKind, Protection};
pub use grant_fault::{GrantFault, GrantFaultKind};
pub use outcome::{Item, KindUse, Method, ProcessorUse, RunOutcome};
pub use stepped::SteppedFrames;

use trace::Window;

use crate::code::trap::Trap;
use crate::code::{Code, check_bodies};
use crate::engine::{Answers, Choice, CoreId, Demand, EngineKind, HostSimd, Task, Wish, choose, dispatch};
use crate::profile::{Observer, ProfileLevel};
use crate::semantics::{Computes, Watch};

/// Setup of a run: a machine and its programs.
#[derive(Clone)]
pub struct Setup<'a> {
    /// The machine.
    pub config: &'a Config,
    /// The rows of both programs.
    pub isa: &'a Isa,
    /// Program of the cores.
    pub core: &'a Program,
    /// Program of the main processor.
    pub main: &'a Program,
    /// Names for ranges of global memory, for the totals by kind; ranges must not overlap, names may repeat.
    pub kinds: Vec<(Range<u32>, String)>,
    /// Records that are wanted.
    pub options: RunOptions,
}

impl<'a> Setup<'a> {
    /// The programs of the cores and of the main processor, decoded for machines that compute alike, which then share what is made of them.
    pub(crate) fn codes(&self) -> [Code<'a>; 2] {
        [self.core, self.main].map(|program| Code::new(program, self.isa, self.config.timing()))
    }

    /// Number and step limit of the main processor.
    pub(crate) fn main_id(&self) -> CoreId {
        let cores = self.config.cores;
        CoreId { core: cores, cores, step_limit: self.config.main.step_limit }
    }

    /// Level of a profile that an observer takes.
    pub(crate) fn level<O: Observer>(&self) -> ProfileLevel {
        if O::IS_ACTIVE { self.options.profile } else { ProfileLevel::None }
    }

    /// The engine that runs the cores' program, and why not a faster one that was wanted.
    pub fn engine(&self) -> Choice {
        let code = Code::new(self.core, self.isa, self.config.timing());
        choose(&self.demand(&code)).choice()
    }

    /// Makes the engine ready that records the cores' program, which takes native code the time to generate it, and yields that engine.
    pub fn prepare_engine(&self) -> Choice {
        let code = Code::new(self.core, self.isa, self.config.timing());
        let answers = Answers::AtOnce { keeps_time: true };
        let mut runner = choose(&Demand { answers, ..self.demand(&code) });
        runner.prepare();
        runner.choice()
    }

    fn demand<'c>(&self, code: &'c Code<'c>) -> Demand<'c> {
        let watching = self.config.arithmetic.watching(self.options.has_losses);
        let computes = watching.map_or(Computes::default(), |watching| watching.computes());
        let demand = Demand::new(code, self.options.wish(), computes, self.config.buffer_octets);
        Demand { follows_cores: true, profile: self.options.profile, ..demand }
    }
}

/// Records of a run beyond counts and times, and the engine that it wants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RunOptions {
    /// Detail in which functions and regions are measured.
    pub profile: ProfileLevel,
    /// Each work item.
    pub has_items: bool,
    /// Losses in the results of each instruction: [`crate::code::tally::Losses`]. Costs time.
    pub has_losses: bool,
    /// Trace of every processor and of the bus in this window of clocks.
    pub window: Option<Window>,
    /// Clocks of the bus over time. Costs time.
    pub has_course: bool,
    /// Engine that is wanted for the work items; see [`Setup::engine`].
    pub engine: EngineKind,
    /// Vector instructions of the host that an engine may use at most; `None` for all that there are.
    pub simd: Option<HostSimd>,
    /// Programs that run briefly are compiled as well, where that is what the engine does.
    pub is_eager: bool,
    /// Fault of the bus's grants, on purpose.
    pub grant_fault: Option<GrantFault>,
}

impl RunOptions {
    /// The engine that is wanted.
    pub(crate) fn wish(&self) -> Wish {
        Wish { kind: self.engine, simd: self.simd.unwrap_or_else(HostSimd::best), is_eager: self.is_eager }
    }
}

/// Reason for which a run has no result.
#[derive(Clone, Debug)]
pub enum RunFailure {
    /// The machine or the programs cannot be used.
    Setup(Report),
    /// A program went wrong.
    Trap(Box<Trap>),
}

impl RunFailure {
    /// The messages for a person.
    pub fn report(&self) -> Report {
        match self {
            RunFailure::Setup(report) => report.clone(),
            RunFailure::Trap(trap) => trap.diagnostic().into(),
        }
    }
}

impl fmt::Display for RunFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RunFailure::Setup(report) => report.fmt(f),
            RunFailure::Trap(trap) => trap.fmt(f),
        }
    }
}

impl std::error::Error for RunFailure {}

impl From<Trap> for RunFailure {
    fn from(trap: Trap) -> RunFailure {
        RunFailure::Trap(Box::new(trap))
    }
}

impl From<Report> for RunFailure {
    fn from(report: Report) -> RunFailure {
        RunFailure::Setup(report)
    }
}

/// Check that a machine and its programs can be used.
///
/// # Errors
/// A machine out of its ranges, initial data that do not fit a buffer, or a cache of data that nothing is called.
pub(crate) fn check(setup: &Setup) -> Result<(), RunFailure> {
    setup.config.check()?;
    check_buffer("a core", setup.core, setup.config.buffer_octets)?;
    check_buffer("the main processor", setup.main, setup.config.main.buffer_octets)?;
    for program in [setup.core, setup.main] {
        check_bodies(program, setup.isa).map_err(|error| Report::from(Diagnostic::from(error)))?;
    }
    let cache = &setup.config.cache;
    let mut names = setup.kinds.iter().map(|(_, kind)| kind.as_str());
    if cache.octets != 0 && !setup.kinds.is_empty() && !names.clone().any(|kind| kind == cache.kind) {
        let message = Diagnostic::error(format!("`cache.kind` is `{}`, but no data are called so", cache.kind));
        let hint = did_you_mean(&cache.kind, names.clone())
            .unwrap_or_else(|| format!("there are {}", names.by_ref().collect::<Vec<_>>().join(", ")));
        return Err(Report::from(message.hint(hint)).into());
    }
    Ok(())
}

/// Does work on the arithmetic and for the observer that a machine needs.
pub(crate) fn on_arithmetic<W: Task>(setup: &Setup, task: W) -> W::Result {
    dispatch(setup.config.arithmetic.watching(setup.options.has_losses), setup.options.profile, task)
}

/// Check that the data that a program wants in its buffer fit.
pub(crate) fn check_buffer(whose: &str, program: &Program, octets: u32) -> Result<(), Report> {
    if program.buffer.len() <= octets as usize {
        return Ok(());
    }
    let wanted = program.buffer.len();
    let message = format!("the program's data take {wanted} octets, but the buffer of {whose} has {octets}");
    Err(Diagnostic::error(message)
        .hint("leave out what the scene does not need, or give the machine a larger buffer")
        .into())
}
