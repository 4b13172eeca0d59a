//! `lancer cores`: what more cores bring on one bus.

use std::path::{Path, PathBuf};

use clap::Args;
use emu::engine::EngineKind;
use emu::machine::arbiter::ArbiterKind;
use emu::machine::config::MOST_CORES;
use messages::{Diagnostic, Report};
use scenes::layout::Layout;
use schemars::JsonSchema;
use serde::Serialize;

use super::sweep;
use crate::arguments::{
    self, ChartArguments, EffortArguments, JobArguments, KernelArguments, MachineArguments, MachineKeyArguments,
    NumberArguments, RecordingArguments, SetArguments, ViewArguments, tell_notes,
};
use crate::cores::{self, CoresResult};
use crate::failure::{Exit, Failure};
use crate::load::{ANNEX, ANNEX_PIXELS};
use crate::numeral::numbers;
use crate::result::WithSettings;
use crate::settings::{MachineSettings, Settings};
use crate::sweep::contents::Contents;
use crate::sweep::study::Study;
use crate::sweep::study_text::check_named;
use crate::terminal::Terminal;
use crate::{files, machine, result};

const EXAMPLES: &str = "\
Examples:
  lancer cores annex                        # the report's estimate: where is the bus full?
  lancer cores cornell --size 80x60 --cores 1..8,16 --svg cores.svg
  lancer cores cornell --size 80x60 --machine report --machine node_cache --csv cores.csv
  lancer cores annex --arbiter fixed-priority --arbiter tdma --json
  lancer cores cornell --size 80x60 --study cores.toml && lancer sweep cores.toml

The report divides 203,000 clocks of computing by 49,600 of transfers and gets 4.09 cores. A core that
computes or waits, never both, fills the bus at (C + M) / M = 5.09. Pixels are computed once and
replayed for each number of cores, machine and arbiter that computes alike.";

/// Draws a picture with several numbers of cores and says what more of them bring: time, speed-up, how busy the bus is.
///
/// Beside the measured time of a pixel stand the time without any waiting, max((C + M) / N, M), and a queueing estimate
/// (mean value analysis). The knee is the number of cores at which a straight line of the first cores would reach the
/// highest speed-up.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct CoresArguments {
    /// Scene: a .dsc with its mesh beside it, a mesh, or the name of a generated scene such as cornell; or annex, the
    /// report's estimate: 1,000 pixels of 203,000 clocks of computing and 49,600 of transfers in 20 equal parts, the
    /// main processor's transfers taking no time.
    scene: String,
    /// Mesh that belongs to the .dsc [default: the file of the same name beside it].
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    /// Numbers of cores and ranges, such as 1-4,8; one core is always among them; may be repeated.
    #[arg(long, value_name = "LIST", value_parser = core_list, default_value = "1..8,12,16")]
    cores: Vec<Vec<u32>>,
    /// Machines between commas: presets' names or TOML files; may be repeated.
    #[arg(long = "machine", value_name = "NAME|FILE,..", value_parser = arguments::machines, default_value = machine::DEFAULT)]
    machines: Vec<Vec<String>>,
    /// Arbiters instead of the machine's, between commas; may be repeated.
    #[arg(long = "arbiter", value_name = "NAME,..", value_delimiter = ',', value_parser = arguments::arbiter())]
    arbiters: Vec<ArbiterKind>,
    #[command(flatten)]
    sets: SetArguments,
    /// Structures of global memory [default: report for the profile report, else wide].
    #[arg(long, value_name = "NAME", value_parser = arguments::layout())]
    layout: Option<Layout>,
    /// Adds energy and area as ranges over published tables.
    #[arg(long, help_heading = "Results")]
    energy: bool,
    /// Prints the results as JSON instead of tables.
    #[arg(long, help_heading = "Results")]
    json: bool,
    /// Roofline of the bus, operations an octet against operations a second: .svg or .pdf.
    #[arg(long, value_name = "FILE", value_parser = arguments::chart_file, help_heading = "Charts and data")]
    roofline: Option<PathBuf>,
    #[command(flatten)]
    chart: ChartArguments,
    /// Writes all machines with all numbers of cores as a study that `lancer sweep` runs, a row each, on one machine or on many, and draws
    /// nothing (`-` for standard output).
    #[arg(long, value_name = "FILE", help_heading = "Charts and data", conflicts_with_all = DRAWN)]
    study: Option<PathBuf>,
    #[command(flatten)]
    view: ViewArguments,
    #[command(flatten)]
    kernels: KernelArguments,
    #[command(flatten)]
    numbers: NumberArguments,
    #[command(flatten)]
    effort: EffortArguments,
    #[command(flatten)]
    recordings: RecordingArguments,
}

