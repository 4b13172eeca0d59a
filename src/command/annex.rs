//! `lancer annex`: the rows of the report's annexes, printed and measured.

use std::path::PathBuf;

use clap::Args;
use kernels::annex::PrintedErratum;
use kernels::build::Crop;
use messages::Diagnostic;

use super::invocation::{CommandSettings, scene_hashes};
use super::render;
use crate::annex::as_printed::{self, ErratumDrawings, ErratumResult};
use crate::annex::figure::{self, ReportFigure};
use crate::annex::result::Annexes;
use crate::annex::scene::{OnScene, job};
use crate::annex::text::{self, Style};
use crate::annex::{AnnexDetail, erratum_text};
use crate::arguments::{self, SettingsArguments, Size, TreeArguments};
use crate::chart::ChartStyle;
use crate::debug::DebugTarget;
use crate::drawing::Comparison;
use crate::failure::{Exit, Failure};
use crate::files::picture::PictureFormat;
use crate::job::Job;
use crate::load::Load;
use crate::result::WithSettings;
use crate::terminal::Terminal;
use crate::{annex, files, input, machine, pixel, result};

const EXAMPLES: &str = "\
Examples:
  lancer annex                                    all rows, printed and counted, and why they differ
  lancer annex cornell sphereflake                and what a call takes on two scenes
  lancer annex terrain --size 320x240 --json > annex.json
  lancer annex --errata
  lancer annex --as-printed list                  the names of the errata
  lancer annex --as-printed first-hit -o as-printed.png
  lancer annex --figure 7 slabs --pixel 40,30 -o walk.svg
  lancer annex --figure 8 --machine wide32 -o machine.svg

Exit codes: 0 done, 1 errors in the input, 2 usage, 4 a difference that its terms do not explain.";

/// Counts the operations of the report's annexes again.
///
/// Each row has a driver, a program that sets the report's assumptions (a packet of 40 triangles, a tree of 16 levels,
/// a pixel of 22 nodes, which is searched), and a region of the kernels of the profile `report`. The difference from what is printed is
/// a sum of terms, each with its source line and a reason.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct AnnexArguments {
    /// Scenes to count on: a .dsc with its mesh beside it, a mesh, or the name of a generated scene such as cornell.
    #[arg(value_name = "SCENE")]
    scenes: Vec<String>,
    /// Size of the scenes' pictures, in pixels.
    #[arg(long, value_name = "WxH", value_parser = arguments::size, default_value = "80x60")]
    size: Size,
    #[command(flatten)]
    tree: TreeArguments,
    #[command(flatten)]
    settings: SettingsArguments,
    /// Prints everything as JSON.
    #[arg(long, conflicts_with_all = ["csv", "markdown"])]
    json: bool,
    /// Prints the rows as CSV.
    #[arg(long, conflicts_with = "markdown")]
    csv: bool,
    /// Prints tables in Markdown.
    #[arg(long)]
    markdown: bool,
    /// Prints what is odd in the report, with what it changes, instead of the rows.
    #[arg(long, conflicts_with_all = ["json", "csv"])]
    errata: bool,
    /// Shows one erratum: the report's mistake beside its correction, by a picture of its own scene or of each SCENE, or by its number; `list` names
    /// all of them.
    #[arg(long, value_name = "NAME", value_parser = erratum, conflicts_with_all = ["csv", "markdown", "errata"])]
    as_printed: Option<Shown>,
    /// Draws a figure of the report for what is here: 6, the cost of a plane along an axis of SCENE; 7, the walk through the rays of a pixel; 8, a
    /// machine; 9, one of its coprocessors.
    #[arg(long, value_name = "6..9", value_parser = clap::value_parser!(u8).range(6..=9), requires = "output",
        conflicts_with_all = ["as_printed", "json", "csv", "markdown", "errata"])]
    figure: Option<u8>,
    /// Pixel of figure 7: its column and its row from the top [default: the middle].
    #[arg(long, value_name = "X,Y", value_parser = arguments::whole::<2>, requires = "figure")]
    pixel: Option<[u32; 2]>,
    /// Machine of figures 8 and 9: a preset's name or a TOML file [default: report].
    #[arg(long, value_name = "NAME|FILE", requires = "figure")]
    machine: Option<String>,
    /// File of the picture: as printed .png, .ppm or .pfm, of a figure .svg or .pdf.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// The corrected picture: .png, .ppm or .pfm.
    #[arg(long, value_name = "FILE", value_parser = picture, requires = "as_printed")]
    corrected: Option<PathBuf>,
}

