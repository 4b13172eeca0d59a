//! `lancer bench`: how fast the engines compute pictures on this host, with native code beside them.

use std::cmp::Ordering;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::Args;
use emu::engine::HostSimd;
use kernels::KernelSet;
use messages::Diagnostic;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

use super::diff;
use super::invocation::{CommandSettings, scene_hashes};
use crate::arguments::{self, ChartArguments, SettingsArguments, Size, TreeArguments};
use crate::benchmark::parts::{self, PictureParts};
use crate::benchmark::{self, BenchResult, Runner};
use crate::failure::{Exit, Failure};
use crate::job::Job;
use crate::numeral::count;
use crate::result::WithSettings;
use crate::table::{row, table};
use crate::terminal::Terminal;
use crate::{files, input, result};

/// Version of what `--json` prints.
pub(super) const SCHEMA: &str = "lancer-bench-2";

const EXAMPLES: &str = "\
Examples:
  lancer bench
  lancer bench cornell --profiles ray,vector --threads 2 --svg bench.svg
  lancer bench my.dsc --size 320x240 --runs 9 --json
  lancer bench --json > before.json             # later, on the same host:
  lancer bench --against before.json            # exit code 4 where something takes 10 % longer

Exit codes: 0 done, 1 errors in the input, 2 usage, 4 slower than before.";

/// Change of a time that is allowed unless the user says otherwise, in per cent.
const SLOWER: f64 = 10.0;

/// Measures how fast the engines compute pictures, beside native code.
///
/// All take turns, and ratios are those of medians. `native` and `checked` compute and count the cores' work, `native, clocks` puts it
/// on the machine's clocks as well, `native, all` measures functions too, as `render` does. The native twin is the profile's functions in Rust on the same tree and the same
/// rays, native f64 the reference picture in double precision.
///
/// A second table has the parts of each picture as `render` draws it, one after the other: tree, image and programs; native code; work items,
/// counted; totals of functions and recorded transfers, beside that; recordings on the machine's clocks; the picture out of memory; the
/// comparison with double precision; the file.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct BenchArguments {
    /// Scenes: .dsc or mesh files, or names of generated ones.
    #[arg(value_name = "SCENE", default_values = ["cornell", "sphereflake", "slabs", "mirrors", "terrain"])]
    scenes: Vec<String>,
    /// Size of the pictures in pixels.
    #[arg(long, value_name = "WxH", value_parser = arguments::size, default_value = "160x120")]
    size: Size,
    /// Sets of kernels.
    #[arg(long, value_name = "NAME,..", value_delimiter = ',', value_parser = profile, default_value = "ray")]
    profiles: Vec<KernelSet>,
    /// Runs of each.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000), default_value = "5")]
    runs: u32,
    /// Host threads.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=256), default_value = "1")]
    threads: u32,
    #[command(flatten)]
    tree: TreeArguments,
    #[command(flatten)]
    settings: SettingsArguments,
    /// Prints the results as JSON.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    chart: ChartArguments,
    /// Earlier result (--json) that the times are set against; both need the same size and threads.
    #[arg(long, value_name = "FILE")]
    against: Option<PathBuf>,
    /// Change to more time a pixel than in --against that is allowed, in per cent of the medians [default: 10].
    #[arg(long, value_name = "PERCENT", value_parser = diff::tolerance, allow_hyphen_values = true, requires = "against")]
    tolerance: Option<f64>,
}

pub(super) fn profile(text: &str) -> Result<KernelSet, String> {
    KernelSet::from_str(text).map_err(|message| arguments::plain(&message))
}

/// Times of pictures on a host.
#[derive(Serialize, JsonSchema)]
pub(super) struct Benches {
    /// Version of the result: a key that goes away or changes its meaning changes it, a new key does not.
    #[schemars(extend("const" = SCHEMA))]
    schema: &'static str,
    /// Width of the pictures in pixels.
    width: u32,
    /// Height of the pictures in pixels.
    height: u32,
    /// Runs of each.
    runs: u32,
    /// Host threads.
    threads: u32,
    /// Vector instructions of the host that native code uses: baseline or avx2.
    features: &'static str,
    /// Measurements, scene by scene.
    measured: Vec<BenchResult>,
    /// Time of each picture by part, as `lancer render` draws it.
    parts: Vec<PictureParts>,
    /// Times beside those of an earlier result, measurement by measurement; left out unless one was named.
    #[serde(skip_serializing_if = "Option::is_none")]
    against: Option<Vec<TimeChange>>,
}

