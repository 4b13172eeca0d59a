//! Main processors that read global memory. A machine that replays lets them read ahead of the clock, which nobody may see: frames and faults
//! are those of the machine that is stepped by the interpreter.

use emu::engine::EngineKind;
use emu::machine::arbiter::ArbiterKind;
use emu::machine::config::BusConfig;
use emu::machine::trace::Window;
use emu::machine::{Config, GrantFault, GrantFaultKind, Method, RunOptions, Setup};
use emu::profile::ProfileLevel;
use emu::quantity::Clocks;
use isa::{Isa, Op, Program};
use programs::builder::{Label, ProgramBuilder};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::builder::program;
use super::clocks::{check_sums, tangle};
use super::replay::{NODES, TRIANGLES, memory, setup, wander, with};

/// Octet behind the answers in which a walk leaves a word for itself.
const SCRATCH: i64 = 392;

/// Most items whose answers lie in front of that.
const MOST_ITEMS: i32 = 90;

/// A main processor that goes through `items` as `programs::main_processor::dispatch` does, and does something else before each of them.
fn busy_dispatch(
    items: i32,
    before: impl Fn(&mut ProgramBuilder),
    functions: impl FnOnce(&mut ProgramBuilder),
) -> Program {
    program(|p| {
        let (feed, drain, done) = (p.label(), p.label(), p.label());
        p.emit(Op::movi, &[1, 0])
            .constant(2, items)
            .emit(Op::cores, &[3])
            .emit(Op::movi, &[4, 0])
            .emit(Op::movi, &[5, 0]);
        p.place(feed).branch(Op::bge, &[5, 3], drain).branch(Op::bge, &[1, 2], drain);
        before(p);
        p.emit(Op::vsplat, &[0, 1]).emit(Op::send5, &[5, 0]).emit(Op::iaddi, &[1, 1, 1]).emit(Op::iaddi, &[5, 5, 1]);
        p.branch(Op::jump, &[], feed);
        p.place(drain).branch(Op::beq, &[4, 2], done);
        p.emit(Op::recv2, &[8, 6]).emit(Op::vget, &[7, 8, 0]).emit(Op::vget, &[8, 9, 0]).emit(Op::slli, &[7, 7, 2]);
        p.emit(Op::stw, &[8, 7, 0]).emit(Op::iaddi, &[4, 4, 1]);
        p.branch(Op::bge, &[1, 2], drain);
        before(p);
        p.emit(Op::vsplat, &[0, 1]).emit(Op::send5, &[6, 0]).emit(Op::iaddi, &[1, 1, 1]);
        p.branch(Op::jump, &[], drain);
        p.place(done).emit(Op::stw, &[9, 0, SCRATCH + 4]).emit(Op::halt, &[]);
        functions(p);
    })
}

/// A main processor that walks so many steps through global memory before each item, where what it reads decides where it goes on and how much
/// it loads; now and then it writes, and reads what it has written.
fn walking_dispatch(items: i32, steps: i32) -> Program {
    let labels = std::cell::OnceCell::<[Label; 2]>::new();
    let call = |p: &mut ProgramBuilder| {
        let &[walk, _] = labels.get_or_init(|| [p.label(), p.label()]);
        p.branch(Op::call, &[30], walk);
    };
    busy_dispatch(items, call, |p| {
        let &[walk, leaf] = labels.get_or_init(|| [p.label(), p.label()]);
        p.function("walk", |p| {
            p.place(walk);
            p.repeat(11, steps, |p| {
                p.emit(Op::andi, &[12, 9, 0xfc]).emit(Op::ldw, &[13, 12, NODES]).emit(Op::iadd, &[9, 9, 13]);
                p.branch(Op::call, &[31], leaf);
            });
            p.emit(Op::ret, &[30]);
        });
        p.function("leaf", |p| {
            let without = p.label();
            p.place(leaf)
                .emit(Op::andi, &[14, 9, 63])
                .emit(Op::andi, &[12, 9, 0x1ff])
                .emit(Op::iaddi, &[12, 12, TRIANGLES]);
            p.emit(Op::load, &[0, 12, 14]).emit(Op::lw, &[13, 0, 0]).emit(Op::iadd, &[9, 9, 13]);
            p.emit(Op::andi, &[12, 9, 7]).branch(Op::bne, &[12, 0], without);
            p.emit(Op::stw, &[9, 0, SCRATCH]).emit(Op::ldw, &[13, 0, SCRATCH]).emit(Op::iadd, &[9, 9, 13]);
            p.place(without).emit(Op::ret, &[31]);
        });
    })
}

