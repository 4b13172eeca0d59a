//! Machines with protections: what they take by hand, and that all engines, replays and steps agree on it.

use emu::engine::EngineKind;
use emu::inject::{FaultKind, Protection};
use emu::machine::config::{MainConfig, ProtectionConfig};
use emu::machine::{Config, Method, RunOptions, RunOutcome, Setup};
use emu::quantity::{Clocks, Octets};
use isa::Isa;

use super::bus::{dispatch_ahead, report_pixel};
use super::machine::{self, dispatch};
use super::replay::{memory, setup, wander};

/// Protections of these structures alone.
fn protections<const N: usize>(all: [(FaultKind, Protection); N]) -> ProtectionConfig {
    let mut config = ProtectionConfig::default();
    all.into_iter().for_each(|(kind, protection)| config.set(kind, protection));
    config
}

#[test]
fn the_reports_pixel_takes_what_its_protections_take_by_hand() {
    use FaultKind::{Buffer, Bus, LostGrant, Memory, Program, Registers, Results};
    use Protection::{Duplicated, Parity, Residue, Retry, Secded};
    // 203,000 clocks of computing, and 20 transfers of 1,240 octets at 2 clocks each, which are 2,480.
    for (protection, busy, transfer) in [
        (protections([]), 203_000, 2_480),
        // Codes of words that stay in their core are checked beside the access, and a residue unit works beside the other.
        (protections([(Registers, Secded), (Buffer, Parity), (Program, Secded)]), 203_000, 2_480),
        (protections([(Results, Residue), (LostGrant, Retry)]), 203_000, 2_480),
        (protections([(Results, Duplicated)]), 406_000, 2_480),
        // 2,480 * 33 / 32 = 2,557.5, 2,480 * 39 / 32 = 3,022.5, and with both codes 2,480 * 40 / 32 = 3,100.
        (protections([(Memory, Parity)]), 203_000, 2_558),
        (protections([(Bus, Secded)]), 203_000, 3_023),
        (protections([(Memory, Secded), (Bus, Parity), (Results, Duplicated)]), 406_000, 3_100),
    ] {
        let main = MainConfig { traffic: false, ..MainConfig::default() };
        let config = Config { cores: 1, main, protection, ..Config::default() };
        let frame = machine::run(&config, &report_pixel(), &dispatch_ahead(3), 2000);
        let used = frame.processors[0];
        assert_eq!((used.busy, used.waiting), (Clocks(3 * busy), Clocks(3 * 20 * transfer)), "{protection:?}");
        assert_eq!(frame.bus.busy, used.waiting);
        // Octets of data are the same; check bits stand apart.
        assert_eq!(frame.bus.moved, Octets(3 * 20 * 1_240));
        assert_eq!(config.transfer_clocks(Octets(1_240)), Clocks(transfer));
        let check = u64::from(protection.moved_bits());
        assert_eq!(protection.check_octets(frame.bus.moved), Octets(3 * 20 * 1_240 * check / 32));
    }
}

#[test]
fn a_slot_holds_bursts_with_their_check_bits() {
    let mut config = Config::default();
    config.bus.arbiter = emu::machine::arbiter::ArbiterKind::Tdma;
    // Slots of 128 clocks hold 64 octets at 2 clocks; with 7 bits beside each 32 they hold 128 * 32 / (2 * 39) = 52.5, so 52 in 126.75.
    for (check_bits, octets, clocks) in [(0, 64, 128), (1, 62, 128), (7, 52, 127)] {
        let burst = config.bus.longest_burst(check_bits);
        assert_eq!((burst, config.bus.length(burst, check_bits)), (Octets(octets), Clocks(clocks)), "{check_bits}");
        assert!(config.bus.length(Octets(octets + 1), check_bits) > Clocks(128));
    }
}

/// Each protection of each structure by itself, and the strongest ones together.
fn all() -> Vec<ProtectionConfig> {
    let single = |kind: FaultKind| kind.protections().iter().map(move |&one| protections([(kind, one)]));
    let mut found: Vec<ProtectionConfig> = ProtectionConfig::keys().flat_map(single).collect();
    let mut strongest = ProtectionConfig::default();
    for kind in ProtectionConfig::keys() {
        let most = kind.protections().iter().max_by_key(|protection| protection.check_bits());
        strongest.set(kind, *most.expect("keys have protections"));
    }
    strongest.set(FaultKind::Results, Protection::Duplicated);
    found.push(strongest);
    found
}

#[test]
fn engines_replays_and_steps_agree_on_every_protection() {
    let (core, main, isa) = (wander(4, 31, 31), dispatch(30), Isa::base());
    let plain = Config { cores: 3, ..Config::default() };
    let plain_frame = emu::run(&setup(&plain, &isa, &core, &main), memory(), &mut |_| {}).expect("it runs");
    let (mut slower, mut as_fast) = (0, 0);
    for protection in all() {
        let config = Config { protection, ..plain.clone() };
        let mut frames = Vec::new();
        for engine in EngineKind::ALL {
            let setup = setup(&config, &isa, &core, &main);
            let options = RunOptions { engine, ..setup.options };
            let setup = Setup { options, ..setup };
            let replayed = emu::run(&setup, memory(), &mut |_| {}).expect("it runs");
            assert_eq!(replayed.method, Method::Replayed);
            let stepped = emu::step(&setup, memory(), &mut |_| {}).expect("it runs");
            frames.extend([replayed, RunOutcome { method: Method::Replayed, ..stepped }]);
        }
        for frame in &frames {
            assert!(*frame == frames[0], "{protection:?}\n{frame:#?}\n{:#?}", frames[0]);
        }
        // A frame without a fault does the same, and is at most slower.
        let frame = &frames[0];
        let counts = |frame: &RunOutcome| {
            frame.tally.all().iter().map(|passes| (passes.count, passes.units)).collect::<Vec<_>>()
        };
        assert!(frame.memory == plain_frame.memory && counts(frame) == counts(&plain_frame), "{protection:?}");
        assert_eq!(frame.bus.moved, plain_frame.bus.moved);
        let is_slower = protection.moved_bits() != 0 || protection.executions() != 1;
        assert_eq!(frame.clocks > plain_frame.clocks, is_slower, "{protection:?}");
        *(if is_slower { &mut slower } else { &mut as_fast }) += 1;
        // What a recording holds does not depend on the bus, only on whether results are computed twice.
        assert_eq!(config.computes_like(&plain), protection.executions() == 1, "{protection:?}");
    }
    // Four codes on the bus, results computed twice, and all together; two codes each of registers, buffer and program, residues,
    // and four of grants, arbiter and cores.
    assert_eq!((slower, as_fast), (6, 11));
}