/// A time beside an earlier one.
#[derive(Clone, Debug, Serialize, JsonSchema)]
struct TimeChange {
    /// Name of the scene.
    scene: String,
    /// The kernel set.
    profile: &'static str,
    /// Runner that computed the picture, as in `measured`.
    #[schemars(with = "String")]
    runner: Runner,
    /// Earlier nanoseconds a pixel; null where the earlier result has none of them.
    before: Option<f64>,
    /// Change of the time in per cent of the earlier one; more is slower.
    percent: Option<f64>,
    /// True where it takes no longer than the tolerance allows.
    is_within: bool,
}

/// Reads an earlier result.
fn earlier(path: &Path, arguments: &BenchArguments) -> Result<Value, Failure> {
    let before = diff::read(path)?;
    let shown = files::shown(path);
    if before["schema"] != SCHEMA {
        let message = Diagnostic::error(format!("{shown} is no result of `lancer bench --json`"));
        return Err(message.hint(format!("the key `schema` of one is {SCHEMA}")).into());
    }
    let (width, height) = arguments.size;
    let ours = [("width", width), ("height", height), ("threads", arguments.threads)];
    match ours.into_iter().find(|(key, value)| before[key] != *value) {
        None => Ok(before),
        Some((key, value)) => {
            let message = format!("the {key} in {shown} is {}, and {value} here: times do not compare", before[key]);
            Err(Diagnostic::error(message).hint("choose the earlier one with `--size` or `--threads`").into())
        }
    }
}

/// The measurements beside those of an earlier result.
fn changes(measured: &[BenchResult], before: &Value, tolerance: f64) -> Vec<TimeChange> {
    let time = |one: &BenchResult| {
        let runner = serde_json::to_value(one.runner).ok()?;
        let same = |other: &&Value| {
            other["scene"] == one.scene.as_str() && other["profile"] == one.profile && other["runner"] == runner
        };
        before["measured"].as_array()?.iter().find(same)?["nanoseconds"].as_f64().filter(|time| *time > 0.0)
    };
    let change = |one: &BenchResult| {
        let before = time(one);
        let percent = before.map(|before| 100.0 * (one.nanoseconds - before) / before);
        let is_within = percent.is_none_or(|percent| percent <= tolerance);
        TimeChange { scene: one.scene.clone(), profile: one.profile, runner: one.runner, before, percent, is_within }
    };
    measured.iter().map(change).collect()
}

