//! A lone core, instruction by instruction: the same states, clocks and counts as a run on one core, and the state after n steps is the same
//! however one came there.

use std::cell::RefCell;

use emu::engine::Wish;
use emu::machine::Config;
use emu::machine::one_core::{self, OneCore};
use emu::octets::Memory;
use emu::registers::Registers;
use emu::stepper::{Lone, LoneEnd, Stepper, TransferKind};
use isa::{Isa, Op, Program};
use proptest::prelude::*;
use testing::check;

use super::builder::program;

fn lone<'a>(config: &'a Config, isa: &'a Isa, program: &'a Program) -> Lone<'a> {
    let (registers, memory) = (Registers::default(), Memory::new((0..=255).collect()));
    Lone { config, isa, program, registers, memory, message: None, step_limit: 2_000 }
}

/// A loop with branches, a call, the buffer, the bus and messages to itself.
fn busy() -> Program {
    program(|p| {
        p.constant(1, 40);
        p.constant(2, 8);
        let top = p.here();
        for (op, operands) in [
            (Op::isubi, &[1i64, 1, 1][..]),
            (Op::imul, &[3, 1, 2]),
            (Op::stw, &[3, 2, 4]),
            (Op::ldw, &[4, 2, 4]),
            (Op::fetchadd, &[5, 2, 1]),
            (Op::sw, &[5, 2, 0]),
            (Op::load, &[2, 2, 2]),
            (Op::send2, &[0, 4]),
            (Op::recv2, &[6, 6]),
            (Op::mul, &[7, 3, 4, 3]),
        ] {
            p.emit(op, operands);
        }
        p.branch(Op::bne, &[1, 0], top);
        p.emit(Op::halt, &[]);
    })
}

#[test]
fn a_lone_core_is_a_run_on_one_core() {
    let (isa, config, program) = (Isa::base(), Config::default(), busy());
    let one_core = OneCore { step_limit: 2_000, ..OneCore::new(&config, &isa, &program) };
    let run = one_core::run_with(&one_core, Memory::new((0..=255).collect()), Wish::CHECKED).unwrap();
    assert_eq!(run.trap, None);
    let mut whole = Stepper::new(lone(&config, &isa, &program)).unwrap();
    whole.run_to(u64::MAX);
    let mut single = Stepper::new(lone(&config, &isa, &program)).unwrap();
    let mut kinds = Vec::new();
    while let Some(executed) = single.step() {
        kinds.extend(executed.transfer.map(|transfer| transfer.kind));
    }
    for stepper in [&whole, &single] {
        assert_eq!(stepper.end(), Some(LoneEnd::Halt));
        assert_eq!((stepper.state(), stepper.clock()), (&run.state, run.clocks));
        assert_eq!(stepper.memory(), &run.memory);
        assert_eq!(stepper.counts(), run.tally.counts(&stepper.code));
    }
    for kind in [TransferKind::Write, TransferKind::Read, TransferKind::Add, TransferKind::Load, TransferKind::Send] {
        assert!(kinds.contains(&kind), "{kind:?}");
    }
}

#[test]
fn the_state_after_some_steps_is_the_same_on_every_way() {
    let (isa, config, program) = (Isa::base(), Config::default(), busy());
    let wandering = RefCell::new(Stepper::new(lone(&config, &isa, &program)).unwrap());
    let start = wandering.borrow().checkpoint();
    check(100, &(0u64..460), |steps| {
        let mut fresh = Stepper::new(lone(&config, &isa, &program)).unwrap();
        fresh.run_to(steps);
        let mut wandering = wandering.borrow_mut();
        wandering.restore(&start);
        // In two leaps and some single steps.
        wandering.run_to(steps / 2);
        let middle = wandering.checkpoint();
        wandering.run_to(u64::MAX);
        wandering.restore(&middle);
        while wandering.steps() < steps && wandering.step().is_some() {}
        prop_assert_eq!(wandering.state(), fresh.state());
        prop_assert_eq!((wandering.clock(), wandering.memory()), (fresh.clock(), fresh.memory()));
        prop_assert_eq!((wandering.calls(), wandering.end()), (fresh.calls(), fresh.end()));
        Ok(())
    });
}

#[test]
fn faults_leave_the_state_before_their_instruction() {
    let (isa, config) = (Isa::base(), Config::default());
    for (op, operands) in [(Op::lw, &[1i64, 0, -4][..]), (Op::recv2, &[2, 3]), (Op::trap, &[3]), (Op::jump, &[-5])] {
        let program = program(|p| {
            p.constant(1, 40);
            p.emit(op, operands);
        });
        let run = one_core::run_with(
            &OneCore { step_limit: 2_000, ..OneCore::new(&config, &isa, &program) },
            Memory::new((0..=255).collect()),
            Wish::CHECKED,
        );
        let run = run.unwrap();
        let mut stepper = Stepper::new(lone(&config, &isa, &program)).unwrap();
        while stepper.step().is_some() {}
        assert_eq!(stepper.trap(), run.trap, "{op:?}");
        assert_eq!(stepper.state().registers, run.state.registers);
    }
}
