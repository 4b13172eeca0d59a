//! `lancer formats`: the fewest bits with which pictures keep an error.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use kernels::KernelSet;
use messages::Diagnostic;
use scenes::generate::{self, GenerateOptions, SCENES};
use scenes::kdtree::VISIT;
use scenes::layout::Layout;
use scenes::model::View;

use super::invocation::{CommandSettings, scene_hashes};
use super::sweep;
use crate::arguments::{self, ArithmeticArguments, MachineKeyArguments, Size, layout};
use crate::failure::{Exit, Failure};
use crate::formats::{self, ChoiceFigures, DemandedError, FormatsResult, NamedScenes, SearchEffort, TrialFigures};
use crate::job::Job;
use crate::numeral::short;
use crate::result::WithSettings;
use crate::settings::Settings;
use crate::sweep::study_text::check_named;
use crate::table::{row, table};
use crate::terminal::Terminal;
use crate::{files, input, result};

const EXAMPLES: &str = "\
Examples:
  lancer formats cornell --psnr 60
  lancer formats cornell slabs terrain --off 0 -o short.toml
  lancer render cornell --settings short.toml
  lancer formats slabs --off 0 --study words.toml && lancer sweep words.toml
  lancer formats house.dsc --largest 1/255 --check barn.dsc --size 80x60 --json

Exit codes: 0 done, 1 errors in the input, 2 usage, 4 the longest word does not keep the demand.";

/// Demand where no other one is made, in dB.
const PSNR: f64 = 60.0;

/// Scenes that are checked where none are named.
const CHECKED: usize = 5;

/// Finds the fewest bits of each quantity, and the shortest word, with which all scenes keep an error.
///
/// Estimates from ranges and the demand come first; pictures then find the fewest fraction bits of one quantity after the
/// other, of positions first, which fill memory, and of the word last; then the kd tree in which they move the fewest octets. The result stands beside words in which the scene
/// chooses all formats, and is checked on scenes and sample positions that the search did not see.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct FormatsArguments {
    /// Scenes: .dsc or mesh files, or names of generated ones.
    #[arg(value_name = "SCENE", default_value = "cornell")]
    scenes: Vec<String>,
    /// Least peak signal-to-noise ratio in dB, over all shifts of a scene [default: 60].
    #[arg(long, value_name = "DB", value_parser = decibels, conflicts_with_all = ["off", "largest"])]
    psnr: Option<f64>,
    /// Most pixels of a picture that are off by 1/255 or more.
    #[arg(long, value_name = "PIXELS", conflicts_with = "largest")]
    off: Option<u64>,
    /// Largest difference of a component: a number or a fraction such as 1/255.
    #[arg(long, value_name = "DIFFERENCE", value_parser = difference)]
    largest: Option<f64>,
    /// Size of the pictures in pixels.
    #[arg(long, value_name = "WxH", value_parser = arguments::size, default_value = "64x48")]
    size: Size,
    /// Pictures of each scene that the search draws, at as many places of the samples in their pixels, 1 to 8.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=8), default_value = "4")]
    shifts: u8,
    /// Bits that are added to the fewest that keep the error, for scenes and sample positions that the search does not see, 0 to 8; half
    /// as many to weights and colours.
    #[arg(long, value_name = "BITS", value_parser = clap::value_parser!(u32).range(0..=8), default_value = "2")]
    guard: u32,
    /// Scenes that the search does not see, to check on; may be repeated [default: up to 5 generated ones].
    #[arg(long, value_name = "SCENE")]
    check: Vec<String>,
    /// Set of kernels.
    #[arg(long, value_name = "NAME", value_parser = profile, default_value = "ray")]
    profile: KernelSet,
    /// Structures of global memory.
    #[arg(long, value_name = "NAME", value_parser = layout(), default_value = Layout::Packed.name())]
    layout: Layout,
    #[command(flatten)]
    machine: MachineKeyArguments,
    /// Writes the formats that were found as a settings file.
    #[arg(short, long, value_name = "FILE.toml")]
    output: Option<PathBuf>,
    /// Writes the formats that were found and the words beside them as a study that `lancer sweep` runs, a row for each scene and place of the
    /// samples. The search is none: its next picture depends on the last.
    #[arg(long, value_name = "FILE")]
    study: Option<PathBuf>,
    /// Prints the results as JSON.
    #[arg(long)]
    json: bool,
}