/// Runs ahead on native code, which is compiled at once, and steps on the interpreter; both say the same, which is yielded as text.
fn both(config: &Config, main: &Program, options: RunOptions) -> Result<Method, String> {
    let (isa, core) = (Isa::base(), wander(4, 31, 31));
    let base = setup(config, &isa, &core, main);
    let native = Setup { options: RunOptions { is_eager: true, ..options }, ..base.clone() };
    let checked = Setup { options: RunOptions { engine: EngineKind::Checked, ..options }, ..base };
    let run = emu::run(&native, memory(), &mut |_| {}).map_err(|failure| failure.to_string());
    let stepped = emu::step(&checked, memory(), &mut |_| {}).map_err(|failure| failure.to_string());
    let method = run.as_ref().map(|run| run.method).map_err(Clone::clone);
    let stepped = stepped.map(|mut stepped| {
        stepped.method = method.clone().unwrap_or(stepped.method);
        stepped
    });
    assert!(run == stepped, "{config:?} {options:?}\n{run:#?}\n{stepped:#?}");
    if let (Ok(run), ProfileLevel::Clocks) = (&run, options.profile) {
        check_sums(&native, run);
    }
    method
}

fn clocked() -> RunOptions {
    RunOptions { profile: ProfileLevel::Clocks, has_items: true, ..RunOptions::default() }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 80, rng_seed: RngSeed::Fixed(11), ..ProptestConfig::default() })]

    #[test]
    fn any_machine_with_a_main_processor_that_reads(
        cores in 1u32..17, arbiter in prop::sample::select(ArbiterKind::ALL.to_vec()), items in 0..MOST_ITEMS, steps in 1i32..9,
        burst_octets in 0u64..40, setup_clocks in 0u64..4, overlap: bool, traffic: bool, is_clocked: bool,
        window in prop::option::weighted(0.2, (0u64..20_000, 1u64..20_000)), has_course: bool,
        fault in prop::option::weighted(0.3, (0u8..3, 0u64..9_000, 0u32..17, 0u64..80)),
    ) {
        let config = with(arbiter, cores, Config::default());
        let mut config = Config { bus: BusConfig { burst_octets, setup_clocks, overlap, ..config.bus }, ..config };
        config.main.traffic = traffic;
        let grant_fault = fault.map(|(kind, at, master, retry)| {
            let kind = match kind {
                0 => GrantFaultKind::Lost { retry: Clocks(retry) },
                1 => GrantFaultKind::Stuck,
                _ => GrantFaultKind::Stopped,
            };
            GrantFault { kind, at: Clocks(at), master: master % (cores + u32::from(traffic)) }
        });
        let window = window.map(|(start, length)| Window { start: Clocks(start), end: Clocks(start + length) });
        let options = RunOptions { window, has_course: has_course && window.is_some(), grant_fault, ..clocked() };
        let options = if is_clocked { options } else { RunOptions { profile: ProfileLevel::None, ..options } };
        let method = both(&config, &walking_dispatch(items, steps), options);
        if grant_fault.is_none() {
            prop_assert_eq!(method, Ok(Method::Replayed));
        }
    }
}

#[test]
fn more_reads_than_are_done_ahead_at_once() {
    let loops = |p: &mut ProgramBuilder| {
        p.repeat(11, 5_000, |p| {
            p.emit(Op::ldw, &[13, 0, NODES]).emit(Op::iadd, &[9, 9, 13]);
        });
    };
    let main = busy_dispatch(3, loops, |_| {});
    assert_eq!(both(&Config { cores: 2, ..Config::default() }, &main, clocked()), Ok(Method::Replayed));
}

#[test]
fn faults_of_a_main_processor_that_reads_ahead() {
    let outside = |p: &mut ProgramBuilder| {
        p.emit(Op::ldw, &[13, 0, NODES]).emit(Op::slli, &[14, 1, 8]).emit(Op::ldw, &[13, 14, NODES]);
    };
    let main = busy_dispatch(40, outside, |_| {});
    let config = Config { cores: 3, ..Config::default() };
    let error = both(&config, &main, clocked()).expect_err("an address leaves the memory");
    assert!(error.contains("global memory"), "{error}");
    // Steps run out in the middle of reads, whose transfers come first.
    for step_limit in [9, 10, 11, 50, 51, 52, 53, 300] {
        let mut config = config.clone();
        config.main.step_limit = step_limit;
        let error = both(&config, &walking_dispatch(40, 8), clocked()).expect_err("steps run out");
        assert!(error.contains(&step_limit.to_string()), "{error}");
    }
}

#[test]
fn calls_of_a_main_processor_in_too_many_ways() {
    let main = program(|p| {
        tangle(p, |p| {
            p.emit(Op::halt, &[]);
        });
    });
    let config = Config { cores: 2, ..Config::default() };
    assert_eq!(both(&config, &main, clocked()), Ok(Method::Replayed));
}
