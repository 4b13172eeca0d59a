//! Replay takes the same clocks, counts and octets as stepping, and what cannot be replayed is stepped.

use emu::machine::arbiter::ArbiterKind;
use emu::machine::config::{BusConfig, CacheConfig};
use emu::machine::preset::PRESETS;
use emu::machine::{Config, Method, RunOptions, RunOutcome, Setup};
use emu::octets::Memory;
use emu::profile::ProfileLevel;
use isa::{Isa, Op, Program};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::builder::{ProgramBuilder, program};
use super::clocks::check_sums;
use super::machine::dispatch;

/// Nodes from octet 400 on, triangles after them; answers lie before.
pub const NODES: i64 = 400;
pub const TRIANGLES: i64 = 700;

pub fn memory() -> Memory {
    Memory::new((0..2000u32).map(|at| ((at * 37) >> 3) as u8).collect())
}

pub fn setup<'a>(config: &'a Config, isa: &'a Isa, core: &'a Program, main: &'a Program) -> Setup<'a> {
    let kind = |from: i64, to: i64, name: &str| (from as u32..to as u32, name.to_owned());
    let kinds = vec![kind(NODES, TRIANGLES, "nodes"), kind(TRIANGLES, 2000, "triangles")];
    Setup {
        config,
        isa,
        core,
        main,
        kinds,
        options: RunOptions { profile: ProfileLevel::Clocks, has_items: true, ..RunOptions::default() },
    }
}

/// A work item that wanders: what it reads decides where it goes on, how long it computes and how much it loads.
pub fn wander(steps: i32, spin: i32, octets: i32) -> Program {
    program(|p| {
        p.emit(Op::recv5, &[0, 20]).emit(Op::vget, &[4, 0, 0]).emit(Op::mov, &[9, 4]);
        p.repeat(1, steps, |p| {
            p.emit(Op::andi, &[5, 9, 0xfc]).emit(Op::ldw, &[6, 5, NODES]).emit(Op::iadd, &[9, 9, 6]);
            p.emit(Op::andi, &[2, 9, spin.into()]).emit(Op::iaddi, &[2, 2, 1]);
            let again = p.here();
            p.emit(Op::isubi, &[2, 2, 1]);
            p.branch(Op::bne, &[2, 0], again);
            p.emit(Op::andi, &[3, 9, octets.into()]).emit(Op::andi, &[5, 9, 0x1ff]);
            p.emit(Op::iaddi, &[5, 5, TRIANGLES]).emit(Op::load, &[0, 5, 3]).emit(Op::lw, &[7, 0, 0]);
            p.emit(Op::iadd, &[9, 9, 7]);
        });
        p.emit(Op::vmov, &[6, 0]).emit(Op::vsplat, &[7, 9]).emit(Op::cores, &[20]);
        p.emit(Op::send2, &[20, 6]).emit(Op::halt, &[]);
    })
}

/// Result of work that the host does on so many threads; on one, recording and replaying take turns.
fn on_threads<R: Send>(threads: usize, work: impl FnOnce() -> R + Send) -> R {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("there are threads").install(work)
}

/// Runs both ways, and one of them on one thread as well, and yields the frame, with how the first was run.
fn both(config: &Config, core: &Program, main: &Program) -> RunOutcome {
    let isa = Isa::base();
    let setup = setup(config, &isa, core, main);
    let run = emu::run(&setup, memory(), &mut |_| {}).unwrap_or_else(|failure| panic!("{failure}"));
    let mut stepped = emu::step(&setup, memory(), &mut |_| {}).unwrap_or_else(|failure| panic!("{failure}"));
    check_sums(&setup, &run);
    let alone = on_threads(1, || emu::run(&setup, memory(), &mut |_| {}));
    assert!(alone.unwrap_or_else(|failure| panic!("{failure}")) == run, "{config:?} on one thread");
    stepped.method = run.method;
    assert!(run == stepped, "{config:?}\n{run:#?}\n{stepped:#?}");
    run
}