fn decibels(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| (0.0..=300.0).contains(number));
    number.ok_or_else(|| "a number of dB from 0 to 300 is expected".into())
}

fn difference(text: &str) -> Result<f64, String> {
    let number = match text.split_once('/') {
        Some((above, below)) => {
            above.trim().parse().ok().zip(below.trim().parse().ok()).map(|(a, b): (f64, f64)| a / b)
        }
        None => text.parse().ok(),
    };
    let number = number.filter(|number: &f64| *number > 0.0 && *number <= 1.0);
    number.ok_or_else(|| "a difference above 0 and at most 1 is expected, such as 0.004 or 1/255".into())
}

fn profile(text: &str) -> Result<KernelSet, String> {
    text.parse().map_err(|message: Box<Diagnostic>| arguments::plain(&message))
}

impl FormatsArguments {
    fn demand(&self) -> DemandedError {
        match (self.off, self.largest) {
            (Some(off), _) => DemandedError::Off(off),
            (_, Some(largest)) => DemandedError::Largest(largest),
            _ => DemandedError::Psnr(self.psnr.unwrap_or(PSNR)),
        }
    }

    /// Scenes to check on: those that were named, else generated ones that are not searched with, then these in another fineness. `spare` refuses to
    /// overwrite files that were read.
    fn unseen(&self, spare: &dyn Fn(&[PathBuf]) -> Result<(), Failure>) -> Result<NamedScenes, Failure> {
        if !self.check.is_empty() {
            let read = |name: &String| -> Result<_, Failure> {
                let loaded = input::scene(name, None, Some(self.size))?;
                spare(&loaded.files)?;
                Ok((name.clone(), loaded.scene))
            };
            return self.check.iter().map(read).collect();
        }
        let is_seen = |name: &str| self.scenes.iter().any(|seen| seen == name);
        let mut unseen = NamedScenes::new();
        // Of a scene that is searched with, other triangles stand elsewhere; one without any shows nothing.
        let finer = |generator: &generate::Generator| {
            let level = generator.level.as_ref().map(|level| (level.default + 1).min(*level.range.end()));
            let triangles = generator.triangles.as_ref().map(|triangles| triangles.default / 2);
            (level.is_some() || triangles.is_some()).then_some((level, triangles))
        };
        let (seen, others): (Vec<_>, Vec<_>) = SCENES.iter().partition(|generator| is_seen(generator.name));
        let plain = others.into_iter().map(|generator| (generator, (None, None)));
        let changed = seen.into_iter().filter_map(|generator| Some((generator, finer(generator)?)));
        for (generator, (level, triangles)) in plain.chain(changed) {
            if unseen.len() == CHECKED {
                break;
            }
            let scene = generate::scene(generator.name, &GenerateOptions { level, triangles, size: self.size })?;
            let name = match (level, triangles) {
                (Some(level), _) => format!("{}, level {level}", generator.name),
                (_, Some(triangles)) => format!("{}, {triangles} triangles", generator.name),
                _ => generator.name.to_owned(),
            };
            if !scene.triangles.is_empty() {
                unseen.push((name, scene));
            }
        }
        Ok(unseen)
    }
}

