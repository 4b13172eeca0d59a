//! Pictures in several profiles of the kernels, next to each other: what vector rows save on the report's scalar ones, the ray unit on
//! those, and what the report's buffer changes.

use emu::machine::Config;
use emu::profile::Profile;
use isa::Counts;
use kernels::{Function, KernelSet};
use scenes::model::{Scene, View};
use schemars::JsonSchema;
use serde::Serialize;

use crate::drawing::{self, Comparison, Drawing};
use crate::failure::Failure;
use crate::job::{Detail, Job, result_name};
use crate::result::{ByClass, FormatTable, image_hash};
use crate::settings::TreeSettings;

/// Version of [`Profiles`].
pub const SCHEMA: &str = "lancer-profiles-1";

/// Scenes in several profiles. All counts are those of the cores together.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Profiles {
    /// Version of the result: a key that goes away or changes its meaning changes it, a new key does not.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: &'static str,
    /// Name of the machine.
    pub machine: String,
    /// Width of the pictures in pixels.
    pub width: u32,
    /// Height of the pictures in pixels.
    pub height: u32,
    /// Place of a ray in its pixel, in pixels to the right of the middle and above it.
    pub shift: [f64; 2],
    /// The pictures, scene by scene.
    pub pictures: Vec<ProfileResult>,
    /// Each profile against the one that it is compared with, scene by scene, and then in the mean of the scenes.
    pub ratios: Vec<Ratio>,
}

/// Cost of a picture in one profile.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ProfileResult {
    /// Name of the scene.
    pub scene: String,
    /// Name of the kernels' profile.
    pub profile: &'static str,
    /// Name of the layout.
    pub layout: &'static str,
    /// Instructions.
    pub instructions: u64,
    /// Instructions of the functions that walk the tree and intersect.
    pub search_instructions: u64,
    /// All operations but moves.
    pub operations: u64,
    /// Operations by class.
    pub counts: ByClass,
    /// Octets that the cores moved over the bus.
    pub octets: u64,
    /// Length of the frame in clocks.
    pub clocks: u64,
    /// Words of the cores' program.
    pub program_words: usize,
    /// Octets of a core's buffer that the program uses.
    pub buffer_octets: usize,
    /// Bits of a word and fraction bits of each quantity.
    pub formats: FormatTable,
    /// Pixels that differ from the double-precision reference by 1/255 or more.
    pub off_pixels: u64,
    /// SHA-256 of the picture.
    pub image_hash: String,
}

/// A profile's figures divided by those of another one.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Ratio {
    /// Name of the scene; null for the mean of the scenes' ratios.
    pub scene: Option<String>,
    /// Name of the profile.
    pub profile: &'static str,
    /// Name of the profile that it is divided by.
    pub of: &'static str,
    /// Of all operations but moves.
    pub operations: f64,
    /// Of the octets.
    pub octets: f64,
    /// Of the instructions.
    pub instructions: f64,
    /// Of the instructions that walk the tree and intersect.
    pub search_instructions: f64,
    /// Of the clocks.
    pub clocks: f64,
}

/// Draws scenes in some profiles, each in its own layout, on a machine and its name. `done` is called when a picture is drawn.
///
/// # Errors
/// What keeps any of them from being drawn.
pub fn measure(
    scenes: &[Scene],
    profiles: &[KernelSet],
    size: (u32, u32),
    tree: &TreeSettings,
    machine: &(String, Config),
    done: &dyn Fn(),
) -> Result<Profiles, Failure> {
    let mut result = Profiles {
        schema: SCHEMA,
        machine: machine.0.clone(),
        width: size.0,
        height: size.1,
        shift: View::new(size).shift,
        pictures: Vec::new(),
        ratios: Vec::new(),
    };
    for scene in scenes {
        let first = result.pictures.len();
        for &profile in profiles {
            let mut job = job(scene, size, profile);
            tree.choose(&mut job);
            (job.machine_name, job.machine) = machine.clone();
            result.pictures.push(ProfileResult::new(&job, &drawing::draw(&job, Comparison::Reference, &mut |_| {})?));
            done();
        }
        // Each profile against the one whose work it does in another way.
        let pictures = profiles.iter().zip(&result.pictures[first..]);
        let ratios = pictures.clone().filter_map(|(profile, picture)| {
            let other = profile.compared_with()?;
            let (_, of) = pictures.clone().find(|&(&of, _)| of == other)?;
            Some(Ratio::new(picture, of))
        });
        result.ratios.extend(ratios);
    }
    // A profile without one that it is compared with has no ratios.
    let means: Vec<Ratio> = profiles.iter().filter_map(|profile| mean(&result.ratios, *profile)).collect();
    result.ratios.extend(means);
    Ok(result)
}

