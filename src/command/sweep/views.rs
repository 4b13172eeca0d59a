//! `lancer sweep front`, `plot` and `table`: a study looked at.

use std::path::PathBuf;

use clap::Args;

use super::table as table_path;
use crate::failure::{Exit, Failure};
use crate::files;
use crate::sweep::dataset::Dataset;
use crate::sweep::front::{self, FrontPoint};
use crate::sweep::svg;
use crate::table;
use crate::terminal::Terminal;

/// Columns of a study that are looked at.
#[derive(Args, Clone, Debug)]
struct ViewedColumns {
    /// Table of a study: .csv, .jsonl or .parquet.
    #[arg(value_name = "STUDY", value_parser = table_path)]
    study: PathBuf,
    /// First column.
    #[arg(short, value_name = "COLUMN")]
    x: String,
    /// Second column.
    #[arg(short, value_name = "COLUMN")]
    y: String,
    /// Columns that tell groups apart, between commas; may be repeated.
    #[arg(long, value_name = "COLUMN,..", value_delimiter = ',')]
    by: Vec<String>,
}

/// Prints the points that no other one beats in two columns.
///
/// Less is better, but for psnr_db, psnr_others_db and cache_hits. Each group has a front of its own.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  lancer sweep front study.csv -x clocks -y rmse --by scene")]
pub struct FrontArguments {
    #[command(flatten)]
    columns: ViewedColumns,
}

/// Draws the points in two columns, with the front of each group as a line.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  lancer sweep plot study.csv -x cores -y clocks --by machine -o study.svg")]
pub struct PlotArguments {
    #[command(flatten)]
    columns: ViewedColumns,
    /// Chart: .svg [default: standard output].
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Prints the mean of the second column by the values of the first, a column a group.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  lancer sweep table study.csv -x machine -y seconds --by cores")]
pub struct TableArguments {
    #[command(flatten)]
    columns: ViewedColumns,
}

/// Columns that the table of a front shows beside the two.
const SHOWN: [&str; 8] = ["scene", "profile", "layout", "word", "machine", "arbiter", "cores", "bounces"];

fn points(columns: &ViewedColumns) -> Result<(Dataset, Vec<FrontPoint>), Failure> {
    let study = Dataset::read(&columns.study)?;
    let points = front::points(&study, &columns.x, &columns.y, &columns.by)?;
    Ok((study, points))
}

/// The front as a table.
pub(super) fn front(arguments: &FrontArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let columns = &arguments.columns;
    let (study, points) = points(columns)?;
    let labels: Vec<&str> = SHOWN.into_iter().filter(|label| study.column(label).is_some()).collect();
    let mut head: Vec<String> = labels.iter().map(|label| (*label).to_owned()).collect();
    head.extend([columns.x.clone(), columns.y.clone()]);
    let mut rows = vec![head];
    for point in points.iter().filter(|point| point.is_on_front) {
        let cells =
            labels.iter().filter_map(|label| study.column(label)).map(|at| front::shown(&study.rows[point.row][at]));
        rows.push(cells.chain([point.x.to_string(), point.y.to_string()]).collect());
    }
    terminal.print(&table::table(rows))?;
    Ok(Exit::Done)
}

/// The chart.
pub(super) fn plot(arguments: &PlotArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let output = arguments.output.as_deref().filter(|path| path.as_os_str() != files::STANDARD);
    if let Some(path) = output {
        files::check_target(path)?;
        files::check_spared([path], [&arguments.columns.study]).map_err(Failure::usage)?;
    }
    let (_, points) = points(&arguments.columns)?;
    let chart = svg(&points, &arguments.columns.x, &arguments.columns.y)?;
    match output {
        Some(path) => files::write(path, chart.as_bytes())?,
        None => terminal.print(&chart)?,
    }
    Ok(Exit::Done)
}

/// The means.
pub(super) fn table(arguments: &TableArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let ViewedColumns { study, x, y, by } = &arguments.columns;
    let (names, columns, means) = front::means(&Dataset::read(study)?, x, y, by)?;
    let mut rows = vec![[vec![x.clone()], columns].concat()];
    for (name, means) in names.into_iter().zip(means) {
        let cells = means.into_iter().map(|mean| mean.map_or_else(|| "-".to_owned(), |mean| mean.to_string()));
        rows.push(std::iter::once(name).chain(cells).collect());
    }
    terminal.print(&table::table(rows))?;
    Ok(Exit::Done)
}
