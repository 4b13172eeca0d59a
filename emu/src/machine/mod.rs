//! The machine: cores, the main processor that feeds them, global memory and the bus between them, stepped in the order
//! of their clocks.

pub mod arbiter;
pub mod bus;
pub mod cache;
pub mod config;
mod count;
mod ending;
pub mod frame;
mod kinds;
mod library;
pub mod mailbox;
mod meeting;
pub mod preset;
mod processor;
mod recorded;
mod recorder;
mod recording;
mod reel;
mod replay;
mod room;
mod schedule;
mod scout;
pub mod single;
mod station;
mod strands;
mod tape;
pub mod trace;
pub mod waits;

use std::fmt;
use std::ops::Range;

use isa::{Isa, Program};
use messages::{Diagnostic, Report, did_you_mean};

pub use config::Config;
pub use count::{Count, count};
pub use frame::{Frame, Item, KindUse, Method, ProcessorUse};
pub use recorded::Recorded;

use trace::Window;

use crate::code::{Code, check_bodies};
use crate::engine::{Choice, Demand, EngineKind, HostSimd, Task, Wish, choose, dispatch};
use crate::exec::Watch;
use crate::octets::Memory;
use crate::profile::RunObserver;
use crate::trap::Trap;
use ending::Ending;

/// What a machine runs.
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
    /// What is recorded.
    pub options: Options,
}

impl Setup<'_> {
    /// The engine that runs the cores' program, and why not a faster one that was wanted.
    pub fn engine(&self) -> Choice {
        let code = Code::new(self.core, self.isa, self.config.timing());
        let is_default_arithmetic = self.config.arithmetic.watching(self.options.has_losses).is_none();
        let Wish { kind, simd } = self.options.wish();
        choose(kind, &Demand { code: &code, simd, is_default_arithmetic, follows_cores: true }).choice()
    }
}

/// What a run records beyond counts and times.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Functions and regions: inclusive counts, calls, least and most a call. Costs time.
    pub has_profile: bool,
    /// Each work item.
    pub has_items: bool,
    /// What the results of each instruction lose: [`crate::tally::Losses`]. Costs time.
    pub has_losses: bool,
    /// What every processor and the bus do in this window of clocks.
    pub window: Option<Window>,
    /// What runs the work items; see [`Setup::engine`].
    pub engine: EngineKind,
    /// Vector instructions of the host that an engine may use at most; `None` for all that there are.
    pub simd: Option<HostSimd>,
}

impl Options {
    /// The engine that is wanted.
    pub(crate) fn wish(&self) -> Wish {
        Wish { kind: self.engine, simd: self.simd.unwrap_or_else(HostSimd::best) }
    }
}

/// Why a run has no result.
#[derive(Clone, Debug)]
pub enum Failure {
    /// The machine or the programs cannot be used.
    Setup(Report),
    /// A program went wrong.
    Trap(Box<Trap>),
}

impl Failure {
    /// Exit code of a command that ends with it: 1 for the setup, 3 for a trap, 5 for a step limit.
    pub fn exit_code(&self) -> u8 {
        match self {
            Failure::Setup(_) => 1,
            Failure::Trap(trap) => trap.exit_code(),
        }
    }

    /// The messages for a person.
    pub fn report(&self) -> Report {
        match self {
            Failure::Setup(report) => report.clone(),
            Failure::Trap(trap) => trap.diagnostic().into(),
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Failure::Setup(report) => report.fmt(f),
            Failure::Trap(trap) => trap.fmt(f),
        }
    }
}

impl std::error::Error for Failure {}

impl From<Trap> for Failure {
    fn from(trap: Trap) -> Failure {
        Failure::Trap(Box::new(trap))
    }
}

impl From<Report> for Failure {
    fn from(report: Report) -> Failure {
        Failure::Setup(report)
    }
}

