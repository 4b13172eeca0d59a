//! `lancer servers`: one frame on several coprocessors.

use std::path::PathBuf;

use clap::Args;

use super::invocation::{CommandSettings, scene_hashes};
use crate::arguments::{self, ChartArguments, JobArguments, Size};
use crate::failure::{Exit, Failure};
use crate::numeral::numbers;
use crate::result::WithSettings;
use crate::servers::{self, FrameDivision, MOST_SERVERS, SceneHome, ServerLink, ServersPlan};
use crate::settings::MachineSettings;
use crate::terminal::Terminal;
use crate::{files, result};

const EXAMPLES: &str = "\
Examples:
  lancer servers cornell --size 160x120
  lancer servers cornell --servers 1,2,4,8,16 --tile 8x8 --tile 32x32 --divide tiles,stealing
  lancer servers terrain --scene-home shared --link-latency 20 --link-octets 8 --json

The report asks for a distributed model and compares with four servers of 0.013 us a pixel (6.4, table 3).";

/// Draws one frame on several coprocessors, each with its own cores, bus and memory, and says what more of them bring.
///
/// The frame is divided into parts, each of which a server draws as a frame of its own, replayed to the clock. Requests, pixels and
/// copies of the scene pass links with a latency, which meet in one port of the host. One server is the machine as it is.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct ServersArguments {
    /// Numbers of servers and ranges, such as 1-4,8; one server is always among them; may be repeated.
    #[arg(long, value_name = "LIST", value_parser = server_list, default_value = "1,2,4,8,16")]
    servers: Vec<Vec<u32>>,
    /// Ways to divide the frame, between commas.
    #[arg(
        long,
        value_enum,
        value_name = "NAME,..",
        value_delimiter = ',',
        default_value = "tiles,rows,stealing",
        hide_possible_values = false
    )]
    divide: Vec<FrameDivision>,
    /// Size of a tile in pixels; may be repeated.
    #[arg(long, value_name = "WxH", value_parser = arguments::size, default_value = "16x16")]
    tile: Vec<Size>,
    /// Home of the scene.
    #[arg(long, value_enum, value_name = "NAME", default_value = "copied", hide_possible_values = false)]
    scene_home: SceneHome,
    /// Latency of a link in clocks of the machine; 480 are 4.8 us at 100 MHz.
    #[arg(long, value_name = "CLOCKS", value_parser = clap::value_parser!(u64).range(0..=1_000_000_000), default_value = "480")]
    link_latency: u64,
    /// Octets that pass the host's port in a clock; 2 are 200 MB/s at 100 MHz.
    #[arg(long, value_name = "OCTETS", value_parser = clap::value_parser!(u64).range(1..=65_536), default_value = "2")]
    link_octets: u64,
    /// Prints the results as JSON instead of tables.
    #[arg(long, help_heading = "Results")]
    json: bool,
    #[command(flatten)]
    chart: ChartArguments,
    #[command(flatten)]
    job: JobArguments,
}

fn server_list(text: &str) -> Result<Vec<u32>, String> {
    numbers(text, 1, MOST_SERVERS, "number of servers")
}

/// Values without those that stand there already.
fn distinct<T: PartialEq + Copy>(values: &[T]) -> Vec<T> {
    let mut distinct = Vec::new();
    for value in values {
        if !distinct.contains(value) {
            distinct.push(*value);
        }
    }
    distinct
}

impl ServersArguments {
    fn plan(&self) -> ServersPlan {
        let mut servers: Vec<u32> = std::iter::once(1).chain(self.servers.iter().flatten().copied()).collect();
        servers.sort_unstable();
        servers.dedup();
        ServersPlan {
            servers,
            divisions: distinct(&self.divide),
            tiles: distinct(&self.tile),
            home: self.scene_home,
            link: ServerLink { latency_clocks: self.link_latency, octets_per_clock: self.link_octets },
        }
    }
}

/// Draws, writes and prints.
pub(super) fn execute(
    arguments: &ServersArguments,
    given: &CommandSettings,
    terminal: &mut Terminal,
) -> Result<Exit, Failure> {
    let targets = arguments.chart.targets(&[])?;
    let is_taken = files::takes_output(targets.iter().map(PathBuf::as_path), arguments.json).map_err(Failure::usage)?;
    let job = arguments.job.job()?;
    files::check_spared(targets.iter().map(PathBuf::as_path), &job.files).map_err(Failure::usage)?;
    terminal.show(&job.warnings);
    let plan = arguments.plan();
    let (width, height) = job.kernels.crop.map_or(job.view.size, |crop| (crop.width, crop.height));
    let bar = terminal.progress("pixels", plan.pixels(u64::from(width) * u64::from(height)));
    let measured = servers::measure(&job, &plan, &|pixels| bar.inc(pixels));
    bar.finish_and_clear();
    let measured = measured?;
    files::write_all(&arguments.chart.files(|| servers::figure(&measured), || servers::csv(&measured)))?;
    let machine = MachineSettings { name: job.machine_name.clone(), config: job.machine.clone() };
    let names = [arguments.job.scene.clone()];
    let hashes = scene_hashes(&names, std::slice::from_ref(&job.scene));
    let settings = given.clone().with_machine(&machine).with_scenes(&hashes);
    match (is_taken, arguments.json) {
        (true, _) => {}
        (false, true) => terminal.print(&result::json(&WithSettings::new(&measured, settings)))?,
        (false, false) => terminal.tell(&servers::text(&measured))?,
    }
    Ok(Exit::Done)
}
