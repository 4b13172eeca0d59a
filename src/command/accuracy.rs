//! `lancer accuracy`: run time against error, in many arithmetics and on several machines.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::Args;
use emu::engine::EngineKind;
use emu::machine::arbiter::ArbiterKind;
use emu::machine::config::MOST_CORES;
use isa::number::Quantization;
use kernels::KernelSet;
use messages::Diagnostic;
use scenes::layout::Layout;
use schemars::JsonSchema;
use serde::Serialize;

use super::invocation::{CommandSettings, scene_hashes};
use super::sweep;
use crate::accuracy::{
    self, ChartAxes, Choices, CostAxis, ErrorAxis, MeasuredVariant, OverScenes, OverallVariant, PLACES, RefusedVariant,
    VariantMachine,
};
use crate::arguments::{
    self, ArithmeticArguments, ChartArguments, EffortArguments, FormatArguments, JobArguments, KernelArguments,
    KernelFileArguments, MachineArguments, MachineKeyArguments, NumberArguments, OverflowArguments, RecordingArguments,
    SetArguments, SkipArguments, TreeArguments, ViewArguments, tell_notes,
};
use crate::failure::{Exit, Failure};
use crate::numeral::numbers;
use crate::result::WithSettings;
use crate::settings::{MachineSettings, SceneSettings, Settings, key};
use crate::sweep::contents::Contents;
use crate::sweep::study_text::check_named;
use crate::terminal::Terminal;
use crate::{files, machine, result};

/// Version of what `--json` prints.
pub(super) const SCHEMA: &str = "lancer-accuracy-1";

const EXAMPLES: &str = "\
Examples:
  lancer accuracy
  lancer accuracy cornell terrain --words 32,24,20 --size 160x120 --svg accuracy.svg --pdf accuracy.pdf
  lancer accuracy slabs --profiles ray --roundings RND,TRN,RND_CONV --bounces 5 --cutoffs 0 --json
  lancer accuracy cornell --profiles ray --layouts packed,wide --machine report,wide32 --shifts 8 --axis seconds --error off
  lancer accuracy cornell slabs terrain --axis nj --error others --over worst --svg all.svg
  lancer accuracy terrain --shifts 8 --study terrain.toml && lancer sweep terrain.toml";