pub fn with(arbiter: ArbiterKind, cores: u32, config: Config) -> Config {
    let weights = vec![3, 1, 2];
    Config { cores, bus: BusConfig { arbiter, weights, slot_clocks: 90, ..config.bus }, ..config }
}

#[test]
fn every_preset_and_arbiter_on_one_to_sixteen_cores() {
    let (core, main) = (wander(6, 63, 63), dispatch(60));
    let isa = Isa::base();
    for preset in PRESETS {
        let machines: Vec<Config> = ArbiterKind::ALL
            .into_iter()
            .flat_map(|arbiter| (1..=16).map(move |cores| with(arbiter, cores, preset.config())))
            .collect();
        // All of them share what the work items did, and each is as if it had been alone, and stepped.
        let frames = emu::run_all(&setup(&machines[0], &isa, &core, &main), &machines, &memory(), &mut |_| {});
        let mut answers = None;
        for (config, frame) in machines.iter().zip(frames) {
            let frame = frame.unwrap_or_else(|failure| panic!("{failure}"));
            let mut stepped = emu::step(&setup(config, &isa, &core, &main), memory(), &mut |_| {}).expect("it runs");
            assert_eq!(frame.method, Method::Replayed);
            check_sums(&setup(config, &isa, &core, &main), &frame);
            stepped.method = Method::Replayed;
            assert!(frame == stepped, "{} {config:?}\n{frame:#?}\n{stepped:#?}", preset.name);
            let found = (frame.memory, frame.tally);
            assert_eq!(answers.get_or_insert_with(|| found.clone()), &found);
        }
    }
}

#[test]
fn recordings_come_in_several_batches() {
    // A batch has as much work as 1,024 cores take; the last one has less, and its last portion less than the others. Answers lie before the nodes.
    let core = program(|p| {
        p.emit(Op::recv5, &[0, 20]).emit(Op::vget, &[4, 0, 0]).emit(Op::andi, &[5, 4, 0xfc]);
        p.emit(Op::ldw, &[6, 5, NODES]).emit(Op::andi, &[2, 6, 7]).emit(Op::iaddi, &[2, 2, 1]);
        let again = p.here();
        p.emit(Op::isubi, &[2, 2, 1]);
        p.branch(Op::bne, &[2, 0], again);
        p.emit(Op::andi, &[4, 4, 63]).emit(Op::cores, &[20]);
        p.emit(Op::vsplat, &[6, 4]).emit(Op::vsplat, &[7, 6]).emit(Op::send2, &[20, 6]).emit(Op::halt, &[]);
    });
    let main = dispatch(5_500);
    let machines = [1, 4, 20, 3].map(|cores| with(ArbiterKind::RoundRobin, cores, Config::default()));
    let alone: Vec<RunOutcome> = machines.iter().map(|config| both(config, &core, &main)).collect();
    for frame in &alone {
        assert_eq!((frame.method, frame.item_count), (Method::Replayed, 5_500));
    }
    // Who records what, and how many machines wait for it meanwhile, changes nothing.
    let isa = Isa::base();
    let setup = setup(&machines[0], &isa, &core, &main);
    for (threads, wanted) in (1..=6).flat_map(|threads| (1..=machines.len()).map(move |wanted| (threads, wanted))) {
        let frames = on_threads(threads, || emu::run_all(&setup, &machines[..wanted], &memory(), &mut |_| {}));
        let frames = frames.into_iter().map(|frame| frame.unwrap_or_else(|failure| panic!("{failure}")));
        assert!(frames.eq(alone[..wanted].iter().cloned()), "{wanted} machines on {threads} threads");
    }
}

