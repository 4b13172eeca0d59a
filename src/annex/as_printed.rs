//! An erratum of the report beside its correction: what a picture becomes of kernels, a tree or a reading of files that do what is printed.

use kernels::annex::{KernelEdit, PrintedErratum, PrintedFigure, Reproduction};
use scenes::kdtree::BuildMethod;
use scenes::metrics::{self, PictureError};
use scenes::model::{Camera, Picture, Scene};
use schemars::JsonSchema;
use serde::Serialize;

use super::scene::job;
use crate::drawing::{Comparison, Drawing};
use crate::failure::{Exit, Failure};
use crate::job::{Detail, Job, result_name};
use crate::result::{ByClass, Render};
use crate::settings::FIELD;

/// Version of [`ErratumResult`]: a key that goes away or changes its meaning changes it, a new key does not.
pub const SCHEMA: &str = "lancer-erratum-1";

/// An erratum, as printed and corrected.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ErratumResult {
    /// Version of the result: a key that goes away or changes its meaning changes it, a new key does not.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: &'static str,
    /// Name of the erratum.
    pub name: String,
    /// Place in the report.
    pub source: &'static str,
    /// Printed text.
    pub printed: &'static str,
    /// Correct text.
    pub correct: &'static str,
    /// Effect on other figures, or on pictures.
    pub effect: &'static str,
    /// Way to have what is printed: `kernels`, `tree`, `reading` or `figure`.
    pub way: &'static str,
    /// Edits of the kernels of the profile `report`.
    pub edits: Vec<EditResult>,
    /// Printed and correct number; null where pictures tell.
    pub figure: Option<PrintedFigure>,
    /// Pictures, a pair for each scene; none where a number tells.
    pub pictures: Vec<PicturePair>,
}

/// A part of a kernel and what stands instead in the other one.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct EditResult {
    /// File of the kernel.
    pub file: String,
    /// Text of the profile `report`.
    pub text: &'static str,
    /// Text that takes its place.
    pub by: &'static str,
}

/// A picture as printed and the corrected one, both measured against double precision.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PicturePair {
    /// Name of the scene.
    pub scene: String,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// As printed.
    pub printed: ErratumPicture,
    /// Corrected.
    pub correct: ErratumPicture,
    /// PSNR of the one against the other in dB; null for equal pictures, and where there is none.
    pub between_db: Option<f64>,
    /// Pixels in which the two differ by 1/255 or more; null where there is no picture.
    pub differing_pixels: Option<u64>,
}

/// A picture, and what it took.
#[derive(Clone, Debug, Default, Serialize, JsonSchema)]
pub struct ErratumPicture {
    /// PSNR against double precision in dB; null for an equal picture, and where there is none.
    pub psnr_db: Option<f64>,
    /// Pixels off by 1/255 or more.
    pub off_pixels: u64,
    /// Elementary operations a pixel.
    pub operations: f64,
    /// Operations of all cores, by class.
    pub counts: Option<ByClass>,
    /// Clocks of the frame.
    pub clocks: u64,
    /// Octets that the cores moved.
    pub octets: u64,
    /// Nodes of the kd tree.
    pub nodes: u64,
    /// References to triangles in its leaves.
    pub references: u64,
    /// SHA-256 of the picture; null where there is none.
    pub image_hash: Option<String>,
    /// The trap in which a kernel ended instead; null where the picture was drawn.
    pub trap: Option<String>,
}

/// The two pictures of a scene, where they were drawn.
#[derive(Clone, Debug)]
pub struct ErratumDrawings {
    /// As printed.
    pub printed: Option<Picture>,
    /// Corrected.
    pub correct: Option<Picture>,
}

/// The two jobs of an erratum on a scene: as printed, and corrected. `None` where a number tells.
pub fn jobs(erratum: &PrintedErratum, scene: &Scene, size: (u32, u32)) -> Option<[Job; 2]> {
    let mut correct = job(scene.clone(), size);
    correct.detail = Detail::Functions;
    if let Some(eye) = erratum.eye {
        correct.view.camera = Camera::Perspective { eye: Some(eye), look: erratum.look, field: FIELD };
    }
    let mut printed = correct.clone();
    match erratum.reproduction() {
        Reproduction::Kernels(kernels) => printed.kernels.replaced.extend(kernels),
        Reproduction::Corrected(kernels) => correct.kernels.replaced.extend(kernels),
        Reproduction::Tree(slip) => printed.kd_method = Some(BuildMethod::Printed(slip)),
        Reproduction::Reading(slip) => printed.scene = slip.misread(scene),
        Reproduction::Figure(_) => return None,
    }
    Some([printed, correct])
}