/// Draws scenes in many arithmetics and sets cost against error.
///
/// Every profile is drawn in every word length, and for each further value of another option the first profile in every
/// word length; all of these on every machine, where machines that compute alike share a recording. The first value of
/// each option is the base. A variant is dominated when another one of the scene costs no more, has no larger error,
/// and is better in one of them; the others are the front. Pixels off by 1/255 or more are told first: a single one that
/// has changed sides moves the PSNR by tens of dB.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES, mut_arg("size", |size| size.default_value(SIZE).help("Size of the pictures in pixels")))]
pub struct AccuracyArguments {
    /// Scenes: .dsc or mesh files, or names of generated ones.
    #[arg(value_name = "SCENE", default_value = "cornell")]
    scenes: Vec<String>,
    /// Mesh that belongs to the .dsc [default: the file of the same name beside it].
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    /// Bits of a word, 8 to 32: numbers and ranges such as 16-24.
    #[arg(long, value_name = "BITS,..", value_parser = words, default_value = "32,28,24,20,16")]
    words: Vec<Vec<u32>>,
    /// Sets of kernels.
    #[arg(long, value_name = "NAME,..", value_delimiter = ',', value_parser = profile, default_value = "ray,vector,report")]
    profiles: Vec<KernelSet>,
    /// Rounding modes, by their IEEE 1666 names.
    #[arg(long, value_name = "MODE,..", value_delimiter = ',', value_parser = rounding, default_value = "RND,TRN")]
    roundings: Vec<Quantization>,
    /// Structures of global memory.
    #[arg(long, value_name = "NAME,..", value_delimiter = ',', value_parser = layout, default_value = "wide,report")]
    layouts: Vec<Layout>,
    /// Levels of secondary rays: numbers and ranges.
    #[arg(long, value_name = "N,..", value_parser = bounces, default_value = "5,2")]
    bounces: Vec<Vec<u32>>,
    /// Weights that a secondary ray must exceed, in [0, 1].
    #[arg(long, value_name = "W,..", value_delimiter = ',', value_parser = weight, default_value = "0,0.0078125")]
    cutoffs: Vec<f64>,
    /// Differences of a component up to which the corners around a pixel agree, so that it is interpolated, in [0, 1]; or `none`.
    #[arg(long, value_name = "D,..", value_delimiter = ',', value_parser = difference, default_value = "none,0.01")]
    interpolate: Vec<CornerAgreement>,
    /// Pictures of each variant, at as many places of the samples in their pixels, 1 to 8; the first place is --shift, the others lie
    /// around it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=PLACES.len() as i64), default_value = "1")]
    shifts: u8,
    #[command(flatten)]
    tree: TreeArguments,
    #[command(flatten)]
    view: ViewArguments,
    #[command(flatten)]
    kernels: KernelFileArguments,
    #[command(flatten)]
    skips: SkipArguments,
    #[command(flatten)]
    formats: FormatArguments,
    #[command(flatten)]
    overflow: OverflowArguments,
    /// Machines between commas: presets' names or TOML files; may be repeated.
    #[arg(long = "machine", value_name = "NAME|FILE,..", value_parser = arguments::machines, default_value = machine::DEFAULT, help_heading = "Machine")]
    machines: Vec<Vec<String>>,
    /// Numbers of cores of each machine, and ranges, such as 1-4,8 [default: the machine's].
    #[arg(long, value_name = "LIST", value_parser = core_list, help_heading = "Machine")]
    cores: Vec<Vec<u32>>,
    /// Arbiters of each machine, between commas [default: the machine's].
    #[arg(long = "arbiter", value_name = "NAME,..", value_delimiter = ',', value_parser = arguments::arbiter(), help_heading = "Machine")]
    arbiters: Vec<ArbiterKind>,
    /// Engine that executes the programs; only the host's time depends on it. auto: the fastest that suits.
    #[arg(long, value_name = "NAME", value_parser = arguments::engine(), default_value = AUTO, help_heading = "Machine")]
    engine: EngineKind,
    #[command(flatten)]
    sets: SetArguments,
    #[command(flatten)]
    recordings: RecordingArguments,
    /// Cost that errors are set against, in fronts and charts; the host's time is then measured.
    #[arg(long, value_enum, default_value_t = CostAxis::Clocks, help_heading = "Charts and data")]
    axis: CostAxis,
    /// Error that costs are set against.
    #[arg(long, value_enum, default_value_t = ErrorAxis::Psnr, help_heading = "Charts and data")]
    error: ErrorAxis,
    /// Scenes that a chart's front goes over.
    #[arg(long, value_enum, default_value_t = OverScenes::Each, help_heading = "Charts and data")]
    over: OverScenes,
    #[command(flatten)]
    chart: ChartArguments,
    /// Writes all pictures as a study that `lancer sweep` runs, a row each, on one machine or on many, and draws nothing (`-` for standard
    /// output).
    #[arg(long, value_name = "FILE", help_heading = "Charts and data", conflicts_with_all = DRAWN)]
    study: Option<PathBuf>,
    /// Prints the results as JSON.
    #[arg(long)]
    json: bool,
    /// Adds nanojoules a pixel as a range over published tables.
    #[arg(long)]
    energy: bool,
    /// Adds the host's nanoseconds a pixel.
    #[arg(long)]
    timing: bool,
}

/// The engine is chosen.
const AUTO: &str = crate::settings::named::AUTO;

/// Options of what is measured and how it is shown, none of which a study has.
const DRAWN: [&str; 10] = ["json", "csv", "svg", "pdf", "energy", "timing", "axis", "error", "over", "folder"];

/// Size of pictures where none is asked for: there are dozens of them.
const SIZE: &str = "64x48";

