//! The study: each variant on each scene at each shift is a point, points that share a recording run together, and what does not depend on the
//! machine is measured once for all of them.

use std::sync::Arc;
use std::time::Instant;

use emu::code::Code;
use emu::machine::{Method, RunOutcome};
use kernels::twin::samples::Samples;
use scenes::metrics;
use scenes::model::Scene;
use scenes::reference::{Reference, SearchMethod};
use schemars::JsonSchema;
use serde::Serialize;

use super::pooled::{PictureFigures, ShiftFigures, pooled};
use super::{MeasuredVariant, PictureNumber, RayErrors, Variant, VariantStudy, similarity};
use crate::drawing::{self, colour_words};
use crate::energy::EnergyResult;
use crate::failure::Failure;
use crate::job::{Job, result_name};
use crate::settings::Settings;
use crate::sweep::contents::Contents;
use crate::sweep::group::{self, DrawnGroup};
use crate::sweep::recordings::RecordingStore;

/// Places of the samples in their pixels for statistics, in pixels to the right of the middle and above it; `examples/shifts.toml` has the same.
pub const PLACES: [[f64; 2]; 8] = [
    [0.0, 0.0],
    [0.137, 0.071],
    [-0.239, 0.311],
    [0.411, -0.173],
    [-0.367, -0.283],
    [0.059, 0.447],
    [0.293, -0.431],
    [-0.113, 0.197],
];

/// A variant that a scene does not fit.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct RefusedVariant {
    /// Name of the scene.
    pub scene: String,
    /// The variant in words.
    pub variant: String,
    /// Reason for which there is no picture.
    pub reason: String,
}

/// Everything that was measured.
#[derive(Debug, Default)]
pub struct AccuracyStudy {
    /// Measured variants, scene by scene.
    pub measured: Vec<MeasuredVariant>,
    /// Variants that a scene does not fit, and why.
    pub refused: Vec<RefusedVariant>,
    /// Times that the work items of a picture ran.
    pub recordings: u64,
    /// Frames that recordings were put on a machine's clocks for.
    pub replays: u64,
    /// Frames that were executed clock by clock, for which there is no recording.
    pub stepped: u64,
    /// First reason for which there was no picture, in full.
    pub first_refusal: Option<Failure>,
}

/// Measures all variants on scenes, at each of the shifts, with the contents of files and the recordings that are kept. With times of the host each
/// picture is drawn by itself and recorded, since a replay alone takes less. `progress` is told of each picture.
///
/// # Errors
/// Files that cannot be read, settings out of their ranges. A scene that does not fit a variant, or a trap, is a result.
pub fn run(
    points: &VariantStudy,
    has_times: bool,
    (contents, store): (&Contents, Option<&RecordingStore>),
    progress: &mut dyn FnMut(u64),
) -> Result<AccuracyStudy, Failure> {
    let mut study = AccuracyStudy::default();
    let store = store.filter(|_| !has_times);
    let count = points.variants();
    for scene in 0..points.scenes() {
        let variants = (0..count).map(|variant| points.variant(scene, variant, contents));
        let variants = variants.collect::<Result<Vec<Variant>, _>>()?;
        let known = contents.scene(&variants[0].settings)?;
        let mut figures: Vec<Vec<ShiftFigures>> = vec![Vec::new(); count];
        let mut reasons: Vec<Option<String>> = vec![None; count];
        for shift in 0..points.shifts() {
            // A variant without a picture at one shift is refused, and needs no others.
            let fitting: Vec<usize> = (0..count).filter(|&at| reasons[at].is_none()).collect();
            progress((count - fitting.len()) as u64);
            let settings = fitting.iter().map(|&variant| PictureNumber { scene, variant, shift });
            let settings = settings.map(|number| points.settings(number, contents));
            let settings = settings.collect::<Result<Vec<Settings>, _>>()?;
            let groups = match has_times {
                true => (0..settings.len()).map(|point| vec![point]).collect(),
                false => group::by_recording(&settings),
            };
            let mut reference = None;
            for group in groups {
                let alike: Vec<&Settings> = group.iter().map(|&point| &settings[point]).collect();
                let measured =
                    study.measure(&alike, (contents, store), has_times, (&known.loaded.scene, &mut reference))?;
                for (&point, figure) in group.iter().zip(measured) {
                    match figure {
                        Ok(figure) => figures[fitting[point]].push(figure),
                        Err(reason) => reasons[fitting[point]] = Some(reason),
                    }
                }
                progress(group.len() as u64);
            }
        }
        let name = result_name(&known.loaded.scene);
        for (number, (variant, (figures, reason))) in variants.iter().zip(figures.iter().zip(reasons)).enumerate() {
            match reason {
                None => study.measured.extend(pooled(number, &name, variant, figures)),
                Some(reason) => {
                    study.refused.push(RefusedVariant { scene: name.clone(), variant: variant.to_string(), reason })
                }
            }
        }
    }
    Ok(study)
}