/// Draws a job for an erratum; `None` with the trap where a kernel that does what is printed ends in one.
fn drawn(job: &Job, comparison: Comparison, draw: Draw) -> Result<(ErratumPicture, Option<Drawing>), Failure> {
    match draw(job, comparison) {
        Ok(drawing) => Ok((ErratumPicture::new(job, &drawing), Some(drawing))),
        Err(Failure::Message { report, exit: Exit::Trap }) => {
            let trap = report.0.first().map(|message| message.message.clone());
            Ok((ErratumPicture { trap, ..ErratumPicture::default() }, None))
        }
        Err(other) => Err(other),
    }
}

/// Draws jobs, and says how far it is.
pub type Draw<'d> = &'d mut dyn FnMut(&Job, Comparison) -> Result<Drawing, Failure>;

/// Draws a scene as printed and corrected.
///
/// Both are measured against double precision of the scene as its files mean it.
///
/// # Errors
/// Pictures that [`crate::drawing::draw`] refuses, and a trap of the corrected kernels.
pub fn compare(jobs: &[Job; 2], draw: Draw) -> Result<(PicturePair, ErratumDrawings), Failure> {
    let [printed_job, correct_job] = jobs;
    let (correct, correct_drawing) = drawn(correct_job, Comparison::Reference, draw)?;
    let (mut printed, printed_drawing) = drawn(printed_job, Comparison::None, draw)?;
    let pictures = ErratumDrawings {
        printed: printed_drawing.map(|drawing| drawing.picture),
        correct: correct_drawing.as_ref().map(|drawing| drawing.picture.clone()),
    };
    let reference = correct_drawing.as_ref().and_then(|drawing| drawing.reference.as_ref());
    if let Some(error) = error(pictures.printed.as_ref(), reference) {
        (printed.psnr_db, printed.off_pixels) = (error.psnr_db, error.off_pixels);
    }
    let between = error(pictures.printed.as_ref(), pictures.correct.as_ref());
    let (width, height) = correct_job.view.size;
    let pair = PicturePair {
        scene: result_name(&correct_job.scene),
        width,
        height,
        printed,
        correct,
        between_db: between.and_then(|between| between.psnr_db),
        differing_pixels: between.map(|between| between.off_pixels),
    };
    Ok((pair, pictures))
}

fn error(a: Option<&Picture>, b: Option<&Picture>) -> Option<PictureError> {
    metrics::compare(a?, b?)
}

impl ErratumPicture {
    fn new(job: &Job, drawing: &Drawing) -> ErratumPicture {
        let result = Render::new(job, drawing);
        let tree = drawing.image.tree;
        ErratumPicture {
            psnr_db: result.error.and_then(|error| error.psnr_db),
            off_pixels: result.error.map_or(0, |error| error.off_pixels),
            operations: result.counts.0.elementary() as f64 / drawing.words.len().max(1) as f64,
            counts: Some(result.counts),
            clocks: result.clocks,
            octets: result.octets,
            nodes: tree.nodes as u64,
            references: tree.references as u64,
            image_hash: Some(result.image_hash),
            trap: None,
        }
    }
}

impl ErratumResult {
    /// An erratum with the pictures that were drawn.
    pub fn new(erratum: &'static PrintedErratum, pictures: Vec<PicturePair>) -> ErratumResult {
        let edit = |edit: &'static KernelEdit| EditResult {
            file: format!("kernels/asm/{}", edit.at),
            text: &edit.text,
            by: &edit.by,
        };
        ErratumResult {
            schema: SCHEMA,
            name: erratum.name(),
            source: &erratum.source,
            printed: &erratum.printed,
            correct: &erratum.correct,
            effect: &erratum.effect,
            way: erratum.reproduction().name(),
            edits: erratum.edits().iter().map(edit).collect(),
            figure: erratum.figure.clone(),
            pictures,
        }
    }
}
