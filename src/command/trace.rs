//! `lancer trace`: what every processor and the bus do, clock by clock.

use std::ops::Range;
use std::path::{Path, PathBuf};

use clap::Args;
use emu::machine::trace::Window;
use emu::machine::{Config, RunOptions, RunOutcome};
use emu::quantity::Clocks;
use messages::Diagnostic;

use crate::arguments::{JobArguments, ungrouped};
use crate::failure::{Exit, Failure};
use crate::files;
use crate::job::result_name;
use crate::load::{ANNEX, Load};
use crate::numeral::{grouped, percent};
use crate::table::{row, table};
use crate::terminal::Terminal;
use crate::trace::{TracedScene, perfetto, wave};

const EXAMPLES: &str = "\
Examples:
  lancer trace cornell --size 80x60 --pixel 40,30
  lancer trace cornell --size 80x60 --clocks 10000..20000 --fst bus.fst
  lancer trace annex --clocks 0..600000 --perfetto bus.json

GTKWave and Surfer show the FST file, https://ui.perfetto.dev the other one.";

/// Clocks of the longest window.
const LONGEST: u64 = 50_000_000;

/// Shows what every processor and the bus do in a window of clocks or during one pixel, as a wave and as a trace.
///
/// The wave (FST) has the bus with its owner and address, and each processor with request, grant, state (0 idle, 1 busy,
/// 2 waiting for the bus) and pixel. The trace has a track a core and one for the bus. The whole picture is drawn:
/// --pixel only chooses the clocks. Without --fst and --perfetto, NAME.fst and NAME.trace.json are written in the current
/// folder.
#[derive(Args, Clone, Debug)]
#[command(
    after_help = EXAMPLES,
    mut_arg("scene", |scene| scene.help("Scene, as for `lancer render`; or annex, the report's estimate as for `lancer cores`")),
    mut_arg("pixel", |pixel| pixel.help("The clocks of this pixel: its column and its row from the top").conflicts_with("clocks")),
)]
pub struct TraceArguments {
    #[command(flatten)]
    job: JobArguments,
    /// The clocks from A on, B no longer.
    #[arg(long, value_name = "A..B", value_parser = clocks, required_unless_present = "pixel")]
    clocks: Option<Range<u64>>,
    /// Wave file: .fst.
    #[arg(long, value_name = "FILE", help_heading = "Results")]
    fst: Option<PathBuf>,
    /// Trace file for Perfetto: .json.
    #[arg(long, value_name = "FILE", help_heading = "Results")]
    perfetto: Option<PathBuf>,
}

fn clocks(text: &str) -> Result<Range<u64>, String> {
    let clock = |text: &str| {
        let plain = ungrouped(text);
        plain.parse::<u64>().map_err(|_| format!("`{}` is no clock", text.trim()))
    };
    let (start, end) = text.split_once("..").ok_or("two clocks are expected, such as 1000..2000")?;
    let (start, end) = (clock(start)?, clock(end)?);
    match end.checked_sub(start) {
        None | Some(0) => Err(format!("there is no clock in {start}..{end}")),
        Some(length) if length > LONGEST => Err(format!("a window has at most {} clocks", grouped(LONGEST))),
        Some(_) => Ok(start..end),
    }
}

/// Runs, writes and prints.
pub(super) fn execute(arguments: &TraceArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let (name, load, config, width, read) = load(arguments, terminal)?;
    // Without a name for either, both files are written beside each other.
    let is_default = arguments.fst.is_none() && arguments.perfetto.is_none();
    let target = |given: &Option<PathBuf>, ending: &str| match is_default {
        true => Some(PathBuf::from(format!("{name}.{ending}"))),
        false => given.clone(),
    };
    let targets = [target(&arguments.fst, "fst"), target(&arguments.perfetto, "trace.json")];
    let paths = || targets.iter().flatten().map(PathBuf::as_path);
    files::check_distinct(paths()).map_err(Failure::usage)?;
    files::check_spared(paths(), &read).map_err(Failure::usage)?;
    for path in paths() {
        files::check_target(path)?;
    }
    // The window: clocks as given, or those of a pixel, for which the frame runs once without watching.
    let window = match (&arguments.clocks, arguments.job.view.pixel) {
        (Some(clocks), _) => Window { start: Clocks(clocks.start), end: Clocks(clocks.end) },
        (None, Some([column, row])) => pixel(&load, &config, [column, row], width, terminal)?,
        (None, None) => return Err(Failure::usage(Diagnostic::error("neither clocks nor a pixel are given"))),
    };
    let frame = run(&load, &config, Some(window), terminal)?;
    if frame.clocks <= window.start {
        let message = format!("the frame is over after {} clocks", grouped(frame.clocks.0));
        return Err(Failure::usage(Diagnostic::error(message).hint("choose earlier clocks")));
    }
    let scene = TracedScene::new(&name, &load, config.clock_hz, &frame);
    let scene = scene.ok_or_else(|| Diagnostic::error("the machine has watched nothing"))?;
    let [fst, perfetto_target] = &targets;
    let mut files = Vec::new();
    if let Some(path) = fst {
        files.push((path, wave(&scene)?));
    }
    files.extend(perfetto_target.as_ref().map(|path| (path, perfetto(&scene).into_bytes())));
    files::write_all(&files)?;
    terminal.print(&text(&scene, &frame, paths()))?;
    Ok(Exit::Done)
}

