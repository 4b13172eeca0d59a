//! Protections of machines against faults: what the table of a machine file chooses, takes and sees.

use emu::inject::{FaultKind, Protection, REGISTER_WORDS, SeenFlip};
use emu::machine::Config;
use emu::machine::config::formula::Dimension;
use emu::quantity::Octets;
use isa::Class;
use lancer::energy::{Prices, Pricing};
use lancer::inject::{ProtectionCost, protection_costs};
use lancer::job::Job;
use lancer::protection::{ProtectionUse, StoredWords, check_bits};
use random::SplitMix64;
use scenes::generate::{GenerateOptions, scene};

use super::source;
use crate::project::{listings, literals, pieces};
use crate::seen::{PlantedFault, Seen, hash, is_sample};
use crate::surface::Surface;

const LONGEST: usize = 1_000;
const MEMORY: usize = 64 << 20;

/// Machine files with tables of protections.
pub const PROTECTIONS: Surface = Surface::text(
    (LONGEST, MEMORY),
    "protections",
    tables,
    protect,
    &[
        "src/protection.rs",
        "src/inject/cost.rs",
        "emu/src/inject/protection.rs",
        "emu/src/machine/config/protection.rs",
    ],
);

/// Inputs of which one draws pictures to find the costs of all protections.
const COSTED: u64 = 1_024;

fn tables() -> Vec<Vec<u8>> {
    let lines: Vec<(FaultKind, String)> = FaultKind::ALL
        .into_iter()
        .flat_map(|kind| kind.protections().iter().map(move |one| (kind, one)))
        .map(|(kind, one)| (kind, format!("{} = \"{}\"\n", kind.name(), one.name())))
        .collect();
    let alone = lines.iter().map(|(_, line)| format!("[protection]\n{line}"));
    // The last line of each structure, all together.
    let last = |at: usize| lines.get(at + 1).is_none_or(|(next, _)| *next != lines[at].0);
    let all: String = (0..lines.len()).filter(|&at| last(at)).map(|at| lines[at].1.as_str()).collect();
    let bus = "cores = 3\n[bus]\narbiter = \"tdma\"\nslot_clocks = 9\nsetup_clocks = 2\noctets_per_beat = 4\n";
    let written = alone.chain([format!("[protection]\n{all}"), format!("{bus}[protection]\n{all}")]);
    let written: Vec<Vec<u8>> = written.map(String::into_bytes).collect();
    let tests = ["src/protection.rs", "emu/src/machine/config/file.rs", "tests/protection.rs"];
    let tests = tests.iter().flat_map(|name| literals(name)).chain(listings());
    let with_table = |text: &Vec<u8>| text.windows(10).any(|window| window == b"protection");
    written.into_iter().chain(pieces(tests.filter(with_table).collect(), LONGEST)).collect()
}

fn protect(input: &[u8], seen: &mut Seen) {
    let Some(source) = source("a.toml", input) else { return };
    let config = match Config::parse(&source) {
        Err(report) => return seen.report(&report, input),
        Ok(config) => config,
    };
    for (kind, protection) in config.protection.iter() {
        assert!(
            kind.protections().contains(&protection),
            "a machine has protections that are made for their structures"
        );
        seen.name(kind.name());
        seen.name(protection.name());
    }
    let protected = config.protection.iter().count();
    seen.count("protected", protected);
    let random = &mut SplitMix64::new(hash(input.iter().copied()));
    let stored = StoredWords {
        program: random.bits() >> 42,
        main_program: random.bits() >> 42,
        memory_octets: random.bits() >> (31 + random.below(32)),
    };
    check_use(&config, stored, Octets(random.bits() >> random.below(63)));
    check_times(&config, random);
    for protection in Protection::ALL {
        let mask = random.bits() as u32 & random.bits() as u32 & random.bits() as u32;
        let change = i128::from(random.bits() as i64 >> random.below(63));
        assert_eq!(protection.sees(mask, change), seen_by(protection, mask, change), "{} {mask:#x}", protection.name());
    }
    let prices: Vec<Prices> = Pricing::all(&config, Dimension::Energy).iter().map(Pricing::prices).collect();
    seen.count("prices", prices.len());
    if is_sample(input, COSTED) {
        check_costs(&config, seen);
    }
    seen.plant(PlantedFault::Panic, protected == 8);
}

/// Check bits of a word, by the names that files have.
fn bits(protection: Protection) -> u128 {
    match protection.name() {
        "parity" => 1,
        "residue" => 2,
        "ecc" => 7,
        _ => 0,
    }
}

