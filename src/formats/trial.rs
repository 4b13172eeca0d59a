//! Pictures of choices of formats, each measured against double precision. What does not change is not done again: scenes are read and
//! traced in double precision once, and a choice that makes the same programs and the same memory has the same picture.

use std::collections::HashMap;

use scenes::metrics;
use scenes::model::{Picture, Scene, View};
use scenes::reference::{Reference, SearchMethod};
use schemars::JsonSchema;
use serde::Serialize;
use sha2::{Digest, Sha256};

use super::choice::{DemandedError, FormatChoice, PictureSquare, PooledError};
use crate::drawing;
use crate::energy::{EnergyResult, FigureRange};
use crate::failure::{Exit, Failure};
use crate::job::Job;
use crate::load::Load;
use crate::sweep::frames::PictureFrames;

/// A scene with its pictures in double precision, one for each shift.
#[derive(Debug)]
pub struct TrialScene {
    /// Name of the scene.
    pub name: String,
    scene: Scene,
    pictures: Vec<(View, Picture)>,
}

impl TrialScene {
    /// A scene as a job sees it, for each of the shifts.
    ///
    /// # Errors
    /// A camera that double precision cannot look through.
    pub fn new(name: &str, scene: Scene, view: &View, shifts: &[[f64; 2]]) -> Result<TrialScene, Failure> {
        let picture = |&shift: &[f64; 2]| -> Result<(View, Picture), Failure> {
            let view = View { shift, ..view.clone() };
            let picture = Reference::new(&scene, &view, SearchMethod::Hierarchy)?.picture(None).picture;
            Ok((view, picture))
        };
        let pictures = shifts.iter().map(picture).collect::<Result<_, Failure>>()?;
        Ok(TrialScene { name: name.to_owned(), scene, pictures })
    }
}

/// Figures of one picture.
#[derive(Clone, Copy, Debug)]
struct PictureFigure {
    error: PictureSquare,
    pixels: u64,
    octets: u64,
    clocks: u64,
    nanojoules: FigureRange,
}

/// Figures of a scene in a choice of formats, over all shifts.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct TrialFigures {
    /// Name of the scene.
    pub scene: String,
    /// Error of its pictures.
    pub error: PooledError,
    /// Octets that the bus moved, a pixel.
    pub octets: f64,
    /// Clocks a pixel.
    pub clocks: f64,
    /// Nanojoules a pixel, as a range over published tables.
    pub pixel_nj: FigureRange,
    /// True where the error is what was asked for.
    pub is_kept: bool,
    /// Reason for which there is no picture; the figures are 0 then.
    pub refused: Option<String>,
}

/// Pictures of scenes, drawn when they are asked for.
pub struct FormatTrials<'a> {
    /// The job that chooses all but formats and the tree.
    pub job: &'a Job,
    demand: DemandedError,
    scenes: Vec<TrialScene>,
    /// Places of the scenes in the order in which they are tried: what failed last comes first.
    order: Vec<usize>,
    verdicts: HashMap<FormatChoice, bool>,
    pictures: HashMap<[u8; 32], PictureFigure>,
    /// Pictures that were drawn.
    pub drawn: u64,
    /// Pictures that were known.
    pub reused: u64,
    /// Called for each picture that was drawn.
    progress: &'a dyn Fn(),
}

