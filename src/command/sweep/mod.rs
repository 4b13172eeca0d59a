//! `lancer sweep`: a design-space study as one file.

mod merge;
mod plan;
mod run;
mod views;

pub(super) use plan::{study_text, write_study};

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use messages::Diagnostic;

use crate::arguments::RecordingArguments;
use crate::failure::{Exit, Failure};
use crate::files;
use crate::numeral::{count, grouped};
use crate::sweep::contents::Contents;
use crate::sweep::dataset::DatasetForm;
use crate::sweep::plan::StudyPlan;
use crate::sweep::shard::Shard;
use crate::sweep::study::Study;
use crate::terminal::Terminal;

const EXAMPLES: &str = "\
Examples:
  lancer sweep study.toml -o study.csv                  plans, runs and merges on this machine
  lancer sweep plan study.toml > plan.jsonl             or in steps, on as many machines as you like:
  lancer sweep run plan.jsonl --out parts --shard 3/24
  lancer sweep merge parts --expect plan.jsonl -o study.csv
  lancer sweep front study.csv -x clocks -y rmse --by scene
  lancer sweep plot study.csv -x cores -y clocks --by machine -o study.svg

docs/sweep.md describes study files and columns.";

/// Runs a study: every combination of the settings that its file varies, one row a point.
///
/// Points that share a recording are run together: machines, cores and arbiters cost a replay each. What is there already is not run again.
/// Without a subcommand, everything is done here: parts go to the folder of the table's name with .parts at its end.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES, args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub struct SweepArguments {
    /// Study: a TOML file.
    #[arg(value_name = "STUDY.toml", required = true)]
    study: Option<PathBuf>,
    /// Table: .csv, .jsonl or .parquet [default: the study's name with .csv, in the current folder].
    #[arg(short, long, value_name = "FILE", value_parser = table)]
    output: Option<PathBuf>,
    #[command(flatten)]
    recordings: RecordingArguments,
    #[command(subcommand)]
    command: Option<SweepCommand>,
}

#[derive(Subcommand, Clone, Debug)]
enum SweepCommand {
    Plan(plan::PlanArguments),
    Run(run::SweepRunArguments),
    Merge(merge::MergeArguments),
    Front(views::FrontArguments),
    Plot(views::PlotArguments),
    Table(views::TableArguments),
}

/// A path of a table.
fn table(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    DatasetForm::of(&path).map(|_| path)
}

/// Executes one of the commands, or all of a study.
pub(super) fn execute(arguments: &SweepArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    match &arguments.command {
        Some(SweepCommand::Plan(arguments)) => plan::execute(arguments, terminal),
        Some(SweepCommand::Run(arguments)) => run::execute(arguments, terminal),
        Some(SweepCommand::Merge(arguments)) => merge::execute(arguments, terminal),
        Some(SweepCommand::Front(arguments)) => views::front(arguments, terminal),
        Some(SweepCommand::Plot(arguments)) => views::plot(arguments, terminal),
        Some(SweepCommand::Table(arguments)) => views::table(arguments, terminal),
        None => whole(arguments, terminal),
    }
}

/// Plans, runs and merges.
fn whole(arguments: &SweepArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let Some(path) = &arguments.study else { return Err(Failure::usage(Diagnostic::error("no study was named"))) };
    let contents = Contents::default();
    let study = study(path)?;
    let output = arguments.output.clone().unwrap_or_else(|| PathBuf::from(format!("{}.csv", study.name)));
    files::check_target(&output)?;
    files::check_spared([output.as_path()], [path]).map_err(Failure::usage)?;
    let plan = planned(&study, &contents, terminal)?;
    let folder = output.with_extension("parts");
    let store = arguments.recordings.store()?;
    let ran = run::run(&plan, &folder, Shard::WHOLE, (&contents, store.as_ref()), terminal)?;
    merge::write(&folder, Some(&plan), &output)?;
    terminal.print(&format!("{}\ntable: {}, parts: {}\n", ran.text(), output.display(), folder.display()))?;
    Ok(Exit::Done)
}

/// The study of a file.
fn study(path: &Path) -> Result<Study, Failure> {
    Ok(Study::parse(&files::source(path)?, &study_name(Some(path), "study"))?)
}

/// The name of a study that says none: that of its file without the ending, or another one where it has no file.
pub(super) fn study_name(path: Option<&Path>, other: &str) -> String {
    let stem = path.filter(|path| path.as_os_str() != files::STANDARD).and_then(Path::file_stem);
    stem.map_or_else(|| other.to_owned(), |stem| stem.to_string_lossy().into_owned())
}

/// The plan of a study; says first how much there is to do.
fn planned(study: &Study, contents: &Contents, terminal: &Terminal) -> Result<StudyPlan, Failure> {
    let plan = StudyPlan::new(study, contents)?;
    let head = &plan.head;
    let repeated = if head.repeated == 0 {
        String::new()
    } else {
        format!(" ({} more are the same as others)", grouped(head.repeated))
    };
    terminal.say(&format!(
        "{}: {}{repeated}, {}, about {} on two host threads",
        head.study,
        count(head.points, "point", "points"),
        count(head.recordings, "recording", "recordings"),
        duration(head.seconds),
    ));
    Ok(plan)
}

/// Seconds as people say them.
fn duration(seconds: f64) -> String {
    match seconds {
        seconds if seconds < 100.0 => format!("{seconds:.1} s"),
        seconds if seconds < 6000.0 => format!("{:.0} min", seconds / 60.0),
        seconds => format!("{:.1} h", seconds / 3600.0),
    }
}
