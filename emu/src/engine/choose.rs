//! The one rule of who may run what: engines in order, best first, each of which says itself what it does not do.

use super::host::HostSimd;
use super::native::Native;
use super::state::{CoreId, Pause, State};
use super::taint::Taint;
use super::{AddOctets, Engine, Refusal, Stopped, TimedLink, Timeless, interpreter};
use crate::code::Code;
use crate::code::tally::Tally;
use crate::code::trap::Fault;
use crate::profile::{Observer, ProfileLevel, Profiler};
use crate::semantics::{Computes, Link, Watch};

/// A program to execute, and what has to be known of it.
#[derive(Clone, Copy, Debug)]
pub struct Demand<'a> {
    /// The program.
    pub code: &'a Code<'a>,
    /// The engine that is wanted.
    pub wish: Wish,
    /// The arithmetic: word, modes, and what it watches for.
    pub computes: Computes,
    /// Octets of the local buffer.
    pub buffer_octets: u32,
    /// Dependence on the number of cores is to be found out.
    pub follows_cores: bool,
    /// Detail in which functions and regions are measured.
    pub profile: ProfileLevel,
    /// Time at which the machine answers.
    pub answers: Answers,
}

impl<'a> Demand<'a> {
    /// A program on a core that may have to wait for each answer, of which nobody wants to know more than counts.
    pub fn new(code: &'a Code<'a>, wish: Wish, computes: Computes, buffer_octets: u32) -> Demand<'a> {
        let answers = Answers::WhenReady;
        let profile = ProfileLevel::None;
        Demand { code, wish, computes, buffer_octets, follows_cores: false, profile, answers }
    }
}

/// Time at which the machine answers a program that asks it for something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answers {
    /// The machine answers when it is ready, so that the program waits and asks again.
    WhenReady,
    /// At once, on a link that is [`super::Quick`].
    AtOnce {
        /// The link wants to know when it is asked.
        keeps_time: bool,
    },
}

/// An engine that is wanted, and the vector instructions of the host that it may use at most.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wish {
    /// The engine.
    pub kind: EngineKind,
    /// The vector instructions.
    pub simd: HostSimd,
    /// Programs that run briefly are compiled as well.
    pub is_eager: bool,
}

impl Wish {
    /// The interpreter.
    pub const CHECKED: Wish = Wish { kind: EngineKind::Checked, simd: HostSimd::Baseline, is_eager: false };

    /// Native code, also for what runs briefly.
    pub fn native() -> Wish {
        Wish { kind: EngineKind::Native, is_eager: true, ..Wish::default() }
    }
}

impl Default for Wish {
    fn default() -> Wish {
        Wish { kind: EngineKind::default(), simd: HostSimd::best(), is_eager: false }
    }
}

/// The engine that runs a program, and why not a faster one that was wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choice {
    /// The engine.
    pub kind: EngineKind,
    /// Reason for which the one that was wanted does not run the program; `None` where it does.
    pub refusal: Option<Refusal>,
}

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

            /// The engine of a name; the best one for `fast`, the name of one that there is no more.
            pub fn named(name: &str) -> Option<EngineKind> {
                let kind = EngineKind::ALL.into_iter().find(|kind| kind.name() == name);
                kind.or_else(|| (name == "fast").then(EngineKind::default))
            }

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

            fn run<T: Watch>(
                &mut self,
                core: CoreId,
                state: &mut State,
                arithmetic: &T,
                link: &mut dyn TimedLink,
                taint: &mut Taint,
                profiler: Option<&mut Profiler>,
            ) -> Stopped {
                match self {
                    $(Ready::$kind(engine) => engine.run(core, state, arithmetic, link, taint, profiler),)*
                }
            }

            fn prepare(&mut self) {
                match self {
                    $(Ready::$kind(engine) => engine.prepare(),)*
                }
            }

            fn patience(&self, core: CoreId, state: &State) -> u64 {
                match self {
                    $(Ready::$kind(engine) => engine.patience(core, state),)*
                }
            }

            fn interpreted(&mut self, steps: u64) {
                match self {
                    $(Ready::$kind(engine) => engine.interpreted(steps),)*
                }
            }

            fn replacement(&self) -> Option<Choice> {
                match self {
                    $(Ready::$kind(engine) => engine.replacement(),)*
                }
            }

            fn fold(&mut self, tally: &mut Tally, add_octets: AddOctets, profiler: Option<&mut Profiler>) {
                match self {
                    $(Ready::$kind(engine) => engine.fold(tally, add_octets, profiler),)*
                }
            }
        }
    };
}

engines! {
    /// Code generated for the host: [`super::native`].
    Native(Native) "native";
}

impl Default for EngineKind {
    fn default() -> EngineKind {
        EngineKind::ALL[0]
    }
}

