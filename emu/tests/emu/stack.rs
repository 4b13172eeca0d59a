//! Rows of the fast engine go on to each other by jumps, where they leave nothing on the stack. With debug assertions the compiler makes some of
//! these jumps calls; then what they leave is given back when the engine looks at its sums, every 16,384 instructions at the latest. So no program
//! may come to the end of a thread's usual stack.

use emu::engine::{HostSimd, Wish};
use emu::machine::Config;
use emu::machine::one_core::{self, OneCore};
use emu::octets::Memory;
use isa::{Isa, Kind, Op};

use super::builder::program;

/// Copies of a row: more than twice as many as there are between two looks.
const COPIES: usize = 36_000;

/// Stack that the standard library gives a thread.
const STACK: usize = 2 << 20;

/// Copies without a branch: the engine refuses runs that are longer than a quarter of what its sums hold.
const RUN: usize = 500;

#[test]
fn no_row_takes_more_stack_than_there_is() {
    let isa = Isa::base();
    for op in Op::BUILT_IN.iter().copied() {
        let row = isa.definition(op);
        if row.room == "control" || matches!(op, Op::send2 | Op::send5 | Op::recv2 | Op::recv5 | Op::barrier) {
            continue;
        }
        let operands: Vec<i64> = row
            .operands
            .iter()
            .map(|operand| match operand.kind {
                Kind::S if operand.is_written() => 1,
                _ => 0,
            })
            .collect();
        let program = program(|p| {
            p.constant(9, (COPIES / RUN / 4) as i32);
            let again = p.here();
            for _ in 0..4 {
                (0..RUN).for_each(|_| {
                    p.emit(op, &operands);
                });
                let next = p.label();
                p.branch(Op::jump, &[], next);
                p.place(next);
            }
            p.emit(Op::isubi, &[9, 9, 1]).branch(Op::bne, &[9, 0], again);
            p.emit(Op::halt, &[]);
        });
        let features = HostSimd::ALL.into_iter().filter(|features| features.is_present());
        for (features, has_profile) in features.flat_map(|features| [(features, false), (features, true)]) {
            let steps = std::thread::scope(|scope| {
                let run = || {
                    let config = Config::default();
                    let one_core = OneCore { has_profile, ..OneCore::new(&config, &isa, &program) };
                    let run = one_core::run_with(&one_core, Memory::new(vec![0; 4096]), Wish::fast(features))
                        .expect("it runs");
                    (run.state.steps, run.trap.map(|trap| trap.to_string()))
                };
                let small = std::thread::Builder::new().name(format!("{op:?} {features:?}")).stack_size(STACK);
                small.spawn_scoped(scope, run).expect("there is a thread").join().expect("it takes no stack")
            });
            assert!(steps.0 > COPIES as u64 && steps.1.is_none(), "{op:?}: {steps:?}");
        }
    }
}