#[test]
fn clocks_by_the_word_are_replayed_as_they_are_stepped() {
    let (core, main) = (wander(3, 31, 31), dispatch(25));
    let isa = Isa::base();
    for preset in PRESETS {
        for word in [16, 24, 32] {
            let mut config = preset.config();
            config.arithmetic.word = word;
            let machines: Vec<Config> = [1, 3, 8].map(|cores| Config { cores, ..config.clone() }).to_vec();
            let frames = emu::run_all(&setup(&machines[0], &isa, &core, &main), &machines, &memory(), &mut |_| {});
            for (config, frame) in machines.iter().zip(frames) {
                let frame = frame.unwrap_or_else(|failure| panic!("{failure}"));
                let alone = both(config, &core, &main);
                assert!(frame == alone, "{} {word}\n{frame:#?}\n{alone:#?}", preset.name);
                assert_eq!(frame.method, Method::Replayed);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 80, rng_seed: RngSeed::Fixed(6), ..ProptestConfig::default() })]

    #[test]
    fn any_machine_and_load(
        cores in 1u32..17, arbiter in prop::sample::select(ArbiterKind::ALL.to_vec()), items in 0i32..90,
        steps in 1i32..7, spin in 0i32..200, octets in 0i32..200, burst_octets in 0u64..40, setup_clocks in 0u64..4,
        overlap: bool, cached in 0u32..200, traffic: bool,
    ) {
        let config = with(arbiter, cores, Config::default());
        let mut config = Config {
            bus: BusConfig { burst_octets, setup_clocks, overlap, ..config.bus },
            cache: CacheConfig { octets: cached, line_octets: 16, ..CacheConfig::default() },
            ..config
        };
        config.main.traffic = traffic;
        let frame = both(&config, &wander(steps, spin, octets), &dispatch(items));
        prop_assert_eq!(frame.method, Method::Replayed);
        prop_assert_eq!(frame.item_count, items as u64);
    }
}

fn why(core: impl FnOnce(&mut ProgramBuilder), main: &Program) -> &'static str {
    let core = program(core);
    let why = |cores| match both(&Config { cores, ..Config::default() }, &core, main).method {
        Method::Stepped { why } => why,
        Method::Replayed => "",
    };
    // A core that is alone with the main processor is played by itself.
    assert_eq!(why(1), why(4));
    why(4)
}

/// The end of a work item that answers with its number.
fn answer(p: &mut ProgramBuilder) {
    p.emit(Op::cores, &[21]).emit(Op::vmov, &[6, 0]).emit(Op::vmov, &[7, 0]).emit(Op::send2, &[21, 6]);
    p.emit(Op::halt, &[]);
}

#[test]
fn what_depends_on_others_is_stepped_and_says_why() {
    let item = |body: fn(&mut ProgramBuilder)| {
        why(
            |p| {
                p.emit(Op::recv5, &[0, 20]).emit(Op::movi, &[2, 1]);
                body(p);
                answer(p);
            },
            &dispatch(20),
        )
    };
    let nothing = |_: &mut ProgramBuilder| {};
    assert_eq!(item(nothing), "");
    let writes = "the cores write to global memory";
    assert_eq!(
        item(|p| {
            p.emit(Op::stw, &[2, 0, 900]);
        }),
        writes
    );
    assert_eq!(
        item(|p| {
            p.emit(Op::store, &[0, 2, 2]);
        }),
        writes
    );
    assert_eq!(
        item(|p| {
            p.emit(Op::fetchadd, &[3, 2, 2]);
        }),
        writes
    );
    assert_eq!(
        item(|p| {
            p.emit(Op::core, &[3]);
        }),
        "a work item asks which core it runs on"
    );
    // The answers of the first items lie there, or do not yet.
    assert_eq!(
        item(|p| {
            p.emit(Op::ldw, &[3, 0, 8]);
        }),
        "the cores read what the main processor has written"
    );
}

