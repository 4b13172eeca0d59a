//! `lancer accuracy`: run time against error, in many arithmetics.

use std::fmt::Write;
use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;
use isa::number::Quantization;
use kernels::KernelSet;
use messages::Diagnostic;
use scenes::layout::Layout;
use scenes::model::View;
use scenes::reference::{Reference, SearchMethod};
use schemars::JsonSchema;
use serde::Serialize;

use super::invocation::{CommandSettings, scene_hashes};
use crate::accuracy::{self, Choices, CostAxis, MeasuredVariant};
use crate::arguments::{self, ChartArguments, SettingsArguments, Size, TreeArguments};
use crate::failure::{Exit, Failure};
use crate::numeral::{numbers, short};
use crate::result::WithSettings;
use crate::table::{row, table};
use crate::terminal::Terminal;
use crate::{files, input, result};

/// Version of what `--json` prints.
pub(super) const SCHEMA: &str = "lancer-accuracy-1";

const EXAMPLES: &str = "\
Examples:
  lancer accuracy
  lancer accuracy cornell terrain --words 32,24,20 --size 160x120 --svg accuracy.svg --pdf accuracy.pdf
  lancer accuracy slabs --profiles ray --roundings RND,TRN,RND_CONV --bounces 5 --cutoffs 0 --json";

/// Draws scenes in many arithmetics and sets clocks against error.
///
/// Every profile is drawn in every word length, and for each further value of another option the first profile in every
/// word length. The first value of each option is the base. A variant is dominated when another one of the scene
/// takes no more clocks, has no larger error, and is better in one of them; the others are the front.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct AccuracyArguments {
    /// Scenes: .dsc or mesh files, or names of generated ones.
    #[arg(value_name = "SCENE", default_value = "cornell")]
    scenes: Vec<String>,
    /// Size of the pictures in pixels.
    #[arg(long, value_name = "WxH", value_parser = arguments::size, default_value = "64x48")]
    size: Size,
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
    #[command(flatten)]
    tree: TreeArguments,
    #[command(flatten)]
    settings: SettingsArguments,
    /// Cost that charts set errors against: clocks of the machine, or the host's time, which is then measured.
    #[arg(long, value_enum, default_value_t = CostAxis::Clocks, help_heading = "Charts and data")]
    axis: CostAxis,
    #[command(flatten)]
    chart: ChartArguments,
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

/// Difference up to which corners agree; none when every pixel has its ray.
#[derive(Clone, Copy, Debug)]
struct CornerAgreement(Option<f64>);

fn words(text: &str) -> Result<Vec<u32>, String> {
    numbers(text, 8, 32, "number of bits")
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
    /// Measured variants, scene by scene.
    variants: Vec<MeasuredVariant>,
    /// Variants that a scene does not fit, and why.
    refused: Vec<Refused>,
}

/// A variant that a scene does not fit.
#[derive(Serialize, JsonSchema)]
struct Refused {
    /// Name of the scene.
    scene: String,
    /// The variant in words.
    variant: String,
    /// Reason for which there is no picture.
    reason: String,
}

/// Draws and prints.
pub(super) fn execute(
    arguments: &AccuracyArguments,
    given: &CommandSettings,
    terminal: &mut Terminal,
) -> Result<Exit, Failure> {
    let targets = arguments.chart.targets(&[])?;
    let is_taken = files::takes_output(targets.iter().map(PathBuf::as_path), arguments.json).map_err(Failure::usage)?;
    let has_times = arguments.timing || arguments.axis == CostAxis::Host;
    let choice = Choices {
        profiles: arguments.profiles.clone(),
        words: arguments.words.concat(),
        roundings: arguments.roundings.clone(),
        layouts: arguments.layouts.clone(),
        bounces: arguments.bounces.concat(),
        cutoffs: arguments.cutoffs.clone(),
        interpolate: arguments.interpolate.iter().map(|agreement| agreement.0).collect(),
    };
    let variants = choice.variants().ok_or_else(|| Failure::usage(Diagnostic::error("an option has no value")))?;
    let (mut measured, mut refused, mut read) = (Vec::new(), Vec::new(), Vec::new());
    for name in &arguments.scenes {
        let loaded = input::scene(name, None, Some(arguments.size))?;
        terminal.show(&loaded.warnings);
        let view = View::new(arguments.size);
        let reference = Reference::new(&loaded.scene, &view, SearchMethod::Hierarchy)?;
        let bar = terminal.progress(&loaded.scene.name, variants.len() as u64);
        for variant in &variants {
            match accuracy::measure(&loaded.scene, &view, &reference, variant, &arguments.tree.settings(), has_times) {
                Ok(one) => measured.push(one),
                // A word that the scene does not fit, or in which a ray is stuck, is a result, not a mistake.
                Err(Failure::Message { report, exit: Exit::Input | Exit::Trap }) => refused.push(Refused {
                    scene: loaded.scene.name.clone(),
                    variant: variant.to_string(),
                    reason: report.0.iter().map(|message| message.message.as_str()).collect::<Vec<_>>().join("; "),
                }),
                Err(failure) => return Err(failure),
            }
            bar.inc(1);
        }
        bar.finish_and_clear();
        read.push(loaded.scene.clone());
    }
    accuracy::rank(&mut measured);
    let figure = || accuracy::figure(&measured, arguments.size, arguments.axis);
    files::write_all(&arguments.chart.files(figure, || csv(&measured)))?;
    let (width, height) = arguments.size;
    let results = AccuracyResults {
        schema: SCHEMA,
        width,
        height,
        shift: View::new(arguments.size).shift,
        variants: measured,
        refused,
    };
    let settings = given.clone().with_scenes(&scene_hashes(&arguments.scenes, &read));
    match (is_taken, arguments.json) {
        (true, _) => {}
        (false, true) => terminal.print(&result::json(&WithSettings::new(&results, settings)))?,
        (false, false) => terminal.tell(&text(&results, arguments.energy))?,
    }
    Ok(Exit::Done)
}