impl<'a> FormatTrials<'a> {
    /// Trials of some scenes, drawn as the job says.
    pub fn new(
        job: &'a Job,
        demand: DemandedError,
        scenes: Vec<TrialScene>,
        progress: &'a dyn Fn(),
    ) -> FormatTrials<'a> {
        FormatTrials {
            job,
            demand,
            order: (0..scenes.len()).collect(),
            scenes,
            verdicts: HashMap::new(),
            pictures: HashMap::new(),
            drawn: 0,
            reused: 0,
            progress,
        }
    }

    /// The job that draws a scene in a choice of formats.
    fn job_of(&self, scene: usize, view: &View, choice: &FormatChoice) -> Job {
        let mut job = self.job.clone();
        job.scene = self.scenes[scene].scene.clone();
        job.view = view.clone();
        job.formats = choice.overrides();
        job.machine.arithmetic.word = choice.word;
        job.kd_visit = choice.visit.unwrap_or(job.kd_visit);
        job
    }

    /// The formats of each scene in a choice, where it fits.
    pub fn formats(&self, choice: &FormatChoice) -> Vec<scenes::cadrage::Formats> {
        let formats = |at: usize| {
            let (view, _) = self.scenes[at].pictures.first()?;
            let load = Load::picture(&self.job_of(at, view, choice)).ok()?;
            load.0.formats
        };
        (0..self.scenes.len()).filter_map(formats).collect()
    }

    /// True where all scenes keep the demand; stops at the first that does not.
    ///
    /// # Errors
    /// As of [`FormatTrials::measure`].
    pub fn keeps(&mut self, choice: FormatChoice) -> Result<bool, Failure> {
        if let Some(&verdict) = self.verdicts.get(&choice) {
            return Ok(verdict);
        }
        let mut verdict = true;
        for place in 0..self.order.len() {
            let scene = self.order[place];
            if !self.scene(scene, &choice)?.is_kept {
                self.order[..=place].rotate_right(1);
                verdict = false;
                break;
            }
        }
        self.verdicts.insert(choice, verdict);
        Ok(verdict)
    }

    /// Figures of all scenes.
    ///
    /// # Errors
    /// Errors in the user's kernels or the machine; a scene that does not fit a choice is a result.
    pub fn measure(&mut self, choice: FormatChoice) -> Result<Vec<TrialFigures>, Failure> {
        (0..self.scenes.len()).map(|scene| self.scene(scene, &choice)).collect()
    }

    fn scene(&mut self, scene: usize, choice: &FormatChoice) -> Result<TrialFigures, Failure> {
        let mut figures = Vec::new();
        // Draw the scene at each shift; formats that it does not fit are an answer, and no reason to end the search
        for shift in 0..self.scenes[scene].pictures.len() {
            match self.picture(scene, shift, choice) {
                Ok(figure) => figures.push(figure),
                Err(Failure::Message { report, exit: Exit::Input | Exit::Trap | Exit::StepLimit }) => {
                    let reason: Vec<&str> = report.0.iter().map(|message| message.message.as_str()).collect();
                    return Ok(TrialFigures {
                        scene: self.scenes[scene].name.clone(),
                        error: PooledError::default(),
                        octets: 0.0,
                        clocks: 0.0,
                        pixel_nj: FigureRange::default(),
                        is_kept: false,
                        refused: Some(reason.join("; ")),
                    });
                }
                Err(failure) => return Err(failure),
            }
        }
        // Pool errors over the shifts, and give costs by the pixel
        let errors: Vec<PictureSquare> = figures.iter().map(|figure| figure.error).collect();
        let error = PooledError::of(&errors);
        let pixels = figures.iter().map(|figure| figure.pixels).sum::<u64>().max(1) as f64;
        let each = |part: fn(&PictureFigure) -> u64| figures.iter().map(part).sum::<u64>() as f64 / pixels;
        let nanojoules =
            |part: fn(&FigureRange) -> f64| figures.iter().map(|figure| part(&figure.nanojoules)).sum::<f64>() / pixels;
        Ok(TrialFigures {
            scene: self.scenes[scene].name.clone(),
            error,
            octets: each(|figure| figure.octets),
            clocks: each(|figure| figure.clocks),
            pixel_nj: FigureRange { least: nanojoules(|range| range.least), most: nanojoules(|range| range.most) },
            is_kept: self.demand.allows(&error),
            refused: None,
        })
    }

    fn picture(&mut self, scene: usize, shift: usize, choice: &FormatChoice) -> Result<PictureFigure, Failure> {
        let job = self.job_of(scene, &self.scenes[scene].pictures[shift].0, choice);
        let (load, image) = Load::picture(&job)?;
        let key = digest(&load, &job, (scene, shift));
        if let Some(&known) = self.pictures.get(&key) {
            self.reused += 1;
            return Ok(known);
        }
        let frames = PictureFrames::new(&load, None).run(std::slice::from_ref(&job.machine), &mut |_| {});
        let frame = frames.into_iter().next().expect("a machine has a result")?;
        let crop = load.build.crop;
        let words = drawing::colour_words(&image, &frame, &crop);
        let picture = drawing::picture(&image, &words, (crop.width, crop.height));
        let error =
            metrics::compare(&picture, &self.scenes[scene].pictures[shift].1).expect("both have the view's size");
        let pixels = words.len() as u64;
        let energy = EnergyResult::new(&job.machine, load.programs(), &frame, pixels, None).summary;
        let figure = PictureFigure {
            error: PictureSquare { square: error.rmse * error.rmse, off: error.off_pixels, largest: error.max },
            pixels,
            octets: frame.bus.moved.0,
            clocks: frame.clocks.0,
            nanojoules: energy.frame_nj,
        };
        self.drawn += 1;
        (self.progress)();
        self.pictures.insert(key, figure);
        Ok(figure)
    }
}

/// SHA-256 of everything that decides a picture and its figures.
fn digest(load: &Load, job: &Job, which: (usize, usize)) -> [u8; 32] {
    let mut hash = Sha256::new();
    for program in [&load.build.cores, &load.build.main] {
        program.words.iter().for_each(|word| hash.update(word.to_le_bytes()));
        hash.update(&program.buffer);
        hash.update(program.entry.to_le_bytes());
    }
    hash.update(load.memory.octets());
    // Colours are raw numbers of their format, and the word is the machine's.
    let colour = load.formats.map_or(0, |formats| formats.colour);
    hash.update(format!("{which:?} {colour} {}", job.machine.arithmetic.word));
    hash.finalize().into()
}
