//! Clocks of functions: own clocks of all functions and of what lies outside add up to each core's account, and inclusive ones to what was
//! executed between call and return, whichever way a frame was run.

use emu::code::Code;
use emu::engine::EngineKind;
use emu::machine::arbiter::ArbiterKind;
use emu::machine::preset::PRESETS;
use emu::machine::{Config, Method, RunOptions, RunOutcome, Setup};
use emu::profile::{Profile, ProfileLevel, ProgramClocks, WorkClocks};
use emu::quantity::Clocks;
use isa::{Class, Isa, Op, Program};

use super::builder::{ProgramBuilder, program};
use super::machine::dispatch;
use super::replay::{NODES, TRIANGLES, memory, setup, with};

/// Checks that all clocks of a frame's functions add up to the accounts of its processors.
pub fn check_sums(setup: &Setup, frame: &RunOutcome) {
    let (profile, main) = (frame.profile.as_ref(), frame.main_profile.as_ref());
    let (cores, main_use) = frame.processors.split_at(setup.config.cores as usize);
    let core_code = Code::new(setup.core, setup.isa, setup.config.timing());
    // The cores one by one, and together as the profile has them
    let mut sum: Option<ProgramClocks> = None;
    assert_eq!(frame.core_clocks.len(), cores.len());
    for (found, used) in frame.core_clocks.iter().zip(cores) {
        let total = found.total();
        assert_eq!((total.busy, total.waiting, total.octets), (used.busy, used.waiting, used.octets));
        match &mut sum {
            None => sum = Some(found.clone()),
            Some(sum) => {
                sum.outside += found.outside;
                for (sum, more) in sum.regions.iter_mut().zip(&found.regions) {
                    sum.exclusive += more.exclusive;
                    sum.inclusive += more.inclusive;
                }
            }
        }
    }
    let of = |profile: Option<&Profile>| {
        let profile = profile.expect("a profile was asked for");
        let clocks = profile.clocks.as_ref().expect("clocks were asked for");
        let found = clocks.regions();
        let mut places = WorkClocks::default();
        for place in clocks.places.values() {
            assert_eq!(place.waiting_kinds.iter().sum::<u64>(), place.work.waiting.0);
            places += place.work;
        }
        assert_eq!(found.total(), places);
        check_operations(setup, profile, &found);
        found
    };
    assert_eq!(of(profile), sum.expect("there is a core"));
    let total = of(main).total();
    assert_eq!((total.busy, total.waiting, total.octets), (main_use[0].busy, main_use[0].waiting, main_use[0].octets));
    // Words have the clocks of their passes
    let clocks = profile.and_then(|profile| profile.clocks.as_ref()).expect("clocks were asked for");
    for (word, place) in clocks.words() {
        assert_eq!(place.work.busy.0, frame.tally.word(&core_code, word).busy, "word {word}");
    }
}

/// Clocks and octets are those of the operations, which were counted by themselves, where a clock is a clock for each operation.
fn check_operations(setup: &Setup, profile: &Profile, found: &ProgramClocks) {
    let timing = setup.config.timing();
    let is_plain = timing.units.0.iter().all(|&units| units == 1);
    for (region, clocks) in profile.regions.iter().zip(&found.regions) {
        for (counts, work) in [(region.exclusive, clocks.exclusive), (region.inclusive, clocks.inclusive)] {
            assert_eq!(work.octets.0, counts[Class::Octet], "{}", region.name);
            if is_plain {
                let clocks = counts.iter().map(|(class, count)| count * timing.clocks[class]).sum();
                assert_eq!(work.busy, Clocks(clocks), "{}", region.name);
            }
        }
    }
}

/// A work item with calls from several places, regions, a function that calls itself, and a call through a register.
fn caller(rounds: i32) -> Program {
    program(|p| {
        let (walk, leaf, down, bottom) = (p.label(), p.label(), p.label(), p.label());
        p.emit(Op::recv5, &[0, 20]).emit(Op::vget, &[4, 0, 0]).emit(Op::mov, &[9, 4]);
        p.repeat(1, rounds, |p| {
            p.branch(Op::call, &[30], walk).emit(Op::iadd, &[9, 9, 1]);
            p.branch(Op::call, &[31], leaf).emit(Op::andi, &[10, 9, 3]);
            p.branch(Op::call, &[31], down);
        });
        p.emit(Op::vmov, &[6, 0]).emit(Op::vsplat, &[7, 9]).emit(Op::cores, &[20]);
        p.emit(Op::send2, &[20, 6]).emit(Op::halt, &[]);
        p.function("walk", |p| {
            p.place(walk).emit(Op::andi, &[5, 9, 0xfc]).emit(Op::ldw, &[6, 5, NODES]).emit(Op::iadd, &[9, 9, 6]);
            p.region("twice", |p| {
                p.repeat(2, 2, |p| {
                    p.emit(Op::add, &[7, 7, 6]).branch(Op::call, &[31], leaf);
                });
            });
            p.emit(Op::ret, &[30]);
        });
        p.function("leaf", |p| {
            p.place(leaf).emit(Op::andi, &[3, 9, 63]).emit(Op::andi, &[5, 9, 0x1ff]);
            p.emit(Op::iaddi, &[5, 5, TRIANGLES]).emit(Op::load, &[0, 5, 3]).emit(Op::lw, &[7, 0, 0]);
            p.emit(Op::iadd, &[9, 9, 7]).emit(Op::ret, &[31]);
        });
        // As deep as s10 says; the way back lies in the buffer.
        p.function("down", |p| {
            p.place(down).branch(Op::beq, &[10, 0], bottom);
            p.emit(Op::slli, &[11, 10, 2]).emit(Op::sw, &[31, 11, 100]).emit(Op::isubi, &[10, 10, 1]);
            p.branch(Op::call, &[31], down);
            p.emit(Op::iaddi, &[10, 10, 1]).emit(Op::slli, &[11, 10, 2]).emit(Op::lw, &[31, 11, 100]);
            p.place(bottom).emit(Op::andi, &[5, 9, 0xfc]).emit(Op::ldw, &[6, 5, NODES]).emit(Op::iadd, &[9, 9, 6]);
            p.emit(Op::ret, &[31]);
        });
    })
}