/// Chooses who runs a program: the engine that is wanted, or the next one that does what is demanded. The interpreter does everything.
pub fn choose<'a>(demand: &Demand<'a>) -> EngineRunner<'a> {
    let mut refusal = None;
    for kind in EngineKind::ALL.into_iter().skip_while(|kind| *kind != demand.wish.kind) {
        match Ready::new(kind, demand) {
            Ok(ready) => return EngineRunner { code: demand.code, ready, choice: Choice { kind, refusal } },
            // The first reason is that of the engine which was wanted, and the one that users are told.
            Err(reason) => refusal = refusal.or(Some(reason)),
        }
    }
    EngineRunner { code: demand.code, ready: None, choice: Choice { kind: EngineKind::Checked, refusal } }
}

/// Engine of one program: quickly as far as it is nothing unusual, then on the interpreter.
#[derive(Clone, Debug)]
pub struct EngineRunner<'a> {
    code: &'a Code<'a>,
    ready: Option<Ready<'a>>,
    choice: Choice,
}

impl EngineRunner<'_> {
    /// The engine that was chosen; after a run in which that one had to give up, the one that runs the program instead.
    pub fn choice(&self) -> Choice {
        self.ready.as_ref().and_then(Ready::replacement).unwrap_or(self.choice)
    }

    /// As [`interpreter::run`], but passes of words that were executed quickly come into the tally by [`EngineRunner::fold`].
    pub fn run<T: Watch, O: Observer>(
        &mut self,
        core: CoreId,
        state: &mut State,
        arithmetic: &T,
        link: &mut dyn Link,
        tally: &mut Tally,
        observer: &mut O,
    ) -> Pause {
        self.run_timed(core, state, arithmetic, &mut Timeless(link), tally, observer)
    }

    /// As [`EngineRunner::run`], on a link that an engine tells when it is asked; the interpreter asks without that.
    pub(crate) fn run_timed<T: Watch, O: Observer>(
        &mut self,
        core: CoreId,
        state: &mut State,
        arithmetic: &T,
        link: &mut impl TimedLink,
        tally: &mut Tally,
        observer: &mut O,
    ) -> Pause {
        loop {
            match self.run_ahead(core, state, arithmetic, link, &mut Taint::default(), observer.profiler()) {
                Some(Stopped::Halt) => return Pause::Halt,
                Some(Stopped::Wait) => return Pause::Wait,
                Some(Stopped::Fault(fault)) => return Pause::Fault(fault),
                Some(Stopped::Bailout) | None => {}
            }
            // The interpreter goes on as long as the engine likes.
            let before = state.steps + state.inner_steps;
            // Patience is a step limit of its own. The engine is asked again only if that one was met, not the machine's.
            let limit = before.saturating_add(self.patience(core, state));
            let patient = CoreId { step_limit: core.step_limit.min(limit), ..core };
            let pause = interpreter::run(self.code, patient, state, arithmetic, link, tally, observer);
            self.interpreted(state.steps + state.inner_steps - before);
            if limit >= core.step_limit || pause != Pause::Fault(Fault::StepLimit(limit)) {
                return pause;
            }
        }
    }

    /// Does now what would be done when the program runs for a while.
    pub(crate) fn prepare(&mut self) {
        if let Some(ready) = &mut self.ready {
            ready.prepare();
        }
    }

    /// Notes that the interpreter has executed so many steps of the program.
    pub(crate) fn interpreted(&mut self, steps: u64) {
        if let Some(ready) = &mut self.ready {
            ready.interpreted(steps);
        }
    }

    /// Steps that the interpreter is to take before the engine is asked again; no end of them where there is none.
    pub(crate) fn patience(&self, core: CoreId, state: &State) -> u64 {
        self.ready.as_ref().map_or(u64::MAX, |ready| ready.patience(core, state))
    }

    /// As far as an engine comes that is faster than the interpreter, as [`Engine::run`]; `None` where there is none.
    pub(crate) fn run_ahead<T: Watch>(
        &mut self,
        core: CoreId,
        state: &mut State,
        arithmetic: &T,
        link: &mut dyn TimedLink,
        taint: &mut Taint,
        profiler: Option<&mut Profiler>,
    ) -> Option<Stopped> {
        Some(self.ready.as_mut()?.run(core, state, arithmetic, link, taint, profiler))
    }

    /// Adds the passes of words that were executed quickly to a tally of the program and to its profile, and the octets of reads that the link
    /// was not told of, and forgets them.
    pub fn fold(&mut self, tally: &mut Tally, add_octets: AddOctets, profiler: Option<&mut Profiler>) {
        if let Some(ready) = &mut self.ready {
            ready.fold(tally, add_octets, profiler);
        }
    }
}
