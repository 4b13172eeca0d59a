//! Programs that go wrong, and what a person is told.

use emu::machine::one_core::{self, OneCore, OneCoreRun};
use emu::machine::{Config, RunFailure, RunOptions, Setup};
use emu::octets::Memory;
use emu::trap::{Fault, Trap};
use isa::{Isa, Op, Program};

use super::builder::{ProgramBuilder, program};

/// Runs a program on one core with 100 octets of memory and a limit of 1000 instructions.
fn run_with(config: &Config, program: &Program) -> OneCoreRun {
    let isa = Isa::base();
    let one_core = OneCore { step_limit: 1000, ..OneCore::new(config, &isa, program) };
    one_core::run(&one_core, Memory::new(vec![0; 100])).expect("the setup is right")
}

fn trap(body: impl FnOnce(&mut ProgramBuilder)) -> Trap {
    run_with(&Config::default(), &program(body)).trap.expect("the program traps")
}

#[test]
fn a_word_that_is_no_instruction_traps_when_it_is_executed_and_not_before() {
    let (illegal, kind) = (0xffff_ffff, Fault::IllegalWord(0xffff_ffff));
    let found = trap(|p| {
        p.emit(Op::movi, &[1, 5]).word(illegal);
    });
    assert_eq!((found.kind, found.pc, found.core), (kind, 1, 0));
    let passed = run_with(
        &Config::default(),
        &program(|p| {
            p.emit(Op::halt, &[]).word(illegal);
        }),
    );
    assert_eq!(passed.trap, None);
}

#[test]
fn the_program_counter_may_not_leave_the_program() {
    let kind = Fault::OutsideProgram { words: 1 };
    assert_eq!(
        trap(|p| {
            p.emit(Op::movi, &[1, 5]);
        })
        .kind,
        kind
    );
    assert_eq!(
        trap(|p| {
            p.emit(Op::jump, &[-1]);
        })
        .kind,
        kind
    );
    let found = trap(|p| {
        p.emit(Op::movi, &[1, -1]).emit(Op::ret, &[1]);
    });
    assert_eq!((found.kind, found.pc), (Fault::OutsideProgram { words: 2 }, u32::MAX));
}

#[test]
fn accesses_beyond_the_buffer_trap_and_those_to_its_last_octet_do_not() {
    let last = i64::from(Config::default().buffer_octets);
    let at = |op: Op, address: i64| {
        let body = |p: &mut ProgramBuilder| {
            p.constant(1, address as i32).emit(op, &[1, 1, 0]).emit(Op::halt, &[]);
        };
        run_with(&Config::default(), &program(body)).trap.map(|trap| trap.kind)
    };
    for (op, octets) in [(Op::lbu, 1), (Op::lh, 2), (Op::lhu, 2), (Op::lw, 4), (Op::lv, 12), (Op::lwide, 8)] {
        assert_eq!(at(op, last - octets), None, "{op:?}");
        let (octets, size) = (octets as u32, last as u32);
        let fault = |address| Some(Fault::Buffer { address, octets, size });
        assert_eq!(at(op, last - i64::from(octets) + 1), fault((last + 1) as u32 - octets), "{op:?}");
        assert_eq!(at(op, -1), fault(u32::MAX), "{op:?}");
    }
    for (op, octets) in [(Op::sb, 1), (Op::sh, 2), (Op::sw, 4), (Op::sv, 12), (Op::swide, 8)] {
        assert_eq!(at(op, last - octets), None, "{op:?}");
        assert!(at(op, last - octets + 1).is_some(), "{op:?}");
    }
}

#[test]
fn transfers_beyond_the_memory_or_of_a_huge_length_trap_before_they_start() {
    let transfer = |op: Op, to: i32, from: i32, octets: i32| {
        let body = |p: &mut ProgramBuilder| {
            p.constant(1, to).constant(2, from).constant(3, octets).emit(op, &[1, 2, 3]).emit(Op::halt, &[]);
        };
        let run = run_with(&Config::default(), &program(body));
        (run.trap.map(|trap| trap.kind), run.waiting.0)
    };
    assert_eq!(transfer(Op::load, 0, 60, 40), (None, 80));
    assert_eq!(transfer(Op::load, 0, 61, 40), (Some(Fault::Memory { address: 61, octets: 40, size: 100 }), 0));
    assert_eq!(transfer(Op::store, 61, 0, 40), (Some(Fault::Memory { address: 61, octets: 40, size: 100 }), 0));
    let huge = Fault::Buffer { address: 0, octets: u32::MAX, size: 18_525 };
    assert_eq!(transfer(Op::load, 0, 0, -1), (Some(huge), 0));
    assert_eq!(transfer(Op::load, 18_525, 100, 0), (None, 0), "nothing at the very end");
    let beyond = trap(|p| {
        p.emit(Op::ldw, &[1, 0, 97]);
    });
    assert_eq!(beyond.kind, Fault::Memory { address: 97, octets: 4, size: 100 });
}

