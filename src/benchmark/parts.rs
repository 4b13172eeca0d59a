//! Time of a picture by part: what `lancer render` does, one part after the other.

use emu::machine::{RunOptions, Setup};
use emu::profile::ProfileLevel;
use emu::replay::Recorded;
use kernels::twin::samples::Samples;
use messages::Diagnostic;
use scenes::metrics;
use scenes::reference::{Reference, SearchMethod};
use schemars::JsonSchema;
use serde::Serialize;

use super::{median, timed};
use crate::drawing::{self, Comparison};
use crate::failure::Failure;
use crate::files::picture::PictureFormat;
use crate::job::Job;
use crate::load::Load;

/// Parts of a picture in the order in which they follow each other: the key in results, and the heading.
macro_rules! parts {
    ($($(#[$doc:meta])* $part:ident $heading:literal)*) => {
        /// Host's milliseconds that a picture takes, medians of the runs. What is told apart by a difference of two runs may be a little below 0.
        #[derive(Clone, Debug, Serialize, JsonSchema)]
        pub struct PictureParts {
            /// Name of the scene.
            pub scene: String,
            /// The kernel set.
            pub profile: &'static str,
            $($(#[$doc])* pub $part: f64,)*
        }

        /// Number of parts.
        const PARTS: usize = [$($heading),*].len();

        impl PictureParts {
            /// Headings of the parts.
            pub const HEADINGS: [&'static str; PARTS] = [$($heading),*];

            /// Times in the order of the headings.
            pub fn times(&self) -> [f64; PARTS] {
                [$(self.$part),*]
            }

            fn new(job: &Job, [$($part),*]: [f64; PARTS]) -> PictureParts {
                PictureParts { scene: job.scene.name.clone(), profile: job.kernels.profile.name(), $($part),* }
            }
        }
    };
}

parts! {
    /// Tree, memory image and programs.
    building "build"
    /// Native code of the cores' program.
    compiling "compile"
    /// Work items, counted.
    executing "execute"
    /// Totals of functions, beside that.
    functions "functions"
    /// Transfers of the work items, beside that.
    recording "record"
    /// Recordings on the machine's clocks.
    replaying "replay"
    /// Picture out of global memory.
    reading "read"
    /// Picture in double precision, and the difference from that.
    comparing "compare"
    /// Picture as a file.
    writing "write"
    /// The picture as `lancer render` draws it: with two threads of the host to spare, recording goes on beside replaying, and both beside comparing.
    whole "whole"
}

/// Measures the parts of a picture.
///
/// # Errors
/// A scene that does not fit its formats, errors in the user's kernels, a machine that cannot be used, a frame that cannot be replayed.
pub fn measure(job: &Job, runs: u32, mut after_run: impl FnMut()) -> Result<PictureParts, Failure> {
    let mut times: [Vec<f64>; PARTS] = Default::default();
    for _ in 0..runs {
        times.iter_mut().zip(run(job)?).for_each(|(times, time)| times.push(time));
        after_run();
    }
    let medians = times.each_mut().map(|times| median(times).0);
    Ok(PictureParts::new(job, medians))
}

/// Times of one run, in milliseconds.
fn run(job: &Job) -> Result<[f64; PARTS], Failure> {
    let refused = |reason| Failure::from(Diagnostic::error(format!("the frame cannot be replayed: {reason}")));
    let ((load, image), building) = milliseconds(|| Load::picture(job))?;
    let setup = |profile| {
        // Eager, so that short programs are compiled as well: what compiling takes is taken off below.
        let options =
            RunOptions { profile, has_items: true, engine: job.engine, is_eager: true, ..RunOptions::default() };
        load.setup(&job.machine, options)
    };
    let (plain, profiled) = (setup(ProfileLevel::None), setup(ProfileLevel::Totals));
    let count = |setup: &Setup| milliseconds(|| emu::count(setup, &load.memory)?.map_err(refused));
    // Each of these does what the one before it does, and something more.
    let (_, compiling) = milliseconds(|| Ok(profiled.prepare_engine()))?;
    let (_, counting) = count(&plain)?;
    let (_, profiling) = count(&profiled)?;
    let (recorded, recording) = milliseconds(|| Recorded::new(&profiled, &load.memory).map_err(refused))?;
    let (frame, replaying) = milliseconds(|| recorded.replay(&profiled, load.memory.clone())?.map_err(refused))?;
    let crop = load.build.crop;
    let (picture, reading) = milliseconds(|| Ok(drawing::read(&image, &frame, &crop)))?;
    let (_, comparing) = milliseconds(|| {
        let reference = Reference::new(&job.scene, &job.view, SearchMethod::Hierarchy)?;
        let samples = Samples::new(&job.scene, &image, job.kernels.profile, job.machine.arithmetic.modes());
        Ok(metrics::compare(&picture, &drawing::part(&reference, &samples, &crop)))
    })?;
    let (_, writing) = milliseconds(|| Ok(PictureFormat::Png.encode(&picture)))?;
    let (_, whole) = milliseconds(|| {
        let drawn = drawing::draw(job, Comparison::Reference, &mut |_| {})?;
        Ok(PictureFormat::Png.encode(&drawn.picture))
    })?;
    let beyond = |all: f64, less: f64| (all - less).max(0.0);
    let executing = beyond(counting, compiling);
    let [functions, recording] = [beyond(profiling, counting), beyond(recording, profiling)];
    Ok([building, compiling, executing, functions, recording, replaying, reading, comparing, writing, whole])
}

fn milliseconds<T>(work: impl FnOnce() -> Result<T, Failure>) -> Result<(T, f64), Failure> {
    let mut done = None;
    let time = timed(|| {
        done = Some(work()?);
        Ok(())
    })?;
    Ok((done.expect("it was done"), time.as_secs_f64() * 1e3))
}
