//! Time of a load by the number of cores, measured on several machines, beside what theory expects. What is
//! printed or drawn of it is said in the files below.

#[cfg(feature = "cli")]
mod chart;
mod demand;
mod points;
#[cfg(feature = "cli")]
mod text;

use emu::code::Code;
use emu::machine::config::protection::WORD_BITS;
use emu::machine::{self, Config, RunOutcome};
use schemars::JsonSchema;
use serde::Serialize;

#[cfg(feature = "cli")]
pub use chart::{figure, roofline};
pub use demand::PixelDemand;
pub use points::{drawn, study};
#[cfg(feature = "cli")]
pub use text::{csv, energy_text, text};

use crate::energy::{EnergyResult, EnergySummary};
use crate::failure::Failure;
use crate::load::{ANNEX, Load};
use crate::machine::arbiter_note;
use crate::numeral::share;
use crate::result::{FormatTable, OperationTimes};
use crate::settings::MachineSettings;
use crate::sweep::frames::PictureFrames;

/// Version of [`CoresResult`]: a key that goes away or changes its meaning changes it, a new key does not.
pub const SCHEMA: &str = "lancer-cores-1";

/// A load on several machines, each with several numbers of cores.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct CoresResult {
    /// Version of the result: a key that goes away or changes its meaning changes it, a new key does not.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: &'static str,
    /// Name of the scene, or `annex`.
    pub scene: String,
    /// Pixels.
    pub pixels: u64,
    /// C / M of the report, 203,000 / 49,600.
    pub report_quotient: f64,
    /// The machines.
    pub machines: Vec<Curve>,
}

/// A machine with several numbers of cores.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Curve {
    /// Name of the machine.
    pub machine: String,
    /// Name of its arbiter.
    pub arbiter: String,
    /// Reason for which the arbiter does what another one does; null where it does not.
    pub arbiter_note: Option<&'static str>,
    /// Bits of a word and fraction bits of each quantity; null for `annex`, whose pixels only take time.
    pub formats: Option<FormatTable>,
    /// Clock rate in hertz.
    pub clock_hz: u64,
    /// Clocks and units of operations.
    pub timing: OperationTimes,
    /// Octets that the bus moves in a second when it is never idle, without set-up clocks.
    pub bus_octets_per_second: f64,
    /// Demand of a pixel with one core: of the core, and of the bus, messages and the main processor's share included.
    pub demand: PixelDemand,
    /// C / M.
    pub quotient: Option<f64>,
    /// (C + M) / M.
    pub closed_form: Option<f64>,
    /// Number of cores beyond which more bring no more, as measured.
    pub saturation: Option<Saturation>,
    /// One number of cores each, the fewest first; the first is one core.
    pub points: Vec<Point>,
}

/// The point from which more cores bring no more.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Saturation {
    /// Number of cores at which the straight line of the first cores reaches the highest speed-up.
    pub cores: f64,
    /// Cause that holds the cores up: `bus` and `main-processor` are used up; `arbiter` leaves the bus idle while cores wait for
    /// their turns; `other` when the pixels or the messages set the pace.
    pub limit: &'static str,
}

/// A machine with one number of cores.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Point {
    /// Cores.
    pub cores: u32,
    /// Length of the frame in clocks.
    pub clocks: u64,
    /// Length of the frame in seconds.
    pub seconds: f64,
    /// Seconds a pixel.
    pub pixel_seconds: f64,
    /// Speed relative to one core.
    pub speed_up: f64,
    /// Share of the frame in which the bus was busy.
    pub utilisation: f64,
    /// Share of the cores' clocks in which they waited for the bus.
    pub waiting: f64,
    /// Share of the cores' clocks in which they had nothing to do.
    pub idle: f64,
    /// Longest wait from a request to its grant, in clocks.
    pub longest_wait: u64,
    /// Share of the frame in which the main processor computed.
    pub main_load: f64,
    /// Share of the frame in which the main processor waited for the bus, and so fed nobody.
    pub main_waiting: f64,
    /// Least seconds a pixel, if nobody waited for the bus: max((C + T) / N, M), with T the cores' part of the transfers M.
    pub bound_pixel_seconds: f64,
    /// Seconds a pixel by the queueing estimate.
    pub queueing_pixel_seconds: f64,
    /// Elementary operations of the cores in a second.
    pub operations_per_second: f64,
    /// Elementary operations in a second if no core ever waited or were idle.
    pub peak_operations_per_second: f64,
    /// Elementary operations of the cores for each octet that the bus moved; null where it moved none.
    pub operations_per_octet: Option<f64>,
    /// `replayed`, or `stepped`.
    pub method: &'static str,
    /// Energy and area, as a range over published tables.
    pub energy: EnergySummary,
    /// True where the machine is saturated from this number of cores on.
    pub is_saturated: bool,
}

