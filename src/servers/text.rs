//! Servers as tables for people, and as comma-separated values for other programs.

use super::{FrameDivision, PixelGoal, SceneHome, ServersCurve, ServersPoint, ServersResult};
use crate::csv;
use crate::numeral::{grouped, short};
use crate::table::{row, table};

/// The tables of all divisions, and table 3 of the report continued.
pub fn text(result: &ServersResult) -> String {
    let link = result.link;
    let home = match result.home {
        SceneHome::Copied => {
            format!("each server has a copy of the scene, {} octets", grouped(result.scene_octets))
        }
        SceneHome::Shared => "scene and frame lie in one memory behind the links".to_owned(),
    };
    let mut text = format!(
        "{}: {} x {} pixels, each server a machine `{}`; {home}\n\
         link: a latency of {} clocks, {} octets a clock; one machine takes {} clocks, {} us a pixel\n",
        result.scene,
        result.width,
        result.height,
        result.machine,
        grouped(link.latency_clocks),
        grouped(link.octets_per_clock),
        grouped(result.alone_clocks),
        microseconds(result.alone_pixel_seconds),
    );
    for curve in &result.curves {
        text += &format!("\n{}\n", named(curve));
        text += &curve_table(result, curve);
    }
    text + &table_3(result) + &verdict(result)
}

/// Words for a division.
pub(super) fn named(curve: &ServersCurve) -> String {
    let of = curve.tile.map_or_else(String::new, |[width, height]| format!("tiles of {width} x {height}"));
    match curve.division {
        FrameDivision::Tiles => of,
        FrameDivision::Rows => "bands of rows".to_owned(),
        FrameDivision::Stealing => format!("stealing {of}"),
    }
}

fn curve_table(result: &ServersResult, curve: &ServersCurve) -> String {
    let mut head = row([
        "servers",
        "parts",
        "a pixel",
        "first frame",
        "speed-up",
        "efficiency",
        "least busy",
        "mean",
        "port",
        "port octets",
    ]);
    // Only a shared memory has traffic of its own.
    let is_shared = result.home == SceneHome::Shared;
    head.extend(is_shared.then(|| "octets a clock".to_owned()));
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    // Give each number of servers a row; the first frame has the copies of the scene in it
    let cells = |point: &ServersPoint| {
        let first = point.first_clocks as f64 / result.clock_hz as f64 / pixels(result);
        let mut cells = vec![
            grouped(point.servers.into()),
            grouped(point.parts.into()),
            format!("{} us", microseconds(point.pixel_seconds)),
            format!("{} us", microseconds(first)),
            format!("{:.2}", point.speed_up),
            format!("{:.2}", point.efficiency),
            percent(point.least_busy),
            percent(point.mean_busy),
            percent(point.port_busy),
            short(point.port_octets),
        ];
        let shared = point.shared_octets_per_clock.map_or_else(|| "-".to_owned(), |octets| format!("{octets:.2}"));
        cells.extend(is_shared.then_some(shared));
        cells
    };
    table(std::iter::once(head).chain(curve.points.iter().map(cells)))
}

fn pixels(result: &ServersResult) -> f64 {
    f64::from(result.width) * f64::from(result.height)
}

/// Microseconds with four digits.
fn microseconds(seconds: f64) -> String {
    let time = 1e6 * seconds;
    let decimals = if time > 0.0 { (3.0 - time.log10().floor()).clamp(0.0, 6.0) as usize } else { 0 };
    format!("{time:.decimals$}")
}

/// Table 3 of the report with a line for each number of servers, of the division that is fastest with it.
fn table_3(result: &ServersResult) -> String {
    let mut rows = vec![row(["table 3", "servers", "resolution", "tested", "us a pixel"])];
    for peer in &result.table_3 {
        let [width, height] = peer.resolution;
        let size = format!("{width} x {height}");
        rows.push(vec![
            peer.name.clone(),
            peer.servers.to_string(),
            size,
            peer.primitive.clone(),
            peer.pixel_us.to_string(),
        ]);
    }
    let counts = result.curves.first().map(|curve| &curve.points[..]).unwrap_or_default();
    for (at, servers) in counts.iter().map(|point| point.servers).enumerate() {
        let of = |curve: &ServersCurve| curve.points[at].pixel_seconds;
        let best = result.curves.iter().min_by(|one, other| of(one).total_cmp(&of(other)));
        let Some(best) = best else { continue };
        let division = if servers == 1 { "whole frame".to_owned() } else { named(best) };
        let size = format!("{} x {}", result.width, result.height);
        let name = format!("`{}`, {division}", result.machine);
        rows.push(vec![name, grouped(servers.into()), size, "triangles".to_owned(), microseconds(of(best))]);
    }
    format!("\n{}", table(rows))
}

/// Sentence on the goal.
fn verdict(result: &ServersResult) -> String {
    let PixelGoal { pixel_seconds, ideal_servers, servers, limit, least_pixel_seconds } = result.goal;
    let goal = microseconds(pixel_seconds);
    let reached = match (servers, limit) {
        (Some(servers), _) => format!("{} reach it with the best of these divisions", grouped(servers.into())),
        (None, limit) => {
            let because = match limit {
                Some("link") => "requests and pixels alone take the link longer",
                Some("part") => "a single part takes longer",
                _ => "servers wait for the link and for each other",
            };
            format!(
                "no number of servers reaches it with these divisions, which come to {} us: {because}",
                microseconds(least_pixel_seconds)
            )
        }
    };
    format!("\n{goal} us a pixel: {} servers would do if dividing cost nothing; {reached}\n", grouped(ideal_servers))
}

/// A column of the comma-separated values: its head and what it holds.
type PointColumn = (&'static str, fn(&ServersCurve, &ServersPoint) -> String);

const COLUMNS: [PointColumn; 17] = [
    ("division", |curve, _| curve.division.name().to_owned()),
    ("tile_width", |curve, _| curve.tile.map_or_else(String::new, |tile| tile[0].to_string())),
    ("tile_height", |curve, _| curve.tile.map_or_else(String::new, |tile| tile[1].to_string())),
    ("servers", |_, point| point.servers.to_string()),
    ("parts", |_, point| point.parts.to_string()),
    ("clocks", |_, point| point.clocks.to_string()),
    ("first_clocks", |_, point| point.first_clocks.to_string()),
    ("seconds", |_, point| point.seconds.to_string()),
    ("pixel_seconds", |_, point| point.pixel_seconds.to_string()),
    ("speed_up", |_, point| point.speed_up.to_string()),
    ("efficiency", |_, point| point.efficiency.to_string()),
    ("least_busy", |_, point| point.least_busy.to_string()),
    ("mean_busy", |_, point| point.mean_busy.to_string()),
    ("port_octets", |_, point| point.port_octets.to_string()),
    ("port_busy", |_, point| point.port_busy.to_string()),
    ("bus_octets", |_, point| point.bus_octets.to_string()),
    ("shared_octets_per_clock", |_, point| point.shared_octets_per_clock.map_or_else(String::new, |x| x.to_string())),
];

/// One line a point, with a head; the columns have the names of the JSON's keys.
pub fn csv(result: &ServersResult) -> String {
    let points = result.curves.iter().flat_map(|curve| curve.points.iter().map(move |point| (curve, point)));
    let rows = points.map(|(curve, point)| COLUMNS.map(|(_, value)| value(curve, point)));
    csv::lines(COLUMNS.map(|(name, _)| name), rows)
}
