//! `lancer trace`: what every processor and the bus do, clock by clock.

use std::ops::Range;
use std::path::{Path, PathBuf};

use clap::Args;
use emu::machine::trace::Window;
use emu::machine::{Config, RunOptions, RunOutcome};
use emu::quantity::Clocks;
use emu::stepper::{Lone, Stepper};
use messages::Diagnostic;
use schemars::JsonSchema;
use serde::Serialize;

use crate::arguments::{JobArguments, ungrouped};
use crate::failure::{Exit, Failure};
use crate::files;
use crate::job::result_name;
use crate::load::{ANNEX, Load};
use crate::numeral::{count, grouped, percent};
use crate::result::{self, WithSettings};
use crate::settings::Settings;
use crate::table::{row, table};
use crate::terminal::Terminal;
use crate::trace::instruction::TraceClocks;
use crate::trace::output::{TraceForm, is_standard, write_instructions};
use crate::trace::window::{TraceWindow, TraceWindows};
use crate::trace::{FunctionSlice, TracedScene, functions, perfetto, wave};

const EXAMPLES: &str = "\
Examples:
  lancer trace cornell --size 80x60 --pixel 40,30
  lancer trace cornell --size 80x60 --clocks 10000..20000 --fst bus.fst
  lancer trace annex --clocks 0..600000 --perfetto bus.json
  lancer trace cornell --pixel 40,30 --instructions - --window function=triangle
  lancer trace cornell --size 80x60 --pixel 40,30 --perfetto - | gzip > bus.json.gz

GTKWave and Surfer show the FST file, https://ui.perfetto.dev the other one.";

/// Clocks of the longest window.
const LONGEST: u64 = 50_000_000;

/// Shows what every processor and the bus do in a window of clocks or during one pixel, as a wave and as a trace.
///
/// The wave (FST) has the bus with its owner and address, and each processor with request, grant, state (0 idle, 1 busy,
/// 2 waiting for the bus) and pixel. The trace has a track a core and one for the bus, and one a core with its functions. With --clocks the whole picture is
/// drawn; --pixel draws that pixel alone. With --instructions each instruction of the pixel is written, with what it read and
/// wrote. Where no file is named by an option, NAME.fst and NAME.trace.json are written in the current folder.
#[derive(Args, Clone, Debug)]
#[command(
    after_help = EXAMPLES,
    mut_arg("scene", |scene| scene.help("Scene, as for `lancer render`; or annex, the report's estimate as for `lancer cores`")),
    mut_arg("pixel", |pixel| pixel.help("This pixel alone: its column and its row from the top").conflicts_with("clocks")),
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
    /// File for the instructions of the pixel, a line each; .jsonl: as JSON. - is standard output, with JSON lines by --json.
    #[arg(long, value_name = "FILE|-", help_heading = "Results", requires = "pixel", conflicts_with = "clocks")]
    instructions: Option<PathBuf>,
    /// Instructions that --instructions has: steps=A..B, pc=A..B or function=NAME; may be repeated.
    #[arg(long = "window", value_name = "WHAT=WHICH", help_heading = "Results", requires = "instructions")]
    windows: Vec<TraceWindow>,
    /// Prints the shares of the window as JSON instead of a table.
    #[arg(long, help_heading = "Results")]
    json: bool,
}

/// Version of [`TraceResult`].
pub(super) const SCHEMA: &str = "lancer-trace-1";

/// A window of clocks.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(super) struct TraceResult {
    /// Version of the result: a key that goes away or changes its meaning changes it, a new key does not.
    #[schemars(extend("const" = SCHEMA))]
    schema: &'static str,
    /// Name of the scene, or `annex`.
    scene: String,
    /// Clock rate in hertz.
    clock_hz: u64,
    /// Length of the frame in clocks.
    clocks: u64,
    /// First clock of the window.
    start: u64,
    /// Clock behind the window, at most the end of the frame.
    end: u64,
    /// Clocks of the window in which the bus was busy.
    bus_busy: u64,
    /// The cores, and after them the main processor.
    processors: Vec<TracedProcessor>,
    /// Files that were written.
    written: Vec<String>,
}

