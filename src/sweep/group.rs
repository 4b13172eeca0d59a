//! Points that share a recording, run together: the work items run once, and each point is a replay of them.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use emu::code::Code;
use emu::machine::{Config, RunOutcome};
use kernels::build::Crop;
use kernels::twin::samples::Samples;
use scenes::image::MemoryImage;
use scenes::metrics::{self, PictureError};
use scenes::model::Picture;
use scenes::reference::{Reference, SearchMethod};

use super::contents::Contents;
use super::frames::{FrameResult, KeptRecordings, PictureFrames};
use super::identity;
use super::recordings::RecordingStore;
use super::row::{PointFigures, PointLabels};
use crate::drawing::{colour_words, part, picture};
use crate::failure::{Exit, Failure};
use crate::job::{Job, result_name};
use crate::load::Load;
use crate::result::image_hash;
use crate::settings::Settings;

/// Outcome of a point: its labels, and its figures or the reason for which it cannot be drawn.
pub type GroupResult = (PointLabels, Result<PointFigures, String>);

/// Points that share a recording, on their machines.
pub struct DrawnGroup {
    /// Programs and global memory as it is before the frame.
    pub load: Load,
    /// Description of that memory.
    pub image: MemoryImage,
    /// Frame of each point.
    pub frames: Vec<FrameResult>,
    /// Times that the work items ran: once, again for more machines than take a recording at once, never where all frames were stepped.
    pub recordings: u64,
}

/// Numbers of the settings that share each recording, in the order in which they come.
pub fn by_recording(points: &[Settings]) -> Vec<Vec<usize>> {
    let (mut groups, mut known): (Vec<Vec<usize>>, HashMap<[u8; 32], usize>) = (Vec::new(), HashMap::new());
    for (number, settings) in points.iter().enumerate() {
        let group = *known.entry(identity::recording(settings)).or_insert(groups.len());
        if group == groups.len() {
            groups.push(Vec::new());
        }
        groups[group].push(number);
    }
    groups
}

/// Draws points whose settings have the same recording: the job of the first one, and the frames of all or the reason for which there are none.
/// The recording is in `store`, or is put there, where one is given and the picture is no larger than recordings are kept for.
/// `progress` is told of pixels as far as somebody waits for those of a large picture.
///
/// # Errors
/// Files that cannot be read.
pub fn draw(
    points: &[&Settings],
    contents: &Contents,
    store: Option<&RecordingStore>,
    progress: &mut dyn FnMut(u64),
) -> Result<(Job, Result<DrawnGroup, Failure>), Failure> {
    let first = points.first().expect("a group has a point");
    let job = contents.job(first)?;
    let (load, image) = match Load::picture(&job) {
        Ok(made) => made,
        Err(failure) => return Ok((job, Err(failure))),
    };
    // Each machine's frame, from one recording.
    let configs: Vec<Config> = points.iter().map(|settings| settings.machine.config.clone()).collect();
    let kept = store.map(|store| KeptRecordings { store, settings: first });
    let mut picture = PictureFrames::new(&load, kept);
    let (frames, recordings) = (picture.run(&configs, progress), picture.recordings);
    Ok((job, Ok(DrawnGroup { load, image, frames, recordings })))
}

/// Runs points whose settings have the same recording.
///
/// # Errors
/// Files that cannot be read. A scene that does not fit its formats, or a trap, is a result.
pub fn run(
    points: &[Settings],
    contents: &Contents,
    store: Option<&RecordingStore>,
) -> Result<Vec<GroupResult>, Failure> {
    let Some(first) = points.first() else { return Ok(Vec::new()) };
    let (job, drawn) = draw(&points.iter().collect::<Vec<_>>(), contents, store, &mut |_| {})?;
    let labels = |settings: &Settings| labels(settings, &job);
    let DrawnGroup { load, image, frames, .. } = match drawn {
        Ok(drawn) => drawn,
        Err(failure) => {
            let reason = reason(&failure).ok_or(failure)?;
            return Ok(points.iter().map(|settings| (labels(settings), Err(reason.clone()))).collect());
        }
    };
    // Pictures differ only where a machine was stepped and its programs depend on time; those in double precision by the levels of their rays.
    let crop = load.build.crop;
    let mut errors: HashMap<(String, Option<u32>), PictureError> = HashMap::new();
    let mut references: HashMap<Option<u32>, Picture> = HashMap::new();
    let code = Code::new(&load.build.cores, &load.isa, first.machine.config.timing());
    let mut results = Vec::with_capacity(points.len());
    for (settings, frame) in points.iter().zip(frames) {
        let frame = match frame {
            Ok(frame) => frame,
            Err(failure) => {
                let failure = Failure::from(failure);
                results.push((labels(settings), Err(reason(&failure).ok_or(failure)?)));
                continue;
            }
        };
        let words = colour_words(&image, &frame, &crop);
        let hash = image_hash((crop.width, crop.height), &words);
        let bounces = settings.results.reference_bounces;
        let pair = (hash, bounces);
        if settings.results.error && !errors.contains_key(&pair) {
            let drawn = picture(&image, &words, (crop.width, crop.height));
            let reference = match references.entry(bounces) {
                Entry::Occupied(known) => known.into_mut(),
                Entry::Vacant(place) => place.insert(in_double_precision(&job, bounces, &image, &crop)?),
            };
            errors.extend(metrics::compare(&drawn, reference).map(|error| (pair.clone(), error)));
        }
        let error = errors.get(&pair).filter(|_| settings.results.error);
        let counts = frame.tally.counts(&code);
        results.push((labels(settings), Ok(figures(settings, &job, &load, &frame, counts, error, pair.0))));
    }
    Ok(results)
}

