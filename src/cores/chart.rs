//! A scaling as a chart: speed-up by cores above, how busy the bus was below.

use messages::{Diagnostic, Report};
use plotters::coord::Shift;
use plotters::prelude::*;

use super::{CoresResult, Curve};

const SIZE: (u32, u32) = (840, 720);
const COLOURS: [RGBColor; 6] = [
    RGBColor(31, 119, 180),
    RGBColor(214, 39, 40),
    RGBColor(44, 160, 44),
    RGBColor(148, 103, 189),
    RGBColor(140, 86, 75),
    RGBColor(255, 127, 14),
];
const GREY: RGBColor = RGBColor(110, 110, 110);

type ChartResult = Result<(), Box<dyn std::error::Error>>;
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// The chart as an SVG file.
///
/// # Errors
/// None that a user could make: it is drawn in memory.
pub fn svg(scaling: &CoresResult) -> Result<String, Report> {
    let mut text = String::new();
    let drawn = draw(scaling, SVGBackend::with_string(&mut text, SIZE).into_drawing_area());
    drawn.map_err(|error| Diagnostic::error(format!("no chart can be drawn: {error}")))?;
    Ok(text)
}

fn draw(scaling: &CoresResult, root: Area) -> ChartResult {
    root.fill(&WHITE)?;
    let (above, below) = root.split_vertically(SIZE.1 * 2 / 3);
    speed_up(scaling, &above)?;
    utilisation(scaling, &below)?;
    root.present()?;
    Ok(())
}

fn most_cores(scaling: &CoresResult) -> f64 {
    let points = scaling.machines.iter().flat_map(|curve| &curve.points);
    points.map(|point| f64::from(point.cores)).fold(1.0, f64::max)
}

/// Measured speed-ups as lines with dots, the closed form dashed, the queueing estimate dotted, knees as vertical lines.
fn speed_up(scaling: &CoresResult, area: &Area) -> ChartResult {
    // Scale the axes to all machines, with room for the legend above.
    let widest = most_cores(scaling) + 0.5;
    let points = scaling.machines.iter().flat_map(|curve| &curve.points);
    let highest = points.map(|point| point.speed_up).fold(scaling.report_quotient, f64::max) * 1.15;
    let title = format!("{}: speed-up by cores ({} pixels)", scaling.scene, scaling.pixels);
    let mut chart = ChartBuilder::on(area)
        .caption(title, ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(34)
        .y_label_area_size(48)
        .build_cartesian_2d(0.0..widest, 0.0..highest)?;
    chart.configure_mesh().x_desc("cores").y_desc("times one core").light_line_style(WHITE).draw()?;
    // Draw the report's quotient once, upright.
    let upright = |cores: f64| [(cores, 0.0), (cores, highest)];
    chart
        .draw_series(DashedLineSeries::new(upright(scaling.report_quotient), 2, 4, GREY.stroke_width(1)))?
        .label(format!("the report's C / M = {:.2}", scaling.report_quotient))
        .legend(|(x, y)| PathElement::new([(x, y), (x + 16, y)], GREY));
    for (curve, colour) in scaling.machines.iter().zip(COLOURS.into_iter().cycle()) {
        // Turn times into speed-ups over the same machine with one core.
        let alone = curve.points.first().map_or(0.0, |point| point.pixel_seconds);
        let series = |value: fn(&super::Point) -> f64| -> Vec<(f64, f64)> {
            curve.points.iter().map(|point| (f64::from(point.cores), value(point))).collect()
        };
        let against = |seconds: fn(&super::Point) -> f64| -> Vec<(f64, f64)> {
            let ratio = |(cores, seconds): (f64, f64)| (cores, if seconds > 0.0 { alone / seconds } else { 0.0 });
            series(seconds).into_iter().map(ratio).collect()
        };
        // Draw theory below what was measured.
        let measured = series(|point| point.speed_up);
        chart.draw_series(DashedLineSeries::new(against(|p| p.bound_pixel_seconds), 7, 4, colour.stroke_width(1)))?;
        chart.draw_series(DashedLineSeries::new(
            against(|p| p.queueing_pixel_seconds),
            2,
            3,
            colour.stroke_width(1),
        ))?;
        chart.draw_series(measured.iter().map(|&point| Circle::new(point, 3, colour.filled())))?;
        chart
            .draw_series(LineSeries::new(measured, colour.stroke_width(2)))?
            .label(name(curve))
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], colour.stroke_width(2)));
        // Mark the knee where the curve has one.
        if let Some(saturation) = curve.saturation {
            chart
                .draw_series(LineSeries::new(upright(saturation.cores), colour.stroke_width(1)))?
                .label(format!("knee of `{}`: {:.2} cores", curve.machine, saturation.cores))
                .legend(move |(x, y)| PathElement::new([(x + 8, y - 5), (x + 8, y + 5)], colour));
        }
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::LowerRight)
        .background_style(WHITE.mix(0.85))
        .border_style(GREY)
        .draw()?;
    Ok(())
}

fn name(curve: &Curve) -> String {
    format!("{}, {} (dashed: without waiting, dotted: queueing)", curve.machine, curve.arbiter)
}

fn utilisation(scaling: &CoresResult, area: &Area) -> ChartResult {
    let mut chart = ChartBuilder::on(area)
        .caption("bus busy, per cent of the frame", ("sans-serif", 16))
        .margin(12)
        .x_label_area_size(34)
        .y_label_area_size(48)
        .build_cartesian_2d(0.0..most_cores(scaling) + 0.5, 0.0..105.0)?;
    chart.configure_mesh().x_desc("cores").y_desc("%").light_line_style(WHITE).draw()?;
    for (curve, colour) in scaling.machines.iter().zip(COLOURS.into_iter().cycle()) {
        let busy: Vec<(f64, f64)> =
            curve.points.iter().map(|point| (f64::from(point.cores), 100.0 * point.utilisation)).collect();
        chart.draw_series(busy.iter().map(|&point| Circle::new(point, 3, colour.filled())))?;
        chart.draw_series(LineSeries::new(busy, colour.stroke_width(2)))?;
    }
    Ok(())
}
