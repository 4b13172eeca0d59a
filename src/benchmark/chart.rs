//! Times a pixel as a chart: scenes side by side, a mark for each who computed them, on a logarithmic axis.

use super::{BenchResult, Runner};
use crate::chart::{AxisKind, ChartAxis, ChartFigure, ChartLine, ChartPoint, ChartSeries, Look, Plot};

/// The chart of measurements, with pictures of a size and host threads.
pub fn figure(measured: &[BenchResult], (width, height): (u32, u32), threads: u32) -> ChartFigure {
    // Name the places along the axis; runners of one place follow each other, so comparing neighbours is enough
    let place = |one: &BenchResult| format!("{} ({})", one.scene, one.profile);
    let mut places: Vec<String> = measured.iter().map(place).collect();
    places.dedup();
    // Draw the points of each runner, without lines: places have no order
    let series = Runner::ALL.into_iter().enumerate().map(|(number, runner)| {
        let of_runner = measured.iter().filter(|one| one.runner == runner);
        let points = of_runner.filter_map(|one| {
            let at = places.iter().position(|name| *name == place(one))?;
            let tip = format!("{}, {}: {:.0} ns", place(one), runner.name(), one.nanoseconds);
            Some(ChartPoint { tip, ..ChartPoint::new(at as f64, one.nanoseconds) })
        });
        ChartSeries {
            name: runner.name().to_owned(),
            look: Look::Numbered(number),
            line: ChartLine::None,
            is_marked: true,
            points: points.collect(),
        }
    });
    let plot = Plot {
        title: String::new(),
        x: ChartAxis { name: String::new(), kind: AxisKind::Names(places.clone()) },
        y: ChartAxis { name: "nanoseconds a pixel".to_owned(), kind: AxisKind::Logarithmic },
        series: series.collect(),
        aspect: 0.55,
    };
    let threads = if threads == 1 { "one host thread".to_owned() } else { format!("{threads} host threads") };
    ChartFigure {
        title: format!("Time on this host, {width} x {height} pixels, machine `report`, {threads}"),
        note: String::new(),
        rows: vec![vec![plot]],
    }
}

/// One line a measurement, with a head.
pub fn csv(measured: &[BenchResult]) -> String {
    let mut text = String::from("scene,profile,runner,nanoseconds,least,of_twin,rays\n");
    for one in measured {
        let scene = one.scene.replace('"', "\"\"");
        let (runner, BenchResult { profile, nanoseconds, least, of_twin, rays, .. }) = (one.runner.name(), one);
        text += &format!("\"{scene}\",{profile},\"{runner}\",{nanoseconds},{least},{of_twin},{rays}\n");
    }
    text
}