#[test]
fn a_program_traps_itself_with_a_number() {
    let found = trap(|p| {
        p.emit(Op::trap, &[77]);
    });
    assert_eq!(found.kind, Fault::User(77));
}

#[test]
fn a_program_that_does_not_end_stops_at_the_limit() {
    let found = trap(|p| {
        p.emit(Op::jump, &[0]);
    });
    assert_eq!(found.kind, Fault::StepLimit(1000));
}

#[test]
fn divisions_by_zero_trap_where_the_machine_says_so() {
    let mut config = Config::default();
    let program = program(|p| {
        p.emit(Op::movi, &[1, 5]).emit(Op::div, &[2, 1, 0, 4]).emit(Op::halt, &[]);
    });
    let run = run_with(&config, &program);
    assert_eq!((run.trap, run.state.registers.scalar(2)), (None, i32::MAX));
    config.arithmetic.trap_division_by_zero = true;
    let found = run_with(&config, &program).trap.expect("it traps");
    assert_eq!((found.kind, found.pc), (Fault::DivisionByZero, 1));
}

#[test]
fn a_lone_core_has_nobody_to_talk_to() {
    assert_eq!(
        trap(|p| {
            p.emit(Op::recv2, &[0, 1]);
        })
        .kind,
        Fault::Deadlock
    );
    let kind = Fault::NoSuchCore { number: 1, largest: 0 };
    assert_eq!(
        trap(|p| {
            p.emit(Op::cores, &[1]).emit(Op::send2, &[1, 0]);
        })
        .kind,
        kind
    );
    let itself = trap(|p| {
        p.emit(Op::send2, &[0, 0]).emit(Op::barrier, &[]).emit(Op::recv5, &[0, 1]);
    });
    assert_eq!(itself.kind, Fault::MessageSize { sent: 24, expected: 60 });
    assert_eq!(
        trap(|p| {
            p.emit(Op::send2, &[0, 0]).emit(Op::send2, &[0, 0]);
        })
        .kind,
        Fault::Deadlock
    );
}

#[test]
fn a_trap_shows_core_function_and_source_line() {
    let found = trap(|p| {
        p.function("main", |p| {
            p.emit(Op::movi, &[1, -4]);
            p.region("inner", |p| {
                p.emit(Op::lw, &[2, 1, 0]);
            });
        });
    });
    assert_eq!(
        found.to_string(),
        "octets 4294967292..4294967296 of the buffer, which has 18525, on core 0 at word 1 in `main` (test.s:2)"
    );
    let shown = found.diagnostic().render(false);
    assert!(shown.contains("test.s:2:5"), "{shown}");
    assert!(shown.contains("lw s2, 0(s1)"), "{shown}");
    assert!(shown.contains("^^^^^^^^^^^^ stopped here"), "{shown}");
}

#[test]
fn a_trap_on_the_machine_names_the_work_item() {
    let isa = Isa::base();
    let config = Config { cores: 2, ..Config::default() };
    let core = program(|p| {
        p.emit(Op::recv5, &[0, 20]).emit(Op::vget, &[1, 0, 1]).emit(Op::ldw, &[2, 1, 0]).emit(Op::halt, &[]);
    });
    let main = program(|p| {
        p.emit(Op::movi, &[1, 1]);
        for (component, value) in [(0, 12), (1, 98), (2, -7)] {
            p.emit(Op::movi, &[2, value]).emit(Op::vput, &[4, 2, component]);
        }
        p.emit(Op::send5, &[1, 4]).emit(Op::halt, &[]);
    });
    let setup =
        Setup { config: &config, isa: &isa, core: &core, main: &main, kinds: vec![], options: RunOptions::default() };
    match emu::run(&setup, Memory::new(vec![0; 100]), &mut |_| {}) {
        Err(RunFailure::Trap(trap)) => {
            assert_eq!((trap.core, trap.pc), (1, 2));
            assert_eq!(trap.kind, Fault::Memory { address: 98, octets: 4, size: 100 });
            assert_eq!(trap.detail, "in the work item whose first message began with 12, 98, -7");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn data_that_do_not_fit_the_buffer_are_refused() {
    let isa = Isa::base();
    let config = Config { buffer_octets: 3, ..Config::default() };
    let program = Program { words: vec![0], buffer: vec![1; 4], ..Program::default() };
    let one_core = OneCore::new(&config, &isa, &program);
    let report = one_core::run(&one_core, Memory::default()).expect_err("it does not fit").render(false);
    assert!(report.contains("the program's data take 4 octets, but the buffer of a core has 3"), "{report}");
}
