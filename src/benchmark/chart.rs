//! Times a pixel as a chart: scenes side by side, a bar for each who computed them, on a logarithmic axis.

use plotters::prelude::*;

use super::{BenchResult, Runner};

const WIDTH: u32 = 900;
const HEIGHT: u32 = 420;

/// The chart of one profile.
///
/// # Errors
/// None that numbers above 0 could cause.
pub fn svg(measured: &[BenchResult]) -> Result<String, String> {
    let mut scenes: Vec<String> = measured.iter().map(|one| format!("{} ({})", one.scene, one.profile)).collect();
    scenes.dedup();
    let least = measured.iter().map(|one| one.nanoseconds).fold(f64::INFINITY, f64::min).max(1.0);
    let most = measured.iter().map(|one| one.nanoseconds).fold(1.0, f64::max);
    let mut text = String::new();
    draw(&mut text, measured, &scenes, least / 2.0..most * 2.0).map_err(|error| error.to_string())?;
    Ok(text)
}

fn draw(
    text: &mut String,
    measured: &[BenchResult],
    scenes: &[String],
    range: std::ops::Range<f64>,
) -> Result<(), Box<dyn std::error::Error>> {
    let area = SVGBackend::with_string(text, (WIDTH, HEIGHT)).into_drawing_area();
    area.fill(&WHITE)?;
    let end = scenes.len().max(1) as f64;
    let floor = range.start;
    let mut chart = ChartBuilder::on(&area)
        .margin(12)
        .caption("Nanoseconds a pixel", ("sans-serif", 16))
        .x_label_area_size(28)
        .y_label_area_size(64)
        .build_cartesian_2d(0.0..end, range.log_scale())?;
    let label = |x: &f64| scenes.get(*x as usize).filter(|_| x.fract() != 0.0).cloned().unwrap_or_default();
    chart.configure_mesh().disable_x_mesh().x_labels(2 * scenes.len() + 1).x_label_formatter(&label).draw()?;
    let width = 0.8 / Runner::ALL.len() as f64;
    for (place, runner) in Runner::ALL.into_iter().enumerate() {
        let colour = Palette99::pick(place).to_rgba();
        let bars = measured.iter().filter(|one| one.runner == runner).enumerate().map(|(scene, one)| {
            let left = scene as f64 + 0.1 + width * place as f64;
            Rectangle::new([(left, floor), (left + width, one.nanoseconds)], colour.filled())
        });
        chart
            .draw_series(bars)?
            .label(runner.name())
            .legend(move |(x, y)| Rectangle::new([(x, y - 4), (x + 10, y + 4)], colour.filled()));
    }
    chart.configure_series_labels().border_style(BLACK).background_style(WHITE).draw()?;
    area.present()?;
    Ok(())
}
