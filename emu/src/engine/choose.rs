//! The one rule of who may run what: engines in order, best first, each of which says itself what it does not do.

use super::fast::Fast;
use super::host::HostSimd;
use super::state::{CoreId, Pause, State};
use super::taint::Taint;
use super::{Engine, Refusal, Stopped, TimedLink, Timeless, interpreter};
use crate::code::Code;
use crate::code::tally::Tally;
use crate::profile::RunObserver;
use crate::semantics::{Link, Watch};

/// A program to execute, and what has to be known of it.
#[derive(Clone, Copy, Debug)]
pub struct Demand<'a> {
    /// The program.
    pub code: &'a Code<'a>,
    /// Vector instructions of the host that may be used at most.
    pub simd: HostSimd,
    /// Whether the arithmetic is the default one, and nobody watches what results lose.
    pub is_default_arithmetic: bool,
    /// Whether it is to be found out what depends on the number of cores.
    pub follows_cores: bool,
}

/// An engine that is wanted, and the vector instructions of the host that it may use at most.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wish {
    /// The engine.
    pub kind: EngineKind,
    /// The vector instructions.
    pub simd: HostSimd,
}

impl Wish {
    /// The interpreter.
    pub const CHECKED: Wish = Wish { kind: EngineKind::Checked, simd: HostSimd::Baseline };

    /// The fast engine with these vector instructions at most.
    pub const fn fast(simd: HostSimd) -> Wish {
        Wish { kind: EngineKind::Fast, simd }
    }
}

impl Default for Wish {
    fn default() -> Wish {
        Wish { kind: EngineKind::default(), simd: HostSimd::best() }
    }
}

/// The engine that runs a program, and why not a faster one that was wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choice {
    /// The engine.
    pub kind: EngineKind,
    /// Why the one that was wanted does not run the program; `None` where it does.
    pub refusal: Option<Refusal>,
}

const ARITHMETIC: Refusal =
    "only the interpreter computes in other modes than the default ones, traps divisions by zero and counts losses";

/// The engines beside the interpreter, best first: a line each.
macro_rules! engines {
    ($($(#[$doc:meta])* $kind:ident($engine:ident) $name:literal;)*) => {
        /// Names of the engines, best first. The results are the same.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum EngineKind {
            $($(#[$doc])* $kind,)*
            /// The interpreter, one instruction after the other: [`super::interpreter`].
            Checked,
        }

        impl EngineKind {
            /// All, best first.
            pub const ALL: [EngineKind; [$($name,)* "checked"].len()] = [$(EngineKind::$kind,)* EngineKind::Checked];

            /// Name in options and results.
            pub const fn name(self) -> &'static str {
                match self {
                    $(EngineKind::$kind => $name,)*
                    EngineKind::Checked => "checked",
                }
            }
        }

        /// One of them, ready to run a program.
        #[derive(Clone, Debug)]
        enum Ready<'a> {
            $($kind(Box<$engine<'a>>),)*
        }

        impl<'a> Ready<'a> {
            /// Makes the engine of a kind ready; none where that is the interpreter.
            fn new(kind: EngineKind, demand: &Demand<'a>) -> Result<Option<Ready<'a>>, Refusal> {
                match kind {
                    $(EngineKind::$kind => Ok(Some(Ready::$kind(Box::new($engine::new(demand)?)))),)*
                    EngineKind::Checked => Ok(None),
                }
            }

            #[inline(always)]
            fn run<L: TimedLink, O: RunObserver>(
                &mut self,
                seat: CoreId,
                state: &mut State,
                link: &mut L,
                taint: &mut Taint,
                observer: &mut O,
            ) -> Stopped {
                match self {
                    $(Ready::$kind(engine) => engine.run(seat, state, link, taint, observer),)*
                }
            }

            fn fold(&mut self, tally: &mut Tally) {
                match self {
                    $(Ready::$kind(engine) => engine.fold(tally),)*
                }
            }
        }
    };
}

engines! {
    /// One work item after the other, a run of instructions at a time: [`super::fast`].
    Fast(Fast) "fast";
}

impl Default for EngineKind {
    fn default() -> EngineKind {
        EngineKind::ALL[0]
    }
}

/// Chooses who runs a program: the engine that is wanted, or the next one that does what is demanded. The interpreter does everything.
pub fn choose<'a>(wanted: EngineKind, demand: &Demand<'a>) -> Runner<'a> {
    let mut refusal = None;
    for kind in EngineKind::ALL.into_iter().skip_while(|kind| *kind != wanted) {
        let ready = match kind {
            EngineKind::Checked => Ok(None),
            _ if !demand.is_default_arithmetic => Err(ARITHMETIC),
            _ => Ready::new(kind, demand),
        };
        match ready {
            Ok(ready) => return Runner { code: demand.code, ready, choice: Choice { kind, refusal } },
            Err(reason) => refusal = refusal.or(Some(reason)),
        }
    }
    Runner { code: demand.code, ready: None, choice: Choice { kind: EngineKind::Checked, refusal } }
}

/// Engine of one program: quickly as far as it is nothing unusual, then on the interpreter.
#[derive(Clone, Debug)]
pub struct Runner<'a> {
    code: &'a Code<'a>,
    ready: Option<Ready<'a>>,
    choice: Choice,
}

impl Runner<'_> {
    /// The engine that was chosen.
    pub fn choice(&self) -> Choice {
        self.choice
    }

    /// As [`interpreter::run`], but passes of words that were executed quickly come into the tally by [`Runner::fold`].
    pub fn run<T: Watch, O: RunObserver>(
        &mut self,
        seat: CoreId,
        state: &mut State,
        arithmetic: &T,
        link: &mut dyn Link,
        tally: &mut Tally,
        observer: &mut O,
    ) -> Pause {
        let timed: &mut &mut dyn TimedLink = &mut (&mut Timeless(&mut *link) as _);
        match self.run_ahead(seat, state, timed, &mut Taint::default(), observer) {
            Some(Stopped::Halt) => Pause::Halt,
            Some(Stopped::Wait) => Pause::Wait,
            Some(Stopped::Fault(fault)) => Pause::Fault(fault),
            Some(Stopped::Bailout) | None => {
                interpreter::run(self.code, seat, state, arithmetic, link, tally, observer)
            }
        }
    }

    /// As far as an engine comes that is faster than the interpreter, as [`Engine::run`]; `None` where there is none.
    #[inline]
    pub(crate) fn run_ahead<L: TimedLink, O: RunObserver>(
        &mut self,
        seat: CoreId,
        state: &mut State,
        link: &mut L,
        taint: &mut Taint,
        observer: &mut O,
    ) -> Option<Stopped> {
        Some(self.ready.as_mut()?.run(seat, state, link, taint, observer))
    }

    /// Adds the passes of words that were executed quickly to a tally of the program, and forgets them.
    pub fn fold(&mut self, tally: &mut Tally) {
        if let Some(ready) = &mut self.ready {
            ready.fold(tally);
        }
    }
}
