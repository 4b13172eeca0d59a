//! Engines: whatever executes programs. All give the same bits, counts, clocks and traps; [`interpreter`] is what the others are compared
//! with, and what goes on wherever one of them stops. [`choose`](choose()) alone says which one runs a program.

mod choose;
mod cost;
mod dispatch;
mod host;
pub mod interpreter;
#[cfg(feature = "native")]
pub mod native;
#[cfg(not(feature = "native"))]
#[path = "without_native.rs"]
pub mod native;
mod plan;
mod quick;
mod state;
mod taint;

pub use choose::{Answers, Choice, Demand, EngineKind, EngineRunner, Wish, choose};
pub use dispatch::{Task, dispatch};
pub use host::HostSimd;
pub use plan::Plan;
pub use quick::{NotedRead, Quick};
pub use state::{CoreId, Pause, State};
pub(crate) use taint::{Taint, TaintObserver};

use crate::code::octets::Buffer;
use crate::code::tally::Tally;
use crate::code::trap::{Fault, Stop};
use crate::profile::Profiler;
use crate::semantics::{Link, Message, Watch, methods};

/// Reason for which an engine does not run a program, as the end of a sentence.
pub type Refusal = &'static str;

/// Takes octets that were read of a kind of data.
pub type AddOctets<'a> = &'a mut dyn FnMut(u32, u64);

/// An engine that is faster than the interpreter, for one program.
pub trait Engine<'a>: Sized {
    /// Makes ready for a program.
    ///
    /// # Errors
    /// Something about the program that this engine does not do; then the next one of [`EngineKind::ALL`] is asked.
    fn new(demand: &Demand<'a>) -> Result<Self, Refusal>;

    /// Runs up to the next thing that concerns others: from the state given, until the program halts, waits for the machine or goes wrong, or
    /// until something is for the interpreter.
    ///
    /// Afterwards `state` is that before the instruction at its program counter, with all registers, the buffer, steps, clocks and elementary
    /// operations up to there, as if the interpreter had come to it; only `halt` has been executed. `taint` is what the item knows of the
    /// cores, brought up to date where the demand says that it is followed. The calls that are open are those of the profiler, which there is
    /// where the demand asks for a profile; the link is told before each request of when that is made.
    fn run<T: Watch>(
        &mut self,
        core: CoreId,
        state: &mut State,
        arithmetic: &T,
        link: &mut dyn TimedLink,
        taint: &mut Taint,
        profiler: Option<&mut Profiler>,
    ) -> Stopped;

    /// Does now what would be done when the program runs for a while.
    fn prepare(&mut self) {}

    /// Steps that the interpreter is to take before the engine is asked again, where it has left something to the interpreter.
    fn patience(&self, _id: CoreId, _state: &State) -> u64 {
        u64::MAX
    }

    /// Notes that the interpreter has executed so many steps of the program.
    fn interpreted(&mut self, _steps: u64) {}

    /// Engine that runs the program instead, and why, where that was found only when the program ran.
    fn replacement(&self) -> Option<Choice> {
        None
    }

    /// Adds the passes of all runs since the last call to a tally of the program and to its profiler, and octets of reads that no link was told
    /// of.
    fn fold(&mut self, tally: &mut Tally, add_octets: AddOctets, profiler: Option<&mut Profiler>);
}

/// The machine as a work item sees it.
pub trait TimedLink: Link {
    /// True for a link that is told when it is asked.
    fn keeps_time(&self) -> bool;

    /// Notice of when and where the link is asked next; the time only where it is kept.
    fn note(&mut self, time: RequestTime);

    /// The link as one whose memory may be read directly, where it is one.
    fn quick(&mut self) -> Option<&mut dyn Quick> {
        None
    }
}

/// A link to which the time does not matter.
pub struct Timeless<'a>(pub &'a mut dyn Link);

/// Reason for which an engine stopped. The state is that before the instruction at the program counter, but for `halt`, which has been executed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stopped {
    /// The program executed `halt`.
    Halt,
    /// The instruction at the program counter waits for the machine.
    Wait,
    /// The instruction at the program counter asked the machine for something and went wrong.
    Fault(Fault),
    /// The instruction at the program counter is for the interpreter.
    Bailout,
}

/// Time and place at which a work item asks the machine for something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RequestTime {
    /// Word of the instruction.
    pub pc: u32,
    /// Calling context, where functions are measured; else 0.
    pub context: u32,
    /// Clocks that the item has computed so far.
    pub clocks: u64,
}

impl Link for Timeless<'_> {
    methods! { hand_on! self => self.0; }
}

impl TimedLink for Timeless<'_> {
    fn keeps_time(&self) -> bool {
        false
    }

    fn note(&mut self, _: RequestTime) {}
}

impl TimedLink for &mut dyn TimedLink {
    fn keeps_time(&self) -> bool {
        (**self).keeps_time()
    }

    fn note(&mut self, time: RequestTime) {
        (**self).note(time);
    }

    fn quick(&mut self) -> Option<&mut dyn Quick> {
        (**self).quick()
    }
}
