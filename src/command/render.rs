//! `lancer render`: a scene to a picture, with what it took.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use messages::Diagnostic;

use super::expectation::ExpectationArguments;
use crate::arguments::{JobArguments, chart_file};
use crate::chart::{self, ChartStyle};
use crate::drawing::{self, Comparison, Drawing, HeatOf};
use crate::energy::{self, EnergyResult};
use crate::failure::{Exit, Failure};
use crate::files::picture::PictureFormat;
use crate::files::{self, map};
use crate::job::{Detail, Job, result_name};
use crate::result::{Host, Render, loss_table};
use crate::shadow::{self, ShadowResult, shadow_text};
use crate::terminal::Terminal;
use crate::{clocks, machine, summary};

const EXAMPLES: &str = "\
Examples:
  lancer render cornell
  lancer render cornell --size 160x120 --full --flame flame.svg --heat waits.png --heat-of waits
  lancer render house.dsc -o house.png --heat heat.png --error error.png
  lancer render bunny.off --size 640x480 --camera perspective --eye 0,-1,3 -o bunny.pfm
  lancer render sphereflake --json --cores 8 --word 24 > counts.json
  lancer render cornell --kernel triangle=my.s --pixel 160,120
  lancer render cornell --size 80x60 -o - | magick - -scale 400% big.png
  lancer render cornell --size 80x60 -q --min-psnr 60 --max-clocks 100,000,000
  lancer render cornell --size 80x60 --energy --word 20
  lancer render cornell --size 80x60 --pixel 40,30 --shadow   # where precision died

Exit codes: 0 done, 1 errors in the input, 2 usage, 3 a kernel trapped, 4 an expectation is not
met, 5 step limit.";

/// Draws a scene on the emulated coprocessor and says what it took.
///
/// Files are written when the whole picture is done. Without -o, --json, -q and --pixel, the picture goes to NAME.png in the
/// current folder. A summary goes to standard output, unless a file does (`-`, as PNG). PNG and PPM have the sRGB transfer
/// curve, PFM is linear.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct RenderArguments {
    #[command(flatten)]
    job: JobArguments,
    /// Picture file: .png, .ppm or .pfm [default: NAME.png in the current folder, unless --json, -q or --pixel].
    #[arg(short, long, value_name = "FILE", value_parser = picture, help_heading = "Results")]
    output: Option<PathBuf>,
    /// Prints the results as JSON instead of tables.
    #[arg(long, help_heading = "Results")]
    json: bool,
    /// Writes the results as JSON beside the picture too: NAME.json for NAME.png.
    #[arg(long, help_heading = "Results")]
    sidecar: bool,
    /// Prints all tables: operations by function and by class, each processor.
    #[arg(long, conflicts_with_all = ["json", "quiet"], help_heading = "Results")]
    full: bool,
    /// Prints nothing but messages.
    #[arg(short, long, conflicts_with = "json", help_heading = "Results")]
    quiet: bool,
    /// Counts, instruction by instruction, results that lost bits below the last place or did not fit.
    #[arg(long, help_heading = "Results")]
    flags: bool,
    /// Compares the picture with exact arithmetic on the same inputs: errors by line and function, and where precision died.
    #[arg(long, help_heading = "Results")]
    shadow: bool,
    /// Adds energy and area: a range over published tables, by operation, function and core, with the source of every figure.
    #[arg(long, help_heading = "Results")]
    energy: bool,
    /// Adds the host's times, in seconds.
    #[arg(long, help_heading = "Results")]
    timing: bool,
    /// Map of the elementary operations of each pixel, or of what --heat-of says, logarithmic: .png, .ppm or .pfm.
    #[arg(long, value_name = "FILE", value_parser = picture, help_heading = "Results")]
    heat: Option<PathBuf>,
    /// Number that --heat shows: elementary operations, clocks from begin to end, clocks of waiting, octets, or instructions.
    #[arg(long, value_name = "WHAT", value_enum, default_value_t = HeatOf::Operations, requires = "heat", help_heading = "Results")]
    heat_of: HeatOf,
    /// Clocks by stack of functions, a line each, for tools that draw flame graphs; waits stand on top by kind of data.
    #[arg(long, value_name = "FILE", help_heading = "Results")]
    folded: Option<PathBuf>,
    /// Flame graph of the clocks of the cores by stack of functions: .svg or .pdf.
    #[arg(long, value_name = "FILE", value_parser = chart_file, help_heading = "Results")]
    flame: Option<PathBuf>,
    /// Map of the nanojoules of each pixel by the machine's first table, logarithmic: .png, .ppm or .pfm.
    #[arg(long, value_name = "FILE", value_parser = picture, help_heading = "Results")]
    energy_map: Option<PathBuf>,
    /// Map of each pixel's difference from double precision, logarithmic: .png, .ppm or .pfm.
    #[arg(long, value_name = "FILE", value_parser = picture, help_heading = "Results")]
    error: Option<PathBuf>,
    /// Leaves out the comparison with double precision, which saves its time.
    #[arg(long, conflicts_with = "error", help_heading = "Results")]
    no_error: bool,
    #[command(flatten)]
    expectations: ExpectationArguments,
}

