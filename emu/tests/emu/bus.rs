//! The bus under load: what is asked for is moved, time is accounted for, nobody waits for ever.

use emu::machine::arbiter::ArbiterKind;
use emu::machine::bus::{Bus, Grant};
use emu::machine::config::{BusConfig, MainConfig};
use emu::machine::waits::Waits;
use emu::machine::{Config, RunOutcome};
use emu::quantity::{Clocks, Octets};
use isa::{Class, Op, Program};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::builder::program;
use super::machine::{dispatch, run, worker};

fn check_accounts(frame: &RunOutcome) {
    let uncached = frame.bus.moved - frame.cache.filled + frame.bypassed;
    assert_eq!(frame.asked, uncached + frame.cache.asked);
    assert_eq!(frame.asked, frame.kinds.iter().map(|kind| kind.octets).sum());
    assert_eq!(frame.asked, frame.processors.iter().map(|used| used.octets).sum());
    assert!(frame.bus.busy <= frame.clocks);
    for (number, used) in frame.processors.iter().enumerate() {
        assert_eq!(used.busy + used.waiting + used.idle, frame.clocks, "processor {number}");
    }
}

/// A core program whose load depends on the number of its item: segments of computation and transfers either way.
fn varied(segments: i32, spin: i32, octets: i32) -> Program {
    program(|p| {
        p.emit(Op::recv5, &[0, 20]).emit(Op::vget, &[4, 0, 0]).constant(9, 7).emit(Op::imul, &[9, 4, 9]);
        p.repeat(1, segments, |p| {
            p.emit(Op::andi, &[2, 9, spin.into()]).emit(Op::iaddi, &[2, 2, 1]);
            let again = p.here();
            p.emit(Op::isubi, &[2, 2, 1]);
            p.branch(Op::bne, &[2, 0], again);
            p.emit(Op::andi, &[3, 9, octets.into()]);
            p.emit(Op::load, &[0, 0, 3]).emit(Op::ldw, &[6, 0, 8]).emit(Op::iaddi, &[9, 9, 13]);
        });
        p.emit(Op::iaddi, &[5, 4, 1]).emit(Op::vmov, &[6, 0]).emit(Op::vsplat, &[7, 5]);
        p.emit(Op::send2, &[20, 6]).emit(Op::halt, &[]);
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, rng_seed: RngSeed::Fixed(2), ..ProptestConfig::default() })]

    #[test]
    fn every_clock_and_octet_is_accounted_for(
        cores in 1u32..9, items in 0i32..40, segments in 1i32..6, spin in 0i32..200, octets in 0i32..64,
        octets_per_beat in 1u64..5, clocks_per_beat in 1u64..4, setup_clocks in 0u64..5, traffic: bool,
        arbiter in prop::sample::select(ArbiterKind::ALL.to_vec()), burst_octets in 0u64..70, overlap: bool,
    ) {
        let weights = vec![2, 3];
        let bus = BusConfig {
            octets_per_beat, clocks_per_beat, setup_clocks, burst_octets, overlap, arbiter, weights, slot_clocks: 50,
        };
        let config =
            Config { cores, bus: bus.clone(), main: MainConfig { traffic, ..MainConfig::default() }, ..Config::default() };
        let (core, main) = (varied(segments, spin, octets), dispatch(items));
        let frame = run(&config, &core, &main, 1000);
        check_accounts(&frame);
        prop_assert_eq!(frame.item_count, items as u64);
        for item in 0..items {
            prop_assert_eq!(frame.memory.word(4 * item as u32), Ok(item + 1));
        }
        // In turn, nobody waits for more than one burst of each other master, each of at most 64 octets, or with weights
        // for at most three of them; with slots for less than all of them.
        let others = u64::from(cores) - u64::from(!traffic);
        let burst = bus.length(Octets(64).min(bus.longest_burst(0)), 0).0;
        let bound = match arbiter {
            ArbiterKind::RoundRobin => others * burst,
            ArbiterKind::Weighted => others.min(2) * 3 * burst + others.saturating_sub(2) * burst,
            ArbiterKind::Tdma => (others + 1) * bus.slot_clocks - 1,
            ArbiterKind::OldestFirst => others * burst,
            // Others promise nothing.
            _ => u64::MAX,
        };
        prop_assert!(frame.bus.longest_wait.0 <= bound, "{:?} > {}", frame.bus.longest_wait, bound);
        prop_assert!(frame.bus.bursts >= frame.bus.transfers);
        prop_assert_eq!(frame.waits.iter().map(Waits::total).sum::<u64>(), frame.bus.bursts);
        let longest = frame.processors.iter().map(|used| used.longest_wait).max();
        prop_assert_eq!(longest, Some(frame.bus.longest_wait));

        // What the cores do does not depend on how many they are, nor on the time that it takes.
        let alone = run(&Config { cores: 1, ..Config::default() }, &core, &main, 1000);
        prop_assert_eq!(&frame.profile, &alone.profile);
        prop_assert_eq!(&frame.tally, &alone.tally);
        prop_assert_eq!(&frame.memory, &alone.memory);
        let summary = |frame: &RunOutcome| {
            let mut items: Vec<_> =
                frame.items.iter().map(|item| (item.subject, item.instructions, item.elementary)).collect();
            items.sort_unstable();
            items
        };
        prop_assert_eq!(summary(&frame), summary(&alone));
    }

    #[test]
    fn grants_never_overlap(
        requests in prop::collection::vec((0u32..5, 0u64..30, 0u64..32), 1..200), setup_clocks in 0u64..3,
        arbiter in prop::sample::select(ArbiterKind::ALL.to_vec()), burst_octets in 0u64..12,
    ) {
        // Each master asks again a while after its last transfer, in the order of the list.
        const MASTERS: u32 = 5;
        let config = BusConfig { setup_clocks, arbiter, burst_octets, slot_clocks: 20, ..BusConfig::default() };
        let mut bus = Bus::new(&config, 0, MASTERS);
        let mut lists: Vec<Vec<(u64, u64)>> = vec![Vec::new(); MASTERS as usize];
        for &(master, pause, octets) in requests.iter().rev() {
            lists[master as usize].push((pause, octets));
        }
        let mut asked: Vec<Option<Clocks>> = vec![None; MASTERS as usize];
        let mut ask = |bus: &mut Bus, asked: &mut Vec<Option<Clocks>>, master: u32, now: Clocks| {
            asked[master as usize] = lists[master as usize].pop().map(|(pause, octets)| {
                bus.request(master, now + Clocks(pause), Octets(octets));
                now + Clocks(pause)
            });
        };
        for master in 0..MASTERS {
            ask(&mut bus, &mut asked, master, Clocks(0));
        }
        let mut grants: Vec<Grant> = Vec::new();
        let mut passed = vec![0; MASTERS as usize];
        while let Some(clock) = bus.next_decision() {
            let Some(grant) = bus.decide(clock) else {
                prop_assert_eq!(arbiter, ArbiterKind::Tdma, "the others never leave the bus idle");
                continue;
            };
            let arrival = asked[grant.master as usize].expect("it has asked");
            prop_assert_eq!(grant.start - arrival, grant.waited);
            prop_assert!(grants.last().is_none_or(|last| last.end <= grant.start), "the last one is over");
            if arbiter == ArbiterKind::Tdma {
                let slot = |clock: Clocks| clock.0 / config.slot_clocks % u64::from(MASTERS);
                prop_assert_eq!(slot(grant.start), u64::from(grant.master));
                prop_assert!(grant.end.0 <= (grant.start.0 / config.slot_clocks + 1) * config.slot_clocks);
                prop_assert!(grant.waited.0 < u64::from(MASTERS) * config.slot_clocks);
            } else {
                // The bus is never idle while somebody waits.
                let free = grants.last().map_or(Clocks(0), |last| last.end);
                let earliest = asked.iter().flatten().copied().min().expect("somebody asked");
                prop_assert_eq!(grant.start, earliest.max(free));
            }
            for other in 0..MASTERS as usize {
                if other != grant.master as usize && asked[other].is_some_and(|arrival| arrival <= grant.start) {
                    passed[other] += 1;
                    let is_fair = arbiter != ArbiterKind::RoundRobin || passed[other] < MASTERS;
                    prop_assert!(is_fair, "master {} is passed over", other);
                }
            }
            passed[grant.master as usize] = 0;
            if grant.is_last {
                ask(&mut bus, &mut asked, grant.master, grant.end);
            } else {
                asked[grant.master as usize] = Some(grant.end);
            }
            grants.push(grant);
        }
        let used = bus.used();
        prop_assert_eq!((used.transfers, used.bursts), (requests.len() as u64, grants.len() as u64));
        prop_assert_eq!(used.moved.0, requests.iter().map(|request| request.2).sum::<u64>());
        prop_assert_eq!(used.busy.0, grants.iter().map(|grant| (grant.end - grant.start).0).sum::<u64>());
    }
}