#[test]
fn own_clocks_add_up_on_every_preset_and_arbiter_and_one_to_sixteen_cores() {
    let (isa, core, main) = (Isa::base(), caller(3), dispatch(40));
    for preset in PRESETS {
        for arbiter in ArbiterKind::ALL {
            let machines: Vec<Config> = (1..=16).map(|cores| with(arbiter, cores, preset.config())).collect();
            let all = setup(&machines[0], &isa, &core, &main);
            for (config, frame) in machines.iter().zip(emu::run_all(&all, &machines, &memory(), &mut |_| {})) {
                let setup = Setup { config, ..all.clone() };
                let frame = frame.unwrap_or_else(|failure| panic!("{failure}"));
                assert_eq!(frame.method, Method::Replayed);
                check_sums(&setup, &frame);
                let mut stepped =
                    emu::step(&setup, memory(), &mut |_| {}).unwrap_or_else(|failure| panic!("{failure}"));
                check_sums(&setup, &stepped);
                stepped.method = frame.method;
                assert!(stepped == frame, "{} {config:?}", preset.name);
            }
        }
    }
}

#[test]
fn engines_find_the_same_clocks() {
    let (isa, core, main) = (Isa::base(), caller(5), dispatch(30));
    let config = with(ArbiterKind::RoundRobin, 4, Config::default());
    let run = |engine, is_eager| {
        let options = RunOptions { engine, is_eager, profile: ProfileLevel::Clocks, ..RunOptions::default() };
        let setup = Setup { options, ..setup(&config, &isa, &core, &main) };
        let frames = [emu::run(&setup, memory(), &mut |_| {}), emu::step(&setup, memory(), &mut |_| {})];
        frames.map(|frame| {
            let mut frame = frame.unwrap_or_else(|failure| panic!("{failure}"));
            check_sums(&setup, &frame);
            frame.method = Method::Replayed;
            frame
        })
    };
    let [replayed, stepped] = run(EngineKind::Native, true);
    assert!(replayed == stepped);
    let checked = run(EngineKind::Checked, false);
    assert!(checked[0] == replayed && checked[1] == replayed);
}

/// A program that calls functions often and goes on with `end`. Each of them calls any, as s9 leads, so that whatever is open stands in
/// another order each time.
pub fn tangle(p: &mut ProgramBuilder, end: impl FnOnce(&mut ProgramBuilder)) {
    const FUNCTIONS: usize = 8;
    let labels: Vec<_> = (0..FUNCTIONS).map(|_| p.label()).collect();
    p.emit(Op::iaddi, &[9, 9, 77]).emit(Op::movi, &[12, 0]);
    p.repeat(1, 150, |p| {
        p.emit(Op::movi, &[10, 7]).branch(Op::call, &[31], labels[0]);
    });
    end(p);
    for (number, &label) in labels.iter().enumerate() {
        p.function(&format!("f{number}"), |p| {
            let (bottom, back) = (p.label(), p.label());
            p.place(label).branch(Op::beq, &[10, 0], bottom);
            p.emit(Op::isubi, &[10, 10, 1]).emit(Op::slli, &[11, 10, 2]).emit(Op::sw, &[31, 11, 100]);
            // A number that wanders chooses the next function.
            p.constant(13, 1_103_515_245).emit(Op::imul, &[9, 9, 13]).emit(Op::iaddi, &[9, 9, 12_345]);
            p.emit(Op::srli, &[14, 9, 20]).emit(Op::andi, &[14, 14, 7]);
            for (next, &label) in labels.iter().enumerate() {
                let on = p.label();
                p.emit(Op::movi, &[15, next as i64]).branch(Op::bne, &[14, 15], on);
                p.branch(Op::call, &[31], label).branch(Op::jump, &[], back);
                p.place(on);
            }
            p.place(back).emit(Op::slli, &[11, 10, 2]).emit(Op::lw, &[31, 11, 100]).emit(Op::iaddi, &[10, 10, 1]);
            p.place(bottom).emit(Op::andi, &[5, 9, 0xfc]).emit(Op::ldw, &[6, 5, NODES]);
            p.emit(Op::add, &[16, 16, 6]).emit(Op::ret, &[31]);
        });
    }
}

#[test]
fn functions_that_call_each_other_in_too_many_ways_are_stepped_to_the_clock() {
    let core = program(|p| {
        p.emit(Op::recv5, &[0, 20]).emit(Op::vget, &[9, 0, 0]);
        tangle(p, |p| {
            p.emit(Op::vmov, &[6, 0]).emit(Op::vsplat, &[7, 9]).emit(Op::cores, &[20]);
            p.emit(Op::send2, &[20, 6]).emit(Op::halt, &[]);
        });
    });
    let (isa, main) = (Isa::base(), dispatch(20));
    let config = with(ArbiterKind::RoundRobin, 3, Config::default());
    let setup = setup(&config, &isa, &core, &main);
    let frame = emu::run(&setup, memory(), &mut |_| {}).unwrap_or_else(|failure| panic!("{failure}"));
    assert_eq!(frame.method.reason(), Some("functions call each other in too many ways to record their clocks"));
    check_sums(&setup, &frame);
}
