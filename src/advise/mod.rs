//! Advice on a machine: each change that could help, with the clocks that it would bring. Every figure is a run of the picture on the changed
//! machine, most of them replays of one recording; nothing is estimated but what is called an estimate.

mod bottleneck;
mod change;
mod price;
#[cfg(feature = "cli")]
mod text;
mod verdict;

use emu::code::Code;
use emu::machine::{Config, RunOutcome};
use isa::{Class, Counts};
use messages::Report;
use scenes::image::MemoryImage;
use schemars::JsonSchema;
use serde::Serialize;

pub use bottleneck::{Bottleneck, FrameShares};
pub use change::{Change, ChangedPart, PictureDemand, PictureOption};
pub use price::Price;
#[cfg(feature = "cli")]
pub use text::{csv, text};

use crate::cores::PixelDemand;
use crate::failure::Failure;
use crate::job::{Job, result_name};
use crate::load::Load;
use crate::settings::Settings;
use crate::sweep::frames::{FrameResult, KeptRecordings, PictureFrames};
use crate::sweep::recordings::RecordingStore;
use crate::sweep::study::{Assignments, Study};

/// Version of [`AdviceResult`]: a key that goes away or changes its meaning changes it, a new key does not.
pub const SCHEMA: &str = "lancer-advise-1";

/// Changes of different parts that pairs are made of: the best ones.
const BEST: usize = 6;

/// Speed relative to the machine as it is from which a change is worth while.
const WORTH: f64 = 1.01;

/// Bottleneck of a machine on a picture, and changes that would help.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct AdviceResult {
    /// Version of the result: a key that goes away or changes its meaning changes it, a new key does not.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: &'static str,
    /// Name of the scene.
    pub scene: String,
    /// Width of the picture in pixels.
    pub width: u32,
    /// Height of the picture in pixels.
    pub height: u32,
    /// Work items of the frame: the pixels that have a ray.
    pub pixels: u64,
    /// Name of the machine.
    pub machine: String,
    /// Clock rate in hertz.
    pub clock_hz: u64,
    /// Sentence on what limits the machine, and why.
    pub verdict: String,
    /// The machine as it is.
    pub now: Prediction,
    /// Single changes, the best one first.
    pub advice: Vec<Advice>,
    /// Pairs of the six best changes of different parts, and of the best change with each number of cores; the best pair first.
    pub pairs: Vec<Advice>,
    /// Changes that the machine or the scene does not fit, or that are about next to nothing.
    pub refused: Vec<RefusedChange>,
}

/// A change, or two, with what it brings and costs.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Advice {
    /// The change in words.
    pub change: String,
    /// Parts that it changes: bus-width, bursts, overlap, cache, cores, arbiter, units, speed, layout, kernels, kd-depth, kd-build.
    pub parts: Vec<&'static str>,
    /// Keys of the machine file with their new values, one a line, as they can be pasted into the top of a file.
    pub toml: Vec<String>,
    /// Options of the command line beside the machine, each with its value.
    pub options: Vec<String>,
    /// Basis of the prediction: `replay` of the recording of the machine as it is, `recording` where operations take other clocks, `picture`
    /// where another picture in memory or other programs were built and recorded.
    pub basis: &'static str,
    /// The machine with the change.
    pub predicted: Prediction,
    /// Speed relative to the machine as it is.
    pub speed_up: f64,
    /// Price of the change.
    pub price: Price,
    /// True where the picture has other bits.
    pub changes_picture: bool,
    /// Keys of the settings with their new values.
    #[serde(skip)]
    pub set: Assignments,
}

/// Time of a frame and what sets its pace.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Prediction {
    /// Length of the frame in clocks; a run of the changed machine takes exactly as many.
    pub clocks: u64,
    /// Length of the frame in seconds.
    pub seconds: f64,
    /// Seconds a pixel.
    pub pixel_seconds: f64,
    /// Share of the frame in which the bus was busy.
    pub utilisation: f64,
    /// Share of the cores' clocks in which they waited for the bus.
    pub waiting: f64,
    /// Share of the cores' clocks in which they had nothing to do.
    pub idle: f64,
    /// Share of the frame in which the main processor computed.
    pub main_busy: f64,
    /// Resource that sets the pace: bus, turns (that an arbiter keeps for masters without a request), main-processor, computing, transfers (each
    /// takes too long, though the bus has room) or work.
    pub limit: Bottleneck,
    /// Seconds a pixel by the closed form, max((C + M) / N, M), with C and M of this frame; an estimate.
    pub closed_form_pixel_seconds: f64,
    /// Seconds a pixel by the queueing estimate, with C and M of this frame.
    pub queueing_pixel_seconds: f64,
    /// `replayed`, or `stepped`.
    pub method: &'static str,
}

