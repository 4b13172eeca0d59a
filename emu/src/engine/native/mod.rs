//! Programs as native code, generated at run time by Cranelift: each instruction inline or as a call of its meaning, counted by the ways
//! between its runs. Whatever is unusual is left to [`super::interpreter`], which goes on where this stopped, from the same state.
//!
//! A `Recipe` decides, when code is generated, what it counts, follows and notes.

mod blocks;
mod calls;
mod classes;
mod context;
mod count;
#[cfg(target_arch = "x86_64")]
mod doubles;
mod executable;
mod lower;
mod operands;
mod profiling;
mod run;
mod units;

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

use cranelift_codegen::control::ControlPlane;
use cranelift_codegen::isa::OwnedTargetIsa;
use cranelift_codegen::settings::{self, Configurable, Flags};

use super::host::HostSimd;
use super::plan::{Plan, Step};
use super::state::{CoreId, State};
use super::taint::Taint;
use super::{AddOctets, Answers, Choice, Demand, Engine, EngineKind, NotedRead, Refusal, Stopped, TimedLink};
use crate::code::registers::Registers;
use crate::code::tally::Tally;
use crate::profile::{ProfileLevel, Profiler};
use crate::semantics::{Computes, Watch};
use blocks::Blocks;
use context::{Context, CounterLayout};
use count::Counters;
use executable::Executable;
use profiling::Profiling;
use units::UnitExits;

/// Settings that code is generated for.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Recipe {
    /// The arithmetic: word, modes, and what it watches for.
    computes: Computes,
    /// The arithmetic is not the default one, so that it is one that watches: [`crate::semantics::Watching`].
    is_watching: bool,
    /// Vector instructions that may be used at most.
    simd: HostSimd,
    /// Octets of the local buffer.
    buffer_octets: u32,
    /// Scalars that may hold the number of cores, where that is followed.
    held: Option<u64>,
    /// Time at which the machine answers.
    answers: Answers,
    /// Detail in which functions and regions are measured.
    profile: ProfileLevel,
}

impl Recipe {
    fn new(demand: &Demand, plan: &Plan) -> Recipe {
        let held = || (0..plan.end()).fold(0, |held, place| held | plan.effect(place).counts());
        Recipe {
            computes: demand.computes,
            is_watching: demand.computes != Computes::default(),
            simd: demand.wish.simd,
            buffer_octets: demand.buffer_octets,
            held: demand.follows_cores.then(held),
            answers: demand.answers,
            profile: demand.profile,
        }
    }

    /// Programs may have to wait, and are entered again at each instruction that asks the machine.
    fn is_stepped(&self) -> bool {
        self.answers == Answers::WhenReady
    }

    /// Inline reads are noted with their clocks.
    fn keeps_time(&self) -> bool {
        self.answers == Answers::AtOnce { keeps_time: true }
    }
}

/// Way in which generated code left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
enum Status {
    /// The program executed `halt`.
    Halt,
    /// The instruction waits for the machine.
    Wait,
    /// The instruction asked the machine for something and went wrong.
    Fault,
    /// The instruction is for the interpreter.
    Bailout,
    /// A sum has come to half of its room.
    Full,
    /// Control goes to a word that was found in a register.
    Elsewhere,
}

impl Status {
    fn of(number: u32) -> Status {
        use Status::{Bailout, Elsewhere, Fault, Full, Halt, Wait};
        [Halt, Wait, Fault, Bailout, Full, Elsewhere].get(number as usize).copied().unwrap_or(Bailout)
    }
}

/// The site of what is no read.
const NO_SITE: u32 = u32::MAX;

/// Generated code as a function: see [`lower::function`].
type CompiledFunction = unsafe extern "C" fn(*mut Context, *mut Registers, u32) -> u32;

/// Code that was generated for a program.
#[derive(Debug)]
struct Compiled {
    function: CompiledFunction,
    layout: CounterLayout,
    /// The places at which it can be entered.
    is_join: Vec<bool>,
    /// Numbers of the reads that are done inline, by place.
    sites: Vec<u32>,
    /// The place of each of them.
    site_places: Vec<u32>,
    /// The exits that may have units.
    unit_exits: UnitExits,
    /// By place: the end of its block.
    ends: Vec<u32>,
    /// Functions and regions, where they are measured.
    profiling: Option<Profiling>,
    /// Things that the code points to.
    _steps: Box<[Step]>,
    _extras: Box<[u64]>,
    _executable: Executable,
}

/// The code of a program, shared by the cores that run it. It is generated when the interpreter has taken about as long as that takes.
#[derive(Debug)]
struct SharedCode {
    recipe: Recipe,
    compiled: OnceLock<Result<Compiled, Refusal>>,
    /// Steps that the interpreter has executed of the program.
    executed: AtomicU64,
}

