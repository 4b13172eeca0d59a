//! The machine: cores, the main processor that feeds them, global memory and the bus between them, stepped in the order
//! of their clocks.

pub mod arbiter;
pub mod bus;
pub mod config;
pub mod frame;
mod kinds;
pub mod mailbox;
mod processor;
mod schedule;
pub mod single;
mod station;

use std::fmt;
use std::ops::Range;

use isa::diagnostic::{Diagnostic, Report};
use isa::number::Modes;
use isa::number::Nearest32;
use isa::{Isa, Program};

pub use config::Config;
pub use frame::{Frame, Item, KindUse, ProcessorUse};

use crate::exec::{Watch, Watching};
use crate::octets::Memory;
use crate::profile::{Profiler, Unobserved};
use crate::trap::Trap;

/// What a machine runs.
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

/// What a run records beyond counts and times.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Functions and regions: inclusive counts, calls, least and most a call. Costs time.
    pub has_profile: bool,
    /// Each work item.
    pub has_items: bool,
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

/// Runs a frame on a memory image: until the main processor has halted and no core has anything more to do. `progress` is called with the
/// number of work items finished, each time one is.
///
/// # Errors
/// A machine out of its ranges, a program whose initial buffer does not fit, or a trap.
pub fn run(setup: &Setup, memory: Memory, progress: &mut dyn FnMut(u64)) -> Result<Frame, Failure> {
    setup.config.check()?;
    check_buffer("a core", setup.core, setup.config.buffer_octets)?;
    check_buffer("the main processor", setup.main, setup.config.main.buffer_octets)?;
    let arithmetic = &setup.config.arithmetic;
    let traps = arithmetic.trap_division_by_zero;
    if arithmetic.modes() == Modes::default() && !traps {
        run_on(setup, memory, &Nearest32, progress)
    } else {
        run_on(setup, memory, &Watching::new(arithmetic.modes(), traps), progress)
    }
}

fn run_on<T: Watch>(
    setup: &Setup,
    memory: Memory,
    arithmetic: &T,
    progress: &mut dyn FnMut(u64),
) -> Result<Frame, Failure> {
    if setup.options.has_profile {
        schedule::run::<T, Profiler>(setup, memory, arithmetic, progress)
    } else {
        schedule::run::<T, Unobserved>(setup, memory, arithmetic, progress)
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