/// Runs a frame on a memory image: until the main processor has halted and no core has anything more to do. `progress`
/// is called with the number of work items finished, each time one is.
///
/// Work items that only take a message, read global memory and send messages to the main processor run once, on all host
/// threads, and are then replayed in the order of the machine's clocks; anything else is stepped in that order. The
/// result is the same, but for [`Frame::method`].
///
/// # Errors
/// A machine out of its ranges, a program whose initial buffer does not fit, or a trap.
pub fn run(setup: &Setup, memory: Memory, progress: &mut dyn FnMut(u64)) -> Result<Frame, Failure> {
    check(setup)?;
    let results = run_alike(std::slice::from_ref(setup), &memory, progress);
    results.into_iter().next().expect("a machine has a result")
}

/// Runs a frame by stepping, also where it could be replayed.
///
/// # Errors
/// As [`run`].
pub fn step(setup: &Setup, memory: Memory, progress: &mut dyn FnMut(u64)) -> Result<Frame, Failure> {
    check(setup)?;
    let frame = on_arithmetic(setup, Stepping { setup, memory, progress });
    frame.map_err(Ending::into_failure)
}

/// Runs the same frame on several machines. Those that compute alike (in the same clocks, with the same arithmetic and
/// buffer) and differ only in cores, bus, caches and main processor share one run of the work items. `progress` is told of the first
/// of those that share one.
pub fn run_all(
    setup: &Setup,
    machines: &[Config],
    memory: &Memory,
    progress: &mut dyn FnMut(u64),
) -> Vec<Result<Frame, Failure>> {
    let setups: Vec<Setup> = machines.iter().map(|config| Setup { config, ..setup.clone() }).collect();
    let mut results: Vec<Option<Result<Frame, Failure>>> = setups.iter().map(|_| None).collect();
    for first in 0..setups.len() {
        if results[first].is_some() {
            continue;
        }
        if let Err(failure) = check(&setups[first]) {
            results[first] = Some(Err(failure));
            continue;
        }
        let is_alike = |at: &usize| {
            results[*at].is_none() && machines[*at].computes_like(&machines[first]) && check(&setups[*at]).is_ok()
        };
        let alike: Vec<usize> = (first..setups.len()).filter(is_alike).take(at_once(memory)).collect();
        let group: Vec<Setup> = alike.iter().map(|&at| setups[at].clone()).collect();
        for (&at, result) in alike.iter().zip(run_alike(&group, memory, progress)) {
            results[at] = Some(result);
        }
    }
    results.into_iter().flatten().collect()
}

/// Machines that share a run of the work items, at most: each has a thread, and of global memory what it writes, which may be all of it.
fn at_once(memory: &Memory) -> usize {
    const OCTETS: usize = 256 << 20;
    (OCTETS / memory.size().max(1)).clamp(1, 64)
}

fn check(setup: &Setup) -> Result<(), Failure> {
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
fn on_arithmetic<W: Task>(setup: &Setup, task: W) -> W::Result {
    dispatch(setup.config.arithmetic.watching(setup.options.has_losses), setup.options.has_profile, task)
}

/// Runs machines that compute alike.
fn run_alike(setups: &[Setup], memory: &Memory, progress: &mut dyn FnMut(u64)) -> Vec<Result<Frame, Failure>> {
    let Some(first) = setups.first() else { return Vec::new() };
    on_arithmetic(first, Replaying { setups, memory, progress })
}

struct Stepping<'a> {
    setup: &'a Setup<'a>,
    memory: Memory,
    progress: &'a mut dyn FnMut(u64),
}

impl Task for Stepping<'_> {
    type Result = Result<Frame, Ending>;

    fn run<T: Watch + Clone + Send, O: RunObserver + Send>(self, arithmetic: &T) -> Self::Result {
        schedule::run::<T, O>(self.setup, self.memory, arithmetic, None, self.progress)
    }
}

struct Replaying<'a> {
    setups: &'a [Setup<'a>],
    memory: &'a Memory,
    progress: &'a mut dyn FnMut(u64),
}

impl Task for Replaying<'_> {
    type Result = Vec<Result<Frame, Failure>>;

    fn run<T: Watch + Clone + Send, O: RunObserver + Send>(self, arithmetic: &T) -> Self::Result {
        replay::run::<T, O>(self.setups, self.memory, arithmetic, self.progress)
    }
}

/// Whether what a program wants in its buffer fits.
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
