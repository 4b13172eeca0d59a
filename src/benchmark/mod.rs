//! Speed of pictures on this host: the engines, and native code beside them. Nothing here prints.

#[cfg(feature = "cli")]
mod chart;
pub mod parts;

use std::time::{Duration, Instant};

use emu::code::Code;
use emu::engine::EngineKind;
use emu::machine::{RunOptions, Setup};
use emu::profile::ProfileLevel;
use isa::number::Modes;
use kernels::Function;
use kernels::build::SceneFeatures;
use messages::Diagnostic;
use rayon::prelude::*;
use scenes::reference::{Reference, SearchMethod};
use schemars::JsonSchema;
use serde::Serialize;

#[cfg(feature = "cli")]
pub use chart::{csv, figure};

use crate::failure::Failure;
use crate::job::Job;
use crate::load::Load;
use crate::result::FormatTable;

/// A way to compute a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Runner {
    /// Code generated for the host, counted.
    Native,
    /// Native code with the clocks of the machine.
    NativeClocks,
    /// Native code with clocks and the totals of functions: all that `render` asks for.
    NativeAll,
    /// The interpreter, counted.
    Checked,
    /// The profile's functions in Rust, on the same tree and the same rays.
    Twin,
    /// Double precision on the same scene.
    Reference,
}

impl Runner {
    /// All, in the order of results.
    pub const ALL: [Runner; 6] =
        [Runner::Native, Runner::NativeClocks, Runner::NativeAll, Runner::Checked, Runner::Twin, Runner::Reference];

    /// Name in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Runner::Native => "native",
            Runner::NativeClocks => "native, clocks",
            Runner::NativeAll => "native, all",
            Runner::Checked => "checked",
            Runner::Twin => "native twin",
            Runner::Reference => "native f64",
        }
    }
}

/// A picture by one of them.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct BenchResult {
    /// Name of the scene.
    pub scene: String,
    /// The kernel set.
    pub profile: &'static str,
    /// Runner that computed it: `native`, `native-clocks`, `native-all`, `checked`, `twin` or `reference`.
    #[schemars(with = "String")]
    pub runner: Runner,
    /// Bits of a word and fraction bits of each quantity.
    pub formats: FormatTable,
    /// Host's nanoseconds a pixel, the median of the runs.
    pub nanoseconds: f64,
    /// Least of the runs.
    pub least: f64,
    /// Time as a multiple of that of the native twin, of medians.
    pub of_twin: f64,
    /// Millions of simulated instructions a second, those of the cores; null for native code.
    pub instructions: Option<f64>,
    /// Millions of rays a second: camera, secondary and shadow rays.
    pub rays: f64,
}

