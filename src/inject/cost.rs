//! Cost of protections in storage, octets, clocks and energy, on the machine and the picture of a campaign.
//!
//! A code is checked beside the access, so words at rest cost no clocks. Global memory and the bus move the check bits as well: each word of 32
//! bits is that much longer on a bus of the same width, and the frame is run on such a machine. An instruction that is executed twice takes its
//! clocks twice. Energy is that of the bits and operations that come in addition, by the published tables.

use std::collections::BTreeMap;

use emu::inject::{FaultKind, Protection, REGISTER_WORDS};
use emu::machine::Config;
use emu::machine::config::law::{ClassLaws, Law};
use isa::{Class, Program};
use schemars::JsonSchema;
use serde::Serialize;

use crate::drawing::{self, Comparison, Drawing};
use crate::energy::{EnergyResult, FigureRange};
use crate::failure::Failure;
use crate::job::{Detail, Job};

/// Cost of a protection.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct ProtectionCost {
    /// Bits of storage that come in addition, of all cores together.
    pub storage_bits: u64,
    /// Octets that go over the bus in addition, in a frame.
    pub octets: u64,
    /// Clocks that a frame takes in addition, rounded down; null where the machine's own clocks are too many to be multiplied.
    pub clocks: Option<u64>,
    /// Those as a share of the frame without protection.
    pub clocks_share: Option<f64>,
    /// Nanojoules that a frame takes in addition; null where no table has a figure for the structure.
    pub energy_nj: Option<FigureRange>,
}

/// Protections that a structure may have.
pub fn possible(kind: FaultKind) -> &'static [Protection] {
    match kind {
        FaultKind::Results => &[Protection::Duplicated, Protection::Residue],
        FaultKind::LostGrant => &[Protection::Retry, Protection::Watchdog],
        FaultKind::StuckArbiter | FaultKind::StoppedCore => &[Protection::Watchdog],
        // A wire with a 1 too many is none of the errors that the codes are made for.
        FaultKind::DoubledGrant => &[],
        _ => &[Protection::Parity, Protection::Secded],
    }
}

/// Costs of all protections that the structures may have.
///
/// # Errors
/// A picture that cannot be drawn on a machine with a protection.
pub fn costs(
    job: &Job,
    program: &Program,
    kinds: &[FaultKind],
) -> Result<BTreeMap<(FaultKind, Protection), ProtectionCost>, Failure> {
    let plain = draw(job, job.machine.clone())?;
    let energy = EnergyResult::of(job, &plain, None);
    let mut longer: BTreeMap<u32, Option<u64>> = BTreeMap::new();
    let mut found = BTreeMap::new();
    for &kind in kinds {
        for &protection in possible(kind) {
            let check = protection.check_bits();
            let clocks = match (kind, protection) {
                (FaultKind::Memory | FaultKind::Bus, _) => match longer.get(&check) {
                    Some(&clocks) => clocks,
                    None => {
                        // All times are 32 times as long, and those of beats 32 + c times, so that whole numbers say it.
                        let drawn = draw(job, with_check_bits(&job.machine, check)).ok();
                        let clocks = drawn.map(|drawing| drawing.frame.clocks.0 / 32);
                        longer.insert(check, clocks);
                        clocks
                    }
                },
                (_, Protection::Duplicated) => {
                    draw(job, twice(&job.machine)).ok().map(|drawing| drawing.frame.clocks.0)
                }
                _ => Some(plain.frame.clocks.0),
            };
            let is_moved = matches!(kind, FaultKind::Memory | FaultKind::Bus);
            let more = clocks.map(|clocks| clocks.saturating_sub(plain.frame.clocks.0));
            let cost = ProtectionCost {
                storage_bits: words(job, program, kind, &plain) * u64::from(check),
                octets: if is_moved { plain.frame.bus.moved.0 * u64::from(check) / 32 } else { 0 },
                clocks: more,
                clocks_share: more.map(|more| more as f64 / plain.frame.clocks.0.max(1) as f64),
                energy_nj: energy_of(&energy, job, kind, protection),
            };
            found.insert((kind, protection), cost);
        }
    }
    Ok(found)
}

fn draw(job: &Job, machine: Config) -> Result<Drawing, Failure> {
    let job = Job { machine, detail: Detail::Totals, flags: false, ..job.clone() };
    drawing::draw(&job, Comparison::None, &mut |_| {})
}

/// Words of 32 bits that are stored, of all cores together; what is only moved or computed is not.
fn words(job: &Job, program: &Program, kind: FaultKind, drawing: &Drawing) -> u64 {
    let cores = u64::from(job.machine.cores);
    match kind {
        FaultKind::Registers => cores * u64::from(REGISTER_WORDS),
        FaultKind::Buffer => cores * u64::from(job.machine.buffer_octets).div_ceil(4),
        FaultKind::Program => cores * program.words.len() as u64,
        FaultKind::Memory => drawing.frame.memory.size().div_ceil(4) as u64,
        _ => 0,
    }
}

/// The machine with so many check bits beside each word of 32 on its bus, all of whose clocks are 32 times as many.
fn with_check_bits(machine: &Config, check: u32) -> Config {
    let mut machine = machine.clone();
    let mut clocks = machine.clocks.0.at(machine.arithmetic.word);
    clocks.0.iter_mut().for_each(|clocks| *clocks *= 32);
    machine.clocks.0 = ClassLaws::constant(clocks);
    machine.bus.clocks_per_beat *= u64::from(32 + check);
    machine.bus.setup_clocks *= 32;
    machine.bus.slot_clocks *= 32;
    machine
}

/// The machine with elementary operations that take twice as long.
fn twice(machine: &Config) -> Config {
    let mut machine = machine.clone();
    let clocks = machine.clocks.0.at(machine.arithmetic.word);
    for &class in Class::ALL.iter().filter(|class| class.is_elementary()) {
        machine.clocks.0[class] = Law::Constant(2 * clocks[class]);
    }
    machine
}

/// Energy of the bits and operations that come in addition.
///
/// A residue unit works on two bits beside each word; a published figure is for words, so its energy is taken in proportion.
fn energy_of(energy: &EnergyResult, job: &Job, kind: FaultKind, protection: Protection) -> Option<FigureRange> {
    const BITS: [&str; 5] = ["register", "buffer", "cache", "bus", "memory"];
    let items: &[&str] = match kind {
        FaultKind::Registers => &["register"],
        FaultKind::Buffer => &["buffer"],
        FaultKind::Memory => &["memory", "bus"],
        FaultKind::Bus => &["bus"],
        FaultKind::Results => &[],
        // No table has a figure for reading a program store, or for a counter.
        _ => return None,
    };
    let word = f64::from(job.machine.arithmetic.word);
    let more = match protection {
        Protection::Duplicated => 1.0,
        Protection::Residue => f64::from(protection.check_bits()) / word,
        _ => f64::from(protection.check_bits()) / 32.0,
    };
    let is_it = |item: &str| match kind {
        FaultKind::Results => !BITS.contains(&item),
        _ => items.contains(&item),
    };
    let sums = energy.tables.iter().map(|table| {
        more * table.lines.iter().filter(|line| is_it(line.item)).map(|line| line.nanojoules).sum::<f64>()
    });
    Some(FigureRange::of(sums))
}