#[test]
fn messages_and_barriers_in_the_middle_are_stepped() {
    let send_twice = program(|p| {
        p.emit(Op::cores, &[3]);
        for _ in 0..2 {
            p.emit(Op::movi, &[1, 0]);
            let next = p.here();
            p.emit(Op::vsplat, &[0, 1]).emit(Op::send5, &[1, 0]).emit(Op::iaddi, &[1, 1, 1]);
            p.branch(Op::bne, &[1, 3], next);
        }
        p.emit(Op::halt, &[]);
    });
    let two = |p: &mut ProgramBuilder| {
        p.emit(Op::recv5, &[0, 20]).emit(Op::recv5, &[5, 20]).emit(Op::halt, &[]);
    };
    assert_eq!(why(two, &send_twice), "a work item takes more than one message");
    let meets = |p: &mut ProgramBuilder| {
        p.emit(Op::recv5, &[0, 20]).emit(Op::barrier, &[]).emit(Op::halt, &[]);
    };
    assert_eq!(why(meets, &send_twice), "the cores wait for each other at a barrier");
    let late = |p: &mut ProgramBuilder| {
        p.emit(Op::ldw, &[1, 0, 500]).emit(Op::recv5, &[0, 20]).emit(Op::halt, &[]);
    };
    assert_eq!(why(late, &send_twice), "a work item does not begin with a message");
}

#[test]
fn messages_that_other_cores_would_not_get_are_stepped() {
    let takes = |p: &mut ProgramBuilder| {
        p.emit(Op::recv5, &[0, 20]).emit(Op::halt, &[]);
    };
    // Work is recorded for many cores: one message for each of them, and one that says how many there are.
    let each = program(|p| {
        p.emit(Op::cores, &[3]).emit(Op::movi, &[1, 0]);
        let next = p.here();
        p.emit(Op::vsplat, &[0, 1]).emit(Op::send5, &[1, 0]).emit(Op::iaddi, &[1, 1, 1]);
        p.branch(Op::bne, &[1, 3], next);
        p.emit(Op::halt, &[]);
    });
    assert_eq!(why(takes, &each), "the main processor hands out other work than it would to many cores");
    let told = program(|p| {
        p.emit(Op::cores, &[3]).emit(Op::vsplat, &[0, 3]).emit(Op::movi, &[1, 0]).emit(Op::send5, &[1, 0]);
        p.emit(Op::halt, &[]);
    });
    assert_eq!(why(takes, &told), "the main processor's messages depend on time or on the number of cores");
}

#[test]
fn work_items_end_anywhere_in_their_share_of_a_batch() {
    // Reads and one answer: a share has 4,096 segments.
    for reads in [4_094, 4_095, 4_096, 8_190, 8_191, 8_192] {
        let core = program(|p| {
            p.emit(Op::recv5, &[0, 20]);
            p.repeat(1, reads, |p| {
                p.emit(Op::ldw, &[6, 0, NODES]);
            });
            answer(p);
        });
        let frame = both(&Config::default(), &core, &dispatch(3));
        assert_eq!((frame.method, frame.item_count), (Method::Replayed, 3), "{reads} reads");
    }
}

#[test]
fn work_that_depends_on_the_number_of_cores_is_not_shared() {
    let isa = Isa::base();
    let core = program(|p| {
        p.emit(Op::recv5, &[0, 20]).emit(Op::cores, &[3]).emit(Op::vput, &[0, 3, 1]);
        let again = p.here();
        p.emit(Op::isubi, &[3, 3, 1]);
        p.branch(Op::bne, &[3, 0], again);
        answer(p);
    });
    let main = dispatch(20);
    let machines: Vec<Config> = [3, 5].into_iter().map(|cores| Config { cores, ..Config::default() }).collect();
    let frames = emu::run_all(&setup(&machines[0], &isa, &core, &main), &machines, &memory(), &mut |_| {});
    let frames: Vec<RunOutcome> = frames.into_iter().map(|frame| frame.expect("it runs")).collect();
    assert_eq!(frames[0].method, Method::Replayed);
    assert_eq!(frames[1].method, Method::Stepped { why: "the work items depend on the number of cores" });
    for (config, frame) in machines.iter().zip(frames) {
        let stepped = emu::step(&setup(config, &isa, &core, &main), memory(), &mut |_| {}).expect("it runs");
        assert_eq!(frame.clocks, stepped.clocks);
    }
}