/// Keys that variants vary, with the options that say so.
const VARIED: [(&str, &str); 9] = [
    ("scene", "the operand SCENE"),
    ("scene.name", "the operand SCENE"),
    ("kernels.profile", "--profiles"),
    ("machine.arithmetic.word", "--words"),
    ("machine.arithmetic.quantization", "--roundings"),
    ("layout", "--layouts"),
    ("effort.bounces", "--bounces"),
    ("effort.weight_cutoff", "--cutoffs"),
    ("effort.interpolate", "--interpolate"),
];

/// Difference up to which corners agree; none when every pixel has its ray.
#[derive(Clone, Copy, Debug)]
struct CornerAgreement(Option<f64>);

fn words(text: &str) -> Result<Vec<u32>, String> {
    numbers(text, 8, 32, "number of bits")
}

fn core_list(text: &str) -> Result<Vec<u32>, String> {
    numbers(text, 1, MOST_CORES, "number of cores")
}

fn bounces(text: &str) -> Result<Vec<u32>, String> {
    numbers(text, 0, 100, "number of levels")
}

fn difference(text: &str) -> Result<CornerAgreement, String> {
    match text {
        "none" => Ok(CornerAgreement(None)),
        _ => weight(text).map(|difference| CornerAgreement(Some(difference))),
    }
}

fn profile(text: &str) -> Result<KernelSet, String> {
    KernelSet::from_str(text).map_err(|message| arguments::plain(&message))
}

fn layout(text: &str) -> Result<Layout, String> {
    let names: Vec<&str> = Layout::ALL.iter().map(|layout| layout.name()).collect();
    let found = Layout::ALL.into_iter().find(|layout| layout.name() == text);
    found.ok_or_else(|| format!("it is one of {}", names.join(", ")))
}

fn rounding(text: &str) -> Result<Quantization, String> {
    let names: Vec<&str> = Quantization::ALL.iter().map(|mode| mode.name()).collect();
    Quantization::from_name(text).ok_or_else(|| format!("it is one of {}", names.join(", ")))
}

fn weight(text: &str) -> Result<f64, String> {
    let weight = text.parse().ok().filter(|weight| (0.0..=1.0).contains(weight));
    weight.ok_or_else(|| "a number in [0, 1] is expected".into())
}

/// Variants of pictures with their clocks and errors.
#[derive(Serialize, JsonSchema)]
pub(super) struct AccuracyResults {
    /// Version of the result: a key that goes away or changes its meaning changes it, a new key does not.
    #[schemars(extend("const" = SCHEMA))]
    schema: &'static str,
    /// Width of the pictures in pixels.
    width: u32,
    /// Height of the pictures in pixels.
    height: u32,
    /// Place of a ray in its pixel, in pixels to the right of the middle and above it.
    shift: [f64; 2],
    /// Places of the samples, one a picture of each variant.
    shifts: Vec<[f64; 2]>,
    /// Cost by which variants are dominated.
    cost_axis: CostAxis,
    /// Error by which variants are dominated.
    error_axis: ErrorAxis,
    /// Times that the work items of a picture ran.
    recordings: u64,
    /// Frames that recordings were put on a machine's clocks for.
    replays: u64,
    /// Frames that were executed clock by clock.
    stepped: u64,
    /// Measured variants, scene by scene.
    variants: Vec<MeasuredVariant>,
    /// Variants over all scenes, where there are several.
    overall: Vec<OverallVariant>,
    /// Variants that a scene does not fit, and why.
    refused: Vec<RefusedVariant>,
}