fn picture(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    PictureFormat::of(&path).map(|_| path)
}

/// Draws, writes and prints.
pub(super) fn execute(arguments: &RenderArguments, terminal: &mut Terminal) -> Result<Exit, Failure> {
    let start = Instant::now();
    let mut settings = arguments.job.settings()?;
    settings.results.flags |= arguments.flags;
    settings.results.energy |= arguments.energy;
    settings.results.shadow |= arguments.shadow;
    settings.results.error &= !arguments.no_error;
    // A map of errors is nothing without them.
    settings.results.error |= arguments.error.is_some();
    let mut job = arguments.job.job_of(&settings)?;
    if arguments.tells_clocks() {
        job.detail = Detail::Clocks;
    }
    let load = start.elapsed();
    terminal.show(&job.warnings);
    // One pixel is looked at in the tables; it must not replace the picture.
    let is_alone = arguments.output.is_none() && arguments.job.view.pixel.is_none();
    let is_default = is_alone && !arguments.json && !arguments.quiet;
    let output = match is_default {
        true => Some(PathBuf::from(format!("{}.png", result_name(&job.scene)))),
        false => arguments.output.clone(),
    };
    let sidecar = output.as_ref().filter(|_| arguments.sidecar).map(|output| output.with_extension("json"));
    if arguments.sidecar && sidecar.is_none() {
        let message = Diagnostic::error("there is no picture to write the results beside");
        return Err(Failure::usage(message.hint("name one with `-o FILE`")));
    }
    let (folded, flame) = (&arguments.folded, &arguments.flame);
    let targets = [&output, &arguments.heat, &arguments.error, &sidecar, &arguments.energy_map, folded, flame];
    let targets = targets.map(|path| path.as_deref());
    files::check_distinct(targets.into_iter().flatten()).map_err(Failure::usage)?;
    let is_taken = files::takes_output(targets.into_iter().flatten(), arguments.json).map_err(Failure::usage)?;
    files::check_spared(targets.into_iter().flatten(), &job.files).map_err(Failure::usage)?;
    for target in targets.into_iter().flatten() {
        files::check_target(target)?;
    }
    let comparison = if job.error { Comparison::Reference } else { Comparison::None };
    let drawing = draw(&job, comparison, terminal)?;
    terminal.show(&drawing.warnings);
    terminal.show(&machine::notes(&job.machine));
    let energies = arguments.energy_map.as_ref().map(|_| energy::pixels(&job)).transpose()?;
    let mut result = Render::new(&job, &drawing);
    result.energy = job.energy.then(|| EnergyResult::of(&job, &drawing, Some(result.rays.all())));
    result.shadow = job.shadow.then(|| compare(&job, terminal)).transpose()?;
    result.host = arguments.timing.then(|| Host::new(load, &drawing));
    let [output, heat, error, sidecar, energy_map, folded, flame] = targets;
    let mut files = maps(&drawing, heat.map(|heat| (heat, arguments.heat_of)), error);
    files.extend(clock_files(&result, &drawing, folded, flame));
    files.extend(output.map(|output| (output, format(output).encode(&drawing.picture))));
    files.extend(sidecar.map(|sidecar| (sidecar, result.json().into_bytes())));
    let size = drawing.picture.size;
    let energy_map = energy_map.zip(energies.as_ref());
    files.extend(energy_map.map(|(path, energies)| (path, format(path).encode_pixels(&map::heat(size, energies)))));
    files::write_all(&files)?;
    if arguments.json {
        terminal.print(&result.json())?;
    } else if !is_taken && !arguments.quiet {
        terminal.tell(&if arguments.full {
            full(&job, &result, &drawing, energies.as_deref())
        } else {
            brief(&result, &drawing, energies.as_deref())
        })?;
    }
    if is_default && let Some(output) = output {
        terminal.say(&format!("picture: {}", output.display()));
    }
    let unmet = arguments.expectations.unmet(&result);
    match unmet.0.is_empty() {
        true => Ok(Exit::Done),
        false => Err(Failure::Message { report: unmet, exit: Exit::Tolerance }),
    }
}