/// Choice of --as-printed.
#[derive(Clone, Copy, Debug)]
enum Shown {
    /// The names.
    List,
    /// One erratum.
    One(&'static PrintedErratum),
}

fn erratum(name: &str) -> Result<Shown, String> {
    match name {
        "list" => Ok(Shown::List),
        _ => PrintedErratum::named(name).map(Shown::One).map_err(|message| arguments::plain(&message)),
    }
}

fn picture(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    PictureFormat::of(&path).map(|_| path)
}

/// Measures and prints.
pub(super) fn execute(
    arguments: &AnnexArguments,
    given: &CommandSettings,
    terminal: &mut Terminal,
) -> Result<Exit, Failure> {
    // Leave errata and figures to others
    match arguments.as_printed {
        Some(Shown::List) if arguments.output.is_some() => {
            let message = Diagnostic::error("there is no picture of a list");
            return Err(Failure::usage(message.hint("name one of --as-printed list")));
        }
        Some(Shown::List) => return terminal.tell(&erratum_text::list()).map(|()| Exit::Done),
        Some(Shown::One(erratum)) => return show(erratum, arguments, given, terminal),
        None => {}
    }
    if let Some(number) = arguments.figure {
        return draw_figure(number, arguments, terminal);
    }
    if arguments.output.is_some() {
        let message = Diagnostic::error("-o writes the picture of --as-printed NAME or of --figure N");
        return Err(Failure::usage(message.hint("name one of them")));
    }
    // Count the rows again, and what their calls take on the scenes
    let measured = annex::measure()?;
    let (mut scenes, mut read) = (Vec::new(), Vec::new());
    for name in &arguments.scenes {
        let loaded = input::scene(name, None, Some(arguments.size))?;
        terminal.show(&loaded.warnings);
        read.push(loaded.scene.clone());
        let mut job = job(loaded.scene, arguments.size);
        arguments.tree.settings().choose(&mut job);
        let drawing = render::draw(&job, Comparison::None, terminal)?;
        scenes.push(OnScene::new(&job, &drawing));
    }
    let annexes = Annexes::new(&measured, &AnnexDetail::new(&measured)?, &scenes);
    let style = if arguments.markdown { Style::Markdown } else { Style::Text };
    // Print in the form that was chosen; only text for people is folded to the terminal
    match arguments {
        AnnexArguments { json: true, .. } => {
            let settings = given.clone().with_scenes(&scene_hashes(&arguments.scenes, &read));
            terminal.print(&result::json(&WithSettings::new(&annexes, settings)))?
        }
        AnnexArguments { csv: true, .. } => terminal.print(&text::csv(&annexes))?,
        AnnexArguments { errata: true, markdown: true, .. } => terminal.print(&text::errata(&annexes, style))?,
        AnnexArguments { markdown: true, .. } => terminal.print(&text::annexes(&annexes, style))?,
        AnnexArguments { errata: true, .. } => terminal.tell(&text::errata(&annexes, style))?,
        _ => terminal.tell(&text::annexes(&annexes, style))?,
    }
    // Scripts see by the exit code that the terms still explain all differences.
    match measured.iter().all(annex::Measurement::is_explained) {
        true => Ok(Exit::Done),
        false => Ok(Exit::Tolerance),
    }
}

/// Shows an erratum on its scene, or on those that are named.
fn show(
    erratum: &'static PrintedErratum,
    arguments: &AnnexArguments,
    given: &CommandSettings,
    terminal: &mut Terminal,
) -> Result<Exit, Failure> {
    let is_figure = erratum.scene.is_none();
    let names = match arguments.scenes.is_empty() {
        true => erratum.scene.iter().cloned().collect(),
        false => arguments.scenes.clone(),
    };
    let targets = [arguments.output.as_deref(), arguments.corrected.as_deref()];
    for target in targets.into_iter().flatten() {
        PictureFormat::of(target).map_err(|message| Failure::usage(Diagnostic::error(message)))?;
    }
    if is_figure && (targets.iter().any(Option::is_some) || !arguments.scenes.is_empty()) {
        let message = format!("`{}` is a number: no picture shows it", erratum.name());
        return Err(Failure::usage(Diagnostic::error(message).hint("leave out scenes and files")));
    }
    if names.len() > 1 && targets.iter().any(Option::is_some) {
        let message = Diagnostic::error("a file holds the picture of one scene");
        return Err(Failure::usage(message.hint("name one scene")));
    }
    files::check_distinct(targets.into_iter().flatten()).map_err(Failure::usage)?;
    let is_taken = files::takes_output(targets.into_iter().flatten(), arguments.json).map_err(Failure::usage)?;
    for target in targets.into_iter().flatten() {
        files::check_target(target)?;
    }
    let (mut pairs, mut read) = (Vec::new(), Vec::new());
    for name in &names {
        let loaded = input::scene(name, None, Some(arguments.size))?;
        terminal.show(&loaded.warnings);
        let Some(mut jobs) = as_printed::jobs(erratum, &loaded.scene, arguments.size) else { continue };
        read.push(loaded.scene);
        // A tree that is shown is not chosen.
        let tree = arguments.tree.settings();
        jobs[1].kd_depth = tree.depth.or(jobs[1].kd_depth);
        jobs[1].kd_method = tree.build.or(jobs[1].kd_method);
        (jobs[0].kd_visit, jobs[1].kd_visit) = (tree.visit, tree.visit);
        jobs[0].kd_depth = jobs[1].kd_depth;
        jobs[0].kd_method = jobs[0].kd_method.or(jobs[1].kd_method);
        let (pair, drawings) =
            as_printed::compare(&jobs, &mut |job, comparison| render::draw(job, comparison, terminal))?;
        write(targets, &drawings)?;
        pairs.push(pair);
    }
    let shown = ErratumResult::new(erratum, pairs);
    match (is_taken, arguments.json) {
        (true, _) => {}
        (false, true) => {
            let settings = given.clone().with_scenes(&scene_hashes(&names, &read));
            terminal.print(&result::json(&WithSettings::new(&shown, settings)))?
        }
        (false, false) => terminal.tell(&erratum_text::text(&shown))?,
    }
    Ok(Exit::Done)
}

/// Writes the pictures that are asked for.
fn write([printed, correct]: [Option<&std::path::Path>; 2], drawings: &ErratumDrawings) -> Result<(), Failure> {
    let mut written = Vec::new();
    for (path, picture) in [(printed, &drawings.printed), (correct, &drawings.correct)] {
        let Some(path) = path else { continue };
        let Some(picture) = picture else {
            let message = format!("there is no picture for {}: the kernels as printed end in a trap", path.display());
            return Err(Diagnostic::error(message).into());
        };
        written.push((path, PictureFormat::of(path).expect("the parser lets only such names pass").encode(picture)));
    }
    Ok(files::write_all(&written)?)
}

/// Scene of the figures 6 and 7 where none is named: one with glass and mirrors.
const FIGURE_SCENE: &str = "slabs";

/// Draws a figure of the report for what is here.
fn draw_figure(number: u8, arguments: &AnnexArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let path = arguments.output.as_deref().expect("the parser asks for a file");
    let usage = |message: &str, hint: &str| Failure::usage(Diagnostic::error(message).hint(hint));
    arguments::chart_file(&path.to_string_lossy()).map_err(|message| Failure::usage(Diagnostic::error(message)))?;
    // Refuse what the figure does not show: 6 and 7 are of a scene, 8 and 9 of a machine
    if arguments.scenes.len() > 1 || number > 7 && !arguments.scenes.is_empty() {
        return Err(usage("a figure shows one scene, those of machines none", "leave out the others"));
    }
    if arguments.pixel.is_some() && number != 7 {
        return Err(usage("figure 7 alone shows a pixel", "leave out --pixel"));
    }
    if arguments.machine.is_some() && number < 8 {
        return Err(usage("figures 8 and 9 alone show a machine", "leave out --machine"));
    }
    files::check_target(path)?;
    // Draw it of the scene or the machine, of a default where none is named
    let figure = match number {
        6 | 7 => {
            let name = arguments.scenes.first().map_or(FIGURE_SCENE, String::as_str);
            let loaded = input::scene(name, None, Some(arguments.size))?;
            terminal.show(&loaded.warnings);
            let mut job = job(loaded.scene, arguments.size);
            arguments.tree.settings().choose(&mut job);
            if number == 6 { cost_figure(&job)? } else { walk_figure(job, arguments.pixel)? }
        }
        _ => {
            let (name, config) = machine::find(arguments.machine.as_deref().unwrap_or(machine::DEFAULT))?;
            ReportFigure::Diagram(match number {
                8 => figure::machine(&name, &config),
                _ => figure::coprocessor(&name, &config),
            })
        }
    };
    let is_pdf = path.extension().is_some_and(|end| end == "pdf");
    files::write_all(&[(path, figure.file(is_pdf, ChartStyle::default()))])?;
    Ok(Exit::Done)
}

fn cost_figure(job: &Job) -> Result<ReportFigure, Failure> {
    let image = scenes::image::build(&job.scene, &job.view, &job.memory())?;
    Ok(ReportFigure::Chart(figure::cost(&job.scene, &image)))
}

fn walk_figure(mut job: Job, pixel: Option<[u32; 2]>) -> Result<ReportFigure, Failure> {
    let (width, height) = job.view.size;
    let [column, row] = pixel.unwrap_or([width / 2, height / 2]);
    if column >= width || row >= height {
        let message = format!("the picture has no pixel {column},{row}");
        return Err(Failure::usage(Diagnostic::error(message).hint(format!("it is {width} x {height} pixels large"))));
    }
    job.kernels.crop = Some(Crop { column, row, width: 1, height: 1 });
    let (load, image) = Load::picture(&job)?;
    let target = DebugTarget::pixel(String::new(), load, job.machine.clone())?;
    let explanation = pixel::explain(&job, &image, [column, row], &mut target.stepper()?)?;
    Ok(ReportFigure::Diagram(figure::walk(&explanation)))
}
