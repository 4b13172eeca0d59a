//! From parts to a table: every point of a plan once, in the plan's order, whatever process has run it. Memory holds an index of the rows; the rows
//! themselves are read a second time when they are written.

use std::collections::{BTreeSet, HashMap};
use std::ops::Range;
use std::path::Path;

use messages::{Diagnostic, Report};
use rayon::prelude::*;

use super::dataset::{Dataset, DatasetForm, cell, kind_of};
use super::identity;
use super::key_set::KeySet;
use super::part::{DamagedPart, IndexedRow, StudyPart};
use super::plan::{PlannedPoint, StudyPlan};
use super::row::{Cell, CellKind, PointFigures, PointLabels};
use crate::files::{self, FileStream};
use crate::numeral::count;

/// Mistakes of a kind that are listed, at most.
const LISTED: usize = 20;

/// Rows that are read before they are written.
const AT_ONCE: usize = 1024;

/// Number of a part, and of a row in it.
type RowPlace = (u32, u32);

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

/// A table whose rows stand in parts, and are read when they are written.
pub struct MergedTable<'p> {
    parts: &'p [StudyPart],
    /// The plan, whose points have the order of the rows.
    plan: Option<&'p StudyPlan>,
    /// Keys that vary and have no label.
    keys: Vec<&'p str>,
    places: Vec<RowPlace>,
}

/// The table of parts. With a plan, its points in its order; else all points in the order of their hashes.
///
/// # Errors
/// Parts that were cut short or changed; points of the plan that are missing; points that are in two parts, with the same result or with
/// another. All of them are named.
pub fn merge<'p>(
    parts: &'p [StudyPart],
    damaged: &[DamagedPart],
    plan: Option<&'p StudyPlan>,
) -> Result<MergedTable<'p>, Report> {
    let mut messages: Vec<Diagnostic> = Vec::new();
    for (path, reason) in damaged {
        let message = Diagnostic::error(format!("{} is no whole part: {reason}", path.display()));
        messages.push(message.hint("`lancer sweep run` makes it again"));
    }
    // Each point once: the same result in two parts is as wrong as another one, since somebody has copied or mixed parts.
    let mut found: HashMap<[u8; 32], RowPlace> = HashMap::with_capacity(parts.iter().map(|part| part.rows.len()).sum());
    let (mut double, mut conflicting) = (Vec::new(), Vec::new());
    for (number, part) in (0..).zip(parts) {
        for (at, row) in (0..).zip(&part.rows) {
            if let Some(place) = found.insert(row.point, (number, at)) {
                let (before, other) = row_at(parts, place);
                let named =
                    format!("{} ({} and {})", identity::shown(&row.point), before.path.display(), part.path.display());
                if other.result == row.result { double.push(named) } else { conflicting.push(named) }
            }
        }
    }
    let places: Vec<RowPlace> = match plan {
        None => {
            let mut points: Vec<([u8; 32], RowPlace)> = found.into_iter().collect();
            points.sort_unstable();
            points.into_iter().map(|(_, place)| place).collect()
        }
        Some(plan) => {
            let place =
                |point: &PlannedPoint| identity::read(&point.point).and_then(|point| found.get(&point).copied());
            let missing = plan.points.iter().filter(|point| place(point).is_none());
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
            plan.points.iter().filter_map(place).collect()
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
    // The plan's own keys, where there is one: a part may have been run for another study.
    let keys: BTreeSet<&str> = match plan {
        Some(plan) => plan.points.iter().flat_map(|point| point.set.iter().map(|(key, _)| key)).collect(),
        None => parts.iter().flat_map(|part| part.keys.iter().map(String::as_str)).collect(),
    };
    let keys = keys.into_iter().filter(|key| !LABELLED.contains(key)).collect();
    Ok(MergedTable { parts, plan, keys, places })
}

fn row_at(parts: &[StudyPart], (part, row): RowPlace) -> (&StudyPart, &IndexedRow) {
    let part = &parts[part as usize];
    (part, &part.rows[row as usize])
}

impl MergedTable<'_> {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.places.len()
    }

    /// Names of the columns: the hash, the labels, keys that vary and have no label, the figures, the reason of a refusal.
    pub fn columns(&self) -> Vec<String> {
        let labels = PointLabels::columns().into_iter().map(|(name, ..)| name);
        let figures = PointFigures::columns().into_iter().map(|(name, ..)| name);
        let names = ["point"].into_iter().chain(labels).chain(self.keys.iter().copied()).chain(figures);
        names.chain(["refused"]).map(str::to_owned).collect()
    }

    /// Cells of a row, which is read from its part.
    ///
    /// # Errors
    /// A part that has gone or changed since.
    fn cells(&self, number: usize) -> Result<Vec<Cell>, Report> {
        let (part, row) = row_at(self.parts, self.places[number]);
        let row = part.row(row)?;
        let set = self.plan.map_or(&row.set, |plan| &plan.points[number].set);
        let mut cells = vec![Cell::Text(row.point)];
        cells.extend(row.labels.cells());
        cells.extend(self.keys.iter().map(|key| set.get(key).map_or(Cell::Empty, cell)));
        match row.figures {
            Some(figures) => cells.extend(figures.cells()),
            None => cells.extend(std::iter::repeat_n(Cell::Empty, PointFigures::columns().len())),
        }
        cells.push(row.refused.map_or(Cell::Empty, Cell::Text));
        Ok(cells)
    }

    /// Some rows, read on all host threads and made to something.
    fn each<T: Send>(&self, rows: Range<usize>, make: impl Fn(Vec<Cell>) -> T + Sync) -> Result<Vec<T>, Report> {
        rows.into_par_iter().map(|number| self.cells(number).map(&make)).collect()
    }

    /// Writes the table. Lines of a text are written as they are read; Parquet, which has columns, is in memory as a whole.
    ///
    /// # Errors
    /// Parts that have gone or changed since, and a place that cannot be written.
    pub fn write(&self, form: DatasetForm, path: &Path) -> Result<(), Report> {
        let columns = self.columns();
        let Some(lines) = form.lines(&columns) else {
            return files::write(path, &self.dataset()?.encode(form)?);
        };
        let mut file = FileStream::new(path)?;
        if let Some(head) = lines.head() {
            file.line(&head)?;
        }
        for first in (0..self.rows()).step_by(AT_ONCE) {
            let last = self.rows().min(first + AT_ONCE);
            for line in self.each(first..last, |cells| lines.line(&cells))? {
                file.line(&line)?;
            }
        }
        file.finish()
    }

    /// The table in memory.
    ///
    /// # Errors
    /// Parts that have gone or changed since.
    pub fn dataset(&self) -> Result<Dataset, Report> {
        let rows = self.each(0..self.rows(), |cells| cells)?;
        let labels = PointLabels::columns().into_iter().map(|(_, kind, _)| kind);
        let figures = PointFigures::columns().into_iter().map(|(_, kind, _)| kind);
        let first = 1 + labels.len();
        let keys = (0..self.keys.len()).map(|key| kind_of(rows.iter().map(|row| &row[first + key])));
        let kinds = [CellKind::Text].into_iter().chain(labels).chain(keys).chain(figures).chain([CellKind::Text]);
        let columns = self.columns().into_iter().zip(kinds).collect();
        Ok(Dataset { columns, rows })
    }
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