/// Name, load, machine, columns of the picture, and the files that were read.
fn load(arguments: &TraceArguments, terminal: &Terminal) -> Result<(String, Load, Config, u32, Vec<PathBuf>), Failure> {
    let mut job = arguments.job.clone();
    if job.scene == ANNEX && !Path::new(ANNEX).exists() {
        let mut config = job.settings()?.machine.config;
        config.main.traffic = false;
        let load = Load::annex()?;
        let width = load.build.crop.width;
        return Ok((ANNEX.to_owned(), load, config, width, vec![PathBuf::from(&job.machine.keys.machine)]));
    }
    job.view.pixel = None;
    let job = job.job()?;
    terminal.show(&job.warnings);
    let (load, _) = Load::picture(&job)?;
    terminal.show(&load.build.warnings);
    let width = load.build.crop.width;
    Ok((result_name(&job.scene), load, job.machine, width, job.files))
}

fn run(load: &Load, config: &Config, window: Option<Window>, terminal: &Terminal) -> Result<RunOutcome, Failure> {
    let crop = load.build.crop;
    let bar = terminal.progress("pixels", u64::from(crop.width) * u64::from(crop.height));
    let setup =
        load.setup(config, RunOptions { has_items: true, window, engine: load.engine, ..RunOptions::default() });
    let frame = emu::run(&setup, load.memory.clone(), &mut |done| bar.set_position(done));
    bar.finish_and_clear();
    Ok(frame?)
}

/// The clocks of a pixel of the drawn part.
fn pixel(
    load: &Load,
    config: &Config,
    [column, row]: [u32; 2],
    width: u32,
    terminal: &Terminal,
) -> Result<Window, Failure> {
    let crop = load.build.crop;
    // Pixels are numbered inside the drawn part, row by row.
    let place = column.checked_sub(crop.column).zip(row.checked_sub(crop.row));
    let place = place.filter(|&(column, row)| column < crop.width && row < crop.height);
    let outside = || {
        let message = format!("pixel {column},{row} lies outside the {} x {} that are drawn", crop.width, crop.height);
        Failure::usage(Diagnostic::error(message).hint("columns and rows count from 0, at the top left"))
    };
    let (column, row) = place.ok_or_else(outside)?;
    let frame = run(load, config, None, terminal)?;
    let number = i64::from(row) * i64::from(width) + i64::from(column);
    let item = frame.items.iter().find(|item| i64::from(item.subject[0]) == number).ok_or_else(outside)?;
    // The end is cut so that a pixel that never ends keeps no gigabytes.
    let end = item.end.max(item.start + Clocks(1)).min(item.start + Clocks(LONGEST));
    Ok(Window { start: item.start, end })
}

fn text<'a>(scene: &TracedScene, frame: &RunOutcome, paths: impl Iterator<Item = &'a Path>) -> String {
    let window = scene.trace.window;
    let end = window.end.min(frame.clocks);
    let length = (end - window.start).0;
    let mut rows = vec![row(["processor", "busy", "waiting for the bus", "idle", "bursts"])];
    for (number, shares) in scene.shares(end).into_iter().enumerate() {
        let bursts = scene.trace.bursts.iter().filter(|burst| burst.master as usize == number).count();
        let mut cells = vec![scene.processor(number)];
        cells.extend(shares.map(|clocks| percent(clocks, length)));
        cells.push(grouped(bursts as u64));
        rows.push(cells);
    }
    let written: Vec<String> = paths.map(|path| path.display().to_string()).collect();
    format!(
        "{}: clocks {} to {} of {}, bus busy {}\n{}files: {}\n",
        scene.name,
        grouped(window.start.0),
        grouped(end.0),
        grouped(frame.clocks.0),
        percent(scene.bus_busy(end), length),
        table(rows),
        written.join(", "),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_have_clocks_and_an_end() {
        assert_eq!(clocks("10..20"), Ok(10..20));
        assert_eq!(clocks("1_000 .. 2_000"), Ok(1000..2000));
        for text in ["", "10", "20..10", "10..10", "a..b", "-1..3", "0..50000001"] {
            assert!(clocks(text).is_err(), "{text}");
        }
    }
}
