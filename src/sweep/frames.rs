//! Frames of a picture on several machines: those that compute alike are replays of one recording. A small picture's recordings are kept while it
//! is, and found or left in a folder where one is given; a large one's are handed to some machines at a time as they are made.

use std::sync::Arc;

use emu::machine::outcome::Method;
use emu::machine::{Config, RunFailure, RunOptions, RunOutcome, Setup, SteppedFrames};
use emu::replay::{Reason, Recorded};
use kernels::build::Crop;
use rayon::prelude::*;

use super::identity;
use super::recordings::RecordingStore;
use crate::load::Load;
use crate::settings::Settings;

/// Pixels of the largest picture whose recordings are kept as a whole, for any number of machines: 16 octets a transfer, thousands of transfers
/// a pixel.
const MOST_KEPT: u64 = 8_192;

/// Result of a machine.
pub type FrameResult = Result<RunOutcome, RunFailure>;

/// A folder of recordings, and the settings of a picture, which with those of a machine say which of them are its own.
#[derive(Clone, Copy, Debug)]
pub struct KeptRecordings<'a> {
    /// The folder.
    pub store: &'a RecordingStore,
    /// Settings with the hashes of all files.
    pub settings: &'a Settings,
}

/// A picture in memory with its programs, and the recordings of it so far.
pub struct PictureFrames<'a> {
    load: &'a Load,
    kept: Option<KeptRecordings<'a>>,
    /// Recordings by a machine that computes as all those that they serve, or why there is none.
    known: Vec<(Config, Result<Arc<Recorded>, Reason>)>,
    /// Recordings that frames came of; one that was made again for more machines than take it at once counts again.
    pub recordings: u64,
}

impl<'a> PictureFrames<'a> {
    /// A picture that nothing was recorded of.
    pub fn new(load: &'a Load, kept: Option<KeptRecordings<'a>>) -> PictureFrames<'a> {
        PictureFrames { load, kept, known: Vec::new(), recordings: 0 }
    }

    fn setup<'c>(&'c self, config: &'c Config) -> Setup<'c> {
        self.load.setup(config, RunOptions { engine: self.load.engine, ..RunOptions::default() })
    }

    /// Frames of machines, in their order. `progress` is told of pixels as far as somebody waits for those of a large picture.
    pub fn run(&mut self, configs: &[Config], progress: &mut dyn FnMut(u64)) -> Vec<FrameResult> {
        let Crop { width, height, .. } = self.load.build.crop;
        let is_small = u64::from(width) * u64::from(height) <= MOST_KEPT;
        let mut results: Vec<Option<FrameResult>> = configs.iter().map(|_| None).collect();
        for first in 0..configs.len() {
            if results[first].is_some() {
                continue;
            }
            let is_alike = |&at: &usize| results[at].is_none() && configs[at].computes_like(&configs[first]);
            let alike: Vec<usize> = (first..configs.len()).filter(is_alike).collect();
            let machines: Vec<Config> = alike.iter().map(|&at| configs[at].clone()).collect();
            // A machine that is alone takes its recording as it comes, and nobody else needs it.
            let is_known = self.known.iter().any(|(known, _)| known.computes_like(&machines[0]));
            let frames = match is_small && (machines.len() > 1 || self.kept.is_some() || is_known) {
                true => self.replays(&machines),
                false => self.streamed(&machines, progress),
            };
            alike.into_iter().zip(frames).for_each(|(at, frame)| results[at] = Some(frame));
        }
        results.into_iter().flatten().collect()
    }

    /// Frames of machines that compute alike, to which a recording is handed as it is made.
    fn streamed(&mut self, machines: &[Config], progress: &mut dyn FnMut(u64)) -> Vec<FrameResult> {
        let mut frames = Vec::with_capacity(machines.len());
        for some in machines.chunks(emu::machines_at_once(&self.load.memory)) {
            let some = emu::run_all(&self.setup(&some[0]), some, &self.load.memory, progress);
            self.recordings += u64::from(some.iter().flatten().any(|frame| frame.method == Method::Replayed));
            frames.extend(some);
        }
        frames
    }

    /// Frames of machines that compute alike, of a recording that is kept.
    fn replays(&mut self, machines: &[Config]) -> Vec<FrameResult> {
        let recorded = self.recorded(&machines[0]);
        let setup = self.setup(&machines[0]);
        let stepped = SteppedFrames::new(&setup);
        let step = |config: &Config| stepped.step(config, self.load.memory.clone());
        let replays = recorded.as_ref().map(|recorded| recorded.replays(&setup));
        let one = |config: &Config| match &replays {
            Ok(replays) => replays.replay(config, self.load.memory.clone())?.or_else(|_| step(config)),
            Err(_) => step(config),
        };
        machines.par_iter().map(one).collect()
    }

    /// The recording that serves a machine.
    fn recorded(&mut self, config: &Config) -> Result<Arc<Recorded>, Reason> {
        if let Some((_, known)) = self.known.iter().find(|(known, _)| known.computes_like(config)) {
            return known.clone();
        }
        let (setup, memory) = (self.setup(config), &self.load.memory);
        let recorded = match self.kept {
            Some(KeptRecordings { store, settings }) => {
                let mut settings = settings.clone();
                settings.machine.config.clone_from(config);
                store.recording(&identity::recording(&settings), &setup, memory)
            }
            None => Recorded::new(&setup, memory),
        };
        let recorded = recorded.map(Arc::new);
        self.recordings += u64::from(recorded.is_ok());
        self.known.push((config.clone(), recorded.clone()));
        recorded
    }
}
