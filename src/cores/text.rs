//! A scaling as a table for people, and as comma-separated values for other programs.

use super::{CoresResult, Curve, Point};
use crate::csv;
use crate::numeral::grouped;
use crate::summary::operation_times;
use crate::table::{row, table};

/// The tables of all machines.
pub fn text(scaling: &CoresResult) -> String {
    let parts: Vec<String> = scaling.machines.iter().map(|curve| one(scaling, curve)).collect();
    parts.join("\n")
}

fn one(scaling: &CoresResult, curve: &Curve) -> String {
    let head = ["cores", "a pixel", "no waiting", "queueing", "speed-up", "bus", "waiting", "idle", "main", ""];
    let mut rows = vec![row(head)];
    let mut was_saturated = false;
    for point in &curve.points {
        let is_knee = point.is_saturated && !was_saturated;
        was_saturated = point.is_saturated;
        rows.push(cells(point, is_knee));
    }
    format!(
        "{}: {} pixels on machine `{}`, arbiter {}{}\n{}{}{}",
        scaling.scene,
        grouped(scaling.pixels),
        curve.machine,
        curve.arbiter,
        curve.arbiter_note.map_or(String::new(), |note| format!(" ({note})")),
        operation_times(&curve.timing),
        table(rows),
        verdict(scaling, curve),
    )
}

fn cells(point: &Point, is_knee: bool) -> Vec<String> {
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    vec![
        point.cores.to_string(),
        milliseconds(point.pixel_seconds),
        milliseconds(point.bound_pixel_seconds),
        milliseconds(point.queueing_pixel_seconds),
        format!("{:.2}", point.speed_up),
        percent(point.utilisation),
        percent(point.waiting),
        percent(point.idle),
        percent(point.main_load),
        if is_knee { "knee" } else { "" }.to_owned(),
    ]
}

fn milliseconds(seconds: f64) -> String {
    format!("{:.4} ms", 1e3 * seconds)
}

/// Sentence on the number of cores: the curve beside what others say.
fn verdict(scaling: &CoresResult, curve: &Curve) -> String {
    let clocks = |clocks: f64| grouped(clocks.round() as u64);
    let number = |cores: Option<f64>| cores.map_or("none".to_owned(), |cores| format!("{cores:.2}"));
    let measured = match curve.saturation {
        None => "more cores than these still bring more".to_owned(),
        Some(saturation) => {
            format!(
                "{:.2} cores, {}",
                saturation.cores,
                match saturation.limit {
                    "bus" => "where the bus is full",
                    "main-processor" => "where the main processor has no time left",
                    "arbiter" => "where cores wait for their turns though the bus has room",
                    _ => "though neither bus nor main processor is full",
                }
            ) + &starved(curve)
        }
    };
    format!(
        "a pixel on one core: C = {} clocks of computing, M = {} of the bus\n\
         saturation: {measured}\n\
         expected: (C + M) / M = {}, C / M = {}, the report's C / M = {:.2}\n",
        clocks(curve.demand.computing),
        clocks(curve.demand.transfer),
        number(curve.closed_form),
        number(curve.quotient),
        scaling.report_quotient,
    )
}

/// Share of the frame that the main processor waits for the bus from which it is told.
const STARVED: f64 = 0.5;

/// Share of the cores' clocks without a pixel from which that matters.
const IDLE: f64 = 0.1;

/// Sentence on a main processor that hands out no pixels because it does not get the bus.
fn starved(curve: &Curve) -> String {
    let starved = |point: &&Point| point.main_waiting >= STARVED && point.idle >= IDLE;
    curve.points.last().filter(starved).map_or(String::new(), |point| {
        format!("; the main processor, which feeds the cores, waits for it {:.1} %", 100.0 * point.main_waiting)
    })
}

/// The energies and areas of all machines, number of cores by number of cores.
pub fn energy_text(scaling: &CoresResult) -> String {
    let one = |curve: &Curve| {
        let mut rows = vec![row(["cores", "nJ a pixel", "energy x delay in J s", "cores' area in um2", "larger part"])];
        rows.extend(curve.points.iter().map(|point| {
            let energy = &point.energy;
            let [pixel, delay, area] =
                [energy.pixel_nj, energy.energy_delay_js, energy.area_um2].map(|range| range.to_string());
            vec![point.cores.to_string(), pixel, delay, area, energy.decides.to_owned()]
        }));
        format!(
            "\n{}: energy and area on machine `{}`, by the published tables (docs/energy.md)\n{}",
            scaling.scene,
            curve.machine,
            table(rows)
        )
    };
    scaling.machines.iter().map(one).collect()
}

/// A column of the comma-separated values: its head and what it holds.
type Column = (&'static str, fn(&Curve, &Point) -> String);

const COLUMNS: [Column; 25] = [
    ("machine", |curve, _| csv::quoted(&curve.machine)),
    ("arbiter", |curve, _| curve.arbiter.clone()),
    ("cores", |_, point| point.cores.to_string()),
    ("clocks", |_, point| point.clocks.to_string()),
    ("seconds", |_, point| point.seconds.to_string()),
    ("pixel_seconds", |_, point| point.pixel_seconds.to_string()),
    ("speed_up", |_, point| point.speed_up.to_string()),
    ("utilisation", |_, point| point.utilisation.to_string()),
    ("waiting", |_, point| point.waiting.to_string()),
    ("idle", |_, point| point.idle.to_string()),
    ("longest_wait", |_, point| point.longest_wait.to_string()),
    ("main_load", |_, point| point.main_load.to_string()),
    ("main_waiting", |_, point| point.main_waiting.to_string()),
    ("bound_pixel_seconds", |_, point| point.bound_pixel_seconds.to_string()),
    ("queueing_pixel_seconds", |_, point| point.queueing_pixel_seconds.to_string()),
    ("operations_per_second", |_, point| point.operations_per_second.to_string()),
    ("peak_operations_per_second", |_, point| point.peak_operations_per_second.to_string()),
    ("operations_per_octet", |_, point| point.operations_per_octet.map_or_else(String::new, |x| x.to_string())),
    ("method", |_, point| point.method.to_owned()),
    ("frame_nj_least", |_, point| point.energy.frame_nj.least.to_string()),
    ("frame_nj_most", |_, point| point.energy.frame_nj.most.to_string()),
    ("energy_delay_js_least", |_, point| point.energy.energy_delay_js.least.to_string()),
    ("energy_delay_js_most", |_, point| point.energy.energy_delay_js.most.to_string()),
    ("area_um2_least", |_, point| point.energy.area_um2.least.to_string()),
    ("area_um2_most", |_, point| point.energy.area_um2.most.to_string()),
];

/// One line a point, with a head; the columns have the names of the JSON's keys.
pub fn csv(scaling: &CoresResult) -> String {
    let points = scaling.machines.iter().flat_map(|curve| curve.points.iter().map(move |point| (curve, point)));
    let rows = points.map(|(curve, point)| COLUMNS.map(|(_, value)| value(curve, point)));
    csv::lines(COLUMNS.map(|(name, _)| name), rows)
}