/// Gain in speed-up by one more core below which a curve counts as level.
const LEVEL: f64 = 0.1;

/// Share of the frame from which the bus counts as full.
const FULL: f64 = 0.98;

/// Numbers of cores that are measured, the fewest first: one core is the measure of all others, so it is always among them.
pub fn numbers(cores: &[u32]) -> Vec<u32> {
    let mut cores: Vec<u32> = std::iter::once(1).chain(cores.iter().copied()).collect();
    cores.sort_unstable();
    cores.dedup();
    cores
}

/// Measures the report's estimate: each machine with one core and with each of the numbers of cores. Whatever only differs in time is computed
/// once.
///
/// # Errors
/// A machine out of its ranges, or a trap.
pub fn estimate(
    machines: &[MachineSettings],
    cores: &[u32],
    progress: &mut dyn FnMut(u64),
) -> Result<CoresResult, Failure> {
    let (load, cores) = (Load::annex()?, numbers(cores));
    let with = |MachineSettings { config, .. }: &MachineSettings| {
        cores.iter().map(|&cores| Config { cores, ..config.clone() }).collect::<Vec<_>>()
    };
    let configs: Vec<Config> = machines.iter().flat_map(with).collect();
    if configs.is_empty() {
        return Err(no_machine());
    }
    let frames = PictureFrames::new(&load, None).run(&configs, progress);
    let frames = frames.into_iter().collect::<Result<Vec<RunOutcome>, _>>()?;
    // Frames come back in the order of the configurations: machine by machine, fewest cores first.
    let curves = machines.iter().zip(frames.chunks(cores.len())).map(|(machine, frames)| {
        let frames: Vec<(u32, &RunOutcome)> = cores.iter().copied().zip(frames).collect();
        curve(machine, &load, &frames)
    });
    Ok(result(ANNEX, frames[0].item_count, curves.collect()))
}

fn no_machine() -> Failure {
    Failure::usage(messages::Diagnostic::error("no machine was named"))
}

/// The result of curves.
fn result(scene: &str, pixels: u64, machines: Vec<Curve>) -> CoresResult {
    CoresResult {
        schema: SCHEMA,
        scene: scene.to_owned(),
        pixels,
        report_quotient: PixelDemand::report().quotient().unwrap_or_default(),
        machines,
    }
}

/// The curve of a machine from its frames, that of one core first.
fn curve(machine: &MachineSettings, load: &Load, frames: &[(u32, &RunOutcome)]) -> Curve {
    let MachineSettings { name, config } = machine;
    let (_, alone) = frames[0];
    let pixels = alone.item_count.max(1) as f64;
    // Computing and transfers of a pixel, as one core shows them.
    let demand = PixelDemand {
        computing: alone.processors[0].busy.0 as f64 / pixels,
        transfer: alone.bus.busy.0 as f64 / pixels,
    };
    let mut points: Vec<Point> = frames
        .iter()
        .map(|&(cores, frame)| point(&Config { cores, ..config.clone() }, load, frame, alone, &demand))
        .collect();
    let code = Code::new(&load.build.cores, &load.isa, config.timing());
    for (point, (_, frame)) in points.iter_mut().zip(frames) {
        roofs(point, frame, frame.tally.counts(&code).elementary(), config.clock_hz);
    }
    let saturation = saturation(&points);
    for point in &mut points {
        point.is_saturated = saturation.is_some_and(|saturation| f64::from(point.cores) >= saturation.cores);
    }
    Curve {
        machine: name.clone(),
        arbiter: config.bus.arbiter.name().to_owned(),
        arbiter_note: arbiter_note(config),
        formats: load.formats.as_ref().map(FormatTable::from),
        clock_hz: config.clock_hz,
        timing: OperationTimes::new(config),
        // Check bits take their share of the beats.
        bus_octets_per_second: config.clock_hz as f64 * config.bus.octets_per_beat as f64
            / config.bus.clocks_per_beat as f64
            * (f64::from(WORD_BITS) / f64::from(WORD_BITS + config.protection.moved_bits())),
        demand,
        quotient: demand.quotient(),
        closed_form: demand.saturation(),
        saturation,
        points,
    }
}

