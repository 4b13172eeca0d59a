//! Programs that are decoded once and run more often: each run is as if it were the first.

use emu::engine::{EngineKind, Wish};
use emu::machine::arbiter::ArbiterKind;
use emu::machine::one_core::{self, LoadedCore, OneCore};
use emu::machine::{Config, RunFailure, RunOptions, Setup, SteppedFrames};
use emu::octets::Memory;
use emu::profile::ProfileLevel;
use emu::registers::Registers;
use isa::{Isa, Op};
use programs::generate::{gather, image, scatter, structured};
use random::SplitMix64;

use super::builder::program;
use super::machine::dispatch;
use super::replay::with;

#[test]
fn a_loaded_core_runs_as_if_it_had_not_run_before() {
    let (isa, config) = (Isa::base(), Config::default());
    for seed in 0..12 {
        let random = &mut SplitMix64::new(seed);
        let program = program(|p| {
            structured(p, random, &isa, 1);
            p.emit(Op::halt, &[]);
        });
        let profile = [ProfileLevel::None, ProfileLevel::Extremes][seed as usize % 2];
        let mut core = OneCore { profile, step_limit: 1 << 20, ..OneCore::new(&config, &isa, &program) };
        // Shifts make small numbers as likely as large ones.
        let starts: Vec<Registers> = (0..4)
            .map(|_| {
                let mut registers = Registers::default();
                (1..32).for_each(|place| registers.set_scalar(place, random.bits() as i32 >> random.below(32)));
                registers
            })
            .collect();
        for wish in [Wish::CHECKED, Wish::native()] {
            // Run them all on one core before comparing, so that each meets what the ones before have left behind
            let loaded = LoadedCore::new(&core).expect("the setup is right");
            let again: Vec<_> = starts.iter().map(|start| loaded.run(start, Memory::new(image()), wish)).collect();
            for (start, again) in starts.iter().zip(again) {
                core = OneCore { registers: start.clone(), ..core };
                let first = one_core::run_with(&core, Memory::new(image()), wish).expect("the setup is right");
                assert_eq!((&again.state, &again.memory), (&first.state, &first.memory), "{seed} {wish:?}");
                assert_eq!((again.clocks, again.waiting), (first.clocks, first.waiting), "{seed} {wish:?}");
                assert_eq!((&again.tally, &again.trap), (&first.tally, &first.trap), "{seed} {wish:?}");
                assert_eq!((&again.profile, again.engine), (&first.profile, first.engine), "{seed} {wish:?}");
            }
        }
    }
}

/// The frames of many machines, of which the engine is ready at once or gets so while they run, side by side.
#[test]
fn frames_that_share_a_program_are_as_if_each_were_alone() {
    let isa = Isa::base();
    for seed in 0..6 {
        let random = &mut SplitMix64::new(100 + seed);
        let core = program(|p| {
            scatter(p, random);
            structured(p, random, &isa, 1);
            // Nine items are so many steps that programs are compiled on the way which are not at first.
            p.emit(Op::movi, &[23, 32_000]).emit(Op::isubi, &[23, 23, 1]).emit(Op::bne, &[23, 0, -1]);
            gather(p);
        });
        let main = dispatch(9);
        let first = with(ArbiterKind::RoundRobin, 3, Config::default());
        // One computes otherwise, and one is none.
        let mut narrow = first.clone();
        narrow.arithmetic.word = 24;
        let none = Config { cores: 0, ..first.clone() };
        let machines = [first.clone(), with(ArbiterKind::Tdma, 5, Config::default()), narrow, none, first.clone()];
        for (engine, is_eager) in
            [(EngineKind::Checked, false), (EngineKind::Native, true), (EngineKind::Native, false)]
        {
            let options = RunOptions { engine, is_eager, has_items: true, ..RunOptions::default() };
            let kinds = Vec::new();
            let setup = Setup { config: &first, isa: &isa, core: &core, main: &main, kinds, options };
            let stepped = &SteppedFrames::new(&setup);
            let frames: Vec<_> = std::thread::scope(|scope| {
                let step = |config| move || stepped.step(config, Memory::new(image()));
                let threads: Vec<_> = machines.iter().map(|config| scope.spawn(step(config))).collect();
                threads.into_iter().map(|thread| thread.join().expect("a machine does not panic")).collect()
            });
            for (config, frame) in machines.iter().zip(frames) {
                let alone = Setup { config, ..setup.clone() };
                let alone = emu::step(&alone, Memory::new(image()), &mut |_| {});
                assert_eq!(frame.is_err(), config.cores == 0, "{seed}");
                let text = |frame: Result<_, RunFailure>| frame.map_err(|failure| failure.to_string());
                assert!(text(frame) == text(alone), "{seed} {} {is_eager} {config:?}", engine.name());
            }
        }
    }
}