/// Options of what is measured and how it is shown, none of which a study has.
const DRAWN: [&str; 7] = ["json", "csv", "svg", "pdf", "roofline", "energy", "folder"];

/// Settings of a measurement: a picture's, with all machines and all numbers of cores.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(super) struct CoresSettings {
    /// The picture's, on the first machine.
    #[serde(flatten)]
    job: Settings,
    /// Numbers of cores.
    cores: Vec<u32>,
    /// The machines, key by key, whatever their numbers of cores.
    machines: Vec<MachineSettings>,
}

fn core_list(text: &str) -> Result<Vec<u32>, String> {
    numbers(text, 1, MOST_CORES, "number of cores")
}

/// Measures, writes and prints.
pub(super) fn execute(arguments: &CoresArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let targets = targets(arguments)?;
    let is_taken = files::takes_output(targets.iter().map(PathBuf::as_path), arguments.json).map_err(Failure::usage)?;
    let machines = arguments.machines.iter().flatten().map(PathBuf::from);
    files::check_spared(targets.iter().map(PathBuf::as_path), machines).map_err(Failure::usage)?;
    let is_annex = arguments.scene == ANNEX && !Path::new(ANNEX).exists();
    if let Some(path) = arguments.study.as_deref().filter(|_| !is_annex) {
        let contents = Contents::default();
        let points = points(arguments, &targets, &contents, terminal)?;
        return sweep::write_study(&points.study, "cores", path, &contents, terminal);
    }
    let (scaling, settings) = match is_annex {
        true => annex(arguments, terminal)?,
        false => picture(arguments, &targets, terminal)?,
    };
    let mut files = arguments.chart.files(|| cores::figure(&scaling), || cores::csv(&scaling));
    files.extend(arguments.roofline.as_deref().map(|path| arguments.chart.file(path, &cores::roofline(&scaling))));
    files::write_all(&files)?;
    let energy = if arguments.energy { cores::energy_text(&scaling) } else { String::new() };
    match (is_taken, arguments.json) {
        (true, _) => {}
        (false, true) => terminal.print(&result::json(&WithSettings::new(&scaling, settings)))?,
        (false, false) => terminal.tell(&(cores::text(&scaling) + &energy))?,
    }
    Ok(Exit::Done)
}

/// Files that will be written.
fn targets(arguments: &CoresArguments) -> Result<Vec<PathBuf>, Failure> {
    let more: Vec<&Path> =
        [&arguments.roofline, &arguments.study].into_iter().flatten().map(PathBuf::as_path).collect();
    arguments.chart.targets(&more)
}

/// A machine with each of the arbiters that are asked for, or with its own.
fn with_arbiters(arguments: &CoresArguments, machine: &MachineSettings) -> Vec<MachineSettings> {
    if arguments.arbiters.is_empty() {
        return vec![machine.clone()];
    }
    let with = |&arbiter: &ArbiterKind| {
        let mut machine = machine.clone();
        machine.config.bus.arbiter = arbiter;
        machine
    };
    arguments.arbiters.iter().map(with).collect()
}