/// A change that the machine or the scene does not fit, or that is about next to nothing.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct RefusedChange {
    /// The change in words.
    pub change: String,
    /// Reason for which there is no prediction.
    pub reason: String,
    /// Keys of the settings with their new values, of a change that was tried.
    #[serde(skip)]
    pub set: Option<Assignments>,
}

impl AdviceResult {
    /// The study of the machine as it is and of all changes and pairs that were tried, in the order of the result; those without a prediction come
    /// last. `base` are the settings of the machine as it is.
    pub fn study(&self, name: &str, base: &Settings) -> Study {
        let found = self.advice.iter().chain(&self.pairs).map(|advice| &advice.set);
        let refused = self.refused.iter().filter_map(|refused| refused.set.as_ref());
        let tried = std::iter::once(Assignments::new()).chain(found.chain(refused).cloned());
        Study { name: name.to_owned(), base: base.value(), factors: vec![tried.collect()] }
    }
}

impl Prediction {
    fn new(frame: &RunOutcome, machine: &Config) -> Prediction {
        let shares = FrameShares::new(frame, machine);
        let pixels = frame.item_count.max(1) as f64;
        let cores = &frame.processors[..machine.cores as usize];
        let demand = PixelDemand {
            computing: cores.iter().map(|core| core.busy.0).sum::<u64>() as f64 / pixels,
            transfer: frame.bus.busy.0 as f64 / pixels,
        };
        let seconds = |clocks: f64| clocks / machine.clock_hz as f64;
        Prediction {
            clocks: frame.clocks.0,
            seconds: frame.seconds(machine.clock_hz),
            pixel_seconds: frame.seconds(machine.clock_hz) / pixels,
            utilisation: shares.bus,
            waiting: shares.waiting,
            idle: shares.idle,
            main_busy: shares.main_busy,
            limit: shares.bottleneck(machine.bus.arbiter),
            closed_form_pixel_seconds: seconds(demand.bound(machine.cores)),
            queueing_pixel_seconds: seconds(demand.queueing(machine.cores)),
            method: frame.method.name(),
        }
    }
}

/// The frame that all changes are compared with.
struct Baseline<'a> {
    job: &'a Job,
    /// Folder of recordings.
    store: Option<&'a RecordingStore>,
    prediction: Prediction,
    /// Octets of global memory.
    octets: usize,
    /// The drawn part of the picture.
    colours: Vec<u8>,
}

/// The picture of a job in memory with its programs, and its recordings so far.
struct BuiltPicture<'a> {
    load: &'a Load,
    image: &'a MemoryImage,
    recorded: PictureFrames<'a>,
}

impl<'a> BuiltPicture<'a> {
    fn new(built: &'a (Load, MemoryImage), kept: Option<KeptRecordings<'a>>) -> BuiltPicture<'a> {
        let (load, image) = built;
        BuiltPicture { load, image, recorded: PictureFrames::new(load, kept) }
    }

    /// Frames of machines, in their order. Those that differ in time only share a recording.
    fn frames(&mut self, machines: &[Config], progress: &mut dyn FnMut()) -> Vec<FrameResult> {
        let frames = self.recorded.run(machines, &mut |_| {});
        machines.iter().for_each(|_| progress());
        frames
    }

    /// Octets of the drawn part.
    fn colours(&self, frame: &RunOutcome) -> Vec<u8> {
        let crop = self.load.build.crop;
        crate::drawing::colour_octets(self.image, frame, &crop).to_vec()
    }
}