/// The drawn part in double precision, with so many levels of secondary rays, or as many as the job's picture has; it decides samples on edges as the
/// kernels do.
fn in_double_precision(job: &Job, bounces: Option<u32>, image: &MemoryImage, crop: &Crop) -> Result<Picture, Failure> {
    let samples = Samples::new(&job.scene, image, job.kernels.profile, job.machine.arithmetic.modes());
    let reference = Reference::new(&job.scene, &job.view_of(bounces), SearchMethod::Hierarchy)?;
    Ok(part(&reference, &samples, crop))
}

/// The reason for which a point cannot be drawn, where that is a result and not a mistake of the user's.
pub fn reason(failure: &Failure) -> Option<String> {
    match failure {
        Failure::Message { report, exit: Exit::Input | Exit::Trap | Exit::StepLimit } => {
            Some(report.0.iter().map(|message| message.message.as_str()).collect::<Vec<_>>().join("; "))
        }
        _ => None,
    }
}

fn labels(settings: &Settings, job: &Job) -> PointLabels {
    let config = &settings.machine.config;
    let [width, height] = settings.view.size.unwrap_or_else(|| job.view.size.into());
    PointLabels {
        scene: result_name(&job.scene),
        profile: settings.kernels.profile.name().to_owned(),
        layout: job.layout().name().to_owned(),
        machine: settings.machine.name.clone(),
        cores: config.cores.into(),
        arbiter: config.bus.arbiter.name().to_owned(),
        word: config.arithmetic.word.into(),
        rounding: config.arithmetic.quantization.name().to_owned(),
        overflow: config.arithmetic.overflow.to_string(),
        width: width.into(),
        height: height.into(),
        shift_x: settings.view.shift[0],
        shift_y: settings.view.shift[1],
        bounces: settings.effort.bounces.into(),
    }
}

fn figures(
    settings: &Settings,
    job: &Job,
    load: &Load,
    frame: &RunOutcome,
    counts: isa::Counts,
    error: Option<&PictureError>,
    image_hash: String,
) -> PointFigures {
    let config = &settings.machine.config;
    // Behind the cores stands the main processor, where there is one.
    let (cores, main) = frame.processors.split_at(config.cores as usize);
    let sum = |part: fn(&emu::machine::ProcessorUse) -> u64| cores.iter().map(part).sum::<u64>();
    let share = |part: u64, whole: u64| if whole == 0 { 0.0 } else { part as f64 / whole as f64 };
    // Waiting and idle are shares of all cores' clocks: 4 cores have 4,000 of them in a frame of 1,000.
    let whole = frame.clocks.0 * u64::from(config.cores);
    let pixels = u64::from(load.build.crop.width) * u64::from(load.build.crop.height);
    PointFigures {
        pixels,
        interpolated: pixels.saturating_sub(frame.item_count),
        triangles: job.scene.triangles.len() as u64,
        clocks: frame.clocks.0,
        seconds: frame.seconds(config.clock_hz),
        pixel_clocks: share(frame.clocks.0, pixels),
        instructions: sum(|core| core.instructions),
        operations: counts.operations(),
        elementary: counts.elementary(),
        octets: sum(|core| core.octets.0),
        bus_busy: frame.bus.busy.0,
        utilisation: frame.utilisation(),
        waiting: share(sum(|core| core.waiting.0), whole),
        idle: share(sum(|core| core.idle.0), whole),
        longest_wait: frame.bus.longest_wait.0,
        main_load: share(main.iter().map(|main| (main.busy + main.waiting).0).sum(), frame.clocks.0),
        cache_hits: frame.cache.hits,
        cache_misses: frame.cache.misses,
        program_words: load.build.cores.words.len() as u64,
        position_bits: load.formats.map_or(0.0, |formats| f64::from(formats.position)),
        off_pixels: error.map(|error| error.off_pixels),
        rmse: error.map(|error| error.rmse),
        max_error: error.map(|error| error.max),
        psnr_db: error.and_then(|error| error.psnr_db),
        psnr_others_db: error.and_then(|error| error.psnr_others_db),
        method: frame.method.name().to_owned(),
        image_hash,
    }
}
