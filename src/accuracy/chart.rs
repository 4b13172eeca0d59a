//! Cost against error as a chart: one plot a scene, the front as a line.

use super::MeasuredVariant;
use crate::chart::{AxisKind, ChartAxis, ChartFigure, ChartLine, ChartPoint, ChartSeries, Look, Plot, PointLabel};

/// PSNR of a picture without any error, for the axis.
const PERFECT: f64 = 200.0;

/// Cost that errors are set against.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum CostAxis {
    /// Clocks of the machine.
    #[default]
    Clocks,
    /// Time of the host.
    Host,
}

impl CostAxis {
    const fn name(self) -> &'static str {
        match self {
            CostAxis::Clocks => "clocks a pixel",
            CostAxis::Host => "host's nanoseconds a pixel",
        }
    }

    /// Cost of a variant; `None` where it was not measured.
    fn of(self, one: &MeasuredVariant) -> Option<f64> {
        match self {
            CostAxis::Clocks => Some(one.clocks),
            CostAxis::Host => one.host_nanoseconds,
        }
    }
}

/// The chart of variants on the machine `report`, in pictures of a size.
pub fn figure(measured: &[MeasuredVariant], (width, height): (u32, u32), axis: CostAxis) -> ChartFigure {
    let mut scenes: Vec<&str> = Vec::new();
    for one in measured {
        if !scenes.contains(&one.scene.as_str()) {
            scenes.push(&one.scene);
        }
    }
    let mut profiles: Vec<&str> = Vec::new();
    for one in measured {
        if !profiles.contains(&one.profile) {
            profiles.push(one.profile);
        }
    }
    let plots = scenes.iter().map(|&scene| {
        let variants: Vec<&MeasuredVariant> = measured.iter().filter(|one| one.scene == scene).collect();
        plot(scene, &variants, &profiles, axis)
    });
    ChartFigure {
        title: format!("Run time against error: {}, machine `report`, {width} x {height} pixels", scenes.join(", ")),
        note: "PSNR against double precision. Nothing to the left of the front is nearer to double precision."
            .to_owned(),
        rows: plots.map(|plot| vec![plot]).collect(),
    }
}

fn psnr(one: &MeasuredVariant) -> f64 {
    one.error.psnr_db.unwrap_or(PERFECT).min(PERFECT)
}

/// Variants that no other one of these beats in cost and error both, the cheapest first.
fn front<'v>(variants: &[&'v MeasuredVariant], axis: CostAxis) -> Vec<&'v MeasuredVariant> {
    let cost = |one: &MeasuredVariant| axis.of(one).unwrap_or(f64::INFINITY);
    let beats = |other: &MeasuredVariant, one: &MeasuredVariant| {
        let (fewer, nearer) = (cost(other) < cost(one), other.error.rmse < one.error.rmse);
        cost(other) <= cost(one) && other.error.rmse <= one.error.rmse && (fewer || nearer)
    };
    let is_first = |one: &&&MeasuredVariant| !variants.iter().any(|other| beats(other, one));
    let mut front: Vec<&MeasuredVariant> = variants.iter().filter(is_first).copied().collect();
    front.sort_by(|one, other| cost(one).total_cmp(&cost(other)));
    front
}

fn plot(scene: &str, variants: &[&MeasuredVariant], profiles: &[&str], axis: CostAxis) -> Plot {
    let front = front(variants, axis);
    let is_on_front = |one: &MeasuredVariant| front.iter().any(|other| other.variant == one.variant);
    let point = |one: &MeasuredVariant, has_label: bool, is_important: bool| {
        let label = has_label.then(|| PointLabel { words: one.variant.clone(), is_important });
        let tip = match &one.dominated_by {
            Some(by) if axis == CostAxis::Clocks => format!("{}: dominated by {by}", one.variant),
            _ => one.variant.clone(),
        };
        Some(ChartPoint { x: axis.of(one)?, y: psnr(one), label, tip })
    };
    // Marks by set of kernels; names of the front belong to its line, so that they find room first.
    let of_profile = |(at, &profile): (usize, &&str)| ChartSeries {
        name: format!("kernels `{profile}`"),
        look: Look::Numbered(at),
        line: ChartLine::None,
        is_marked: true,
        points: variants
            .iter()
            .filter(|one| one.profile == profile)
            .filter_map(|one| point(one, !is_on_front(one), false))
            .collect(),
    };
    let mut series: Vec<ChartSeries> = profiles.iter().enumerate().map(of_profile).collect();
    series.push(ChartSeries {
        name: "front".to_owned(),
        look: Look::Numbered(6),
        line: ChartLine::Solid,
        is_marked: false,
        points: front.iter().filter_map(|one| point(one, true, true)).collect(),
    });
    Plot {
        title: scene.to_owned(),
        x: ChartAxis { name: axis.name().to_owned(), kind: AxisKind::Logarithmic },
        y: ChartAxis { name: "PSNR, dB".to_owned(), kind: AxisKind::Linear },
        series,
        aspect: 0.66,
    }
}
