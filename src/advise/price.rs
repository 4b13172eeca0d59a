//! Price of a change: memory in octets, area by the published tables, and hardware that is counted but not weighed.

use emu::machine::Config;
use emu::machine::arbiter::ArbiterKind;
use emu::machine::config::formula::Dimension;
use isa::Class;
use schemars::JsonSchema;
use serde::Serialize;

use super::change::{Change, PictureOption};
use crate::energy::{FigureRange, Pricing, TableArea};
use crate::job::Job;
use crate::numeral::count;

/// Price of a change, against the machine as it is.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Price {
    /// Octets of memory in the cores: buffers and caches of all of them, without tags; below 0 where there are fewer. A core that goes on during
    /// its loads has its buffer twice.
    pub local_octets: i64,
    /// Octets of global memory.
    pub global_octets: i64,
    /// Area of the cores in square micrometres, least and most by the tables of the machine: units, registers, buffers and caches; `None` where
    /// nothing is known of what the change adds.
    pub area_um2: Option<FigureRange>,
    /// Other hardware in words; empty for none.
    pub hardware: String,
}

/// Square micrometres of all cores, by each table. A core that goes on during its loads has its buffer twice.
fn areas(machine: &Config) -> Vec<f64> {
    let buffers = if machine.bus.overlap { 2 } else { 1 };
    let built = Config { buffer_octets: buffers * machine.buffer_octets, ..machine.clone() };
    Pricing::all(&built, Dimension::Area).iter().map(|pricing| TableArea::new(pricing, &built).cores_um2).collect()
}

/// Area that a machine has more than another one. Where none of what differs is in the area of cores, nothing is known of it.
fn more_area(machine: &Config, base: &Config, hardware: &[String]) -> Option<FigureRange> {
    let range = FigureRange::of(areas(machine).iter().zip(areas(base)).map(|(then, now)| then - now));
    let is_unknown = range == FigureRange::default() && !hardware.is_empty();
    (!is_unknown).then_some(range)
}

/// Octets of the memories in all cores.
fn local_octets(machine: &Config) -> i64 {
    let buffers = if machine.bus.overlap { 2 } else { 1 };
    let one = buffers * i64::from(machine.buffer_octets) + i64::from(machine.cache.octets);
    i64::from(machine.cores) * one
}

impl Price {
    /// The price of a change that leads to `machine`.
    pub(super) fn new(job: &Job, machine: &Config, change: &Change, global_octets: i64) -> Price {
        let base = &job.machine;
        let (now, then) = (base.timing(), machine.timing());
        let mut hardware = Vec::new();
        let lines = machine.bus.octets_per_beat.saturating_sub(base.bus.octets_per_beat).saturating_mul(8);
        if lines != 0 {
            hardware.push(count(lines, "data line", "data lines"));
        }
        if machine.cores > base.cores {
            hardware.push(count((machine.cores - base.cores).into(), "core", "cores"));
        }
        // Units of each class, in every core.
        let more = |class: Class| then.units[class].saturating_sub(now.units[class]) * u64::from(machine.cores);
        let units = Class::ALL.iter().map(|&class| (class, more(class))).filter(|&(_, units)| units != 0);
        hardware.extend(units.map(|(class, units)| count(units, &unit(class, ""), &unit(class, "s"))));
        let faster = Class::ALL.iter().filter(|&&class| then.clocks[class] < now.clocks[class]);
        hardware.extend(faster.map(|class| format!("faster {}", class.name())));
        if machine.bus.arbiter != base.bus.arbiter && machine.bus.arbiter != ArbiterKind::default() {
            hardware.push(format!("arbiter {}", machine.bus.arbiter.name()));
        }
        for option in &change.options {
            if let PictureOption::Profile(set) = option {
                hardware.push(format!("instructions of {}", set.name()));
            }
        }
        Price {
            local_octets: local_octets(machine) - local_octets(base),
            global_octets,
            area_um2: more_area(machine, base, &hardware),
            hardware: hardware.join(", "),
        }
    }
}

fn unit(class: Class, end: &str) -> String {
    format!("unit{end} for {}", class.name())
}
