//! Cores, messages and the bus together.

use emu::machine::{Config, RunOptions, RunOutcome, Setup};
use emu::octets::Memory;
use emu::profile::ProfileLevel;
use isa::{Isa, Op, Program};

use super::builder::program;
pub use programs::main_processor::dispatch;

/// Core program: `segments` times some computation and a load, then the answer 3 n + 1.
pub fn worker(segments: i32, spin: i32, octets: i32) -> Program {
    program(|p| {
        p.emit(Op::recv5, &[0, 20]);
        p.constant(3, octets);
        p.repeat(1, segments, |p| {
            p.repeat(2, spin, |_| {});
            p.emit(Op::load, &[0, 0, 3]);
        });
        p.emit(Op::vget, &[4, 0, 0]).emit(Op::iadd, &[5, 4, 4]).emit(Op::iadd, &[5, 5, 4]).emit(Op::iaddi, &[5, 5, 1]);
        p.emit(Op::vmov, &[6, 0]).emit(Op::vsplat, &[7, 5]);
        p.emit(Op::send2, &[20, 6]).emit(Op::halt, &[]);
    })
}

pub fn run(config: &Config, core: &Program, main: &Program, octets: usize) -> RunOutcome {
    let isa = Isa::base();
    let options = RunOptions { profile: ProfileLevel::Totals, has_items: true, ..RunOptions::default() };
    let setup = Setup { config, isa: &isa, core, main, kinds: vec![(0..400, "answer".to_owned())], options };
    match emu::run(&setup, Memory::new(vec![0; octets]), &mut |_| {}) {
        Ok(frame) => frame,
        Err(failure) => panic!("{}", failure.report().render(false)),
    }
}

#[test]
fn machines_run_inside_tasks_of_the_hosts_only_thread() {
    let (core, main) = (worker(3, 10, 100), dispatch(50));
    let frame = || run(&Config::default(), &core, &main, 1000);
    let alone = frame();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread can be had");
    let (one, other) = pool.install(|| rayon::join(frame, frame));
    // Machines that share recordings have threads of their own there.
    let (isa, config) = (Isa::base(), Config::default());
    let options = RunOptions { profile: ProfileLevel::Totals, has_items: true, ..RunOptions::default() };
    let kinds = vec![(0..400, "answer".to_owned())];
    let setup = Setup { config: &config, isa: &isa, core: &core, main: &main, kinds, options };
    let both = [config.clone(), config.clone()];
    let shared = pool.install(|| emu::run_all(&setup, &both, &Memory::new(vec![0; 1000]), &mut |_| {}));
    let shared = shared.into_iter().map(|frame| frame.unwrap_or_else(|failure| panic!("{failure}")));
    for inside in [one, other].into_iter().chain(shared) {
        assert_eq!(
            (inside.clocks, inside.tally, inside.memory),
            (alone.clocks, alone.tally.clone(), alone.memory.clone())
        );
    }
}

#[test]
fn work_goes_out_and_answers_come_back_on_any_number_of_cores() {
    let (core, main) = (worker(3, 10, 100), dispatch(50));
    for cores in [1, 2, 3, 4, 8] {
        let config = Config { cores, ..Config::default() };
        let frame = run(&config, &core, &main, 1000);
        for item in 0..50 {
            assert_eq!(frame.memory.word(4 * item), Ok(3 * item as i32 + 1), "item {item} on {cores} cores");
        }
        assert_eq!(frame.item_count, 50);
        assert_eq!(frame.items.len(), 50);
        assert_eq!(frame.asked, frame.bus.moved);
        for used in &frame.processors {
            assert_eq!(used.busy + used.waiting + used.idle, frame.clocks);
        }
    }
}