/// Measures a picture, each runner in turn, so that whatever else the host does disturbs all alike.
///
/// # Errors
/// A scene that does not fit its formats, errors in the user's kernels, a machine that cannot be used, a frame without counts.
pub fn measure(job: &Job, runs: u32, mut after_run: impl FnMut()) -> Result<Vec<BenchResult>, Failure> {
    let (load, mut image) = Load::picture(job)?;
    image.bytes = load.memory.octets().into_owned();
    // Prepare everything that is not measured: programs, the reference's hierarchy, counts of instructions and rays.
    let setup = |engine| load.setup(&job.machine, RunOptions { engine, ..RunOptions::default() });
    let features = SceneFeatures::new(&job.scene, &job.view, &image.formats, &job.kernels);
    let modes = job.machine.arithmetic.modes();
    let reference = Reference::new(&job.scene, &job.view, SearchMethod::Hierarchy)?;
    let crop = load.build.crop;
    let count = |setup: &Setup| -> Result<emu::replay::FrameTotals, Failure> {
        let count = emu::count(setup, &load.memory)?;
        count.map_err(|reason| Diagnostic::error(format!("the frame cannot be counted: {reason}")).into())
    };
    let counted = count(&setup(EngineKind::Native))?;
    let code = Code::new(&load.build.cores, &load.isa, job.machine.timing());
    let instructions = counted.tally.instructions();
    let pixels = u64::from(crop.width) * u64::from(crop.height);
    let own_packet = load.build.cores.symbols.get(Function::OwnPacket.name());
    // Each secondary and shadow ray starts in its own packet, and looks for it once.
    let other_rays = own_packet.map_or(0, |&pc| counted.tally.word(&code, pc as u32).instructions);

    // Each runner once a round, so that a slow moment of the host meets all of them.
    let mut times: [Vec<f64>; Runner::ALL.len()] = Default::default();
    for _ in 0..runs {
        for (runner, times) in Runner::ALL.into_iter().zip(&mut times) {
            let clocked = |setup: &Setup| {
                let run = || emu::run(setup, load.memory.clone(), &mut |_| {});
                timed(|| run().map(drop).map_err(Failure::from))
            };
            let time = match runner {
                Runner::Native => timed(|| count(&setup(EngineKind::Native)).map(drop))?,
                Runner::NativeClocks => clocked(&setup(EngineKind::Native))?,
                Runner::NativeAll => {
                    let options = RunOptions {
                        engine: EngineKind::Native,
                        profile: ProfileLevel::Totals,
                        ..RunOptions::default()
                    };
                    clocked(&load.setup(&job.machine, options))?
                }
                Runner::Checked => timed(|| count(&setup(EngineKind::Checked)).map(drop))?,
                Runner::Twin => timed(|| twin(&image, &features, &crop, job, modes))?,
                Runner::Reference => timed(|| {
                    (0..crop.height).into_par_iter().for_each(|row| {
                        for column in 0..crop.width {
                            std::hint::black_box(reference.pixel(crop.column + column, crop.row + row, None));
                        }
                    });
                    Ok(())
                })?,
            };
            times.push(time.as_secs_f64());
            after_run();
        }
    }
    // Tell medians and least times; ratios are those of medians.
    let seconds: Vec<(f64, f64)> = times.iter_mut().map(|times| median(times)).collect();
    let of = |runner: Runner| seconds[Runner::ALL.iter().position(|other| *other == runner).unwrap_or(0)];
    let (twin, _) = of(Runner::Twin);
    Ok(Runner::ALL
        .into_iter()
        .map(|runner| {
            let (median, least) = of(runner);
            let is_native = matches!(runner, Runner::Twin | Runner::Reference);
            BenchResult {
                scene: job.scene.name.clone(),
                profile: job.kernels.profile.name(),
                runner,
                formats: (&image.formats).into(),
                nanoseconds: median * 1e9 / pixels as f64,
                least: least * 1e9 / pixels as f64,
                of_twin: median / twin,
                instructions: (!is_native).then(|| instructions as f64 / median / 1e6),
                rays: (pixels + other_rays) as f64 / median / 1e6,
            }
        })
        .collect())
}

fn twin(
    image: &scenes::image::MemoryImage,
    features: &SceneFeatures,
    crop: &kernels::build::Crop,
    job: &Job,
    modes: Modes,
) -> Result<(), Failure> {
    let failed = |failure: kernels::twin::TwinFailure| Failure::from(Diagnostic::error(failure.to_string()));
    kernels::twin::render(image, features, crop, job.kernels.profile, modes).map(drop).map_err(failed)
}

fn timed(work: impl FnOnce() -> Result<(), Failure>) -> Result<Duration, Failure> {
    let start = Instant::now();
    work()?;
    Ok(start.elapsed())
}

/// Median and least of some times; 0 of none.
fn median(times: &mut [f64]) -> (f64, f64) {
    times.sort_by(f64::total_cmp);
    let at = |place: usize| times.get(place).copied().unwrap_or(0.0);
    ((at(times.len() / 2) + at(times.len().saturating_sub(1) / 2)) / 2.0, at(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_lies_in_the_middle() {
        assert_eq!(median(&mut [3.0, 1.0, 2.0]), (2.0, 1.0));
        assert_eq!(median(&mut [4.0, 1.0, 2.0, 3.0]), (2.5, 1.0));
        assert_eq!(median(&mut []), (0.0, 0.0));
    }
}
