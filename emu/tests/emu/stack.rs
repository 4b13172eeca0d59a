//! Stack of threads: generated programs on no more than docs/engines.md says that a thread needs. A picture on it is among the tests of the kernels.

use emu::engine::{EngineKind, Wish};
use emu::machine::one_core::{self, OneCore};
use emu::machine::{Config, RunOptions, Setup};
use emu::octets::Memory;
use emu::profile::ProfileLevel;
use isa::Isa;
use programs::generate::{gather, image, scatter, structured};
use random::SplitMix64;

use super::builder::program;
use super::machine::dispatch;

/// KiB of stack that a thread needs, optimised or not.
pub const STACK_KIB: usize = 1024;

#[test]
fn the_page_says_how_much_stack_a_thread_needs() {
    let page = include_str!("../../../docs/engines.md");
    assert!(page.contains(&format!("A thread needs {STACK_KIB} KiB of stack")), "docs/engines.md does not say so");
}

#[test]
fn generated_programs_run_on_the_stack_that_a_thread_needs() {
    let (isa, main) = (Isa::base(), dispatch(9));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).stack_size(STACK_KIB << 10).build();
    let pool = pool.expect("a thread can be had");
    let mut ends = 0;
    for (seed, word) in (0..3).flat_map(|seed| [(seed, 32), (seed, 24)]) {
        let mut random = SplitMix64::new(1000 + seed);
        let core = program(|p| {
            scatter(p, &mut random);
            structured(p, &mut random, &isa, 2);
            gather(p);
        });
        let mut config = Config { step_limit: 1 << 20, ..Config::default() };
        config.arithmetic.word = word;
        for (engine, profile) in EngineKind::ALL.into_iter().flat_map(|engine| {
            [ProfileLevel::None, ProfileLevel::Totals, ProfileLevel::Clocks].map(|profile| (engine, profile))
        }) {
            let has_losses = word == 24;
            let options = RunOptions { profile, engine, has_losses, is_eager: true, ..RunOptions::default() };
            let setup = Setup { config: &config, isa: &isa, core: &core, main: &main, kinds: Vec::new(), options };
            let wish = if engine == EngineKind::Checked { Wish::CHECKED } else { Wish::native() };
            // The machine, stepped and replayed, and a core that waits for ever, since nobody sends to it.
            let (run, alone) = pool.install(|| {
                let stepped = emu::step(&setup, Memory::new(image()), &mut |_| {});
                let run = emu::run(&setup, Memory::new(image()), &mut |_| {});
                assert_eq!(stepped.is_ok(), run.is_ok(), "seed {seed}, {engine:?}");
                let alone = OneCore { profile, ..OneCore::new(&config, &isa, &core) };
                (run.is_ok(), one_core::run_with(&alone, Memory::new(image()), wish).expect("it can run").trap)
            });
            ends += u64::from(run);
            assert!(alone.is_some(), "seed {seed}, {engine:?}");
        }
    }
    assert!(ends > 20, "most programs come to their end, not only {ends} of 36");
}
