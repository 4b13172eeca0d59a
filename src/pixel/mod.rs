//! A pixel explained: the machine's ray tree, read off its running program, beside that of double precision. What is shown of it is text, JSON, or a
//! page that replays the pixel instruction by instruction.

mod compared;
mod page;
mod probe;
mod replay;
mod result;
mod text;

use emu::stepper::Stepper;
use kernels::twin::samples::Samples;
use messages::Report;
use scenes::image::MemoryImage;
use scenes::reference::{Reference, SearchMethod};

pub use compared::{ComparedNumber, ComparedVector};
pub use page::page;
use probe::probe;
pub use replay::{MOST_STEPS, PixelReplay};
pub use result::{ExplainedHit, ExplainedLight, ExplainedRay, PixelExplanation, SCHEMA};

use crate::job::Job;

/// Explains a pixel of a job from a core before its first instruction, which is then at its program's end.
///
/// # Errors
/// See [`Reference::new`].
pub fn explain(
    job: &Job,
    image: &MemoryImage,
    pixel: [u32; 2],
    stepper: &mut Stepper,
) -> Result<PixelExplanation, Report> {
    let raw = probe(stepper, image);
    let reference = Reference::new(&job.scene, &job.reference_view(), SearchMethod::Hierarchy)?;
    let samples = Samples::new(&job.scene, image, job.kernels.profile, job.machine.arithmetic.modes());
    let (colour, rays) = reference.explain(pixel[0], pixel[1], Some(&samples));
    let explainer = result::Explainer { job, image, scales: compared::RawScales::new(image) };
    Ok(explainer.explain(pixel, &raw, colour, &rays))
}