fn job(scene: &Scene, size: (u32, u32), profile: KernelSet) -> Job {
    let mut job = Job::new(scene.clone());
    job.view = View::new(size);
    job.kernels.profile = profile;
    job.detail = Detail::Totals;
    job
}

/// Instructions of the functions that walk the tree and intersect, inner regions included.
fn search_instructions(spent: &Profile) -> u64 {
    let is_search = |name: &str| name.parse().is_ok_and(|function: Function| function.is_search());
    // A region counts for the function around it.
    let outermost = |mut at: usize| {
        while let Some(parent) = spent.regions[at].parent {
            at = parent.into();
        }
        &spent.regions[at].name
    };
    let inside = spent.regions.iter().enumerate().filter(|(at, _)| is_search(outermost(*at)));
    inside.map(|(_, region)| region.instructions).sum()
}

impl ProfileResult {
    fn new(job: &Job, drawing: &Drawing) -> ProfileResult {
        let frame = &drawing.frame;
        let cores = &frame.processors[..job.machine.cores as usize];
        let counts = frame.profile.as_ref().map_or(Counts::ZERO, Profile::total);
        ProfileResult {
            scene: result_name(&job.scene),
            profile: job.kernels.profile.name(),
            layout: job.layout().name(),
            instructions: cores.iter().map(|core| core.instructions).sum(),
            search_instructions: frame.profile.as_ref().map_or(0, search_instructions),
            operations: counts.operations(),
            counts: ByClass(counts),
            octets: cores.iter().map(|core| core.octets.0).sum(),
            clocks: frame.clocks.0,
            program_words: drawing.build.cores.words.len(),
            buffer_octets: drawing.build.cores.buffer.len(),
            formats: (&drawing.image.formats).into(),
            off_pixels: drawing.error.map_or(0, |error| error.off_pixels),
            image_hash: image_hash((drawing.crop.width, drawing.crop.height), &drawing.words),
        }
    }
}

impl Ratio {
    fn new(spending: &ProfileResult, of: &ProfileResult) -> Ratio {
        let ratio = |figure: fn(&ProfileResult) -> u64| figure(spending) as f64 / figure(of).max(1) as f64;
        Ratio {
            scene: Some(spending.scene.clone()),
            profile: spending.profile,
            of: of.profile,
            operations: ratio(|picture| picture.operations),
            octets: ratio(|picture| picture.octets),
            instructions: ratio(|picture| picture.instructions),
            search_instructions: ratio(|picture| picture.search_instructions),
            clocks: ratio(|picture| picture.clocks),
        }
    }
}

/// The mean of a profile's ratios; `None` where there are none.
fn mean(ratios: &[Ratio], profile: KernelSet) -> Option<Ratio> {
    let own: Vec<&Ratio> = ratios.iter().filter(|ratio| ratio.profile == profile.name()).collect();
    let mean = |figure: fn(&Ratio) -> f64| own.iter().map(|ratio| figure(ratio)).sum::<f64>() / own.len() as f64;
    Some(Ratio {
        scene: None,
        profile: profile.name(),
        of: own.first()?.of,
        operations: mean(|ratio| ratio.operations),
        octets: mean(|ratio| ratio.octets),
        instructions: mean(|ratio| ratio.instructions),
        search_instructions: mean(|ratio| ratio.search_instructions),
        clocks: mean(|ratio| ratio.clocks),
    })
}
