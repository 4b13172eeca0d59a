//! Points of a study as a chart: two columns, a colour a group, the front as a line.

use messages::{Diagnostic, Report};
use plotters::coord::Shift;
use plotters::prelude::*;

use super::front::FrontPoint;

const SIZE: (u32, u32) = (900, 640);
const COLOURS: [RGBColor; 8] = [
    RGBColor(31, 119, 180),
    RGBColor(214, 39, 40),
    RGBColor(44, 160, 44),
    RGBColor(148, 103, 189),
    RGBColor(140, 86, 75),
    RGBColor(255, 127, 14),
    RGBColor(23, 190, 207),
    RGBColor(127, 127, 127),
];

/// The chart as an SVG file; axes are logarithmic where all values are above 0 and differ by more than a factor of 10.
///
/// # Errors
/// No point to draw.
pub fn svg(points: &[FrontPoint], x: &str, y: &str) -> Result<String, Report> {
    if points.is_empty() {
        return Err(Diagnostic::error(format!("no point has both `{x}` and `{y}`")).into());
    }
    let mut text = String::new();
    let drawn = draw(points, [x, y], &SVGBackend::with_string(&mut text, SIZE).into_drawing_area());
    drawn.map_err(|error| Diagnostic::error(format!("no chart can be drawn: {error}")))?;
    Ok(text)
}

/// An axis: a scale and its ends, widened by a twentieth.
struct StudyAxis {
    is_logarithmic: bool,
    ends: (f64, f64),
}

impl StudyAxis {
    fn new(values: impl Iterator<Item = f64> + Clone) -> StudyAxis {
        let (low, high) = (values.clone().fold(f64::MAX, f64::min), values.fold(f64::MIN, f64::max));
        let is_logarithmic = low > 0.0 && high > 10.0 * low;
        let place = |value: f64| if is_logarithmic { value.log10() } else { value };
        let (low, high) = (place(low), place(high));
        let margin = ((high - low) / 20.0).max(1e-9 * high.abs()).max(1e-12);
        StudyAxis { is_logarithmic, ends: (low - margin, high + margin) }
    }

    fn place(&self, value: f64) -> f64 {
        if self.is_logarithmic { value.log10() } else { value }
    }

    fn label(&self, place: f64) -> String {
        let value = if self.is_logarithmic { 10f64.powf(place) } else { place };
        if value != 0.0 && !(1e-3..1e5).contains(&value.abs()) {
            format!("{value:.1e}")
        } else {
            format!("{value:.4}").trim_end_matches('0').trim_end_matches('.').to_owned()
        }
    }
}

fn draw(
    points: &[FrontPoint],
    [name_x, name_y]: [&str; 2],
    area: &DrawingArea<SVGBackend, Shift>,
) -> Result<(), Box<dyn std::error::Error>> {
    area.fill(&WHITE)?;
    let (x, y) =
        (StudyAxis::new(points.iter().map(|point| point.x)), StudyAxis::new(points.iter().map(|point| point.y)));
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .x_label_area_size(40)
        .y_label_area_size(72)
        .build_cartesian_2d(x.ends.0..x.ends.1, y.ends.0..y.ends.1)?;
    chart
        .configure_mesh()
        .x_desc(name_x)
        .y_desc(name_y)
        .x_label_formatter(&|place| x.label(*place))
        .y_label_formatter(&|place| y.label(*place))
        .light_line_style(WHITE)
        .draw()?;
    // Groups come one after the other.
    for (group, colour) in points.chunk_by(|one, other| one.group == other.group).zip(COLOURS.into_iter().cycle()) {
        let place = |point: &FrontPoint| (x.place(point.x), y.place(point.y));
        chart.draw_series(group.iter().map(|point| Circle::new(place(point), 3, colour.mix(0.5).filled())))?;
        let front: Vec<(f64, f64)> = group.iter().filter(|point| point.is_on_front).map(place).collect();
        let line = chart.draw_series(LineSeries::new(front, colour.stroke_width(2)))?;
        let name = if group[0].group.is_empty() { "front" } else { &group[0].group };
        line.label(name).legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], colour.stroke_width(2)));
    }
    chart.configure_series_labels().background_style(WHITE.mix(0.85)).border_style(BLACK.mix(0.4)).draw()?;
    area.present()?;
    Ok(())
}
