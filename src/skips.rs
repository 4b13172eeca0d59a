//! Savings of each skip: the same picture without any, with each alone and with all of them.

use isa::Counts;
use kernels::{Skip, Skips};
use scenes::metrics;
use schemars::JsonSchema;
use serde::Serialize;

use crate::drawing::{self, Comparison, Drawing};
use crate::failure::Failure;
use crate::job::{Job, result_name};
use crate::result::{ByClass, FormatTable, image_hash};

/// Difference of a component up to which corners agree, where a job names none.
pub const DIFFERENCE: f64 = 0.01;

/// Names of the pictures without any skip and with all.
const NONE: &str = "none";
const ALL: &str = "all";

/// Version of [`SkipsResult`].
pub const SCHEMA: &str = "lancer-skips-1";

/// Savings of the skips on one scene.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SkipsResult {
    /// [`SCHEMA`].
    pub schema: &'static str,
    /// Name of the scene.
    pub scene: String,
    /// Name of the kernels' profile.
    pub profile: &'static str,
    /// Name of the layout.
    pub layout: &'static str,
    /// Width of the picture in pixels.
    pub width: u32,
    /// Height of the picture in pixels.
    pub height: u32,
    /// Bits of a word and fraction bits of each quantity.
    pub formats: FormatTable,
    /// First the picture without any skip, then each alone, then all together, then with interpolation, which changes the picture.
    pub rows: Vec<SkipResult>,
}

/// A picture with some skips, next to the one without any.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SkipResult {
    /// `none`, the name of a skip, `all`, or `interpolate`: all, and `--interpolate`.
    pub name: String,
    /// Work that is left out.
    pub description: String,
    /// Operations of cores and main processor, by class.
    pub counts: ByClass,
    /// All operations but moves, of cores and main processor.
    pub operations: u64,
    /// Octets that all processors asked to move.
    pub octets: u64,
    /// Length of the frame in clocks.
    pub clocks: u64,
    /// Words of the cores' program.
    pub program_words: usize,
    /// Share of the operations without any skip that is saved; negative when there are more.
    pub operations_saved: f64,
    /// Share of the octets that is saved.
    pub octets_saved: f64,
    /// Share of the clocks that is saved.
    pub clocks_saved: f64,
    /// True where the work that is left out should not change the picture.
    pub claims_identity: bool,
    /// True where the picture is the same, bit for bit.
    pub is_identical: bool,
    /// Pixels that had no ray of their own.
    pub interpolated: u64,
    /// Pixels that differ by 1/255 or more.
    pub off_pixels: u64,
    /// Peak signal-to-noise ratio of all pixels in dB; null when they are the same.
    pub psnr_db: Option<f64>,
    /// SHA-256 of the picture.
    pub image_hash: String,
}

/// A way to draw the picture.
struct Way {
    name: String,
    description: String,
    job: Job,
}

/// Draws a job's picture in all ways. `done` is called when one is drawn.
///
/// # Errors
/// What keeps any of them from being drawn.
pub fn measure(job: &Job, done: &dyn Fn()) -> Result<SkipsResult, Failure> {
    compare(job, ways(job), done)
}

/// Draws a job's picture without any skip and with all.
///
/// # Errors
/// What keeps it from being drawn.
pub fn together(job: &Job) -> Result<SkipsResult, Failure> {
    let ways = ways(job).into_iter().filter(|way| [NONE, ALL].contains(&way.name.as_str())).collect();
    compare(job, ways, &|| {})
}

/// The first of the ways is what the others are compared with.
fn compare(job: &Job, ways: Vec<Way>, done: &dyn Fn()) -> Result<SkipsResult, Failure> {
    let drawings: Vec<(Way, Drawing)> = ways
        .into_iter()
        .map(|way| {
            let drawing = drawing::draw(&way.job, Comparison::None, &mut |_| {})?;
            done();
            Ok((way, drawing))
        })
        .collect::<Result<_, Failure>>()?;
    // The picture without any skip is what the others are held against.
    let (_, plain) = &drawings[0];
    Ok(SkipsResult {
        schema: SCHEMA,
        scene: result_name(&job.scene),
        profile: job.kernels.profile.name(),
        layout: job.layout().name(),
        width: plain.crop.width,
        height: plain.crop.height,
        formats: (&plain.image.formats).into(),
        rows: drawings.iter().map(|(way, drawing)| SkipResult::new(way, drawing, plain)).collect(),
    })
}

/// Number of pictures that [`measure`] draws of a job.
pub fn pictures(job: &Job) -> usize {
    ways(job).len()
}

fn ways(job: &Job) -> Vec<Way> {
    let way = |name: &str, description: &str, skips: Skips| {
        let mut job = job.clone();
        job.kernels.interpolate = None;
        job.kernels.skips = skips;
        Way { name: name.to_owned(), description: description.to_owned(), job }
    };
    let mut ways = vec![way(NONE, "Nothing.", Skips::NONE)];
    // Each skip that the kernels know, alone.
    let known = Skip::ALL.iter().filter(|&&skip| job.kernels.profile.knows(skip));
    ways.extend(known.map(|&skip| way(skip.name(), skip.description(), Skips::NONE.with(skip))));
    ways.push(way(ALL, "All of these.", Skips::ALL));
    let difference = job.kernels.interpolate.unwrap_or(DIFFERENCE);
    // Interpolation changes the picture, so it comes last and claims nothing.
    let mut interpolated = way("interpolate", "All, and pixels whose corners agree are interpolated.", Skips::ALL);
    interpolated.job.kernels.interpolate = Some(difference);
    ways.push(interpolated);
    ways
}

impl SkipResult {
    fn new(way: &Way, drawing: &Drawing, plain: &Drawing) -> SkipResult {
        let size = (drawing.crop.width, drawing.crop.height);
        let counts = counts(drawing);
        let share = |part: u64, whole: u64| if whole == 0 { 0.0 } else { 1.0 - part as f64 / whole as f64 };
        let error = metrics::compare(&drawing.picture, &plain.picture);
        SkipResult {
            name: way.name.clone(),
            description: way.description.clone(),
            counts: ByClass(counts),
            operations: counts.operations(),
            octets: drawing.frame.asked.0,
            clocks: drawing.frame.clocks.0,
            program_words: drawing.build.cores.words.len(),
            operations_saved: share(counts.operations(), self::counts(plain).operations()),
            octets_saved: share(drawing.frame.asked.0, plain.frame.asked.0),
            clocks_saved: share(drawing.frame.clocks.0, plain.frame.clocks.0),
            claims_identity: way.job.kernels.interpolate.is_none(),
            is_identical: drawing.words == plain.words,
            interpolated: drawing.interpolated(),
            off_pixels: error.map_or(0, |error| error.off_pixels),
            psnr_db: error.and_then(|error| error.psnr_db),
            image_hash: image_hash(size, &drawing.words),
        }
    }
}

/// Operations of cores and main processor.
fn counts(drawing: &Drawing) -> Counts {
    let profiles = [&drawing.frame.profile, &drawing.frame.main_profile];
    profiles.into_iter().flatten().map(emu::profile::Profile::total).fold(Counts::default(), |sum, counts| sum + counts)
}