/// Clocks of a processor in a window.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(super) struct TracedProcessor {
    /// Name of the processor: `core 0` and so on, or `main`.
    name: String,
    /// Clocks of computing.
    busy: u64,
    /// Clocks of waiting for the bus.
    waiting: u64,
    /// Clocks without anything to do.
    idle: u64,
    /// Bursts on the bus.
    bursts: u64,
}

impl TraceResult {
    fn new<'a>(scene: &TracedScene, frame: &RunOutcome, paths: impl Iterator<Item = &'a Path>) -> TraceResult {
        let window = scene.trace.window;
        let end = window.end.min(frame.clocks);
        let bursts = |number: usize| scene.trace.bursts.iter().filter(|burst| burst.master as usize == number).count();
        let shares = scene.shares(end).into_iter().enumerate();
        TraceResult {
            schema: SCHEMA,
            scene: scene.name.to_owned(),
            clock_hz: scene.clock_hz,
            clocks: frame.clocks.0,
            start: window.start.0,
            end: end.0,
            bus_busy: scene.bus_busy(end),
            processors: shares
                .map(|(number, [busy, waiting, idle])| TracedProcessor {
                    name: scene.processor(number),
                    busy,
                    waiting,
                    idle,
                    bursts: bursts(number) as u64,
                })
                .collect(),
            written: paths.map(|path| path.display().to_string()).collect(),
        }
    }
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
    let LoadedTrace { name, load, config, number, read, settings } = load(arguments, terminal)?;
    if let Some(path) = &arguments.instructions {
        instructions(arguments, &load, &config, path, &read, terminal)?;
        if arguments.fst.is_none() && arguments.perfetto.is_none() {
            return Ok(Exit::Done);
        }
    }
    // Without a name for either, both files are written beside each other.
    let is_default = arguments.fst.is_none() && arguments.perfetto.is_none();
    let target = |given: &Option<PathBuf>, ending: &str| match is_default {
        true => Some(PathBuf::from(format!("{name}.{ending}"))),
        false => given.clone(),
    };
    let targets = [target(&arguments.fst, "fst"), target(&arguments.perfetto, "trace.json")];
    let paths = || targets.iter().flatten().map(PathBuf::as_path);
    files::check_distinct(paths()).map_err(Failure::usage)?;
    let is_taken = files::takes_output(paths(), arguments.json).map_err(Failure::usage)?;
    files::check_spared(paths(), &read).map_err(Failure::usage)?;
    for path in paths() {
        files::check_target(path)?;
    }
    // The window: clocks as given, or those of the pixel, for which the machine runs once without watching.
    let window = match (&arguments.clocks, arguments.job.view.pixel) {
        (Some(clocks), _) => Window { start: Clocks(clocks.start), end: Clocks(clocks.end) },
        (None, Some(place)) => pixel(&load, &config, place, terminal)?,
        (None, None) => return Err(Failure::usage(Diagnostic::error("neither clocks nor a pixel are given"))),
    };
    let mut frame = run(&load, &config, Some(window), terminal)?;
    // A pixel that is drawn alone has the number that it has in the picture.
    for item in frame.items.iter_mut().filter(|_| number != 0) {
        item.subject[0] = number;
    }
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
    if let Some(path) = perfetto_target {
        let functions = functions_of(&scene, &config, terminal)?;
        files.push((path, perfetto(&scene, &functions).into_bytes()));
    }
    files::write_all(&files)?;
    let traced = TraceResult::new(&scene, &frame, paths());
    match (is_taken, arguments.json) {
        _ if arguments.instructions.as_deref().is_some_and(is_standard) => {}
        (true, _) => {}
        (false, true) => terminal.print(&result::json(&WithSettings::new(&traced, settings)))?,
        (false, false) => terminal.tell(&traced.text())?,
    }
    Ok(Exit::Done)
}

/// Functions of the cores in the window. Where it cuts work items, the machine runs once more, with a window that has them whole.
fn functions_of(scene: &TracedScene, config: &Config, terminal: &Terminal) -> Result<Vec<FunctionSlice>, Failure> {
    let whole = scene.whole_items();
    if whole == scene.trace.window {
        return Ok(functions(scene, scene.trace, config)?);
    }
    let frame = run(scene.load, config, Some(whole), terminal)?;
    let trace = frame.trace.as_ref().ok_or_else(|| Diagnostic::error("the machine has watched nothing"))?;
    Ok(functions(scene, trace, config)?)
}