/// Steps of the interpreter, for each slot of a program, that take about as long as compiling it.
const PATIENCE: u64 = 600;

/// Refusal of a host that lets nobody execute what was written.
const NO_MEMORY: Refusal = "the host gives no memory for code";

/// The native engine of one program, with what a core has counted.
#[derive(Clone, Debug)]
pub struct Native<'a> {
    plan: Plan<'a>,
    shared: Arc<SharedCode>,
    /// Steps after which the program is compiled.
    patience: u64,
    counters: Option<Counters>,
}

impl<'a> Engine<'a> for Native<'a> {
    fn new(demand: &Demand<'a>) -> Result<Native<'a>, Refusal> {
        host()?;
        if !executable::is_given() {
            return Err(NO_MEMORY);
        }
        let plan = Plan::new(demand.code).ok_or("an instruction takes more clocks than the sums have room for")?;
        let recipe = Recipe::new(demand, &plan);
        let new = || SharedCode { recipe: recipe.clone(), compiled: OnceLock::new(), executed: AtomicU64::new(0) };
        let shared = demand.code.share(|shared: &SharedCode| shared.recipe == recipe, new);
        let patience = if demand.wish.is_eager { 0 } else { PATIENCE * plan.slots().len() as u64 };
        Ok(Native { plan, shared, patience, counters: None })
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
        self.run_code(core, state, arithmetic, link, taint, profiler)
    }

    fn prepare(&mut self) {
        self.shared.compile(&self.plan, self.patience);
    }

    fn patience(&self, core: CoreId, state: &State) -> u64 {
        match self.shared.rest(self.patience) {
            _ if run::is_near_limit(core, state.steps + state.inner_steps) => u64::MAX,
            rest => rest.max(1),
        }
    }

    fn interpreted(&mut self, steps: u64) {
        self.shared.executed.fetch_add(steps, Ordering::Relaxed);
    }

    fn replacement(&self) -> Option<Choice> {
        let refusal = self.shared.compiled.get()?.as_ref().err().copied()?;
        Some(Choice { kind: EngineKind::Checked, refusal: Some(refusal) })
    }

    fn fold(&mut self, tally: &mut Tally, add_octets: AddOctets, profiler: Option<&mut Profiler>) {
        self.fold_counters(tally, add_octets, profiler);
    }
}

impl SharedCode {
    /// Steps that the interpreter is to execute before the program is compiled; no end of them where it cannot be.
    fn rest(&self, patience: u64) -> u64 {
        match self.compiled.get() {
            None => patience.saturating_sub(self.executed.load(Ordering::Relaxed)),
            Some(Ok(_)) => 0,
            Some(Err(_)) => u64::MAX,
        }
    }

    /// The code, where there is some, or it is time to generate it.
    fn code(&self, plan: &Plan, patience: u64) -> Option<&Compiled> {
        if self.rest(patience) != 0 {
            return None;
        }
        self.compile(plan, patience).as_ref().ok()
    }

    /// Code, or why there is none; it is generated once. Without patience somebody looks at the code itself, so in builds with assertions it is
    /// verified.
    fn compile(&self, plan: &Plan, patience: u64) -> &Result<Compiled, Refusal> {
        let is_verified = cfg!(debug_assertions) && patience == 0;
        self.compiled.get_or_init(|| Compiled::new(plan, &self.recipe, is_verified))
    }
}

