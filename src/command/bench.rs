//! `lancer bench`: how fast the engines compute pictures on this host, with native code beside them.

use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;
use emu::engine::HostSimd;
use kernels::KernelSet;
use messages::Diagnostic;
use schemars::JsonSchema;
use serde::Serialize;

use super::invocation::{CommandSettings, scene_hashes};
use crate::arguments::{self, SettingsArguments, Size};
use crate::benchmark::{self, BenchResult, Runner};
use crate::failure::{Exit, Failure};
use crate::job::Job;
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
  lancer bench my.dsc --size 320x240 --runs 9 --json";

/// Measures how fast the engines compute pictures, beside native code.
///
/// All take turns, and ratios are those of medians. `native` and `checked` compute and count the cores' work, `native, clocks` puts it
/// on the machine's clocks as well, `native, all` measures functions too, as `render` does. The native twin is the profile's functions in Rust on the same tree and the same
/// rays, native f64 the reference picture in double precision.
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
    settings: SettingsArguments,
    /// Prints the results as JSON.
    #[arg(long)]
    json: bool,
    /// Chart of the times a pixel.
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
}

fn profile(text: &str) -> Result<KernelSet, String> {
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
}

/// Measures and prints.
pub(super) fn execute(
    arguments: &BenchArguments,
    given: &CommandSettings,
    terminal: &mut Terminal,
) -> Result<Exit, Failure> {
    if let Some(path) = &arguments.svg {
        files::check_target(path)?;
    }
    let threads = arguments.threads as usize;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global();
    pool.map_err(|error| Diagnostic::error(format!("there are no {threads} threads: {error}")))?;
    let (mut measured, mut read) = (Vec::new(), Vec::new());
    for name in &arguments.scenes {
        let loaded = input::scene(name, None, Some(arguments.size))?;
        terminal.show(&loaded.warnings);
        for &profile in &arguments.profiles {
            let mut job = Job::new(loaded.scene.clone());
            job.view.size = arguments.size;
            job.kernels.profile = profile;
            let rounds = u64::from(arguments.runs) * Runner::ALL.len() as u64;
            let bar = terminal.progress(&job.scene.name, rounds);
            measured.extend(benchmark::measure(&job, arguments.runs, || bar.inc(1))?);
            bar.finish_and_clear();
        }
        read.push(loaded.scene);
    }
    if let Some(path) = &arguments.svg {
        files::write(path, benchmark::svg(&measured).map_err(Diagnostic::error)?.as_bytes())?;
    }
    let (width, height) = arguments.size;
    let BenchArguments { runs, threads, .. } = *arguments;
    let features = HostSimd::best().name();
    let benches = Benches { schema: SCHEMA, width, height, runs, threads, features, measured };
    let settings = given.clone().with_scenes(&scene_hashes(&arguments.scenes, &read));
    terminal.print(&match arguments.json {
        true => result::json(&WithSettings::new(&benches, settings)),
        false => text(&benches),
    })?;
    Ok(Exit::Done)
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
    let Benches { width, height, runs, threads, features, .. } = benches;
    format!(
        "{width} x {height} pixels, medians of {runs} runs, host threads: {threads}, vector instructions: {features}\n{}",
        table(rows)
    )
}
