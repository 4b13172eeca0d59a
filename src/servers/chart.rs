//! Servers as a chart: speed-up to the left, how busy servers and port are to the right.

use super::text::named;
use super::{SceneHome, ServersCurve, ServersPoint, ServersResult};
use crate::chart::{AxisKind, ChartAxis, ChartFigure, ChartLine, ChartPoint, ChartSeries, Look, Plot};

/// Speed-up by servers, one curve a division, beside the shares of time.
pub fn figure(result: &ServersResult) -> ChartFigure {
    let title = format!(
        "{}: speed-up by servers, each a machine `{}`, {} x {} pixels",
        result.scene, result.machine, result.width, result.height
    );
    let note = format!(
        "scene {}; link: latency {} clocks, {} octets a clock",
        match result.home {
            SceneHome::Copied => "copied to each server",
            SceneHome::Shared => "shared behind the links",
        },
        result.link.latency_clocks,
        result.link.octets_per_clock
    );
    let share = |name: &str, of: fn(&ServersPoint) -> f64| plot(result, name, "%", of);
    let rows = vec![vec![
        plot(result, "speed-up", "times one server", |point| point.speed_up),
        share("servers that draw", |point| 100.0 * point.mean_busy),
    ]];
    ChartFigure { title, note, rows }
}

fn plot(result: &ServersResult, title: &str, unit: &str, of: fn(&ServersPoint) -> f64) -> Plot {
    let series = |(number, curve): (usize, &ServersCurve)| ChartSeries {
        name: named(curve),
        look: Look::Numbered(number),
        line: ChartLine::Solid,
        is_marked: true,
        points: curve.points.iter().map(|point| ChartPoint::new(point.servers.into(), of(point))).collect(),
    };
    Plot {
        title: title.to_owned(),
        x: ChartAxis { name: "servers".to_owned(), kind: AxisKind::Logarithmic },
        y: ChartAxis { name: unit.to_owned(), kind: AxisKind::FromZero },
        series: result.curves.iter().enumerate().map(series).collect(),
        aspect: 0.62,
    }
}
