//! Cost of protections in storage, octets, clocks and energy, on the machine and the picture of a campaign: that of the machine which has the
//! protection, beside the same one without any.

use std::collections::BTreeMap;

use emu::inject::{FaultKind, Protection};
use emu::machine::Config;
use emu::machine::config::ProtectionConfig;
use emu::machine::config::formula::Dimension;
use schemars::JsonSchema;
use serde::Serialize;

use crate::drawing::{self, Comparison, Drawing};
use crate::energy::{EnergyResult, FigureRange, Prices, Pricing, nanojoules};
use crate::failure::Failure;
use crate::job::{Detail, Job};
use crate::protection::check_bits;

/// Cost of a protection, beside the same machine without any; all null where the machine cannot have it, since a slot of its bus is too short for a
/// beat with its check bits.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct ProtectionCost {
    /// Bits of storage that come in addition, of all cores and the main processor together.
    pub storage_bits: Option<u64>,
    /// Octets that go over the bus in addition, in a frame.
    pub octets: Option<u64>,
    /// Clocks that a frame takes in addition; less than 0 where what takes longer brings the requests of cores into a better order.
    pub clocks: Option<i64>,
    /// Clocks in addition as a share of the frame without protections.
    pub clocks_share: Option<f64>,
    /// Nanojoules that a frame takes in addition; null where nobody has a figure for the structure, neither a table nor the machine.
    pub energy_nj: Option<FigureRange>,
}

/// Costs of all protections that the structures may have, each by itself.
///
/// # Errors
/// A picture that cannot be drawn.
pub fn costs(job: &Job, kinds: &[FaultKind]) -> Result<BTreeMap<(FaultKind, Protection), ProtectionCost>, Failure> {
    let unprotected = Config { protection: ProtectionConfig::default(), ..job.machine.clone() };
    let plain = draw(job, &unprotected)?;
    let energy = energy(job, &unprotected, &plain);
    let plain_clocks = plain.frame.clocks.0;
    // Clocks of the frame by what they depend on: check bits on the bus, and the times of operations.
    let mut known: Vec<(Config, u64)> = vec![(unprotected.clone(), plain_clocks)];
    let mut found = BTreeMap::new();
    for (kind, protection) in kinds.iter().flat_map(|&kind| kind.protections().iter().map(move |&one| (kind, one))) {
        let mut machine = unprotected.clone();
        machine.protection.set(kind, protection);
        if machine.check().is_err() {
            found.insert((kind, protection), ProtectionCost::default());
            continue;
        }
        let is_alike = |other: &Config| {
            other.computes_like(&machine) && other.protection.moved_bits() == machine.protection.moved_bits()
        };
        let clocks = match known.iter().find(|(other, _)| is_alike(other)) {
            Some((_, clocks)) => *clocks,
            None => {
                let clocks = draw(job, &machine)?.frame.clocks.0;
                known.push((machine.clone(), clocks));
                clocks
            }
        };
        let more = clocks as i64 - plain_clocks as i64;
        let cost = ProtectionCost {
            storage_bits: Some(check_bits(&machine, plain.stored_words(), kind, protection)),
            octets: Some(machine.protection.check_octets(plain.frame.bus.moved).0),
            clocks: Some(more),
            clocks_share: Some(more as f64 / plain_clocks.max(1) as f64),
            energy_nj: (prices(&machine) != prices(&unprotected)).then(|| {
                // Counts are those of the frame without protections: what they do beside it is in the prices.
                let with = self::energy(job, &machine, &plain);
                let pairs = with.tables.iter().zip(&energy.tables);
                FigureRange::of(pairs.map(|(with, without)| nanojoules(with.attojoules - without.attojoules)))
            }),
        };
        found.insert((kind, protection), cost);
    }
    Ok(found)
}

/// Prices by each table. A protection shows in the formula of an item that somebody has a figure for, be it 0, and nowhere else.
fn prices(machine: &Config) -> Vec<Prices> {
    Pricing::all(machine, Dimension::Energy).iter().map(Pricing::prices).collect()
}

fn energy(job: &Job, machine: &Config, drawing: &Drawing) -> EnergyResult {
    EnergyResult::of(&Job { machine: machine.clone(), ..job.clone() }, drawing, None)
}

fn draw(job: &Job, machine: &Config) -> Result<Drawing, Failure> {
    let job = Job { machine: machine.clone(), detail: Detail::Totals, flags: false, ..job.clone() };
    drawing::draw(&job, Comparison::None, &mut |_| {})
}