fn annex(arguments: &CoresArguments, terminal: &Terminal) -> Result<(CoresResult, CoresSettings), Failure> {
    if arguments.study.is_some() {
        let message = Diagnostic::error("the report's estimate is no picture, and a study has pictures");
        return Err(Failure::usage(message.hint("name a scene in the place of `annex`")));
    }
    let mut machines = Vec::new();
    for name in arguments.machines.iter().flatten() {
        let mut settings = job(arguments, name).settings()?;
        settings.machine.config.main.traffic = false;
        machines.extend(with_arbiters(arguments, &settings.machine));
    }
    let bar = terminal.progress("pixels", ANNEX_PIXELS.into());
    let scaling = cores::estimate(&machines, &cores_of(arguments), &mut |done| bar.set_position(done));
    bar.finish_and_clear();
    let mut job = Settings::default();
    ANNEX.clone_into(&mut job.scene.name);
    Ok((scaling?, settings(arguments, job, machines)))
}

/// A study of a picture with its machines, and its settings on the first of them.
struct CorePoints {
    study: Study,
    machines: Vec<MachineSettings>,
    settings: Settings,
}

/// The points that the options ask for. Reads the scene, and refuses results in the place of what was read.
fn points(
    arguments: &CoresArguments,
    targets: &[PathBuf],
    contents: &Contents,
    terminal: &Terminal,
) -> Result<CorePoints, Failure> {
    let jobs: Vec<JobArguments> = arguments.machines.iter().flatten().map(|machine| job(arguments, machine)).collect();
    let all = jobs.iter().map(JobArguments::settings).collect::<Result<Vec<Settings>, _>>()?;
    let (Some(first), Some(base)) = (jobs.first(), all.first()) else {
        return Err(Diagnostic::error("no machine was named").into());
    };
    if arguments.study.is_some() {
        check_named(base, [])?;
    }
    let job = first.job_by(base, contents)?;
    files::check_spared(targets.iter().map(PathBuf::as_path), &job.files).map_err(Failure::usage)?;
    terminal.show(&job.warnings);
    let machines: Vec<MachineSettings> =
        all.iter().flat_map(|settings| with_arbiters(arguments, &settings.machine)).collect();
    let name = sweep::study_name(arguments.study.as_deref(), "cores");
    let study = cores::study(&name, base, &machines, &cores_of(arguments));
    Ok(CorePoints { study, machines, settings: Settings::of(&job) })
}

/// Measures the points, and shows how far the computing is.
fn picture(
    arguments: &CoresArguments,
    targets: &[PathBuf],
    terminal: &Terminal,
) -> Result<(CoresResult, CoresSettings), Failure> {
    let contents = Contents::default();
    let CorePoints { study, machines, settings: job } = points(arguments, targets, &contents, terminal)?;
    let store = arguments.recordings.store()?;
    let bar = terminal.progress("pixels", job.pixels());
    let mut shown: Vec<Report> = Vec::new();
    let mut warn = |warnings: &Report| {
        // Machines that compute otherwise have programs of the same kernels.
        if !shown.contains(warnings) {
            bar.suspend(|| terminal.show(warnings));
            shown.push(warnings.clone());
        }
    };
    let progress = &mut |done| bar.set_position(done);
    let scaling = cores::drawn(&study, (&contents, store.as_ref()), &mut warn, progress);
    bar.finish_and_clear();
    tell_notes(store.as_ref(), terminal);
    Ok((scaling?, settings(arguments, job, machines)))
}

fn settings(arguments: &CoresArguments, mut job: Settings, machines: Vec<MachineSettings>) -> CoresSettings {
    job.machine.clone_from(&machines[0]);
    job.tree.resolve(job.kernels.profile);
    CoresSettings { job, cores: cores_of(arguments), machines }
}

/// The numbers of cores, the fewest first.
fn cores_of(arguments: &CoresArguments) -> Vec<u32> {
    let mut cores: Vec<u32> = arguments.cores.iter().flatten().copied().collect();
    cores.sort_unstable();
    cores.dedup();
    cores
}

fn job(arguments: &CoresArguments, machine: &str) -> JobArguments {
    let CoresArguments { scene, mesh, layout, view, kernels, numbers, effort, sets, .. } = arguments.clone();
    let keys = MachineKeyArguments { machine: machine.to_owned(), cores: None, arbiter: None, sets };
    let machine = MachineArguments { keys, layout, engine: EngineKind::default() };
    JobArguments { scene, mesh, view, kernels, machine, numbers, effort }
}