impl AccuracyStudy {
    /// Figures of points that share a recording, or the reason for which one has none. The reference is kept for other points of the scene and shift.
    fn measure<'s>(
        &mut self,
        points: &[&Settings],
        (contents, store): (&Contents, Option<&RecordingStore>),
        has_times: bool,
        (scene, reference): (&'s Scene, &mut Option<Reference<'s>>),
    ) -> Result<Vec<Result<ShiftFigures, String>>, Failure> {
        // Draw the points, those of one recording together.
        let start = Instant::now();
        let (job, drawn) = group::draw(points, contents, store, &mut |_| {})?;
        let host = has_times.then(|| start.elapsed());
        let mut drawn = match drawn {
            Ok(drawn) => drawn,
            Err(failure) => {
                let reason = self.refuse(failure)?;
                return Ok(vec![Err(reason); points.len()]);
            }
        };
        self.recordings += drawn.recordings;
        let reference = match reference {
            Some(known) => known,
            None => reference.insert(Reference::new(scene, &job.reference_view(), SearchMethod::Hierarchy)?),
        };
        // The scene as it lies in memory, for double precision over the vertices that the format could hold.
        drawn.image.bytes = drawn.load.memory.octets().to_vec();
        let frames = std::mem::take(&mut drawn.frames);
        let mut pictures: Vec<(Vec<[i32; 3]>, Arc<PictureFigures>)> = Vec::new();
        let mut results = Vec::with_capacity(points.len());
        for (settings, frame) in points.iter().zip(frames) {
            let frame = match frame {
                Ok(frame) => frame,
                Err(failure) => {
                    results.push(Err(self.refuse(failure.into())?));
                    continue;
                }
            };
            // Pictures differ only where a machine was stepped and its programs depend on time.
            let words = colour_words(&drawn.image, &frame, &drawn.load.build.crop);
            let known = pictures.iter().find(|(known, _)| *known == words).map(|(_, figures)| figures.clone());
            let picture = match known {
                Some(picture) => picture,
                None => {
                    let figures = Arc::new(picture_figures(&job, &drawn, &words, reference)?);
                    pictures.push((words, figures.clone()));
                    figures
                }
            };
            results.push(Ok(self.shift_figures(settings, &drawn, &frame, picture, host)));
        }
        Ok(results)
    }

    /// The reason of a refusal, where it is a result and not a mistake of the user's.
    fn refuse(&mut self, failure: Failure) -> Result<String, Failure> {
        match group::reason(&failure) {
            Some(reason) => {
                self.first_refusal.get_or_insert(failure);
                Ok(reason)
            }
            None => Err(failure),
        }
    }

    fn shift_figures(
        &mut self,
        settings: &Settings,
        drawn: &DrawnGroup,
        frame: &RunOutcome,
        picture: Arc<PictureFigures>,
        host: Option<std::time::Duration>,
    ) -> ShiftFigures {
        let (load, config) = (&drawn.load, &settings.machine.config);
        let is_replayed = frame.method == Method::Replayed;
        *if is_replayed { &mut self.replays } else { &mut self.stepped } += 1;
        let pixels = u64::from(load.build.crop.width) * u64::from(load.build.crop.height);
        let (cores, _) = frame.processors.split_at(config.cores as usize);
        let code = Code::new(&load.build.cores, &load.isa, config.timing());
        ShiftFigures {
            shift: settings.view.shift,
            picture,
            pixels,
            clocks: frame.clocks.0,
            seconds: frame.seconds(config.clock_hz),
            octets: cores.iter().map(|core| core.octets.0).sum(),
            instructions: cores.iter().map(|core| core.instructions).sum(),
            operations: frame.tally.counts(&code),
            energy: EnergyResult::new(config, load.programs(), frame, pixels, None).summary,
            host,
            is_replayed,
        }
    }
}

/// A picture against double precision: over the scene as it was given, and over the vertices that the format could hold.
fn picture_figures(
    job: &Job,
    drawn: &DrawnGroup,
    words: &[[i32; 3]],
    reference: &Reference,
) -> Result<PictureFigures, Failure> {
    let (image, crop) = (&drawn.image, &drawn.load.build.crop);
    let picture = drawing::picture(image, words, (crop.width, crop.height));
    let samples = Samples::new(&job.scene, image, job.kernels.profile, job.machine.arithmetic.modes());
    let stored = image.stored_scene(&job.scene).expect("an image that was built can be read");
    let stored = Reference::framed(&stored, job.scene.bounds(), &job.reference_view(), SearchMethod::Hierarchy)?;
    let [exact, stored] = [reference, &stored].map(|reference| drawing::part(reference, &samples, crop));
    let error = |reference| metrics::compare(&picture, reference).expect("both have the size of the drawn part");
    Ok(PictureFigures {
        error: error(&exact),
        ssim: similarity::structural_similarity(&picture, &exact),
        stored_error: error(&stored),
        rays: RayErrors::new(image, job, crop),
        formats: (&image.formats).into(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_those_of_the_example() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/shifts.toml");
        let source = messages::Source::new("shifts.toml", std::fs::read_to_string(path).unwrap());
        let study = crate::sweep::study::Study::parse(&source, "shifts").unwrap();
        let of_example: Vec<serde_json::Value> = study
            .factors
            .iter()
            .flatten()
            .flatten()
            .filter(|(key, _)| key == "view.shift")
            .map(|(_, value)| value.clone())
            .collect();
        assert_eq!(of_example, PLACES.map(|place| serde_json::json!(place)));
    }
}