fn point(config: &Config, load: &Load, frame: &RunOutcome, alone: &RunOutcome, demand: &PixelDemand) -> Point {
    let (cores, clock_hz, overlaps) = (config.cores, config.clock_hz, config.bus.overlap);
    let (workers, main) = frame.processors.split_at(cores as usize);
    let sum = |part: fn(&machine::ProcessorUse) -> u64| workers.iter().map(part).sum::<u64>();
    let whole = frame.clocks.0 * u64::from(cores);
    let seconds = |clocks: f64| clocks / clock_hz as f64;
    let main_busy = main.iter().map(|main| main.busy.0).sum();
    let main_waiting = main.iter().map(|main| main.waiting.0).sum::<u64>();
    // The cores' own transfers: all of the bus but what the main processor waited for, which has its transfers in it.
    let pixels = frame.item_count.max(1) as f64;
    // A core that computes while its transfer goes on may hide all of it.
    let own = match overlaps {
        true => 0,
        false => frame.bus.busy.0.saturating_sub(main_waiting),
    };
    let own = PixelDemand { computing: sum(|used| used.busy.0) as f64 / pixels, transfer: own as f64 / pixels };
    let bound = own.bound(cores).max(frame.bus.busy.0 as f64 / pixels);
    Point {
        cores,
        clocks: frame.clocks.0,
        seconds: frame.seconds(clock_hz),
        pixel_seconds: frame.seconds(clock_hz) / frame.item_count.max(1) as f64,
        speed_up: share(alone.clocks.0, frame.clocks.0),
        utilisation: frame.utilisation(),
        waiting: share(sum(|used| used.waiting.0), whole),
        idle: share(sum(|used| used.idle.0), whole),
        longest_wait: frame.bus.longest_wait.0,
        main_load: share(main_busy, frame.clocks.0),
        main_waiting: share(main_waiting, frame.clocks.0),
        bound_pixel_seconds: seconds(bound),
        queueing_pixel_seconds: seconds(demand.queueing(cores)),
        operations_per_second: 0.0,
        peak_operations_per_second: 0.0,
        operations_per_octet: None,
        method: frame.method.name(),
        energy: EnergyResult::new(config, load.programs(), frame, frame.item_count, None).summary,
        is_saturated: false,
    }
}

/// Operations of a frame against what its cores and its bus could do.
fn roofs(point: &mut Point, frame: &RunOutcome, operations: u64, clock_hz: u64) {
    let busy: u64 = frame.processors[..point.cores as usize].iter().map(|core| core.busy.0).sum();
    let hertz = clock_hz as f64;
    point.operations_per_second = share(operations, frame.clocks.0) * hertz;
    point.peak_operations_per_second = share(operations, busy) * f64::from(point.cores) * hertz;
    point.operations_per_octet = (frame.bus.moved.0 != 0).then(|| share(operations, frame.bus.moved.0));
}

/// The point where the curve levels off; `None` where it still rises at its end though the bus has room, or has no end to speak of.
fn saturation(points: &[Point]) -> Option<Saturation> {
    let [.., before, last] = points else { return None };
    // A curve that still rises at its end has a knee only where the bus is full already.
    let gain = (last.speed_up - before.speed_up) / f64::from(last.cores - before.cores);
    if gain >= LEVEL && last.utilisation < FULL {
        return None;
    }
    let highest = points.iter().max_by(|one, other| one.speed_up.total_cmp(&other.speed_up))?;
    // Both may be nearly full; the one that is fuller holds the others up. Where neither is, cores that wait do so for their turns.
    let limit = match (last.utilisation, last.main_load) {
        (busy, main) if busy >= 0.95 && busy >= main => "bus",
        (_, main) if main >= 0.9 => "main-processor",
        (busy, _) if busy >= 0.9 => "bus",
        _ if last.waiting >= 0.5 => "arbiter",
        _ => "other",
    };
    Some(Saturation { cores: highest.speed_up, limit })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn limit(change: impl Fn(&mut Point)) -> Option<&'static str> {
        let point = |cores: u32, speed_up: f64| {
            let mut point = Point {
                cores,
                clocks: 100,
                seconds: 1.0,
                pixel_seconds: 1.0,
                speed_up,
                utilisation: 0.5,
                waiting: 0.1,
                idle: 0.1,
                longest_wait: 1,
                main_load: 0.1,
                main_waiting: 0.1,
                bound_pixel_seconds: 1.0,
                queueing_pixel_seconds: 1.0,
                operations_per_second: 0.0,
                peak_operations_per_second: 0.0,
                operations_per_octet: None,
                method: "replayed",
                energy: EnergySummary::default(),
                is_saturated: false,
            };
            change(&mut point);
            point
        };
        saturation(&[point(1, 1.0), point(8, 4.0), point(9, 4.0)]).map(|saturation| saturation.limit)
    }

    #[test]
    fn what_holds_cores_up_is_named() {
        assert_eq!(limit(|point| point.utilisation = 0.999), Some("bus"));
        // A main processor that waits for a full bus has time: it is the bus that is full.
        assert_eq!(limit(|point| (point.utilisation, point.main_waiting) = (0.999, 0.98)), Some("bus"));
        assert_eq!(limit(|point| point.main_load = 0.97), Some("main-processor"));
        assert_eq!(limit(|point| (point.utilisation, point.waiting) = (0.7, 0.8)), Some("arbiter"));
        assert_eq!(limit(|_| ()), Some("other"));
    }
}
