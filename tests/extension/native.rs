//! Instructions with a meaning in Rust in native code: what goes wrong in them.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::thread::ThreadId;
use std::time::{Duration, Instant};

use emu::engine::Wish;
use emu::extension::{Call, Ending, Meaning, attach};
use emu::machine::one_core::{self, OneCore, OneCoreRun};
use emu::machine::{Config, RunOptions, Setup};
use emu::octets::Memory;
use emu::trap::Fault;
use isa::Isa;
use isa::number::Arithmetic;
use programs::main_processor::dispatch;

use super::{isa_of, program};

const ROWS: &str = "\
.extension wrongs
;; Quotient of words.
.instr ratio (d: S, a: S, b: S)  \"custom0 ddddd aaaaa bbbbb -----------\"  [Done(div 1)]
    .meaning rust
.end
;; Panics where `a` is not zero.
.instr panics (a: S)  \"custom1 aaaaa ---------------------\"  [Done(cmp 1)]
    .meaning rust
.end
";

/// A quotient.
#[derive(Clone, Debug)]
struct Ratio;

impl Meaning for Ratio {
    fn execute(&mut self, call: &mut Call) -> Result<Ending, Fault> {
        let [a, b] = ['a', 'b'].map(|letter| i128::from(call.operands.scalar(letter)));
        call.set_scalar('d', call.arithmetic.quotient(a, b));
        Ok(Ending::DONE)
    }
}

/// A mistake.
#[derive(Clone, Debug)]
struct Panics;

impl Meaning for Panics {
    fn execute(&mut self, call: &mut Call) -> Result<Ending, Fault> {
        match call.operands.scalar('a') {
            0 => Ok(Ending::DONE),
            number => panic!("{number} is too much"),
        }
    }
}

fn run(text: &str, config: &Config, wish: Wish) -> OneCoreRun {
    let (mut isa, _): (Isa, _) = isa_of(ROWS);
    attach(&mut isa, "ratio", Ratio).unwrap();
    attach(&mut isa, "panics", Panics).unwrap();
    let program = program(text, &isa);
    // Native code leaves what is close to the step limit to the interpreter.
    let one_core = OneCore { step_limit: 1 << 20, ..OneCore::new(config, &isa, &program) };
    let run = one_core::run_with(&one_core, Memory::default(), wish).expect("the setup is right");
    assert_eq!(run.engine.kind, wish.kind, "{:?}", run.engine.refusal);
    run
}

#[test]
fn divisions_by_zero_trap_at_the_instruction_that_has_written_nothing() {
    let mut config = Config::default();
    config.arithmetic.trap_division_by_zero = true;
    let text = " li s1, 7\n ratio s3, s1, s1\n ratio s3, s1, s0\n add s4, s1, s1\n ratio s5, s1, s1\n halt";
    let [native, checked] = [Wish::native(), Wish::CHECKED].map(|wish| run(text, &config, wish));
    let trap = native.trap.as_ref().expect("the second quotient has no divisor");
    assert_eq!((&trap.kind, trap.pc), (&Fault::DivisionByZero, 2));
    assert_eq!([3, 4, 5].map(|number| native.state.registers.scalar(number)), [1, 0, 0]);
    assert_eq!((&native.state, &native.trap, &native.tally), (&checked.state, &checked.trap, &checked.tally));
    // Where it does not trap, native code goes on.
    let [native, checked] = [Wish::native(), Wish::CHECKED].map(|wish| run(text, &Config::default(), wish));
    assert_eq!((native.trap, native.state, native.tally), (None, checked.state, checked.tally));
}

#[test]
fn panics_come_to_who_runs_the_program() {
    let text = " li s1, 7\n panics s0\n panics s1\n halt";
    for wish in [Wish::native(), Wish::CHECKED] {
        let ran = catch_unwind(AssertUnwindSafe(|| run(text, &Config::default(), wish)));
        let panic = ran.expect_err("the second one panics");
        assert_eq!(panic.downcast_ref::<String>().map(String::as_str), Some("7 is too much"));
    }
}

/// A mistake that only another thread makes than the one that came first, which waits for another one for a while.
#[derive(Clone, Debug)]
struct PanicsElsewhere {
    first: Arc<OnceLock<ThreadId>>,
    has_come: Arc<AtomicBool>,
    until: Instant,
}

impl Meaning for PanicsElsewhere {
    fn execute(&mut self, _: &mut Call) -> Result<Ending, Fault> {
        let own = std::thread::current().id();
        if *self.first.get_or_init(|| own) != own {
            self.has_come.store(true, Ordering::Relaxed);
            panic!("another thread has come");
        }
        while !self.has_come.load(Ordering::Relaxed) && Instant::now() < self.until {
            std::thread::yield_now();
        }
        Ok(Ending::DONE)
    }
}

/// A core's program that answers each work item, and panics at number 700 where the instruction does.
const ANSWERS: &str = "
    recv5 v0, s20
    vget  s4, v0, 0
    li    s5, NUMBER
    blt   s4, s5, fine
    panics s4
fine:
    andi  s4, s4, 63
    cores s20
    vsplat v6, s4
    vmov  v7, v6
    send2 s20, v6
    halt";

/// Text of the panic with which machines end on so many threads, whose cores panic from an item on.
fn panic_of(meaning: impl Meaning + Clone, from: u32, threads: usize, machines: &[Config]) -> Option<String> {
    let (mut isa, _): (Isa, _) = isa_of(ROWS);
    attach(&mut isa, "panics", meaning).unwrap();
    let (core, main) = (program(&ANSWERS.replace("NUMBER", &from.to_string()), &isa), dispatch(2_500));
    let options = RunOptions::default();
    let setup = Setup { config: &machines[0], isa: &isa, core: &core, main: &main, kinds: Vec::new(), options };
    let memory = Memory::new(vec![0; 2_000]);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let run = || {
        pool.install(|| match machines {
            [_] => drop(emu::count(&setup, &memory)),
            _ => drop(emu::run_all(&setup, machines, &memory, &mut |_| {})),
        })
    };
    let panic = catch_unwind(AssertUnwindSafe(run)).err()?;
    panic.downcast_ref::<String>().cloned().or_else(|| panic.downcast_ref::<&str>().map(|&text| text.to_owned()))
}

#[test]
fn panics_of_work_items_come_to_who_runs_the_machines() {
    let machines: Vec<Config> = [4, 4, 2, 7].map(|cores| Config { cores, ..Config::default() }).to_vec();
    // One machine is counted, two machines are as many as wait at once with a prerun, and four are more than there are threads.
    for (threads, wanted) in [1, 2, 3, 6].into_iter().flat_map(|threads| [1, 2, 4].map(|wanted| (threads, wanted))) {
        let machines = &machines[..wanted];
        let said = panic_of(Panics, 700, threads, machines).expect("an item panics");
        assert!(said.ends_with("is too much"), "{wanted} machines on {threads} threads: {said}");
        if threads == 1 {
            continue;
        }
        let until = Instant::now() + Duration::from_secs(60);
        let elsewhere = PanicsElsewhere { first: Arc::default(), has_come: Arc::default(), until };
        let said = panic_of(elsewhere, 0, threads, machines);
        assert_eq!(said.as_deref(), Some("another thread has come"), "{wanted} machines on {threads} threads");
    }
}