impl Compiled {
    /// Generates the code of a plan.
    ///
    /// # Errors
    /// Refused, with the reason.
    fn new(plan: &Plan, recipe: &Recipe, is_verified: bool) -> Result<Compiled, Refusal> {
        let isa = host()?;
        let steps: Box<[Step]> = plan.steps().into();
        let extras: Box<[u64]> = (0..plan.exits()).map(|exit| plan.extra(exit).0).collect();
        let (mut sites, mut site_places) = (vec![NO_SITE; steps.len()], Vec::new());
        for (place, step) in (0..plan.end()).zip(&steps) {
            if blocks::asks(plan, step) && run::octets(plan, step) != 0 {
                sites[place as usize] = site_places.len() as u32;
                site_places.push(place);
            }
        }
        let profiling = Profiling::new(plan, recipe.profile);
        let regions = profiling.as_ref().map_or(0, Profiling::regions);
        let unit_exits = UnitExits::new(plan);
        let exits = [plan.exits(), unit_exits.exits().len()];
        let layout = CounterLayout::new(exits, steps.len(), regions, site_places.len());
        let layout = layout.ok_or("the program is too large")?;
        let blocks = Blocks::new(plan, recipe, profiling.as_ref());
        let source = lower::LowerSource {
            plan,
            steps: &steps,
            extras: &extras,
            recipe,
            layout,
            blocks: &blocks,
            sites: &sites,
            unit_exits: &unit_exits,
            profiling: profiling.as_ref(),
        };
        let mut context = cranelift_codegen::Context::for_function(lower::function(&*isa, &source));
        if is_verified {
            context.verify(&*isa).map_err(|_| "the program cannot be compiled")?;
        }
        let compiled = context.compile(&*isa, &mut ControlPlane::default());
        let compiled = compiled.map_err(|_| "the program cannot be compiled")?;
        if !compiled.buffer.relocs().is_empty() {
            return Err("the host lacks an instruction that compiled programs need");
        }
        let executable = Executable::new(compiled.code_buffer()).map_err(|_| NO_MEMORY)?;
        // SAFETY: what was generated is a function of that signature, in the host's calling convention, with nothing left to relocate.
        let function = unsafe { std::mem::transmute::<*const u8, CompiledFunction>(executable.start()) };
        Ok(Compiled {
            function,
            layout,
            is_join: blocks.is_join,
            ends: blocks.end,
            profiling,
            sites,
            site_places,
            unit_exits,
            _steps: steps,
            _extras: extras,
            _executable: executable,
        })
    }
}

/// Cranelift for this host, found once.
///
/// # Errors
/// The host is one for which it does not know how to compile.
fn host() -> Result<OwnedTargetIsa, Refusal> {
    static HOST: OnceLock<Result<OwnedTargetIsa, Refusal>> = OnceLock::new();
    HOST.get_or_init(find_host).clone()
}

fn find_host() -> Result<OwnedTargetIsa, Refusal> {
    const UNKNOWN: Refusal = "no compiler knows this host";
    let mut flags = settings::builder();
    for (name, value) in [("opt_level", "speed"), ("enable_verifier", "false"), ("enable_probestack", "false")] {
        flags.set(name, value).map_err(|_| UNKNOWN)?;
    }
    let isa = cranelift_native::builder().map_err(|_| UNKNOWN)?;
    let isa = isa.finish(Flags::new(flags)).map_err(|_| UNKNOWN)?;
    if isa.pointer_bits() != 64 || cfg!(target_endian = "big") {
        return Err(UNKNOWN);
    }
    Ok(isa)
}

#[cfg(test)]
mod tests {
    use isa::number::Nearest32;
    use isa::{Isa, Op, Program};

    use super::*;
    use crate::code::Code;
    use crate::code::octets::Buffer;
    use crate::code::trap::Stop;
    use crate::engine::{Pause, Wish, choose};
    use crate::profile::Unobserved;
    use crate::semantics::{Link, Message, methods};

    /// A machine of which nobody asks anything.
    struct Silent;

    impl Link for Silent {
        methods! { refuse! }
    }

    #[test]
    fn a_program_that_cannot_be_compiled_is_interpreted_and_says_so() {
        let isa = Isa::base();
        let word = |op, operands: &[i64]| isa.encode(op, operands).expect("operands are in their ranges");
        // As many rounds as there is patience, and more.
        let words = vec![
            word(Op::movi, &[1, 30_000]),
            word(Op::isubi, &[1, 1, 1]),
            word(Op::bne, &[1, 0, -1]),
            word(Op::halt, &[]),
        ];
        let program = Program { words, region_of: vec![], ..Program::default() };
        let buffer_octets = 64;
        for is_eager in [false, true] {
            let code = Code::new(&program, &isa, Default::default());
            let wish = Wish { is_eager, ..Wish::native() };
            let demand = Demand::new(&code, wish, Computes::default(), buffer_octets);
            let native = Native::new(&demand).expect("there is a compiler for this host");
            let mut runner = choose(&demand);
            assert_eq!(runner.choice(), Choice { kind: EngineKind::Native, refusal: None });
            native.shared.compiled.set(Err(NO_MEMORY)).expect("nothing is compiled yet");

            let core = CoreId { core: 0, cores: 1, step_limit: 1 << 30 };
            let mut state = State::new(&code, Buffer::new(&[], buffer_octets));
            let mut tally = Tally::new(&code);
            let pause = runner.run(core, &mut state, &Nearest32, &mut Silent, &mut tally, &mut Unobserved);
            assert_eq!((pause, state.steps), (Pause::Halt, 60_002));
            assert_eq!(tally.instructions(), 60_002);
            assert_eq!(runner.choice(), Choice { kind: EngineKind::Checked, refusal: Some(NO_MEMORY) });
        }
    }
}
