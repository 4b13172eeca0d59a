//! Cost against error as a chart: variants that differ in the word length alone share colour and mark, the front is a line.

use super::front::{OverScenes, dominated};
use super::{AccuracyStudy, CostAxis, ErrorAxis, MeasuredVariant, OverallVariant};
use crate::chart::{AxisKind, ChartAxis, ChartFigure, ChartLine, ChartPoint, ChartSeries, Look, Plot, PointLabel};

/// Look of fronts, which no other series has.
const FRONT: usize = 6;

/// Kinds of variants that differ in colour and mark; further ones begin anew, with other lines.
const KINDS: usize = 7;

/// Axes of a chart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChartAxes {
    /// The axis to the right.
    pub cost: CostAxis,
    /// The axis upwards.
    pub error: ErrorAxis,
    /// Scenes of each plot.
    pub over: OverScenes,
}

/// A variant in a plot.
struct PlacedVariant<'m> {
    kind: &'m str,
    word: u32,
    name: &'m str,
    place: (f64, f64),
    /// Least and most of the shifts, where there are several.
    ends: Option<[f64; 2]>,
    /// Cost and badness, by which the front goes.
    rank: (f64, f64),
}

/// The chart of variants, in pictures of a size.
pub fn figure(
    study: &AccuracyStudy,
    overall: &[OverallVariant],
    (width, height): (u32, u32),
    axes: ChartAxes,
) -> ChartFigure {
    let measured = &study.measured;
    let scenes = distinct(measured.iter().map(|one| one.scene.as_str()));
    let machines = distinct(measured.iter().map(|one| one.machine.as_str()));
    let kinds = distinct(measured.iter().map(|one| one.kind.as_str()));
    // Draw a plot for each scene, or a single one over all of them
    let plots: Vec<Plot> = match axes.over {
        OverScenes::Each => scenes
            .iter()
            .map(|&scene| {
                let variants: Vec<PlacedVariant> =
                    measured.iter().filter(|one| one.scene == scene).filter_map(|one| placed(one, axes)).collect();
                plot(scene, &variants, &kinds, axes)
            })
            .collect(),
        OverScenes::Mean | OverScenes::Worst => {
            let variants: Vec<PlacedVariant> =
                overall.iter().filter_map(|one| placed_over(one, measured, axes)).collect();
            let title = if axes.over == OverScenes::Mean { "mean of all scenes" } else { "worst of all scenes" };
            vec![plot(title, &variants, &kinds, axes)]
        }
    };
    let of_machines = if machines.len() == 1 { "machine" } else { "machines" };
    let shifts = measured.first().map_or(1, |one| one.shifts.len());
    let mut note = format!(
        "Against double precision. Numbers are bits of a word. Nothing to the left of the front is {} it.",
        if axes.error.is_better_above() { "higher than" } else { "lower than" }
    );
    // Means and worsts over scenes have no bars, so there is nothing to explain.
    if shifts > 1 && axes.over == OverScenes::Each {
        note += &format!(" Bars reach over {shifts} places of the samples.");
    }
    ChartFigure {
        title: format!(
            "Run time against error: {}, {of_machines} `{}`, {width} x {height} pixels",
            scenes.join(", "),
            machines.join("`, `")
        ),
        note,
        rows: plots.into_iter().map(|plot| vec![plot]).collect(),
    }
}

/// The names in the order in which they come, each once.
fn distinct<'n>(names: impl Iterator<Item = &'n str>) -> Vec<&'n str> {
    let mut found: Vec<&str> = Vec::new();
    for name in names {
        if !found.contains(&name) {
            found.push(name);
        }
    }
    found
}

/// A variant on its scene; `None` where its cost was not measured.
fn placed(one: &MeasuredVariant, axes: ChartAxes) -> Option<PlacedVariant<'_>> {
    let cost = axes.cost.of(one)?;
    let (place, ends) = axes.error.place(one);
    Some(PlacedVariant {
        kind: &one.kind,
        word: one.word,
        name: &one.variant,
        place: (cost, place),
        ends: (one.shifts.len() > 1).then_some(ends),
        rank: (cost, axes.error.badness(one)),
    })
}

/// A variant over all scenes.
fn placed_over<'m>(
    one: &'m OverallVariant,
    measured: &'m [MeasuredVariant],
    axes: ChartAxes,
) -> Option<PlacedVariant<'m>> {
    let first = measured.iter().find(|measured| measured.number == one.number)?;
    let (cost, error) = match axes.over {
        OverScenes::Worst => (one.cost.worst, one.error.worst),
        _ => (one.cost.mean, one.error.mean),
    };
    let rank = if axes.error.is_better_above() { -error } else { error };
    Some(PlacedVariant {
        kind: &first.kind,
        word: first.word,
        name: &one.variant,
        place: (cost, error),
        ends: None,
        rank: (cost, rank),
    })
}

fn plot(title: &str, variants: &[PlacedVariant], kinds: &[&str], axes: ChartAxes) -> Plot {
    let by = dominated(&variants.iter().map(|one| one.rank).collect::<Vec<_>>());
    let label = |words: &str, is_important: bool| Some(PointLabel { words: words.to_owned(), is_important });
    // Words of one kind stand in the order of their lengths, as their line has it; the front has names in full, and finds room first.
    let of_kind = |(at, &kind): (usize, &&str)| {
        let mut points: Vec<(&PlacedVariant, &Option<usize>)> =
            variants.iter().zip(&by).filter(|(one, _)| one.kind == kind).collect();
        points.sort_by_key(|(one, _)| one.word);
        let point = |(one, by): (&PlacedVariant, &Option<usize>)| ChartPoint {
            label: by.and_then(|_| label(&one.word.to_string(), false)),
            tip: by
                .map_or_else(|| one.name.to_owned(), |by| format!("{}: dominated by {}", one.name, variants[by].name)),
            bar: one.ends,
            ..ChartPoint::new(one.place.0, one.place.1)
        };
        ChartSeries {
            name: kind.to_owned(),
            look: Look::Numbered(if at % KINDS < FRONT { at % KINDS } else { at % KINDS + 1 }),
            line: if at < KINDS { ChartLine::Dotted } else { ChartLine::Dashed },
            is_marked: true,
            points: points.into_iter().map(point).collect(),
        }
    };
    let mut series: Vec<ChartSeries> = kinds.iter().enumerate().map(of_kind).collect();
    let mut front: Vec<&PlacedVariant> =
        variants.iter().zip(&by).filter(|(_, by)| by.is_none()).map(|(one, _)| one).collect();
    front.sort_by(|one, other| one.place.0.total_cmp(&other.place.0));
    series.push(ChartSeries {
        name: "front".to_owned(),
        look: Look::Numbered(FRONT),
        line: ChartLine::Solid,
        is_marked: false,
        points: front
            .iter()
            .map(|one| ChartPoint { label: label(one.name, true), ..ChartPoint::new(one.place.0, one.place.1) })
            .collect(),
    });
    Plot {
        title: title.to_owned(),
        x: ChartAxis { name: axes.cost.name().to_owned(), kind: AxisKind::Logarithmic },
        y: ChartAxis {
            name: axes.error.name().to_owned(),
            kind: match axes.error {
                ErrorAxis::Largest => AxisKind::Logarithmic,
                ErrorAxis::Off => AxisKind::FromZero,
                _ => AxisKind::Linear,
            },
        },
        series,
        aspect: 0.66,
    }
}