fn decibels(psnr: Option<f64>) -> String {
    psnr.map_or_else(|| "-".into(), |psnr| format!("{psnr:.1}"))
}

fn text(results: &AccuracyResults, has_energy: bool) -> String {
    // Scenes in the order in which they were measured, a table each.
    let mut scenes: Vec<&str> = results.variants.iter().map(|one| one.scene.as_str()).collect();
    scenes.dedup();
    let mut text = String::new();
    for scene in scenes {
        let _ = writeln!(
            text,
            "{scene}, {} x {} pixels; clocks and octets a pixel, * on the front",
            results.width, results.height
        );
        let mut rows = vec![row([
            "variant",
            "clocks",
            "octets",
            "PSNR",
            "off",
            "SSIM",
            "stored",
            "wrong/M",
            "t p99",
            "u p99",
            "v p99",
            "N p99",
            "dominated by",
        ])];
        if has_energy {
            rows[0].insert(3, "nJ".to_owned());
        }
        for one in results.variants.iter().filter(|one| one.scene == scene) {
            let ulp = |error: Option<f64>| error.map_or_else(|| "-".into(), |error| format!("{error:.2}"));
            rows.push(vec![
                format!("{}{}", if one.is_on_front { "* " } else { "  " }, one.variant),
                short(one.clocks.round() as u64),
                short(one.octets.round() as u64),
                decibels(one.error.psnr_db),
                short(one.error.off_pixels),
                one.ssim.map_or_else(|| "-".into(), |ssim| format!("{ssim:.4}")),
                decibels(one.stored_error.psnr_db),
                format!("{:.0}", one.rays.misclassified_per_million),
                ulp(one.rays.t_p99),
                ulp(one.rays.u_p99),
                ulp(one.rays.v_p99),
                ulp(one.rays.normal_p99),
                one.dominated_by.clone().unwrap_or_default(),
            ]);
            if has_energy && let Some(last) = rows.last_mut() {
                last.insert(3, one.energy.pixel_nj.to_string());
            }
        }
        text += &table(rows);
        text.push('\n');
    }
    // Variants that a scene does not fit come last.
    for Refused { scene, variant, reason } in &results.refused {
        let _ = writeln!(text, "{scene}, {variant}: {reason}");
    }
    text
}

fn csv(measured: &[MeasuredVariant]) -> String {
    let mut text = String::from(
        "scene,variant,profile,word,rounding,layout,bounces,cutoff,interpolate,clocks,instructions,octets,rmse,psnr_db,max,off_pixels,ssim,stored_psnr_db,\
         stored_off_pixels,misclassified_per_million,t_p99,t_max,u_p99,u_max,v_p99,v_max,normal_p99,normal_max,host_nanoseconds,dominated_by,pixel_nj_least,pixel_nj_most,energy_delay_js_least,energy_delay_js_most,area_um2_least,area_um2_most\n",
    );
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
    // Names may hold commas; RFC 4180 doubles the quotes inside.
    let quoted = |name: &str| format!("\"{}\"", name.replace('"', "\"\""));
    for one in measured {
        let cells = [
            quoted(&one.scene),
            quoted(&one.variant),
            one.profile.to_owned(),
            one.word.to_string(),
            one.rounding.to_owned(),
            one.layout.to_owned(),
            one.bounces.to_string(),
            one.cutoff.to_string(),
            number(one.interpolate),
            one.clocks.to_string(),
            one.instructions.to_string(),
            one.octets.to_string(),
            one.error.rmse.to_string(),
            number(one.error.psnr_db),
            one.error.max.to_string(),
            one.error.off_pixels.to_string(),
            number(one.ssim),
            number(one.stored_error.psnr_db),
            one.stored_error.off_pixels.to_string(),
            one.rays.misclassified_per_million.to_string(),
            number(one.rays.t_p99),
            number(one.rays.t_max),
            number(one.rays.u_p99),
            number(one.rays.u_max),
            number(one.rays.v_p99),
            number(one.rays.v_max),
            number(one.rays.normal_p99),
            number(one.rays.normal_max),
            number(one.host_nanoseconds),
            quoted(one.dominated_by.as_deref().unwrap_or("")),
            one.energy.pixel_nj.least.to_string(),
            one.energy.pixel_nj.most.to_string(),
            one.energy.energy_delay_js.least.to_string(),
            one.energy.energy_delay_js.most.to_string(),
            one.energy.area_um2.least.to_string(),
            one.energy.area_um2.most.to_string(),
        ];
        text += &(cells.join(",") + "\n");
    }
    text
}