/// The report's load: a pixel of 20 equal segments, each 10,150 clocks of computation and 1,240 octets. Report 6.1.
pub fn report_pixel() -> Program {
    program(|p| {
        p.emit(Op::recv5, &[0, 20]).constant(3, 1240);
        // A turn of the inner loop takes two clocks, one of the outer loop two more.
        p.repeat(1, 20, |p| {
            p.repeat(2, (10_150 - 2) / 2, |_| {});
            p.emit(Op::load, &[0, 0, 3]);
        });
        p.emit(Op::send2, &[20, 0]).emit(Op::halt, &[]);
    })
}

/// Hands out work two pieces ahead to each core, so that none of them waits for the main processor.
pub fn dispatch_ahead(items: i32) -> Program {
    program(|p| {
        let (more, answers, done) = (p.label(), p.label(), p.label());
        p.emit(Op::movi, &[1, 0]).constant(2, items).emit(Op::cores, &[3]).emit(Op::movi, &[4, 0]);
        p.emit(Op::slli, &[9, 3, 1]).emit(Op::min, &[9, 9, 2]);
        let first = p.here();
        p.branch(Op::bge, &[1, 9], answers);
        p.emit(Op::mov, &[5, 1]);
        p.branch(Op::blt, &[5, 3], more);
        p.emit(Op::isub, &[5, 5, 3]);
        p.place(more).emit(Op::send5, &[5, 0]).emit(Op::iaddi, &[1, 1, 1]);
        p.branch(Op::jump, &[], first);
        p.place(answers);
        p.branch(Op::beq, &[4, 2], done);
        p.emit(Op::recv2, &[8, 6]).emit(Op::iaddi, &[4, 4, 1]);
        p.branch(Op::bge, &[1, 2], answers);
        p.emit(Op::send5, &[6, 0]).emit(Op::iaddi, &[1, 1, 1]);
        p.branch(Op::jump, &[], answers);
        p.place(done).emit(Op::halt, &[]);
    })
}

