//! `lancer sweep run`: the points of a plan, or of a share of it, as parts.

use std::path::{Path, PathBuf};

use clap::Args;
use messages::{Diagnostic, Report};

use crate::arguments::{RecordingArguments, tell_notes};
use crate::failure::{Exit, Failure};
use crate::numeral::{count, grouped};
use crate::settings::Settings;
use crate::sweep::contents::Contents;
use crate::sweep::group;
use crate::sweep::identity;
use crate::sweep::part;
use crate::sweep::plan::{PlannedPoint, StudyPlan};
use crate::sweep::recordings::RecordingStore;
use crate::sweep::row::PointRow;
use crate::sweep::shard::Shard;
use crate::terminal::Terminal;

const EXAMPLES: &str = "\
Examples:
  lancer sweep run plan.jsonl --out parts
  lancer sweep run plan.jsonl --out parts --shard 3/24
  lancer sweep run plan.jsonl --out parts --recordings ~/recordings";

/// Runs the points of a plan that are not in the folder yet.
///
/// Points that share a recording are one part, which takes its place when all of them are done. A run that was killed goes on where it was;
/// any number of processes may write to the same folder. The shard goes by recordings. Without --shard it is the one that SLURM_ARRAY_TASK_ID
/// or JOB_COMPLETION_INDEX says.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct SweepRunArguments {
    /// Plan, as `lancer sweep plan` prints it.
    #[arg(value_name = "PLAN.jsonl")]
    plan: PathBuf,
    /// Folder of the parts, which is made where it is not there.
    #[arg(long, value_name = "FOLDER")]
    out: PathBuf,
    /// Share of the work, such as 3/24, counted from 0 or from 1 [default: by the scheduler's variables, else all].
    #[arg(long, value_name = "I/N", value_parser = Shard::parse)]
    shard: Option<Shard>,
    /// Number of shares where the scheduler's variables say which one this is, and not of how many.
    #[arg(long, value_name = "N", conflicts_with = "shard", value_parser = clap::value_parser!(u64).range(1..))]
    shards: Option<u64>,
    #[command(flatten)]
    recordings: RecordingArguments,
}

/// Work that was done.
pub(super) struct SweepWork {
    recordings: u64,
    points: u64,
    skipped: u64,
    refused: u64,
    /// Recordings that were in a folder of them; `None` without one.
    reused: Option<u64>,
}

impl SweepWork {
    /// The work in a sentence.
    pub(super) fn text(&self) -> String {
        let refused =
            if self.refused == 0 { String::new() } else { format!(", {} of them refused", grouped(self.refused)) };
        let reused = self.reused.map_or_else(String::new, |reused| format!(" ({} of them kept)", grouped(reused)));
        format!(
            "{} from {}{reused}{refused}; {} were there",
            count(self.points, "point", "points"),
            count(self.recordings, "recording", "recordings"),
            grouped(self.skipped),
        )
    }
}

/// Runs and says how much it was.
pub(super) fn execute(arguments: &SweepRunArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let variable = |name: &str| std::env::var(name).ok();
    let shard = match arguments.shard {
        Some(shard) => shard,
        None => Shard::of_environment(&variable, arguments.shards).map_err(Failure::usage)?,
    };
    let plan = StudyPlan::read(&arguments.plan)?;
    let store = arguments.recordings.store()?;
    let work = run(&plan, &arguments.out, shard, (&Contents::default(), store.as_ref()), terminal)?;
    terminal.print(&format!("{}\n", work.text()))?;
    Ok(Exit::Done)
}

/// Runs a share of a plan, with the contents of its files and the recordings that are kept.
pub(super) fn run(
    plan: &StudyPlan,
    folder: &Path,
    shard: Shard,
    (contents, store): (&Contents, Option<&RecordingStore>),
    terminal: &Terminal,
) -> Result<SweepWork, Failure> {
    std::fs::create_dir_all(folder).map_err(|error| {
        Report::from(Diagnostic::error(format!("the folder {} cannot be made: {error}", folder.display())))
    })?;
    // Points that are there: a part that was cut short has none.
    let (parts, _) = part::read_all(folder)?;
    let known = part::points(&parts);
    let is_known = |point: &PlannedPoint| identity::read(&point.point).is_some_and(|point| known.contains(&point));
    let mut work = SweepWork { recordings: 0, points: 0, skipped: 0, refused: 0, reused: None };
    let groups: Vec<Vec<&PlannedPoint>> = plan
        .groups()
        .into_iter()
        .enumerate()
        .filter(|(number, _)| shard.has(*number))
        .map(|(_, group)| group.into_iter().map(|number| &plan.points[number]).collect())
        .collect();
    let bar = terminal.progress("points", groups.iter().map(|group| group.len() as u64).sum());
    for group in groups {
        let all = group.len() as u64;
        let group: Vec<&PlannedPoint> = group.into_iter().filter(|point| !is_known(point)).collect();
        work.skipped += all - group.len() as u64;
        if let Some(first) = group.first() {
            let settings =
                group.iter().map(|point| plan.settings(point, contents)).collect::<Result<Vec<Settings>, _>>()?;
            let results = group::run(&settings, contents, store)?;
            bar.suspend(|| tell_notes(store, terminal));
            let rows: Vec<PointRow> = group.iter().zip(results).map(|(point, result)| row(point, result)).collect();
            part::write(folder, &first.recording, &rows)?;
            work.recordings += 1;
            work.points += rows.len() as u64;
            work.refused += rows.iter().filter(|row| row.refused.is_some()).count() as u64;
        }
        bar.inc(all);
    }
    bar.finish_and_clear();
    work.reused = store.map(RecordingStore::reused);
    Ok(work)
}

fn row(point: &PlannedPoint, (labels, figures): group::GroupResult) -> PointRow {
    let (figures, refused) = match figures {
        Ok(figures) => (Some(figures), None),
        Err(reason) => (None, Some(reason)),
    };
    PointRow { point: point.point.clone(), set: point.set.clone(), labels, figures, refused }
}