/// Advice on a job's machine, with recordings that are kept where a folder of them is given. `progress` is told the number of machines that have run and of those that will at least.
///
/// # Errors
/// A scene that does not fit its formats, errors in the user's kernels, a machine out of its ranges, a trap.
pub fn advise(
    job: &Job,
    store: Option<&RecordingStore>,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<AdviceResult, Failure> {
    let (built, settings) = (Load::picture(job)?, Settings::of(job));
    let mut picture = BuiltPicture::new(&built, store.map(|store| KeptRecordings { store, settings: &settings }));
    let now = picture.frames(std::slice::from_ref(&job.machine), &mut || {});
    let now = now.into_iter().next().expect("the machine as it is has a result")?;
    let (changes, left) = change::all(job, picture.image, &demand(&now, job, picture.load));
    let (on_machine, of_picture): (Vec<Change>, Vec<Change>) =
        changes.into_iter().partition(|change| change.options.is_empty());
    let pairs = (BEST * (BEST - 1) / 2) as u64;
    let (mut done, total) = (0, (on_machine.len() + of_picture.len()) as u64 + pairs);
    let mut step = || {
        done += 1;
        progress(done, total.max(done));
    };
    let base = Baseline {
        job,
        store,
        prediction: Prediction::new(&now, &job.machine),
        octets: picture.load.memory.size(),
        colours: picture.colours(&now),
    };
    let mut found = Findings {
        singles: Vec::new(),
        refused: left.into_iter().map(|(change, reason)| refused(&change, reason, None)).collect(),
    };
    // Those that differ in time only share a recording.
    try_on(&mut picture, &base, &on_machine, &mut found, &mut step)?;
    for change in &of_picture {
        try_all(&base, std::slice::from_ref(change), &mut found, &mut step)?;
    }
    let mut singles = std::mem::take(&mut found.singles);
    rank(&mut singles);
    // Pairs of the best change of each of the best parts; and the best one with every number of cores, since on a machine that is held up
    // elsewhere all numbers look alike by themselves.
    let best = best(&singles, &base);
    let mut together = pairs_of(&best);
    let numbers = singles.iter().map(|(change, _)| change).filter(|change| change.parts == [ChangedPart::Cores]);
    let others = numbers.filter(|change| !best.iter().any(|(known, _)| known.keys == change.keys));
    if let Some((first, _)) = best.first() {
        together.extend(others.filter_map(|change| first.with(change)));
    }
    // Those with the same options share their picture and its recording.
    together.sort_by_key(|pair| pair.options.iter().map(|option| option.words()).collect::<Vec<_>>());
    for alike in together.chunk_by(|one, other| one.options == other.options) {
        match alike[0].options.is_empty() {
            true => try_on(&mut picture, &base, alike, &mut found, &mut step)?,
            false => try_all(&base, alike, &mut found, &mut step)?,
        }
    }
    rank(&mut found.singles);
    let (width, height) = job.view.size;
    Ok(AdviceResult {
        schema: SCHEMA,
        scene: result_name(&job.scene),
        width,
        height,
        pixels: now.item_count,
        machine: job.machine_name.clone(),
        clock_hz: job.machine.clock_hz,
        verdict: verdict::sentence(&now, &job.machine, picture.load),
        now: base.prediction,
        advice: singles.into_iter().map(|(_, advice)| advice).collect(),
        pairs: found.singles.into_iter().map(|(_, advice)| advice).collect(),
        refused: found.refused,
    })
}

/// Predictions so far, and changes without one.
struct Findings {
    singles: Vec<(Change, Advice)>,
    refused: Vec<RefusedChange>,
}

fn refused(change: &Change, reason: String, set: Option<Assignments>) -> RefusedChange {
    RefusedChange { change: change.words.clone(), reason, set }
}

/// A change that was tried, and is refused.
fn failed(change: &Change, report: &Report) -> RefusedChange {
    refused(change, change::reason(report), Some(change.assignments()))
}

/// Octets and clocks of a frame of the machine as it is.
fn demand(frame: &RunOutcome, job: &Job, load: &Load) -> PictureDemand {
    let code = Code::new(&load.build.cores, &load.isa, job.machine.timing());
    let (counts, mut clocks) = (frame.tally.counts(&code), Counts::ZERO);
    for &class in Class::ALL {
        clocks[class] = counts[class].saturating_mul(code.timing.clocks[class]);
    }
    PictureDemand { octets: frame.kinds.iter().map(|kind| (kind.kind.clone(), kind.octets.0)).collect(), clocks }
}

impl Findings {
    /// Takes the frame of a change.
    fn take(&mut self, base: &Baseline, change: &Change, machine: &Config, picture: &BuiltPicture, frame: FrameResult) {
        match frame {
            Ok(frame) => self.singles.push((change.clone(), advice(base, change, machine, picture, &frame))),
            Err(failure) => self.refused.push(failed(change, &failure.report())),
        }
    }
}

/// Builds the picture of changes with the same options, and runs it on each of their machines.
fn try_all(base: &Baseline, changes: &[Change], found: &mut Findings, step: &mut dyn FnMut()) -> Result<(), Failure> {
    let job = changes[0].job(base.job)?;
    let built = match Load::picture(&job) {
        Ok(built) => built,
        // A layout or a word that the scene does not fit is a result; a closed pipe is not.
        Err(Failure::Message { report, .. }) => {
            found.refused.extend(changes.iter().map(|change| failed(change, &report)));
            return Ok(());
        }
        Err(failure) => return Err(failure),
    };
    let settings = Settings::of(&job);
    let kept = base.store.map(|store| KeptRecordings { store, settings: &settings });
    try_on(&mut BuiltPicture::new(&built, kept), base, changes, found, step)
}

/// Runs a picture on the machine of each change.
fn try_on(
    picture: &mut BuiltPicture,
    base: &Baseline,
    changes: &[Change],
    found: &mut Findings,
    step: &mut dyn FnMut(),
) -> Result<(), Failure> {
    let machines = changes.iter().map(|change| change.machine(&base.job.machine));
    let machines = machines.collect::<Result<Vec<Config>, _>>()?;
    let frames = picture.frames(&machines, step);
    for ((change, machine), frame) in changes.iter().zip(&machines).zip(frames) {
        found.take(base, change, machine, picture, frame);
    }
    Ok(())
}

fn advice(base: &Baseline, change: &Change, machine: &Config, picture: &BuiltPicture, frame: &RunOutcome) -> Advice {
    let predicted = Prediction::new(frame, machine);
    let basis = match () {
        () if !change.options.is_empty() => "picture",
        () if !machine.computes_like(&base.job.machine) => "recording",
        () => "replay",
    };
    let changes_picture = picture.colours(frame) != base.colours;
    Advice {
        change: change.words.clone(),
        parts: change.parts.iter().map(|part| part.name()).collect(),
        toml: change.lines(),
        options: change.options.iter().map(|option| option.words()).collect(),
        basis,
        speed_up: base.prediction.clocks as f64 / predicted.clocks.max(1) as f64,
        price: Price::new(base.job, machine, change, picture.load.memory.size() as i64 - base.octets as i64),
        predicted,
        changes_picture,
        set: change.assignments(),
    }
}

/// Sorts by time; of equal ones the one that takes less memory comes first.
fn rank(found: &mut [(Change, Advice)]) {
    found.sort_by_key(|(_, advice)| (advice.predicted.clocks, advice.price.local_octets, advice.price.global_octets));
}

/// The best change of each part that brings anything, of the best parts; true where it brings something worth while by itself.
fn best(ranked: &[(Change, Advice)], base: &Baseline) -> Vec<(Change, bool)> {
    let mut best: Vec<(Change, bool)> = Vec::new();
    for (change, advice) in ranked {
        let is_new = !best.iter().any(|(known, _)| known.parts == change.parts);
        if best.len() < BEST && is_new && advice.predicted.clocks < base.prediction.clocks {
            best.push((change.clone(), advice.speed_up >= WORTH));
        }
    }
    best
}

/// Pairs of changes, each with at least one that brings something worth while by itself.
fn pairs_of(changes: &[(Change, bool)]) -> Vec<Change> {
    let from = |at: usize| {
        let (change, is_worth) = &changes[at];
        let others = changes[at + 1..].iter().filter(move |(_, is_other_worth)| *is_worth || *is_other_worth);
        others.filter_map(move |(other, _)| change.with(other))
    };
    (0..changes.len()).flat_map(from).collect()
}