/// Writes the instructions of a pixel: on one core, whose transfers are answered from the memory at the start.
fn instructions(
    arguments: &TraceArguments,
    load: &Load,
    config: &Config,
    path: &Path,
    read: &[PathBuf],
    terminal: &mut Terminal,
) -> Result<(), Failure> {
    files::check_spared([path].into_iter().filter(|path| !is_standard(path)), read).map_err(Failure::usage)?;
    let windows = TraceWindows(arguments.windows.clone());
    windows.check(&load.build.cores).map_err(|message| Failure::usage(Diagnostic::error(message)))?;
    let setup = load.setup(config, RunOptions::default());
    let mut stepper = Stepper::new(Lone::first_item(&setup, load.memory.clone())?)?;
    let form = TraceForm::of(path, arguments.json);
    let written = write_instructions(&mut stepper, TraceClocks::None, &windows, path, form, terminal)?;
    if !is_standard(path) {
        let written = count(written, "instruction", "instructions");
        terminal.tell(&format!("{written} of {} written to {}\n", grouped(stepper.steps()), path.display()))?;
    }
    match stepper.trap() {
        Some(trap) => Err(Failure::Message { exit: Exit::of_trap(&trap), report: trap.diagnostic().into() }),
        None => Ok(()),
    }
}

/// Load of a scene, and what else is known of it.
struct LoadedTrace {
    name: String,
    load: Load,
    config: Config,
    /// Number in the picture of a pixel that is drawn alone, 0 for others.
    number: i32,
    /// Files that were read.
    read: Vec<PathBuf>,
    settings: Settings,
}

/// The load of the scene that is named.
fn load(arguments: &TraceArguments, terminal: &Terminal) -> Result<LoadedTrace, Failure> {
    let job = &arguments.job;
    if job.scene == ANNEX && !Path::new(ANNEX).exists() {
        let settings = job.settings()?;
        let mut config = settings.machine.config.clone();
        config.main.traffic = false;
        let (load, read) = (Load::annex()?, vec![PathBuf::from(&job.machine.keys.machine)]);
        return Ok(LoadedTrace { name: ANNEX.to_owned(), load, config, number: 0, read, settings });
    }
    let job = job.job()?;
    terminal.show(&job.warnings);
    let (load, _) = Load::picture(&job)?;
    terminal.show(&load.build.warnings);
    let number = job.kernels.crop.filter(|_| arguments.job.view.pixel.is_some());
    let number = number.map_or(0, |crop| (crop.row * job.view.size.0 + crop.column) as i32);
    let settings = Settings::of(&job);
    Ok(LoadedTrace { name: result_name(&job.scene), load, config: job.machine, number, read: job.files, settings })
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

/// The clocks of a pixel: of the only one that is drawn, or of one of the report's estimate.
fn pixel(load: &Load, config: &Config, [column, row]: [u32; 2], terminal: &Terminal) -> Result<Window, Failure> {
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
    let number = i64::from(row) * i64::from(crop.width) + i64::from(column);
    let item = frame.items.iter().find(|item| i64::from(item.subject[0]) == number).ok_or_else(outside)?;
    // The end is cut so that a pixel that never ends keeps no gigabytes.
    let end = item.end.max(item.start + Clocks(1)).min(item.start + Clocks(LONGEST));
    Ok(Window { start: item.start, end })
}

impl TraceResult {
    fn text(&self) -> String {
        let length = self.end - self.start;
        let mut rows = vec![row(["processor", "busy", "waiting for the bus", "idle", "bursts"])];
        for processor in &self.processors {
            let mut cells = vec![processor.name.clone()];
            cells.extend([processor.busy, processor.waiting, processor.idle].map(|clocks| percent(clocks, length)));
            cells.push(grouped(processor.bursts));
            rows.push(cells);
        }
        format!(
            "{}: clocks {} to {} of {}, bus busy {}\n{}files: {}\n",
            self.scene,
            grouped(self.start),
            grouped(self.end),
            grouped(self.clocks),
            percent(self.bus_busy, length),
            table(rows),
            self.written.join(", "),
        )
    }
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