impl AccuracyArguments {
    /// Settings that all variants share, and the machines.
    fn shared(&self) -> Result<(Settings, Vec<VariantMachine>), Failure> {
        for set in &self.sets.sets {
            let key = key::resolve(set.split('=').next().unwrap_or_default())?;
            if let Some((_, option)) = VARIED.iter().find(|(varied, _)| key == *varied) {
                let message = format!("`--set {set}` sets what the variants vary");
                return Err(Failure::usage(Diagnostic::error(message).hint(format!("{option} has its values"))));
            }
        }
        if self.mesh.is_some() && self.scenes.len() > 1 {
            let message = Diagnostic::error("`--mesh` belongs to one scene, and there are several");
            return Err(Failure::usage(message.hint("a mesh of a scene's own name lies beside it")));
        }
        // Each machine with each number of cores and each arbiter, or with its own.
        fn or_own<T: Copy>(values: impl Iterator<Item = T>) -> Vec<Option<T>> {
            let values: Vec<Option<T>> = values.map(Some).collect();
            if values.is_empty() { vec![None] } else { values }
        }
        let numbers_of_cores = or_own(self.cores.iter().flatten().copied());
        let arbiters = or_own(self.arbiters.iter().copied());
        let machines: Vec<&String> = self.machines.iter().flatten().collect();
        let (mut base, mut variants) = (Settings::default(), Vec::new());
        for &machine in &machines {
            for &cores in &numbers_of_cores {
                for &arbiter in &arbiters {
                    let settings = self.job(machine, cores, arbiter).settings()?;
                    // Only what differs between machines is part of a variant's name.
                    let words = [
                        (machines.len() > 1).then(|| settings.machine.name.clone()),
                        cores.filter(|_| numbers_of_cores.len() > 1).map(|cores| format!("{cores} cores")),
                        arbiter.filter(|_| arbiters.len() > 1).map(|arbiter| arbiter.name().to_owned()),
                    ];
                    let words = words.into_iter().flatten().collect::<Vec<_>>().join(" ");
                    variants.push(VariantMachine { machine: settings.machine.clone(), words });
                    base = settings;
                }
            }
        }
        Ok((base, variants))
    }

    /// The options of a picture, on one machine.
    fn job(&self, machine: &str, cores: Option<u32>, arbiter: Option<ArbiterKind>) -> JobArguments {
        let AccuracyArguments { mesh, view, kernels, skips, tree, formats, overflow, sets, engine, .. } = self.clone();
        let keys = MachineKeyArguments { machine: machine.to_owned(), cores, arbiter, sets };
        let arithmetic = ArithmeticArguments { word: None, rounding: None, overflow };
        // What variants vary is set for each of them.
        JobArguments {
            scene: String::new(),
            mesh,
            view,
            kernels: KernelArguments { profile: KernelSet::default(), files: kernels },
            machine: MachineArguments { keys, layout: None, engine },
            numbers: NumberArguments { arithmetic, formats },
            effort: EffortArguments { bounces: 0, tree, weight_cutoff: 0.0, skips, interpolate: None },
        }
    }

    /// Files that are read, none of which a result may overwrite.
    fn sources(&self) -> Vec<PathBuf> {
        let machines = self.machines.iter().flatten().map(PathBuf::from);
        let kernels = self.kernels.replaced.iter().map(|(_, path)| path.clone());
        let scenes = self.scenes.iter().map(PathBuf::from).chain(self.mesh.clone());
        let extensions = self.kernels.extensions.extensions.iter().cloned();
        machines.chain(kernels).chain(scenes).chain(extensions).chain(self.sets.settings.settings.clone()).collect()
    }
}

