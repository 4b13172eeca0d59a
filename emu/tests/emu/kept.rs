//! Recordings as octets: what is read back replays as what was written, and whatever else is read is refused.

use emu::machine::arbiter::ArbiterKind;
use emu::machine::config::CacheConfig;
use emu::machine::{Config, RunOptions, Setup};
use emu::octets::Memory;
use emu::profile::ProfileLevel;
use emu::replay::Recorded;
use isa::{Isa, Op, Program};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::builder::program;
use super::machine::dispatch;
use super::replay::{memory, setup, wander, with};

/// A setup without clocks of functions, which recordings are not kept with.
fn plain<'a>(config: &'a Config, isa: &'a Isa, core: &'a Program, main: &'a Program) -> Setup<'a> {
    let options = RunOptions { has_items: true, ..RunOptions::default() };
    Setup { options, ..setup(config, isa, core, main) }
}

fn recorded(setup: &Setup, memory: &Memory) -> Recorded {
    Recorded::new(setup, memory).unwrap_or_else(|reason| panic!("{reason}"))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, rng_seed: RngSeed::Fixed(22), ..ProptestConfig::default() })]

    #[test]
    fn what_was_kept_replays_as_what_was_recorded(
        steps in 1i32..9, spin in prop::sample::select(vec![0, 7, 63]), octets in prop::sample::select(vec![3, 63, 255]), items in 1i32..90,
        kind in prop::sample::select(&ArbiterKind::ALL[..]), cores in 1u32..9, has_cache: bool, overlap: bool, word in 16u32..=32,
    ) {
        let (core, main) = (wander(steps, spin, octets), dispatch(items));
        let isa = Isa::base();
        let mut first = Config::default();
        first.arithmetic.word = word;
        let recorded = recorded(&plain(&first, &isa, &core, &main), &memory());
        let octets = recorded.encode().expect("it serves every machine");
        prop_assert!(octets.len() < 7 * recorded.segments() + 200 * items as usize + 50_000);
        let read = Recorded::decode(&plain(&first, &isa, &core, &main), &octets);
        let read = read.unwrap_or_else(|reason| panic!("{reason}"));
        prop_assert!(read.encode().as_ref() == Some(&octets));
        // On another machine that computes alike, frames are equal, and that of the machine stepped is too.
        let mut config = with(kind, cores, first.clone());
        config.bus.overlap = overlap;
        if has_cache {
            config.cache = CacheConfig { octets: 256, line_octets: 16, ..CacheConfig::default() };
        }
        let setup = plain(&config, &isa, &core, &main);
        let replay = |recorded: &Recorded| recorded.replay(&setup, memory()).expect("it runs").expect("it is replayed");
        let (kept, fresh) = (replay(&read), replay(&recorded));
        prop_assert!(kept == fresh, "{config:?}\n{kept:#?}\n{fresh:#?}");
        let stepped = emu::step(&setup, memory(), &mut |_| {}).expect("it runs");
        prop_assert_eq!((kept.clocks, kept.bus, kept.memory), (stepped.clocks, stepped.bus, stepped.memory));
    }

    #[test]
    fn octets_that_are_none_are_refused_or_read_without_harm(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6), cut in any::<prop::sample::Index>(),
    ) {
        let (core, main) = (wander(2, 7, 63), dispatch(9));
        let (isa, config) = (Isa::base(), Config::default());
        let setup = plain(&config, &isa, &core, &main);
        let octets = recorded(&setup, &memory()).encode().expect("it serves every machine");
        let cut = &octets[..cut.index(octets.len())];
        prop_assert!(Recorded::decode(&setup, cut).is_err());
        let mut changed = octets.clone();
        for (place, octet) in changes {
            let place = place.index(changed.len());
            changed[place] = octet;
        }
        // A change of a number may make another recording; whoever keeps octets has a checksum against that.
        if let Ok(read) = Recorded::decode(&setup, &changed) {
            prop_assert!(read.encode().is_some());
        }
        changed.push(0);
        prop_assert!(Recorded::decode(&setup, &changed).is_err());
    }
}

#[test]
fn a_recording_of_another_program_is_refused() {
    let (isa, config, main) = (Isa::base(), Config::default(), dispatch(9));
    let (core, other) = (wander(2, 7, 63), readers_of_less());
    let octets = recorded(&plain(&config, &isa, &core, &main), &memory()).encode().expect("it serves every machine");
    let read = Recorded::decode(&plain(&config, &isa, &other, &main), &octets);
    assert_eq!(read.err(), Some("it is of another program"));
}

/// Items that answer with their own number.
fn readers_of_less() -> Program {
    program(|p| {
        p.emit(Op::recv5, &[0, 20]).emit(Op::vmov, &[6, 0]).emit(Op::vmov, &[7, 0]).emit(Op::cores, &[20]);
        p.emit(Op::send2, &[20, 6]).emit(Op::halt, &[]);
    })
}

#[test]
fn what_does_not_serve_every_machine_is_not_kept() {
    let (isa, config, main) = (Isa::base(), Config::default(), dispatch(5));
    let is_kept = |core: &Program, profile| {
        let mut setup = plain(&config, &isa, core, &main);
        setup.options.profile = profile;
        recorded(&setup, &memory()).encode().is_some()
    };
    let usual = wander(2, 7, 63);
    assert!(is_kept(&usual, ProfileLevel::None));
    assert!(!is_kept(&usual, ProfileLevel::Clocks), "its clocks would be missing");
    let answers = |p: &mut super::builder::ProgramBuilder| {
        p.emit(Op::vmov, &[6, 0]).emit(Op::cores, &[20]).emit(Op::send2, &[20, 6]).emit(Op::halt, &[]);
    };
    let depends = program(|p| {
        p.emit(Op::recv5, &[0, 20]).emit(Op::cores, &[20]).emit(Op::vsplat, &[7, 20]);
        answers(p);
    });
    assert!(!is_kept(&depends, ProfileLevel::None), "it answers with the number of cores");
    let traps = program(|p| {
        p.emit(Op::recv5, &[0, 20]).emit(Op::trap, &[3]);
    });
    assert!(!is_kept(&traps, ProfileLevel::None), "it ends in a fault");
}
