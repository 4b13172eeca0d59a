//! From parts to a table: every point of a plan once, in the plan's order, whatever process has run it.

use std::collections::HashMap;

use messages::{Diagnostic, Report};

use super::dataset::{Dataset, cell, kind_of};
use super::key_set::KeySet;
use super::part::{DamagedPart, StudyPart};
use super::plan::StudyPlan;
use super::row::{Cell, CellKind, PointFigures, PointLabels, PointRow};
use crate::numeral::count;

/// Mistakes of a kind that are listed, at most.
const LISTED: usize = 20;

/// Number of a part, and of a row in it.
type RowPlace = (usize, usize);

/// Keys that have a column of their own name among the labels, or part of one.
const LABELLED: [&str; 15] = [
    "scene",
    "scene.name",
    "kernels.profile",
    "layout",
    "machine",
    "machine.from",
    "machine.name",
    "machine.cores",
    "machine.bus.arbiter",
    "machine.arithmetic.word",
    "machine.arithmetic.quantization",
    "machine.arithmetic.overflow",
    "view.size",
    "view.shift",
    "effort.bounces",
];

/// The table of parts. With a plan, its points in its order; else all points in the order of their hashes.
///
/// # Errors
/// Parts that were cut short or changed; points of the plan that are missing; points that are in two parts, with the same result or with
/// another. All of them are named.
pub fn merge(parts: Vec<StudyPart>, damaged: &[DamagedPart], plan: Option<&StudyPlan>) -> Result<Dataset, Report> {
    let mut messages: Vec<Diagnostic> = Vec::new();
    for (path, reason) in damaged {
        let message = Diagnostic::error(format!("{} is no whole part: {reason}", path.display()));
        messages.push(message.hint("`lancer sweep run` makes it again"));
    }
    // Each point once: the same result in two parts is as wrong as another one, since somebody has copied or mixed parts.
    let mut found: HashMap<&str, RowPlace> = HashMap::new();
    let (mut double, mut conflicting) = (Vec::new(), Vec::new());
    for (number, part) in parts.iter().enumerate() {
        for (at, row) in part.rows.iter().enumerate() {
            if let Some((before, place)) = found.insert(&row.point, (number, at)) {
                let before = &parts[before];
                let other = &before.rows[place];
                let named = format!("{} ({} and {})", row.point, before.path.display(), part.path.display());
                let is_same = (&other.figures, &other.refused) == (&row.figures, &row.refused);
                if is_same { double.push(named) } else { conflicting.push(named) }
            }
        }
    }
    let places: Vec<RowPlace> = match plan {
        None => {
            let mut points: Vec<(&str, RowPlace)> = found.iter().map(|(&point, &place)| (point, place)).collect();
            points.sort_unstable();
            points.into_iter().map(|(_, place)| place).collect()
        }
        Some(plan) => {
            let missing = plan.points.iter().filter(|point| !found.contains_key(point.point.as_str()));
            let named = |set: &KeySet| {
                set.iter()
                    .map(|(key, value)| {
                        format!("{key}={}", value.as_str().map_or_else(|| value.to_string(), str::to_owned))
                    })
                    .collect::<Vec<_>>()
                    .join(" ")
            };
            let missing: Vec<String> =
                missing.map(|point| format!("{} ({})", point.point, named(&point.set))).collect();
            messages.extend(listed(
                "missing",
                &missing,
                "run `lancer sweep run` with the same plan and folder: it makes what is not there",
            ));
            plan.points.iter().filter_map(|point| found.get(point.point.as_str()).copied()).collect()
        }
    };
    messages.extend(listed("in two parts", &double, "remove one of the parts"));
    messages.extend(listed(
        "in two parts with different results",
        &conflicting,
        "remove both parts and run again: one of them was made otherwise",
    ));
    if !messages.is_empty() {
        return Err(Report(messages));
    }
    // Rows become cells one by one, so that texts are moved and a row goes when its cells are there.
    let mut taken: Vec<Vec<Option<PointRow>>> =
        parts.into_iter().map(|part| part.rows.into_iter().map(Some).collect()).collect();
    let mut rows: Vec<PointRow> = places.into_iter().filter_map(|(part, row)| taken[part][row].take()).collect();
    // The plan's own names and keys, where there is one: a part may have been run for another study.
    let own: Vec<KeySet> = match plan {
        Some(_) => Vec::new(),
        None => rows.iter_mut().map(|row| std::mem::take(&mut row.set)).collect(),
    };
    let sets: Vec<&KeySet> = match plan {
        Some(plan) => plan.points.iter().map(|point| &point.set).collect(),
        None => own.iter().collect(),
    };
    Ok(table(rows, &sets))
}

fn listed(what: &str, points: &[String], hint: &str) -> Option<Diagnostic> {
    let more = points.len().saturating_sub(LISTED);
    let mut names = points[..points.len() - more].join("\n  ");
    if more != 0 {
        names += &format!("\n  and {more} more");
    }
    let are = if points.len() == 1 { "is" } else { "are" };
    (!points.is_empty()).then(|| {
        let message = format!("{} {are} {what}:\n  {names}", count(points.len() as u64, "point", "points"));
        Diagnostic::error(message).hint(hint)
    })
}

/// Rows with their columns: the hash, the labels, keys that vary and have no label, the figures, the reason of a refusal.
fn table(rows: Vec<PointRow>, sets: &[&KeySet]) -> Dataset {
    let is_labelled = |key: &str| LABELLED.contains(&key);
    let mut keys: Vec<&str> =
        sets.iter().flat_map(|set| set.iter()).map(|(key, _)| key).filter(|key| !is_labelled(key)).collect();
    keys.sort_unstable();
    keys.dedup();
    let figures = PointFigures::columns().len();
    let labels = PointLabels::columns().len();
    let cells = |(row, set): (PointRow, &&KeySet)| {
        let mut cells = Vec::with_capacity(2 + labels + keys.len() + figures);
        cells.push(Cell::Text(row.point));
        cells.extend(row.labels.cells());
        cells.extend(keys.iter().map(|key| set.get(key).map_or(Cell::Empty, cell)));
        match row.figures {
            Some(figures) => cells.extend(figures.cells()),
            None => cells.extend(std::iter::repeat_n(Cell::Empty, figures)),
        }
        cells.push(row.refused.map_or(Cell::Empty, Cell::Text));
        cells
    };
    let rows: Vec<Vec<Cell>> = rows.into_iter().zip(sets).map(cells).collect();
    let mut columns = vec![("point".to_owned(), CellKind::Text)];
    columns.extend(PointLabels::columns().into_iter().map(|(name, kind, _)| (name.to_owned(), kind)));
    for key in keys {
        let number = columns.len();
        columns.push((key.to_owned(), kind_of(rows.iter().map(|row| &row[number]))));
    }
    columns.extend(PointFigures::columns().into_iter().map(|(name, kind, _)| (name.to_owned(), kind)));
    columns.push(("refused".to_owned(), CellKind::Text));
    Dataset { columns, rows }
}
