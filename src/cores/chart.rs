//! A scaling as charts: speed-up and shares of time by cores, one row a machine; and the roofline of the bus.

use super::{CoresResult, Curve, Point};
use crate::chart::{AxisKind, ChartAxis, ChartFigure, ChartLine, ChartPoint, ChartSeries, Look, Plot, PointLabel};
use crate::numeral::grouped;

/// Speed-up by cores to the left, shares of time to the right, one row a machine.
pub fn figure(scaling: &CoresResult) -> ChartFigure {
    let rows = scaling.machines.iter().map(|curve| vec![speed_up(scaling, curve), shares(curve)]);
    ChartFigure { title: title(scaling, "speed-up by cores"), note: String::new(), rows: rows.collect() }
}

fn title(scaling: &CoresResult, what: &str) -> String {
    let mut machines: Vec<String> = scaling.machines.iter().map(|curve| format!("`{}`", curve.machine)).collect();
    machines.dedup();
    let noun = if machines.len() == 1 { "machine" } else { "machines" };
    format!("{}: {what}, {noun} {}, {} pixels", scaling.scene, machines.join(", "), grouped(scaling.pixels))
}

fn named(curve: &Curve) -> String {
    format!("machine `{}`, arbiter {}", curve.machine, curve.arbiter)
}

fn series(name: &str, number: usize, line: ChartLine, points: impl Iterator<Item = (f64, f64)>) -> ChartSeries {
    ChartSeries {
        name: name.to_owned(),
        look: Look::Numbered(number),
        line,
        is_marked: line == ChartLine::Solid,
        points: points.map(|(x, y)| ChartPoint::new(x, y)).collect(),
    }
}

/// A line upwards with its name at the upper end.
fn upright(name: &str, line: ChartLine, x: f64, height: f64, words: String) -> ChartSeries {
    let label = PointLabel { words, is_important: true };
    let top = ChartPoint { label: Some(label), ..ChartPoint::new(x, height) };
    let points = vec![ChartPoint::new(x, 0.0), top];
    ChartSeries { name: name.to_owned(), look: Look::Muted, line, is_marked: false, points }
}

/// Measured speed-ups with marks, beside what theory expects; the knee and the report's quotient upright.
fn speed_up(scaling: &CoresResult, curve: &Curve) -> Plot {
    // Turn times into speed-ups over the same machine with one core.
    let alone = curve.points.first().map_or(0.0, |point| point.pixel_seconds);
    let against = |seconds: fn(&Point) -> f64| {
        let ratio = move |point: &Point| match seconds(point) {
            seconds if seconds > 0.0 => alone / seconds,
            _ => 0.0,
        };
        curve.points.iter().map(move |point| (f64::from(point.cores), ratio(point)))
    };
    let highest = curve.points.iter().map(|point| point.speed_up).fold(1.0, f64::max);
    let most = curve.points.iter().map(|point| f64::from(point.cores)).fold(1.0, f64::max);
    let mut all = vec![
        series("closed form, max((C + M) / N, M)", 1, ChartLine::Dashed, against(|point| point.bound_pixel_seconds)),
        series("queueing estimate", 2, ChartLine::Dotted, against(|point| point.queueing_pixel_seconds)),
    ];
    // A quotient beyond the measured cores would only make the plot wider.
    if scaling.report_quotient <= most {
        let words = format!("C / M = {:.2}", scaling.report_quotient);
        all.push(upright("the report's C / M", ChartLine::Dotted, scaling.report_quotient, 0.35 * highest, words));
    }
    if let Some(saturation) = curve.saturation {
        let words = format!("{:.2} cores", saturation.cores);
        all.push(upright("knee", ChartLine::Dashed, saturation.cores, 0.6 * highest, words));
    }
    let measured = curve.points.iter().map(|point| (f64::from(point.cores), point.speed_up));
    all.push(series("measured", 0, ChartLine::Solid, measured));
    Plot {
        title: named(curve),
        x: ChartAxis { name: "cores".to_owned(), kind: AxisKind::FromZero },
        y: ChartAxis { name: "times one core".to_owned(), kind: AxisKind::FromZero },
        series: all,
        aspect: 0.62,
    }
}

/// Shares of the frame and of the cores' time, in per cent.
fn shares(curve: &Curve) -> Plot {
    let of =
        |share: fn(&Point) -> f64| curve.points.iter().map(move |point| (f64::from(point.cores), 100.0 * share(point)));
    Plot {
        title: "shares of time".to_owned(),
        x: ChartAxis { name: "cores".to_owned(), kind: AxisKind::FromZero },
        y: ChartAxis { name: "%".to_owned(), kind: AxisKind::FromZero },
        series: vec![
            series("cores idle", 5, ChartLine::Solid, of(|point| point.idle)),
            series("cores waiting", 4, ChartLine::Solid, of(|point| point.waiting)),
            series("bus busy", 3, ChartLine::Solid, of(|point| point.utilisation)),
        ],
        aspect: 0.62,
    }
}

/// Operations an octet of the bus against operations a second. Below a slanted roof the bus holds a machine up, below a level one its cores
/// do; the level one is that of the most cores.
pub fn roofline(scaling: &CoresResult) -> ChartFigure {
    let all = || scaling.machines.iter().flat_map(|curve| &curve.points);
    let intensities = || all().filter_map(|point| point.operations_per_octet).filter(|&x| x > 0.0);
    let (least, most) = (intensities().fold(f64::INFINITY, f64::min), intensities().fold(0.0, f64::max));
    let mut curves = Vec::new();
    for (number, curve) in scaling.machines.iter().enumerate() {
        let Some(last) = curve.points.last().filter(|_| most > 0.0) else { continue };
        // The roofs around all intensities and the corner where they meet.
        let (bus, level) = (curve.bus_octets_per_second, last.peak_operations_per_second);
        let corner = level / bus;
        let roof = [least.min(corner) / 2.0, corner, most.max(corner) * 2.0].map(|x| (x, (x * bus).min(level) / 1e6));
        curves.push(series(&format!("roof of {}", named(curve)), number, ChartLine::Dashed, roof.into_iter()));
        let points = curve.points.iter().filter_map(|point| {
            let label = Some(PointLabel { words: point.cores.to_string(), is_important: false });
            let place = ChartPoint::new(point.operations_per_octet?, point.operations_per_second / 1e6);
            Some(ChartPoint { label, tip: format!("{} cores", point.cores), ..place })
        });
        curves.push(ChartSeries {
            name: format!("{}, by cores", named(curve)),
            look: Look::Numbered(number),
            line: ChartLine::None,
            is_marked: true,
            points: points.collect(),
        });
    }
    let plot = Plot {
        title: String::new(),
        x: ChartAxis { name: "operations an octet of the bus".to_owned(), kind: AxisKind::Logarithmic },
        y: ChartAxis { name: "million operations a second".to_owned(), kind: AxisKind::Logarithmic },
        series: curves,
        aspect: 0.6,
    };
    ChartFigure { title: title(scaling, "roofline of the bus"), note: String::new(), rows: vec![vec![plot]] }
}
