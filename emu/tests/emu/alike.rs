//! Work items that read the same places of global memory.

use emu::engine::EngineKind;
use emu::engine::HostSimd;
use emu::machine::{Config, RunOptions, Setup};
use emu::octets::Memory;
use isa::{Isa, Op, Program};

use super::builder::program;
use super::machine::dispatch;

const NUMBER: i64 = 22;

/// Items whose number of rounds is their own number: the first one has none. Each round reads what all others read, into other registers and
/// into those that say where, and something of its own.
fn readers(rounds: i64) -> Program {
    program(|p| {
        p.emit(Op::recv5, &[0, 20]).emit(Op::vget, &[NUMBER, 0, 0]);
        p.constant(2, rounds as i32).emit(Op::imul, &[2, 2, NUMBER]).emit(Op::movi, &[1, 0]);
        let (again, end) = (p.here(), p.label());
        p.branch(Op::beq, &[2, 0], end);
        p.emit(Op::movi, &[3, 500]).emit(Op::ldw, &[4, 3, 0]).emit(Op::ldwide, &[5, 3, 4]).emit(Op::ldv3, &[6, 3, 8]);
        p.emit(Op::ldw, &[0, 3, 12]).emit(Op::ldw, &[3, 3, 16]).emit(Op::iadd, &[1, 1, 3]);
        p.emit(Op::slli, &[7, NUMBER, 4]).emit(Op::ldw, &[8, 7, 900]).emit(Op::iadd, &[1, 1, 8]);
        p.emit(Op::iadd, &[1, 1, 4]).emit(Op::wlow, &[9, 5]).emit(Op::iadd, &[1, 1, 9]);
        p.emit(Op::vget, &[9, 8, 2]).emit(Op::iadd, &[1, 1, 9]).emit(Op::isubi, &[2, 2, 1]);
        p.branch(Op::jump, &[], again);
        p.place(end);
        p.emit(Op::vsplat, &[6, NUMBER]).emit(Op::vsplat, &[7, 1]).emit(Op::cores, &[20]);
        p.emit(Op::send2, &[20, 6]).emit(Op::halt, &[]);
    })
}

fn memory() -> Memory {
    Memory::new((0..3000u32).map(|at| (at.wrapping_mul(2_654_435_761) >> 13) as u8).collect())
}

#[test]
fn both_engines_count_what_they_read() {
    let (isa, config) = (Isa::base(), Config { step_limit: 1 << 30, ..Config::default() });
    // Long enough for the sums of an item to be emptied on the way.
    let (core, main) = (readers(150), dispatch(45));
    let count = |engine, features| {
        let kinds = vec![(500..508, "first".to_owned()), (512..600, "second".to_owned())];
        let options = RunOptions { engine, simd: features, is_eager: true, ..RunOptions::default() };
        let setup = Setup { config: &config, isa: &isa, core: &core, main: &main, kinds, options };
        let count = emu::count(&setup, &memory()).expect("it runs").expect("it is counted");
        let octets = count.kinds.totals().iter().map(|kind| (kind.kind.clone(), kind.octets)).collect::<Vec<_>>();
        (count.memory, count.tally, octets)
    };
    let checked = count(EngineKind::Checked, None);
    assert!(checked.2.iter().all(|(kind, octets)| kind == "messages" || octets.0 > 100_000), "{:?}", checked.2);
    for features in HostSimd::ALL.into_iter().filter(|features| features.is_present()) {
        let found = count(EngineKind::Native, Some(features));
        assert!(found == checked, "{features:?} {:?} {:?}", found.2, checked.2);
    }
}

#[test]
fn what_they_may_not_read_is_the_interpreters() {
    let (isa, config, main) = (Isa::base(), Config::default(), dispatch(45));
    let end = |core: &Program, engine| {
        let options = RunOptions { engine, is_eager: true, ..RunOptions::default() };
        let setup = Setup { config: &config, isa: &isa, core, main: &main, kinds: Vec::new(), options };
        emu::run(&setup, memory(), &mut |_| {}).map(|frame| (frame.method, frame.clocks)).map_err(|e| e.to_string())
    };
    let beyond = program(|p| {
        p.emit(Op::recv5, &[0, 20]).emit(Op::movi, &[3, 2968]).emit(Op::ldv3, &[4, 3, 0]).emit(Op::halt, &[]);
    });
    let early = program(|p| {
        p.emit(Op::movi, &[3, 500]).emit(Op::ldw, &[4, 3, 0]).emit(Op::recv5, &[0, 20]);
        p.emit(Op::cores, &[20]).emit(Op::vmov, &[6, 0]).emit(Op::vmov, &[7, 0]).emit(Op::send2, &[20, 6]);
        p.emit(Op::halt, &[]);
    });
    for core in [&beyond, &early] {
        assert_eq!(end(core, EngineKind::Native), end(core, EngineKind::Checked));
    }
    let outside = end(&beyond, EngineKind::Native).expect_err("it ends behind the memory");
    assert!(outside.contains("2968"), "{outside}");
    let (method, _) = end(&early, EngineKind::Native).expect("it runs");
    assert_eq!(method.reason(), Some("a work item does not begin with a message"));
}
