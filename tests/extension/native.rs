//! Instructions with a meaning in Rust in native code: what goes wrong in them.

use std::panic::{AssertUnwindSafe, catch_unwind};

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

/// A core's program that answers each work item but number 700, at which it panics.
const ANSWERS: &str = "
    recv5 v0, s20
    vget  s4, v0, 0
    li    s5, 700
    bne   s4, s5, fine
    panics s4
fine:
    andi  s4, s4, 63
    cores s20
    vsplat v6, s4
    vmov  v7, v6
    send2 s20, v6
    halt";

#[test]
fn panics_of_a_work_item_come_to_who_runs_the_machines() {
    let (mut isa, _): (Isa, _) = isa_of(ROWS);
    attach(&mut isa, "panics", Panics).unwrap();
    let (core, main) = (program(ANSWERS, &isa), dispatch(2_500));
    let machines: Vec<Config> = [4, 2, 7].map(|cores| Config { cores, ..Config::default() }).to_vec();
    let options = RunOptions::default();
    let setup = Setup { config: &machines[0], isa: &isa, core: &core, main: &main, kinds: Vec::new(), options };
    let memory = Memory::new(vec![0; 2_000]);
    for (threads, wanted) in [1, 2, 3, 6].into_iter().flat_map(|threads| [(threads, 1), (threads, 3)]) {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let run = || pool.install(|| emu::run_all(&setup, &machines[..wanted], &memory, &mut |_| {}));
        let panic = catch_unwind(AssertUnwindSafe(run)).expect_err("an item panics");
        let said = panic.downcast_ref::<String>().map(String::as_str);
        assert_eq!(said, Some("700 is too much"), "{wanted} machines on {threads} threads");
    }
}