/// Draws with a bar that shows how far it is.
pub(super) fn draw(job: &Job, comparison: Comparison, terminal: &Terminal) -> Result<Drawing, Failure> {
    let crop = job.crop();
    let bar = terminal.progress("pixels", u64::from(crop.width) * u64::from(crop.height));
    let drawing = drawing::draw(job, comparison, &mut |done| bar.set_position(done));
    bar.finish_and_clear();
    drawing
}

/// Runs the picture with shadows, with a bar that shows how far that is.
fn compare(job: &Job, terminal: &Terminal) -> Result<ShadowResult, Failure> {
    let crop = job.crop();
    let bar = terminal.progress("shadows", u64::from(crop.width) * u64::from(crop.height));
    let result = shadow::picture(job, &|| bar.inc(1));
    bar.finish_and_clear();
    result
}

/// The maps that are asked for, as the octets of their files.
pub(super) fn maps<'p>(
    drawing: &Drawing,
    heat: Option<(&'p Path, HeatOf)>,
    error: Option<&'p Path>,
) -> Vec<(&'p Path, Vec<u8>)> {
    let size = drawing.picture.size;
    let heat = heat.map(|(path, of)| (path, format(path).encode_pixels(&map::heat(size, &drawing.heat(of)))));
    let error = error.zip(drawing.differences());
    let error = error.map(|(path, differences)| (path, format(path).encode_pixels(&map::error(size, &differences))));
    heat.into_iter().chain(error).collect()
}

/// The files of clocks that are asked for.
fn clock_files<'p>(
    result: &Render,
    drawing: &Drawing,
    folded: Option<&'p Path>,
    flame: Option<&'p Path>,
) -> Vec<(&'p Path, Vec<u8>)> {
    if folded.is_none() && flame.is_none() {
        return Vec::new();
    }
    let stacks = clocks::stacks(&drawing.build.cores, &drawing.frame);
    let folded = folded.map(|path| (path, clocks::folded(&stacks).into_bytes()));
    let flame = flame.map(|path| {
        let (figure, style) = (clocks::flame(result.title(), &stacks), ChartStyle::default());
        let is_pdf = path.extension().is_some_and(|end| end == "pdf");
        let octets = || chart::flame_svg(&figure, style).into_bytes();
        (path, if is_pdf { chart::flame_pdf(&figure, style) } else { octets() })
    });
    folded.into_iter().chain(flame).collect()
}

impl RenderArguments {
    /// Something is asked for that tells clocks of functions, so that they have to be measured.
    fn tells_clocks(&self) -> bool {
        self.json || self.sidecar || self.full || self.folded.is_some() || self.flame.is_some()
    }
}

fn format(path: &Path) -> PictureFormat {
    PictureFormat::of(path).expect("the parser lets only such names pass")
}

/// Energy of the picture and of its pixels, where they were asked for.
fn energy_parts(result: &Render, energies: Option<&[u64]>) -> impl Iterator<Item = String> {
    let pixels = energies.map(|energies| format!("energy of a pixel: {}\n", energy::spread(energies)));
    result.energy.as_ref().map(energy::text).into_iter().chain(pixels)
}

/// The picture in ten lines, and after them what was asked for.
fn brief(result: &Render, drawing: &Drawing, energies: Option<&[u64]>) -> String {
    let mut parts = vec![summary::brief(result)];
    if drawing.words.len() == 1 {
        parts.insert(0, summary::pixel(drawing));
    }
    parts.extend(energy_parts(result, energies));
    parts.extend(asked(result));
    parts.join("\n")
}

/// All tables of the picture.
fn full(job: &Job, result: &Render, drawing: &Drawing, energies: Option<&[u64]>) -> String {
    let mut parts = vec![
        summary::title(result) + &summary::rays(result),
        summary::functions(result),
        clocks::functions(result),
        clocks::line_table(&clocks::lines(job, drawing)),
        summary::classes(result),
        summary::processors(result),
    ];
    parts.extend(energy_parts(result, energies));
    parts.extend(result.error.as_ref().map(summary::error));
    if drawing.words.len() == 1 {
        parts.push(summary::pixel(drawing));
    }
    parts.push(
        format!("elementary operations a pixel: {}\n", summary::spread(&drawing.operations()))
            + &summary::hashes(result),
    );
    parts.extend(asked(result));
    parts.join("\n")
}

/// Tables that options add to either.
fn asked(result: &Render) -> Vec<String> {
    let mut parts: Vec<String> = result.flags.as_deref().map(loss_table).into_iter().collect();
    parts.extend(result.shadow.as_ref().map(shadow_text));
    if let Some(host) = &result.host {
        parts.push(format!(
            "host: load {:.2} s, build {:.2} s, run {:.2} s, reference {:.2} s (beside the run)\n",
            host.load_seconds, host.build_seconds, host.run_seconds, host.reference_seconds
        ));
    }
    parts
}