#[test]
fn the_reports_load_takes_what_the_report_says_on_one_core() {
    let pixels = 40;
    let run = |cores| {
        let main = MainConfig { traffic: false, ..MainConfig::default() };
        let config = Config { cores, main, ..Config::default() };
        let frame = run(&config, &report_pixel(), &dispatch_ahead(pixels), 2000);
        check_accounts(&frame);
        frame
    };
    let one = run(1);
    let used = one.processors[0];
    assert_eq!(used.busy, Clocks(203_000 * pixels as u64));
    assert_eq!(used.waiting, Clocks(49_600 * pixels as u64));
    // The main processor takes a few clocks before the first and after the last pixel.
    let around = one.clocks.0 - 252_600 * pixels as u64;
    assert!(around < 50, "{around}");
    // Four cores cannot be four times as fast: they wait for each other's transfers.
    let four = run(4);
    let share = four.clocks.0 as f64 / (252_600.0 * pixels as f64 / 4.0);
    assert!((1.0..1.2).contains(&share), "{share}");
    assert!(four.utilisation() > 0.7 && four.utilisation() < 0.785, "{}", four.utilisation());
}

#[test]
fn octets_are_told_apart_by_what_they_are() {
    let frame = run(&Config::default(), &worker(3, 10, 100), &dispatch(10), 1000);
    let octets = |kind: &str| frame.kinds.iter().find(|total| total.kind == kind).map(|total| total.octets.0);
    // Loads start in the answers, where the loader says that 0..400 are.
    assert_eq!(octets("answer"), Some(10 * (3 * 100 + 4)));
    assert_eq!(octets("messages"), Some(10 * (60 + 24)));
    assert_eq!(octets("other"), Some(0));
    assert_eq!(frame.bus.transfers, 10 * (3 + 1 + 2));
    let core = emu::code::Code::new;
    let (isa, program) = (isa::Isa::base(), worker(3, 10, 100));
    let counts = frame.tally.counts(&core(&program, &isa, Config::default().timing()));
    assert_eq!(counts[Class::Octet], 10 * (300 + 24));
    assert_eq!(counts[Class::Mem], 10 * 4);
}
