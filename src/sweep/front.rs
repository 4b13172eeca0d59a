//! Fronts and tables of a study: which points no other one beats in two columns, and means by two columns.

use std::collections::BTreeMap;

use messages::{Diagnostic, Report, did_you_mean};

use super::dataset::Dataset;
use super::row::Cell;

/// Columns of which more is better; of all others less is.
const MORE_IS_BETTER: [&str; 3] = ["psnr_db", "psnr_others_db", "cache_hits"];

/// A point in two columns.
#[derive(Clone, Debug, PartialEq)]
pub struct FrontPoint {
    /// Number of the row.
    pub row: usize,
    /// Values of the columns that tell groups apart, between commas.
    pub group: String,
    /// Value of the first column.
    pub x: f64,
    /// Value of the second column.
    pub y: f64,
    /// True where no other point of the group is at least as good in both columns and better in one.
    pub is_on_front: bool,
}

/// The column of a name.
///
/// # Errors
/// A name of no column, with what is near.
pub fn column(table: &Dataset, name: &str) -> Result<usize, Report> {
    let names = || table.columns.iter().map(|(name, _)| name.as_str());
    table.column(name).ok_or_else(|| {
        let hint = did_you_mean(name, names())
            .unwrap_or_else(|| format!("the columns are {}", names().collect::<Vec<_>>().join(", ")));
        Diagnostic::error(format!("the study has no column `{name}`")).hint(hint).into()
    })
}

/// A cell as a number.
fn number(cell: &Cell) -> Option<f64> {
    match cell {
        Cell::Whole(number) => Some(*number as f64),
        Cell::Real(number) => Some(*number),
        _ => None,
    }
}

/// A cell as people read it.
pub fn shown(cell: &Cell) -> String {
    match cell {
        Cell::Empty => String::new(),
        Cell::Whole(number) => number.to_string(),
        Cell::Real(number) => number.to_string(),
        Cell::Text(text) => text.clone(),
    }
}

/// All points that have a number in both columns, group by group, in each by the first column; `by` are the columns that tell groups apart.
///
/// # Errors
/// Names of no column.
pub fn points(table: &Dataset, x: &str, y: &str, by: &[String]) -> Result<Vec<FrontPoint>, Report> {
    let (at_x, at_y) = (column(table, x)?, column(table, y)?);
    let by = by.iter().map(|name| column(table, name)).collect::<Result<Vec<_>, _>>()?;
    let mut groups: BTreeMap<String, Vec<FrontPoint>> = BTreeMap::new();
    for (row, cells) in table.rows.iter().enumerate() {
        let (Some(x), Some(y)) = (number(&cells[at_x]), number(&cells[at_y])) else { continue };
        let group = by.iter().map(|&at| shown(&cells[at])).collect::<Vec<_>>().join(", ");
        groups.entry(group.clone()).or_default().push(FrontPoint { row, group, x, y, is_on_front: false });
    }
    let sign = |name: &str| if MORE_IS_BETTER.contains(&name) { -1.0 } else { 1.0 };
    let (sign_x, sign_y) = (sign(x), sign(y));
    let mut all = Vec::new();
    for (_, mut points) in groups {
        // Sorted by the first column, a point is on the front when it is better in the second than all before it.
        points.sort_by(|one, other| {
            let key = |point: &FrontPoint| (sign_x * point.x, sign_y * point.y);
            let ((x, y), (other_x, other_y)) = (key(one), key(other));
            x.total_cmp(&other_x).then(y.total_cmp(&other_y)).then(one.row.cmp(&other.row))
        });
        let mut best: Option<(f64, f64)> = None;
        for point in &mut points {
            let here = (sign_x * point.x, sign_y * point.y);
            point.is_on_front = best.is_none_or(|best| here.1 < best.1 || here == best);
            if point.is_on_front {
                best = Some(here);
            }
        }
        all.extend(points);
    }
    Ok(all)
}

/// Means of a column by the values of two others: names of the rows, names of the columns, and means, none where there is no point.
pub type MeanTable = (Vec<String>, Vec<String>, Vec<Vec<Option<f64>>>);

/// Means of `y` by `x` and by the columns `by`, in the order in which values come.
///
/// # Errors
/// Names of no column.
pub fn means(table: &Dataset, x: &str, y: &str, by: &[String]) -> Result<MeanTable, Report> {
    let (at_x, at_y) = (column(table, x)?, column(table, y)?);
    let by = by.iter().map(|name| column(table, name)).collect::<Result<Vec<_>, _>>()?;
    let (mut rows, mut columns): (Vec<String>, Vec<String>) = (Vec::new(), Vec::new());
    let mut sums: BTreeMap<(usize, usize), (f64, u64)> = BTreeMap::new();
    fn place(names: &mut Vec<String>, name: String) -> usize {
        names.iter().position(|known| *known == name).unwrap_or_else(|| {
            names.push(name);
            names.len() - 1
        })
    }
    for cells in &table.rows {
        let Some(value) = number(&cells[at_y]) else { continue };
        let group = if by.is_empty() {
            y.to_owned()
        } else {
            by.iter().map(|&at| shown(&cells[at])).collect::<Vec<_>>().join(", ")
        };
        let key = (place(&mut rows, shown(&cells[at_x])), place(&mut columns, group));
        let (sum, count) = sums.entry(key).or_default();
        *sum += value;
        *count += 1;
    }
    let mean = |row: usize, column: usize| sums.get(&(row, column)).map(|(sum, count)| sum / *count as f64);
    let means = (0..rows.len()).map(|row| (0..columns.len()).map(|column| mean(row, column)).collect()).collect();
    Ok((rows, columns, means))
}

#[cfg(test)]
mod tests {
    use super::super::row::CellKind;
    use super::*;

    fn table(points: &[(&str, u64, f64)]) -> Dataset {
        let columns = [("scene", CellKind::Text), ("clocks", CellKind::Whole), ("rmse", CellKind::Real)];
        Dataset {
            columns: columns.map(|(name, kind)| (name.to_owned(), kind)).to_vec(),
            rows: points
                .iter()
                .map(|&(scene, x, y)| vec![Cell::Text(scene.into()), Cell::Whole(x), Cell::Real(y)])
                .collect(),
        }
    }

    #[test]
    fn a_front_is_what_no_other_point_beats() {
        let points_of = [("a", 3, 1.0), ("a", 1, 3.0), ("a", 2, 3.0), ("a", 2, 2.0), ("a", 2, 2.0), ("b", 9, 9.0)];
        let table = table(&points_of);
        let front: Vec<usize> = points(&table, "clocks", "rmse", &["scene".into()])
            .unwrap()
            .iter()
            .filter(|point| point.is_on_front)
            .map(|point| point.row)
            .collect();
        assert_eq!(front, [1, 3, 4, 0, 5]);
        let (rows, columns, means) = means(&table, "clocks", "rmse", &["scene".into()]).unwrap();
        assert_eq!((rows.join(" "), columns.join(" ")), ("3 1 2 9".into(), "a b".into()));
        assert_eq!((means[2][0], means[2][1]), (Some(7.0 / 3.0), None));
        assert!(points(&table, "clock", "rmse", &[]).unwrap_err().render(false).contains("did you mean `clocks`?"));
    }
}
