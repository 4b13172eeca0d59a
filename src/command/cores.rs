//! `lancer cores`: what more cores bring on one bus.

use std::path::{Path, PathBuf};

use clap::Args;
use emu::engine::EngineKind;
use emu::machine::Config;
use emu::machine::arbiter::ArbiterKind;
use emu::machine::config::MOST_CORES;
use scenes::layout::Layout;
use schemars::JsonSchema;
use serde::Serialize;

use crate::arguments::{
    self, ChartArguments, EffortArguments, JobArguments, KernelArguments, MachineArguments, MachineKeyArguments,
    NumberArguments, RecordingArguments, SetArguments, ViewArguments, tell_notes,
};
use crate::cores::{self, CoresResult};
use crate::failure::{Exit, Failure};
use crate::job::{Job, result_name};
use crate::load::{ANNEX, Load};
use crate::numeral::numbers;
use crate::result::WithSettings;
use crate::settings::{MachineSettings, Settings};
use crate::sweep::frames::KeptRecordings;
use crate::terminal::Terminal;
use crate::{files, machine, result};

const EXAMPLES: &str = "\
Examples:
  lancer cores annex                        # the report's estimate: where is the bus full?
  lancer cores cornell --size 80x60 --cores 1..8,16 --svg cores.svg
  lancer cores cornell --size 80x60 --machine report --machine node_cache --csv cores.csv
  lancer cores annex --arbiter fixed-priority --arbiter tdma --json

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
    let (scaling, settings) = match arguments.scene == ANNEX && !Path::new(ANNEX).exists() {
        true => annex(arguments, terminal)?,
        false => picture(arguments, terminal)?,
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
    let roofline: Vec<&Path> = arguments.roofline.as_deref().into_iter().collect();
    arguments.chart.targets(&roofline)
}

/// A machine with each of the arbiters that are asked for, or with its own.
fn with_arbiters(arguments: &CoresArguments, name: &str, config: &Config) -> Vec<(String, Config)> {
    if arguments.arbiters.is_empty() {
        return vec![(name.to_owned(), config.clone())];
    }
    let with = |&arbiter: &ArbiterKind| {
        let mut config = config.clone();
        config.bus.arbiter = arbiter;
        (name.to_owned(), config)
    };
    arguments.arbiters.iter().map(with).collect()
}

fn annex(arguments: &CoresArguments, terminal: &Terminal) -> Result<(CoresResult, CoresSettings), Failure> {
    let mut machines = Vec::new();
    for name in arguments.machines.iter().flatten() {
        let mut settings = job(arguments, name).settings()?;
        settings.machine.config.main.traffic = false;
        machines.extend(with_arbiters(arguments, &settings.machine.name, &settings.machine.config));
    }
    let scaling = measure(ANNEX, &Load::annex()?, &machines, arguments, (None, terminal))?;
    let mut job = Settings::default();
    ANNEX.clone_into(&mut job.scene.name);
    Ok((scaling, settings(arguments, job, machines)))
}

fn picture(arguments: &CoresArguments, terminal: &Terminal) -> Result<(CoresResult, CoresSettings), Failure> {
    let jobs = arguments.machines.iter().flatten().map(|machine| job(arguments, machine).job());
    let jobs = jobs.collect::<Result<Vec<Job>, Failure>>()?;
    let targets = targets(arguments)?;
    files::check_spared(targets.iter().map(PathBuf::as_path), jobs.iter().flat_map(|job| &job.files))
        .map_err(Failure::usage)?;
    terminal.show(&jobs[0].warnings);
    let store = arguments.recordings.store()?;
    let (mut whole, mut all): (Option<CoresResult>, Vec<(String, Config)>) = (None, Vec::new());
    // Machines with words of the same length share the picture in memory and the programs.
    for alike in jobs.chunk_by(|one, other| one.machine.arithmetic.word == other.machine.arithmetic.word) {
        let (load, _) = Load::picture(&alike[0])?;
        terminal.show(&load.build.warnings);
        let machines = alike.iter().flat_map(|job| with_arbiters(arguments, &job.machine_name, &job.machine));
        let machines: Vec<(String, Config)> = machines.collect();
        let picture = Settings::of(&alike[0]);
        let kept = store.as_ref().map(|store| KeptRecordings { store, settings: &picture });
        let scaling = measure(&result_name(&alike[0].scene), &load, &machines, arguments, (kept, terminal))?;
        all.extend(machines);
        match &mut whole {
            Some(whole) => whole.machines.extend(scaling.machines),
            None => whole = Some(scaling),
        }
    }
    let whole = whole.ok_or_else(|| messages::Diagnostic::error("no machine was named"))?;
    Ok((whole, settings(arguments, Settings::of(&jobs[0]), all)))
}

fn settings(arguments: &CoresArguments, mut job: Settings, machines: Vec<(String, Config)>) -> CoresSettings {
    let machines: Vec<_> = machines.into_iter().map(|(name, config)| MachineSettings { name, config }).collect();
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

/// Measures, with the recordings that are kept, and a bar that shows how far the computing is.
fn measure(
    scene: &str,
    load: &Load,
    machines: &[(String, Config)],
    arguments: &CoresArguments,
    (kept, terminal): (Option<KeptRecordings>, &Terminal),
) -> Result<CoresResult, Failure> {
    let bar = terminal.progress("pixels", u64::from(load.build.crop.width) * u64::from(load.build.crop.height));
    let progress = &mut |done| bar.set_position(done);
    let scaling = cores::measure(scene, load, machines, &cores_of(arguments), kept, progress);
    bar.finish_and_clear();
    tell_notes(kept.map(|kept| kept.store), terminal);
    scaling
}