/// Draws and prints.
pub(super) fn execute(
    arguments: &AccuracyArguments,
    given: &CommandSettings,
    terminal: &mut Terminal,
) -> Result<Exit, Failure> {
    let study: Vec<&Path> = arguments.study.as_deref().into_iter().collect();
    let targets = arguments.chart.targets(&study)?;
    let is_taken = files::takes_output(targets.iter().map(PathBuf::as_path), arguments.json).map_err(Failure::usage)?;
    let sources = arguments.sources();
    files::check_spared(targets.iter().map(PathBuf::as_path), sources.iter().filter(|path| path.exists()))
        .map_err(Failure::usage)?;
    let has_times = arguments.timing || arguments.axis == CostAxis::Host;
    let (base, machines) = arguments.shared()?;
    base.check()?;
    let choice = Choices {
        base,
        scenes: arguments.scenes.clone(),
        machines,
        profiles: arguments.profiles.clone(),
        words: arguments.words.concat(),
        roundings: arguments.roundings.clone(),
        layouts: arguments.layouts.clone(),
        bounces: arguments.bounces.concat(),
        cutoffs: arguments.cutoffs.clone(),
        interpolate: arguments.interpolate.iter().map(|agreement| agreement.0).collect(),
        shifts: PLACES[..usize::from(arguments.shifts)].to_vec(),
    };
    if arguments.study.is_some() {
        check_named(&choice.base, arguments.scenes.iter().map(String::as_str))?;
    }
    let name = sweep::study_name(arguments.study.as_deref(), "accuracy");
    let variants = choice.study(&name).ok_or_else(|| Failure::usage(Diagnostic::error("an option has no value")))?;
    // Read the scenes, which the study then knows.
    let contents = Contents::default();
    let mut read = Vec::new();
    for name in &arguments.scenes {
        let scene = SceneSettings { name: name.clone(), ..choice.base.scene.clone() };
        let scene = contents.scene(&Settings { scene, ..choice.base.clone() })?;
        files::check_spared(targets.iter().map(PathBuf::as_path), &scene.loaded.files).map_err(Failure::usage)?;
        terminal.show(&scene.loaded.warnings);
        read.push(scene.loaded.scene.clone());
    }
    if let Some(path) = &arguments.study {
        return sweep::write_study(&variants.study, "accuracy", path, &contents, terminal);
    }
    // Measure, and rank by the axes that are asked for.
    let bar = terminal.progress("pictures", variants.study.count());
    let store = arguments.recordings.store()?;
    let known = (&contents, store.as_ref());
    let study = accuracy::run(&variants, has_times, known, &mut |done| bar.inc(done));
    bar.finish_and_clear();
    tell_notes(store.as_ref(), terminal);
    let mut study = study?;
    // Where no picture came of the user's own files, they are what is wrong.
    let has_own = !arguments.kernels.replaced.is_empty() || !arguments.kernels.extensions.extensions.is_empty();
    if let Some(failure) = study.first_refusal.take().filter(|_| study.measured.is_empty() && has_own) {
        return Err(failure);
    }
    accuracy::rank(&mut study.measured, arguments.axis, arguments.error);
    let overall = match read.len() {
        0 | 1 => Vec::new(),
        scenes => accuracy::overall(&study.measured, scenes, arguments.axis, arguments.error),
    };
    let view = &choice.base.view;
    let size = view.size.map_or(read[0].size, <(u32, u32)>::from);
    // Write and print.
    let axes = ChartAxes { cost: arguments.axis, error: arguments.error, over: arguments.over };
    let figure = || accuracy::figure(&study, &overall, size, axes);
    files::write_all(&arguments.chart.files(figure, || accuracy::csv(&study.measured)))?;
    let machines = arguments.machines.iter().flatten().map(|name| MachineSettings::find(name));
    let machines = machines.collect::<Result<Vec<_>, _>>()?;
    let settings = given.clone().with_scenes(&scene_hashes(&arguments.scenes, &read)).with_machines(&machines);
    match (is_taken, arguments.json) {
        (true, _) => {}
        (false, true) => {
            let results = AccuracyResults {
                schema: SCHEMA,
                width: size.0,
                height: size.1,
                shift: view.shift,
                shifts: choice.shifts.iter().map(|place| [0, 1].map(|k| view.shift[k] + place[k])).collect(),
                cost_axis: arguments.axis,
                error_axis: arguments.error,
                recordings: study.recordings,
                replays: study.replays,
                stepped: study.stepped,
                variants: study.measured,
                overall,
                refused: study.refused,
            };
            terminal.print(&result::json(&WithSettings::new(&results, settings)))?;
        }
        (false, false) => {
            let axes = (arguments.axis, arguments.error);
            terminal.tell(&accuracy::text(&study, &overall, size, axes, arguments.energy))?;
        }
    }
    Ok(Exit::Done)
}
