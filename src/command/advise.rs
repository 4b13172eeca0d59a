//! `lancer advise`: what limits a machine, and what would help.

use std::path::{Path, PathBuf};

use clap::Args;

use super::sweep;
use crate::advise;
use crate::arguments::{JobArguments, RecordingArguments, tell_notes};
use crate::failure::{Exit, Failure};
use crate::result::WithSettings;
use crate::settings::Settings;
use crate::sweep::study_text::check_named;
use crate::terminal::Terminal;
use crate::{files, result};

const EXAMPLES: &str = "\
Examples:
  lancer advise cornell --size 160x120
  lancer advise terrain --size 160x120 --machine wide32 --all
  lancer advise cornell --size 80x60 --machine mine.toml --json > advice.json
  lancer advise cornell --size 80x60 --study tried.toml && lancer sweep tried.toml

Keys are written as they stand at the top of a machine's file: bus.octets_per_beat = 8. Each time is that of a
run of the changed machine on this very picture. Changes marked with + do not come of the recording of the
machine as it is: operations take other clocks, or another picture in memory was built.";

/// Says what limits a machine on a picture, and ranks what would help.
///
/// Each change by itself: a wider beat, bursts, loads beside computing, a cache of each size for each kind of data, more and
/// fewer cores, each arbiter, more units, faster operations, the other layout, other sets of kernels, other kd trees; then
/// pairs of the six best of different parts. Memory is what the cores have more of, in octets.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct AdviseArguments {
    #[command(flatten)]
    job: JobArguments,
    #[command(flatten)]
    recordings: RecordingArguments,
    /// Shows all changes and pairs instead of the best ones.
    #[arg(long, help_heading = "Results")]
    all: bool,
    /// Writes changes and pairs as comma-separated values.
    #[arg(long, value_name = "FILE", help_heading = "Results")]
    csv: Option<PathBuf>,
    /// Writes the machine as it is and all changes and pairs that were tried as a study that `lancer sweep` runs, a row each. Pairs depend on what
    /// the changes bring, so everything runs here as well.
    #[arg(long, value_name = "FILE", help_heading = "Results")]
    study: Option<PathBuf>,
    /// Prints the results as JSON instead of tables.
    #[arg(long, help_heading = "Results")]
    json: bool,
}

/// Runs all changes, writes and prints.
pub(super) fn execute(arguments: &AdviseArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    // Refuse what cannot be written or read before some eighty machines run
    let targets: Vec<&Path> = [&arguments.csv, &arguments.study].into_iter().flatten().map(PathBuf::as_path).collect();
    let is_taken = files::takes_output(targets.iter().copied(), arguments.json).map_err(Failure::usage)?;
    files::check_distinct(targets.iter().copied()).map_err(Failure::usage)?;
    targets.iter().try_for_each(|path| files::check_target(path))?;
    let settings = arguments.job.settings()?;
    if arguments.study.is_some() {
        check_named(&settings, [])?;
    }
    let job = arguments.job.job_of(&settings)?;
    files::check_spared(targets, &job.files).map_err(Failure::usage)?;
    terminal.show(&job.warnings);
    // Try all changes; how many there are shows as they run, since pairs depend on what the changes bring
    let bar = terminal.progress("machines", 1);
    let store = arguments.recordings.store()?;
    let advice = advise::advise(&job, store.as_ref(), &mut |done, total| {
        bar.set_length(total);
        bar.set_position(done);
    });
    bar.finish_and_clear();
    // Notes on recordings come first, since they may say why the advice failed.
    tell_notes(store.as_ref(), terminal);
    let advice = advice?;
    // Write the files, and print what does not go there
    let mut files: Vec<(&Path, String)> = Vec::new();
    files.extend(arguments.csv.as_deref().map(|path| (path, advise::csv(&advice))));
    if let Some(path) = arguments.study.as_deref() {
        let study = advice.study(&sweep::study_name(Some(path), "advise"), &settings);
        files.push((path, sweep::study_text(&study, "advise")?));
    }
    files::write_all(&files)?;
    match (is_taken, arguments.json) {
        (true, _) => {}
        (false, true) => terminal.print(&result::json(&WithSettings::new(&advice, Settings::of(&job))))?,
        (false, false) => terminal.tell(&advise::text(&advice, arguments.all))?,
    }
    Ok(Exit::Done)
}