/// Measures and prints.
pub(super) fn execute(
    arguments: &BenchArguments,
    given: &CommandSettings,
    terminal: &mut Terminal,
) -> Result<Exit, Failure> {
    // Check the files and the earlier result before anything is measured
    let targets = arguments.chart.targets(&[])?;
    let is_taken = files::takes_output(targets.iter().map(PathBuf::as_path), arguments.json).map_err(Failure::usage)?;
    let spare =
        |read: &[PathBuf]| files::check_spared(targets.iter().map(PathBuf::as_path), read).map_err(Failure::usage);
    spare(arguments.against.as_slice())?;
    let before = arguments.against.as_deref().map(|path| earlier(path, arguments)).transpose()?;
    let threads = arguments.threads as usize;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global();
    pool.map_err(|error| Diagnostic::error(format!("there are no {threads} threads: {error}")))?;
    let (mut measured, mut by_part, mut read) = (Vec::new(), Vec::new(), Vec::new());
    // Measure each scene with each set of kernels
    for name in &arguments.scenes {
        let loaded = input::scene(name, None, Some(arguments.size))?;
        spare(&loaded.files)?;
        terminal.show(&loaded.warnings);
        for &profile in &arguments.profiles {
            let mut job = Job::new(loaded.scene.clone());
            job.view.size = arguments.size;
            job.kernels.profile = profile;
            arguments.tree.settings().choose(&mut job);
            // Each run is one of every runner, and one more of the parts.
            let rounds = u64::from(arguments.runs) * (Runner::ALL.len() as u64 + 1);
            let bar = terminal.progress(&job.scene.name, rounds);
            measured.extend(benchmark::measure(&job, arguments.runs, || bar.inc(1))?);
            by_part.push(parts::measure(&job, arguments.runs, || bar.inc(1))?);
            bar.finish_and_clear();
        }
        read.push(loaded.scene);
    }
    let figure = || benchmark::figure(&measured, arguments.size, arguments.threads);
    files::write_all(&arguments.chart.files(figure, || benchmark::csv(&measured)))?;
    let (width, height) = arguments.size;
    let BenchArguments { runs, threads, .. } = *arguments;
    let features = HostSimd::best().name();
    let tolerance = arguments.tolerance.unwrap_or(SLOWER);
    let against = before.map(|before| changes(&measured, &before, tolerance));
    let benches = Benches { schema: SCHEMA, width, height, runs, threads, features, measured, parts: by_part, against };
    let settings = given.clone().with_scenes(&scene_hashes(&arguments.scenes, &read));
    match (is_taken, arguments.json) {
        (true, _) => {}
        (false, true) => terminal.print(&result::json(&WithSettings::new(&benches, settings)))?,
        (false, false) => terminal.tell(&text(&benches))?,
    }
    // Fail with the time that has grown most, where one grew beyond the tolerance
    let slower: Vec<&TimeChange> = benches.against.iter().flatten().filter(|change| !change.is_within).collect();
    let Some(worst) =
        slower.iter().max_by(|one, other| one.percent.partial_cmp(&other.percent).unwrap_or(Ordering::Equal))
    else {
        return Ok(Exit::Done);
    };
    let message = format!(
        "{} by more than {} %: {} of {} with {} takes {:.1} % longer",
        count(slower.len() as u64, "time is larger", "times are larger"),
        tolerance,
        worst.runner.name(),
        worst.scene,
        worst.profile,
        worst.percent.unwrap_or(0.0),
    );
    Err(Failure::Message { report: Diagnostic::error(message).into(), exit: Exit::Tolerance })
}

fn text(benches: &Benches) -> String {
    let mut rows = vec![row(["scene", "profile", "by", "ns a pixel", "of twin", "M instructions/s", "M rays/s"])];
    let number = |value: Option<f64>| value.map_or_else(|| "-".into(), |value| format!("{value:.1}"));
    for one in &benches.measured {
        rows.push(vec![
            one.scene.clone(),
            one.profile.to_owned(),
            one.runner.name().to_owned(),
            format!("{:.0}", one.nanoseconds),
            format!("{:.2}", one.of_twin),
            number(one.instructions),
            format!("{:.2}", one.rays),
        ]);
    }
    // The change stands behind everything else.
    if let Some(changes) = &benches.against {
        rows[0].push("against before".to_owned());
        for (row, change) in rows[1..].iter_mut().zip(changes) {
            let mark = if change.is_within { "" } else { " *" };
            row.push(change.percent.map_or("-".to_owned(), |percent| format!("{percent:+.1} %{mark}")));
        }
    }
    let headings = ["scene", "profile"].into_iter().chain(PictureParts::HEADINGS).map(str::to_owned);
    let times = |one: &PictureParts| {
        let names = [one.scene.clone(), one.profile.to_owned()];
        names.into_iter().chain(one.times().map(|time| format!("{time:.1}"))).collect::<Vec<_>>()
    };
    let parts: Vec<Vec<String>> = std::iter::once(headings.collect()).chain(benches.parts.iter().map(times)).collect();
    let Benches { width, height, runs, threads, features, .. } = benches;
    format!(
        "{width} x {height} pixels, medians of {runs} runs, host threads: {threads}, vector instructions: {features}\n{}\n\
         Milliseconds of a picture by part, as `lancer render` draws it\n{}",
        table(rows),
        table(parts)
    )
}