#[test]
fn machines_that_want_no_more_recordings_leave_the_others_theirs() {
    let isa = Isa::base();
    // Both programs hand out six batches. Of the first, recordings serve three cores only; the second one traps in the first batch.
    let counts = program(|p| {
        p.emit(Op::recv5, &[0, 20]).emit(Op::cores, &[3]).emit(Op::vput, &[0, 3, 1]);
        p.emit(Op::vget, &[4, 0, 0]).emit(Op::andi, &[4, 4, 63]).emit(Op::vsplat, &[6, 4]).emit(Op::vmov, &[7, 0]);
        p.emit(Op::cores, &[20]).emit(Op::send2, &[20, 6]).emit(Op::halt, &[]);
    });
    let traps = program(|p| {
        let good = p.label();
        p.emit(Op::recv5, &[0, 20]).emit(Op::vget, &[4, 0, 0]).emit(Op::movi, &[2, 330]);
        p.branch(Op::bne, &[4, 2], good);
        p.emit(Op::trap, &[7]);
        p.place(good);
        p.emit(Op::andi, &[4, 4, 63]).emit(Op::cores, &[20]);
        p.emit(Op::vsplat, &[6, 4]).emit(Op::vsplat, &[7, 4]).emit(Op::send2, &[20, 6]).emit(Op::halt, &[]);
    });
    let main = dispatch(6_000);
    let machines: Vec<Config> = [3, 5, 3, 4].into_iter().map(|cores| Config { cores, ..Config::default() }).collect();
    for threads in 1..=5 {
        let run = |core: &Program| {
            let setup = setup(&machines[0], &isa, core, &main);
            on_threads(threads, || emu::run_all(&setup, &machines, &memory(), &mut |_| {}))
        };
        let frames: Vec<RunOutcome> = run(&counts).into_iter().map(|frame| frame.expect("it runs")).collect();
        let stepped = Method::Stepped { why: "the work items depend on the number of cores" };
        let methods: Vec<Method> = frames.iter().map(|frame| frame.method).collect();
        assert_eq!(methods, [Method::Replayed, stepped, Method::Replayed, stepped], "{threads} threads");
        assert!(frames[0] == frames[2] && frames.iter().all(|frame| frame.item_count == 6_000), "{threads} threads");
        for failed in run(&traps) {
            let failed = failed.expect_err("it traps").to_string();
            assert!(failed.contains("began with 330, 330, 330"), "{threads} threads: {failed}");
        }
    }
}

#[test]
fn a_trap_is_the_same_either_way() {
    let core = program(|p| {
        let good = p.label();
        p.emit(Op::recv5, &[0, 20]).emit(Op::vget, &[1, 0, 0]).emit(Op::movi, &[2, 33]);
        p.branch(Op::bne, &[1, 2], good);
        p.emit(Op::trap, &[7]);
        p.place(good);
        answer(p);
    });
    let isa = Isa::base();
    let main = dispatch(60);
    for cores in [1, 4] {
        let config = Config { cores, ..Config::default() };
        let setup = setup(&config, &isa, &core, &main);
        let run = emu::run(&setup, memory(), &mut |_| {}).expect_err("it traps");
        let alone = on_threads(1, || emu::run(&setup, memory(), &mut |_| {}).expect_err("it traps"));
        assert_eq!(alone.to_string(), run.to_string());
        let stepped = emu::step(&setup, memory(), &mut |_| {}).expect_err("it traps");
        assert_eq!(run.to_string(), stepped.to_string());
        assert!(run.to_string().contains("began with 33, 33, 33"), "{run}");
    }
}
