//! Points of a study as a chart: two columns, a look a group, the front as a line.

use messages::{Diagnostic, Report};

use super::front::FrontPoint;
use crate::chart::{
    self, AxisKind, ChartAxis, ChartFigure, ChartLine, ChartPoint, ChartSeries, ChartStyle, Look, Plot,
};

/// The chart as an SVG file; axes are logarithmic where all values are above 0 and differ by more than a factor of 10.
///
/// # Errors
/// No point to draw.
pub fn svg(points: &[FrontPoint], x: &str, y: &str) -> Result<String, Report> {
    if points.is_empty() {
        return Err(Diagnostic::error(format!("no point has both `{x}` and `{y}`")).into());
    }
    Ok(chart::svg(&figure(points, [x, y]), ChartStyle::default()))
}

fn axis(name: &str, values: impl Iterator<Item = f64> + Clone) -> ChartAxis {
    let (low, high) = (values.clone().fold(f64::MAX, f64::min), values.fold(f64::MIN, f64::max));
    let kind = if low > 0.0 && high > 10.0 * low { AxisKind::Logarithmic } else { AxisKind::Linear };
    ChartAxis { name: name.to_owned(), kind }
}

fn figure(points: &[FrontPoint], [name_x, name_y]: [&str; 2]) -> ChartFigure {
    // Groups come one after the other; each has its points, and the front among them as a line.
    let mut series = Vec::new();
    for (number, group) in points.chunk_by(|one, other| one.group == other.group).enumerate() {
        let place = |point: &FrontPoint| ChartPoint::new(point.x, point.y);
        let one = |name: String, line: ChartLine, is_marked: bool, points: Vec<ChartPoint>| ChartSeries {
            name,
            look: Look::Numbered(number),
            line,
            is_marked,
            points,
        };
        let name = if group[0].group.is_empty() { "points" } else { &group[0].group };
        series.push(one(name.to_owned(), ChartLine::None, true, group.iter().map(place).collect()));
        let front = group.iter().filter(|point| point.is_on_front).map(place).collect();
        let name = if group[0].group.is_empty() { "front".to_owned() } else { format!("front of {}", group[0].group) };
        series.push(one(name, ChartLine::Solid, false, front));
    }
    let plot = Plot {
        title: String::new(),
        x: axis(name_x, points.iter().map(|point| point.x)),
        y: axis(name_y, points.iter().map(|point| point.y)),
        series,
        aspect: 0.66,
    };
    ChartFigure { title: format!("{name_y} by {name_x}"), note: String::new(), rows: vec![vec![plot]] }
}
