//! `lancer cores`: what more cores bring on one bus.

use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use emu::engine::EngineKind;
use emu::machine::Config;
use emu::machine::arbiter::ArbiterKind;
use scenes::layout::Layout;

use crate::arguments::JobArguments;
use crate::arguments::{self, EffortArguments, KernelArguments, MachineArguments, NumberArguments, ViewArguments};
use crate::cores::{self, CoresResult};
use crate::failure::{Exit, Failure};
use crate::job::{Job, result_name};
use crate::load::{ANNEX, Load};
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
    /// Numbers of cores; one core is always among them.
    #[arg(long, value_name = "LIST", value_parser = core_list, default_value = "1..8,12,16")]
    cores: CoreList,
    /// Machine: a preset's name or a TOML file; may be repeated.
    #[arg(long = "machine", value_name = "NAME|FILE", default_value = machine::DEFAULT)]
    machines: Vec<String>,
    /// Arbiter instead of the machine's; may be repeated.
    #[arg(long = "arbiter", value_name = "NAME", value_parser = arbiter())]
    arbiters: Vec<ArbiterKind>,
    /// Structures of global memory [default: report for the profile report, else wide].
    #[arg(long, value_name = "NAME", value_parser = arguments::layout())]
    layout: Option<Layout>,
    /// Writes the points as comma-separated values.
    #[arg(long, value_name = "FILE", help_heading = "Results")]
    csv: Option<PathBuf>,
    /// Draws the curves.
    #[arg(long, value_name = "FILE", help_heading = "Results")]
    svg: Option<PathBuf>,
    /// Prints the results as JSON instead of tables.
    #[arg(long, help_heading = "Results")]
    json: bool,
    #[command(flatten)]
    view: ViewArguments,
    #[command(flatten)]
    kernels: KernelArguments,
    #[command(flatten)]
    numbers: NumberArguments,
    #[command(flatten)]
    effort: EffortArguments,
}

/// Numbers of cores, the fewest first.
#[derive(Clone, Debug, PartialEq, Eq)]
struct CoreList(Vec<u32>);

/// Numbers and ranges between commas: `1..4,8`.
fn core_list(text: &str) -> Result<CoreList, String> {
    let number = |text: &str| match text.trim().parse::<u32>() {
        Ok(cores) if (1..=256).contains(&cores) => Ok(cores),
        _ => Err(format!("`{}` is no number of cores from 1 to 256", text.trim())),
    };
    let mut cores = Vec::new();
    for part in text.split(',') {
        match part.split_once("..") {
            None => cores.push(number(part)?),
            Some((first, last)) => {
                let (first, last) = (number(first)?, number(last.trim_start_matches('='))?);
                if first > last {
                    return Err(format!("`{part}` goes down"));
                }
                cores.extend(first..=last);
            }
        }
    }
    cores.sort_unstable();
    cores.dedup();
    Ok(CoreList(cores))
}

fn arbiter() -> impl TypedValueParser<Value = ArbiterKind> {
    let names = PossibleValuesParser::new(ArbiterKind::ALL.map(ArbiterKind::name));
    let find = |name: String| ArbiterKind::ALL.into_iter().find(|kind| kind.name() == name);
    names.map(move |name| find(name).expect("the parser lets only names pass"))
}

/// Measures, writes and prints.
pub(super) fn execute(arguments: &CoresArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let targets = [arguments.csv.as_deref(), arguments.svg.as_deref()];
    files::check_distinct(targets.into_iter().flatten()).map_err(Failure::usage)?;
    for target in targets.into_iter().flatten() {
        files::check_target(target)?;
    }
    let machines = arguments.machines.iter().map(PathBuf::from);
    files::check_spared(targets.into_iter().flatten(), machines).map_err(Failure::usage)?;
    let scaling = match arguments.scene == ANNEX && !Path::new(ANNEX).exists() {
        true => annex(arguments, terminal)?,
        false => picture(arguments, terminal)?,
    };
    let mut files = Vec::new();
    files.extend(arguments.csv.as_ref().map(|path| (path, cores::csv(&scaling))));
    if let Some(path) = &arguments.svg {
        files.push((path, cores::svg(&scaling)?));
    }
    files::write_all(&files)?;
    terminal.print(&if arguments.json { result::json(&scaling) } else { cores::text(&scaling) })?;
    Ok(Exit::Done)
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

fn annex(arguments: &CoresArguments, terminal: &Terminal) -> Result<CoresResult, Failure> {
    let mut machines = Vec::new();
    for name in &arguments.machines {
        let (name, mut config) = machine::find(name)?;
        config.main.traffic = false;
        machines.extend(with_arbiters(arguments, &name, &config));
    }
    measure(ANNEX, &Load::annex()?, &machines, arguments, terminal)
}

fn picture(arguments: &CoresArguments, terminal: &Terminal) -> Result<CoresResult, Failure> {
    let jobs = arguments.machines.iter().map(|machine| job(arguments, machine).job());
    let jobs = jobs.collect::<Result<Vec<Job>, Failure>>()?;
    let targets = [arguments.csv.as_deref(), arguments.svg.as_deref()].into_iter().flatten();
    files::check_spared(targets, jobs.iter().flat_map(|job| &job.files)).map_err(Failure::usage)?;
    terminal.show(&jobs[0].warnings);
    let mut whole: Option<CoresResult> = None;
    // Machines with words of the same length share the picture in memory and the programs.
    for alike in jobs.chunk_by(|one, other| one.machine.arithmetic.word == other.machine.arithmetic.word) {
        let (load, _) = Load::picture(&alike[0])?;
        terminal.show(&load.build.warnings);
        let machines = alike.iter().flat_map(|job| with_arbiters(arguments, &job.machine_name, &job.machine));
        let machines: Vec<(String, Config)> = machines.collect();
        let scaling = measure(&result_name(&alike[0].scene), &load, &machines, arguments, terminal)?;
        match &mut whole {
            Some(whole) => whole.machines.extend(scaling.machines),
            None => whole = Some(scaling),
        }
    }
    whole.ok_or_else(|| messages::Diagnostic::error("no machine was named").into())
}

fn job(arguments: &CoresArguments, machine: &str) -> JobArguments {
    let CoresArguments { scene, mesh, layout, view, kernels, numbers, effort, .. } = arguments.clone();
    let machine = MachineArguments { machine: machine.to_owned(), cores: None, layout, engine: EngineKind::default() };
    JobArguments { scene, mesh, view, kernels, machine, numbers, effort }
}

/// Measures with a bar that shows how far the computing is.
fn measure(
    scene: &str,
    load: &Load,
    machines: &[(String, Config)],
    arguments: &CoresArguments,
    terminal: &Terminal,
) -> Result<CoresResult, Failure> {
    let bar = terminal.progress("pixels", u64::from(load.build.crop.width) * u64::from(load.build.crop.height));
    let scaling = cores::measure(scene, load, machines, &arguments.cores.0, &mut |done| bar.set_position(done));
    bar.finish_and_clear();
    scaling
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_cores() {
        assert_eq!(core_list("1..4,8, 2"), Ok(CoreList(vec![1, 2, 3, 4, 8])));
        assert_eq!(core_list("16"), Ok(CoreList(vec![16])));
        for text in ["", "0", "257", "4..2", "1..", "a", "1,,2", "1..999"] {
            assert!(core_list(text).is_err(), "{text}");
        }
    }
}
