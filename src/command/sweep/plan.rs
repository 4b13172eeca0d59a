//! `lancer sweep plan`: the points of a study.

use std::path::{Path, PathBuf};

use clap::Args;
use messages::Report;

use super::{planned, study};
use crate::failure::{Exit, Failure};
use crate::files;
use crate::sweep::contents::Contents;
use crate::sweep::study::Study;
use crate::terminal::Terminal;

const EXAMPLES: &str = "\
Examples:
  lancer sweep plan study.toml > plan.jsonl
  lancer sweep plan examples/study.toml -o plan.jsonl";

/// Lists the points of a study, each with the hash of all that its result depends on.
///
/// The number of points and recordings, and a rough time, go to standard error. A hash covers version, settings and contents of files, never
/// paths, names, order, host or engine; points with the same hash are one.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct PlanArguments {
    /// Study: a TOML file.
    #[arg(value_name = "STUDY.toml")]
    study: PathBuf,
    /// Plan [default: standard output].
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// The file of a study whose points a command draws.
pub(in crate::command) fn study_text(study: &Study, command: &str) -> Result<String, Report> {
    study.text(&format!("Points of `lancer {command}`, which `lancer sweep` runs."))
}

/// Writes the study whose points a command draws, and says how many they are. Points that could not be run are refused.
pub(in crate::command) fn write_study(
    study: &Study,
    command: &str,
    path: &Path,
    contents: &Contents,
    terminal: &Terminal,
) -> Result<Exit, Failure> {
    let text = study_text(study, command)?;
    planned(study, contents, terminal)?;
    files::write_all(&[(path, text)])?;
    Ok(Exit::Done)
}

/// Plans and prints.
pub(super) fn execute(arguments: &PlanArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let output = arguments.output.as_deref().filter(|path| path.as_os_str() != files::STANDARD);
    if let Some(path) = output {
        files::check_target(path)?;
        files::check_spared([path], [&arguments.study]).map_err(Failure::usage)?;
    }
    let plan = planned(&study(&arguments.study)?, &Contents::default(), terminal)?;
    match output {
        Some(path) => files::write(path, &plan.octets().collect::<Vec<_>>().concat())?,
        None => plan.octets().try_for_each(|octets| terminal.print_octets(&octets))?,
    }
    Ok(Exit::Done)
}