/// Searches, checks, writes and prints.
pub(super) fn execute(
    arguments: &FormatsArguments,
    given: &CommandSettings,
    terminal: &mut Terminal,
) -> Result<Exit, Failure> {
    // Check where the results go before a search of many pictures
    let targets: Vec<&Path> =
        [&arguments.output, &arguments.study].into_iter().flatten().map(PathBuf::as_path).collect();
    let is_taken = files::takes_output(targets.iter().copied(), arguments.json).map_err(Failure::usage)?;
    files::check_distinct(targets.iter().copied()).map_err(Failure::usage)?;
    targets.iter().try_for_each(|path| files::check_target(path))?;
    let spare = |read: &[PathBuf]| files::check_spared(targets.iter().copied(), read).map_err(Failure::usage);
    // A machine's name may be that of a file.
    let machine = PathBuf::from(&arguments.machine.machine);
    if machine.exists() {
        spare(&[machine])?;
    }
    if arguments.study.is_some() {
        check_named(&Settings::default(), arguments.scenes.iter().map(String::as_str))?;
    }
    let machine = arguments.machine.machine(&ArithmeticArguments::default())?;
    // Read the scenes to search with, and those to check on
    let mut seen = NamedScenes::new();
    for name in &arguments.scenes {
        let loaded = input::scene(name, None, Some(arguments.size))?;
        spare(&loaded.files)?;
        terminal.show(&loaded.warnings);
        seen.push((name.clone(), loaded.scene));
    }
    let unseen = arguments.unseen(&spare)?;
    let Some((_, first)) = seen.first() else { return Err(Failure::usage(Diagnostic::error("there is no scene"))) };
    // The first scene stands for all: each trial puts its own in its place.
    let mut job = Job::new(first.clone());
    job.view = View::new(arguments.size);
    job.kernels.profile = arguments.profile;
    job.layout = Some(arguments.layout);
    (job.machine_name, job.machine) = (machine.name.clone(), machine.config.clone());
    let bar = terminal.counter("pictures");
    let demand = arguments.demand();
    let effort = SearchEffort { shifts: arguments.shifts.into(), guard: arguments.guard };
    let found = formats::find(&job, demand, &seen, &unseen, effort, &|| bar.inc(1));
    bar.finish_and_clear();
    let Some(found) = found? else {
        let refusal = format!("words of {} bits do not keep {demand}", formats::WORDS.1);
        return Err(Failure::Message {
            report: Diagnostic::error(refusal).hint("ask for less, or for fewer scenes at once").into(),
            exit: Exit::Tolerance,
        });
    };
    // Write the files, and print what does not go there
    let mut files: Vec<(&Path, String)> = Vec::new();
    files.extend(arguments.output.as_deref().map(|path| (path, settings_file(&found))));
    if let Some(path) = arguments.study.as_deref() {
        let study = found.study(&sweep::study_name(Some(path), "formats"), &machine, &arguments.scenes);
        files.push((path, sweep::study_text(&study, "formats")?));
    }
    files::write_all(&files)?;
    let scenes: Vec<_> = seen.into_iter().map(|(_, scene)| scene).collect();
    let settings = given.clone().with_machine(&machine).with_scenes(&scene_hashes(&arguments.scenes, &scenes));
    match (is_taken, arguments.json) {
        (true, _) => {}
        (false, true) => terminal.print(&result::json(&WithSettings::new(&found, settings)))?,
        (false, false) => terminal.tell(&text(&found))?,
    }
    Ok(Exit::Done)
}

/// The formats as settings that other commands read.
fn settings_file(found: &FormatsResult) -> String {
    let mut text = format!("# Formats for {}, found by lancer formats.\n", found.demand);
    let _ = writeln!(text, "layout = \"{}\"\n\n[kernels]\nprofile = \"{}\"\n\n[formats]", found.layout, found.profile);
    let mut word = 0;
    for quantity in &found.quantities {
        match quantity.integer {
            Some(_) if quantity.is_given => {
                let _ = writeln!(text, "{} = {}", quantity.quantity, quantity.bits);
            }
            Some(_) => {
                let _ = writeln!(text, "# {}: as many as the scene has room for", quantity.quantity);
            }
            None => word = quantity.bits,
        }
    }
    if found.visit != VISIT {
        let _ = writeln!(text, "\n[tree]\nvisit = {}", found.visit);
    }
    let _ = writeln!(text, "\n[machine.arithmetic]\nword = {word}");
    text
}

fn ratio(psnr: Option<f64>) -> String {
    psnr.map_or_else(|| "-".into(), |psnr| format!("{psnr:.1}"))
}

/// Figures of a choice as cells: octets, clocks, nanojoules, error.
fn cells(figures: &ChoiceFigures) -> Vec<String> {
    vec![
        short(figures.octets.round() as u64),
        short(figures.clocks.round() as u64),
        figures.pixel_nj.to_string(),
        ratio(figures.worst_psnr_db),
        short(figures.worst_off),
        format!("{:.4}", figures.largest),
        if figures.is_kept { "yes" } else { "no" }.to_owned(),
    ]
}

/// Difference of the formats that were found from a uniform word.
fn beside(found: &FormatsResult) -> &'static str {
    // Behind the positions come the other quantities, and last the word.
    let [positions, others @ .., _] = &found.quantities[..] else { return "" };
    match (positions.is_given, others.iter().any(|one| one.is_given)) {
        (true, _) => "with positions that are as fine in each scene",
        (_, true) => "with the positions of that word, since others would not move less",
        _ => "that word itself, since other formats would not move less",
    }
}

