//! `lancer sweep merge`: parts to a table.

use std::path::{Path, PathBuf};

use clap::Args;

use super::table;
use crate::failure::{Exit, Failure};
use crate::files;
use crate::numeral::count;
use crate::sweep::dataset::DatasetForm;
use crate::sweep::merge::merge;
use crate::sweep::part;
use crate::sweep::plan::StudyPlan;
use crate::terminal::Terminal;

const EXAMPLES: &str = "\
Examples:
  lancer sweep merge parts --expect plan.jsonl -o study.csv
  lancer sweep merge parts -o all.jsonl";

/// Merges the parts of a study to one table, a row a point.
///
/// With --expect, every point of the plan has to be there, once, and the rows have its order. Points that are missing, that are in two parts, or
/// whose results contradict each other, are named, and nothing is written. The octets of the table do not depend on shards, hosts or order.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct MergeArguments {
    /// Folder of the parts.
    #[arg(value_name = "FOLDER")]
    parts: PathBuf,
    /// Plan whose points have to be there [default: whatever is there, by hash].
    #[arg(long, value_name = "PLAN.jsonl")]
    expect: Option<PathBuf>,
    /// Table: .csv, .jsonl or .parquet.
    #[arg(short, long, value_name = "FILE", value_parser = table)]
    output: PathBuf,
}

/// Merges and writes.
pub(super) fn execute(arguments: &MergeArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    files::check_target(&arguments.output)?;
    files::check_spared([arguments.output.as_path()], &arguments.expect).map_err(Failure::usage)?;
    let plan = arguments.expect.as_deref().map(StudyPlan::read).transpose()?;
    let rows = write(&arguments.parts, plan.as_ref(), &arguments.output)?;
    terminal.print(&format!("{}: {}\n", arguments.output.display(), count(rows as u64, "point", "points")))?;
    Ok(Exit::Done)
}

/// Merges a folder to a table, and gives the number of its rows.
pub(super) fn write(folder: &Path, plan: Option<&StudyPlan>, output: &Path) -> Result<usize, Failure> {
    let (parts, damaged) = part::read_all(folder)?;
    let table = merge(&parts, &damaged, plan)?;
    let form = DatasetForm::of(output).expect("the parser lets only such names pass");
    table.write(form, output)?;
    Ok(table.rows())
}