/// Storage and octets, against the same in numbers without an end.
fn check_use(config: &Config, stored: StoredWords, moved: Octets) {
    let cores = u128::from(config.cores);
    let words = |octets: u64| u128::from(octets).div_ceil(4);
    let storage = |(kind, protection): (FaultKind, Protection)| {
        let words = match kind.name() {
            "registers" => (cores + 1) * u128::from(REGISTER_WORDS),
            "buffer" => cores * words(config.buffer_octets.into()) + words(config.main.buffer_octets.into()),
            "program" => cores * u128::from(stored.program) + u128::from(stored.main_program),
            "memory" => words(stored.memory_octets),
            _ => 0,
        };
        let storage = words * bits(protection);
        assert_eq!(u128::from(check_bits(config, stored, kind, protection)), storage, "bits of {}", kind.name());
        storage
    };
    let storage: u128 = config.protection.iter().map(storage).sum();
    let moved_bits: u128 =
        [FaultKind::Memory, FaultKind::Bus].map(|kind| bits(config.protection.of(kind))).iter().sum();
    let octets = u128::from(moved.0) * moved_bits / 32;
    let found = ProtectionUse::new(config, stored, moved);
    assert_eq!((u128::from(found.storage_bits), u128::from(found.octets)), (storage, octets), "what protections take");
}

/// Clocks of transfers and of operations, against the same burst by burst and class by class.
fn check_times(config: &Config, random: &mut SplitMix64) {
    let octets = random.below(2_000);
    let bits = config.protection.moved_bits();
    let burst = config.bus.longest_burst(bits).0;
    let clocks_of = |octets: u64| {
        let beats = u128::from(octets.div_ceil(config.bus.octets_per_beat));
        let clocks = beats * u128::from(config.bus.clocks_per_beat) * u128::from(32 + bits);
        u128::from(config.bus.setup_clocks) + clocks.div_ceil(32)
    };
    let (mut rest, mut clocks) = (octets, 0);
    while rest > burst {
        clocks += clocks_of(burst);
        rest -= burst;
    }
    // A transfer of nothing is one burst.
    clocks += clocks_of(rest);
    assert_eq!(u128::from(config.transfer_clocks(Octets(octets)).0), clocks, "clocks of {octets} octets");
    let (single, times) = (config.single_clocks(), config.timing().clocks);
    let executions = if config.protection.of(FaultKind::Results) == Protection::Duplicated { 2 } else { 1 };
    for &class in Class::ALL {
        let executions = if class.is_elementary() { executions } else { 1 };
        assert_eq!(u128::from(times[class]), u128::from(single[class]) * executions, "clocks of {}", class.name());
    }
}

/// Flipped bits behind a protection, found by trying all errors of one bit that look the same.
fn seen_by(protection: Protection, mask: u32, change: i128) -> SeenFlip {
    let is_found = match protection {
        Protection::Parity => mask.count_ones() % 2 == 1,
        Protection::Duplicated => change != 0,
        Protection::Residue => change.rem_euclid(3) != 0,
        Protection::Secded => return seen_by_code(mask),
        _ => false,
    };
    if is_found { SeenFlip::Detected } else { SeenFlip::Passed(mask) }
}

/// The code has a column of three ones a bit, in the order of their numbers, and a column of a single one a check bit.
fn seen_by_code(mask: u32) -> SeenFlip {
    let columns: Vec<u8> = (0..128u8).filter(|column| column.count_ones() == 3).take(32).collect();
    let checks = |mask: u32| (0..32).filter(|bit| mask >> bit & 1 == 1).fold(0, |sum, bit| sum ^ columns[bit]);
    let found = checks(mask);
    let looks_like = (0..32).map(|bit| 1u32 << bit).find(|&other| checks(other) == found);
    match looks_like {
        Some(other) if other == mask => SeenFlip::Corrected,
        Some(other) => SeenFlip::Passed(mask ^ other),
        None if mask == 0 => SeenFlip::Corrected,
        None if found == 0 || found.is_power_of_two() => SeenFlip::Passed(mask),
        None => SeenFlip::Detected,
    }
}

/// Costs of all protections on a small picture: all figures or none, and those that are known otherwise.
fn check_costs(config: &Config, seen: &mut Seen) {
    let scene = scene("triangle", &GenerateOptions { size: (2, 1), ..GenerateOptions::default() });
    let mut job = Job::new(scene.expect("the scene has such a size"));
    let Config { bus, arithmetic, protection, energy, area, .. } = config.clone();
    job.machine = Config { bus, arithmetic, protection, energy, area, ..job.machine };
    let costs = match protection_costs(&job, &FaultKind::ALL) {
        Err(failure) => return seen.text(&format!("{failure:?}")),
        Ok(costs) => costs,
    };
    for ((kind, protection), cost) in costs {
        let (Some(storage), Some(octets), Some(clocks), Some(share)) =
            (cost.storage_bits, cost.octets, cost.clocks, cost.clocks_share)
        else {
            assert!(cost == ProtectionCost::default(), "all is known, or nothing");
            continue;
        };
        let is_stored = bits(protection) != 0 && ["registers", "buffer", "program", "memory"].contains(&kind.name());
        assert_eq!(storage != 0, is_stored, "check bits of {} are stored", kind.name());
        let is_moved = bits(protection) != 0 && ["memory", "bus"].contains(&kind.name());
        assert_eq!(octets != 0, is_moved, "check bits of {} are moved", kind.name());
        assert!(share.is_finite() && (share < 0.0) == (clocks < 0), "a share of clocks goes the way of the clocks");
        seen.count("clocks", clocks.unsigned_abs() as usize);
    }
}