fn text(found: &FormatsResult) -> String {
    let mut text = format!(
        "{}: profile {}, layout {}, {} x {} pixels, {} shifts, {} guard bits; {} pictures drawn, {} known\n\n",
        found.demand,
        found.profile,
        found.layout,
        found.width,
        found.height,
        found.shifts.len(),
        found.guard,
        found.drawn,
        found.reused
    );
    // Say how many bits each quantity needs, and what one fewer and one more would bring
    let mut rows =
        vec![row(["quantity", "before the point", "estimate", "fewest", "one fewer", "nJ", "one more", "nJ"])];
    let number = |bits: Option<i32>| bits.map_or_else(String::new, |bits| bits.to_string());
    let step = |figures: &Option<ChoiceFigures>| match figures {
        Some(figures) => [format!("{} dB", ratio(figures.worst_psnr_db)), figures.pixel_nj.to_string()],
        None => ["-".to_owned(), "-".to_owned()],
    };
    for one in &found.quantities {
        let bits = if one.is_given { one.bits.to_string() } else { "by scene".to_owned() };
        let mut cells = vec![one.quantity.to_owned(), number(one.integer), number(one.estimate), bits];
        cells.extend(step(&one.fewer).into_iter().chain(step(&one.more)));
        rows.push(cells);
    }
    text += &table(rows);
    text += "\nFraction bits, of the word all bits; with the least PSNR of a scene and nJ a pixel.\n\n";
    // Set them beside words in which each scene chooses its formats
    let mut rows = vec![row(["formats", "octets", "clocks", "nJ", "PSNR", "off", "largest", "kept"])];
    rows.push([vec!["found".to_owned()], cells(&found.found)].concat());
    for one in &found.uniform {
        let tree = if one.visit == VISIT { String::new() } else { format!(", visits {} %", one.visit) };
        let name = format!("{} bits, {}{}{tree}", one.word, one.layout, if one.is_best { ", shortest" } else { "" });
        rows.push([vec![name], cells(&one.figures)].concat());
    }
    text += &table(rows);
    text += "\nA pixel, mean of the scenes; errors are the worst of them. In words the scene chooses the formats.\n";
    let share = |formats::UniformShare { octets, nj: [least, most] }: formats::UniformShare| {
        format!("{octets:.2} of the octets and {least:.2} to {most:.2} of the nJ")
    };
    let _ = writeln!(text, "Found: {} of the shortest word, {}.", share(found.share), beside(found));
    if found.visit != VISIT {
        let _ = writeln!(
            text,
            "The kd tree is built for visits of nodes that cost {} % of a test of a triangle; of that word in the same tree it is {}.",
            found.visit,
            share(found.share_of_tree)
        );
    }
    text.push('\n');
    // Say what they come to in memory
    let mut rows = vec![row(["in memory", "node", "reference", "triangle", "material", "light", "pixel"])];
    for scene in &found.fields {
        let bits = scene.bits.0.iter().map(|(_, bits)| bits.to_string());
        rows.push([scene.scene.clone()].into_iter().chain(bits).collect());
    }
    text += &table(rows);
    text += "\nBits of the widest field.\n\n";
    // Check them on scenes and shifts that the search did not see
    let mut rows = vec![row(["check", "PSNR", "off, mean", "off, worst", "largest", "kept"])];
    let check = |of: &str, scene: &TrialFigures| {
        let name = format!("{} ({of})", scene.scene);
        match &scene.refused {
            Some(reason) => vec![name, reason.clone()],
            None => vec![
                name,
                ratio(scene.error.psnr_db),
                format!("{:.2}", scene.error.mean_off),
                short(scene.error.worst_off),
                format!("{:.4}", scene.error.largest),
                if scene.is_kept { "yes" } else { "no" }.to_owned(),
            ],
        }
    };
    rows.extend(found.seen.iter().map(|scene| check("seen", scene)));
    rows.extend(found.unseen.iter().map(|scene| check("unseen", scene)));
    text += &table(rows);
    let kept = found.unseen.iter().filter(|scene| scene.is_kept).count();
    let _ = writeln!(
        text,
        "\nOver {} shifts that the search did not see; {kept} of {} unseen scenes keep the demand.",
        formats::CHECKED_SHIFTS.len(),
        found.unseen.len()
    );
    text
}
