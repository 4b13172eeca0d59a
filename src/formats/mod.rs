//! The shortest formats: of each quantity the fewest fraction bits, and the shortest word, with which pictures of some scenes keep a demanded
//! error. How the search goes is said in `search.rs`, what a picture costs comes from its run.

mod choice;
mod points;
mod search;
mod trial;

use scenes::cadrage::Overrides;
use scenes::image::MemoryOptions;
use scenes::layout::Layout;
use scenes::model::{Scene, View};
use schemars::JsonSchema;
use serde::Serialize;

pub use choice::{DemandedError, FormatChoice, PooledError};
pub use search::WORDS;
pub use trial::TrialFigures;

use trial::{FormatTrials, TrialScene};

use crate::accuracy::PLACES;
use crate::energy::FigureRange;
use crate::failure::Failure;
use crate::job::Job;

/// Version of [`FormatsResult`].
pub const SCHEMA: &str = "lancer-formats-1";

/// Places of the samples in their pixels, in pixels to the right of the middle and above it, that pictures are checked at: those of
/// [`PLACES`], but for the middle and the one that the search draws.
pub const CHECKED_SHIFTS: [[f64; 2]; 8] =
    [[0.023, 0.017], [0.211, -0.367], PLACES[2], PLACES[3], PLACES[4], PLACES[5], PLACES[6], PLACES[7]];

/// Places of the samples that the search draws; none of [`CHECKED_SHIFTS`] is among them.
pub const SEARCHED_SHIFTS: [[f64; 2]; 8] = [
    [0.137, 0.071],
    [-0.189, -0.443],
    [0.331, 0.277],
    [-0.421, 0.119],
    [0.453, -0.337],
    [-0.059, 0.389],
    [0.173, -0.227],
    [-0.307, -0.131],
];

/// A quantity and its fewest bits.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct QuantityBits {
    /// Name of the quantity, as `--format` takes it; `word` for registers and what is computed in them.
    pub quantity: &'static str,
    /// Bits before the point, and the sign, of the scene that needs most; null for the word.
    pub integer: Option<i32>,
    /// First estimate of the fraction bits, from ranges and the demand; null for the word.
    pub estimate: Option<i32>,
    /// Fewest fraction bits with the guard, of the word all bits; those of the scene that has fewest where the scenes choose.
    pub bits: i32,
    /// True where the format is one for all scenes; false where each scene has what the word leaves it.
    pub is_given: bool,
    /// Figures with one bit fewer; null where there is none.
    pub fewer: Option<ChoiceFigures>,
    /// Figures with one bit more; null where there is none.
    pub more: Option<ChoiceFigures>,
}

/// Figures of a choice of formats over all scenes.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ChoiceFigures {
    /// Octets that the bus moved, a pixel, mean of the scenes.
    pub octets: f64,
    /// Clocks a pixel, mean of the scenes.
    pub clocks: f64,
    /// Nanojoules a pixel, mean of the scenes.
    pub pixel_nj: FigureRange,
    /// Least peak signal-to-noise ratio of a scene in dB; null where all are equal to double precision.
    pub worst_psnr_db: Option<f64>,
    /// Most pixels of a picture off by 1/255 or more.
    pub worst_off: u64,
    /// Largest difference of a component.
    pub largest: f64,
    /// True where all scenes keep the demand.
    pub is_kept: bool,
    /// By scene.
    pub scenes: Vec<TrialFigures>,
}

/// A word in which the scenes choose all formats.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct UniformWord {
    /// Bits of the word.
    pub word: u32,
    /// Structures of global memory.
    pub layout: &'static str,
    /// True for the shortest that keeps the demand, with the guard.
    pub is_best: bool,
    /// Cost of visiting a node of the kd tree that it was drawn with, in percent of testing a triangle.
    pub visit: u32,
    /// Figures in it.
    #[serde(flatten)]
    pub figures: ChoiceFigures,
}

/// Cost of the formats that were found, by that of the shortest uniform word that keeps the demand, in the same layout.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct UniformShare {
    /// Octets that the bus moved, 1 for as many.
    pub octets: f64,
    /// Nanojoules: the least and the most of published tables, each by that of the word.
    pub nj: [f64; 2],
}

/// The fields that memory takes in a scene.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SceneFields {
    /// Name of the scene.
    pub scene: String,
    /// Bits of the widest field of each structure, by its name.
    pub bits: scenes::info::Named<u32>,
}

/// The shortest formats of some scenes.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct FormatsResult {
    /// Version of the result: a key that goes away or changes its meaning changes it, a new key does not.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: &'static str,
    /// Demanded error in words.
    pub demand: String,
    /// Width of the pictures in pixels.
    pub width: u32,
    /// Height of the pictures in pixels.
    pub height: u32,
    /// Name of the set of kernels.
    pub profile: &'static str,
    /// Structures of global memory.
    pub layout: &'static str,
    /// Places of the samples that were searched with.
    pub shifts: Vec<[f64; 2]>,
    /// Bits that were added to the fewest that kept the demand, of quantities (half as many of weights and colours) and of the uniform word.
    pub guard: u32,
    /// Quantities with their fewest bits, the word last.
    pub quantities: Vec<QuantityBits>,
    /// Figures of the formats that were found.
    pub found: ChoiceFigures,
    /// Their part of the octets and nanojoules of the shortest uniform word.
    pub share: UniformShare,
    /// Cost of visiting a node of the kd tree that was found with them, in percent of testing a triangle.
    pub visit: u32,
    /// Their part of the octets and nanojoules of that word in the same tree: what formats save by themselves.
    pub share_of_tree: UniformShare,
    /// Bits of the fields in memory, by scene.
    pub fields: Vec<SceneFields>,
    /// Words in which the scenes choose all formats, longest first; then the shortest that keeps the demand once more, in the tree that was found and in the
    /// layout `wide`.
    pub uniform: Vec<UniformWord>,
    /// The scenes that were searched with, at other shifts.
    pub seen: Vec<TrialFigures>,
    /// Scenes that were not searched with, at those shifts.
    pub unseen: Vec<TrialFigures>,
    /// Pictures that were drawn.
    pub drawn: u64,
    /// Pictures that were known already.
    pub reused: u64,
}

/// Effort of a search, and how careful it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SearchEffort {
    /// Pictures of each scene, at as many of [`SEARCHED_SHIFTS`].
    pub shifts: usize,
    /// Bits that are added to the fewest that keep the demand, for what the search does not see; half as many to weights and colours.
    pub guard: u32,
}

/// Scenes by the names that they are known by.
pub type NamedScenes = Vec<(String, Scene)>;

/// Searches for the shortest formats with some scenes, and checks them on these and others at shifts that the search did not see.
///
/// The job says how pictures are drawn; its scene, word, formats and shift are of no account. `None` where even the longest word does not
/// keep the demand.
///
/// # Errors
/// Errors in the user's kernels or the machine. A scene that does not fit a format is a result.
pub fn find(
    job: &Job,
    demand: DemandedError,
    seen: &NamedScenes,
    unseen: &NamedScenes,
    effort: SearchEffort,
    progress: &dyn Fn(),
) -> Result<Option<FormatsResult>, Failure> {
    let SearchEffort { shifts, guard } = effort;
    let shifts = &SEARCHED_SHIFTS[..shifts.clamp(1, SEARCHED_SHIFTS.len())];
    let trial_scenes = |scenes: &NamedScenes, shifts: &[[f64; 2]]| -> Result<Vec<TrialScene>, Failure> {
        scenes.iter().map(|(name, scene)| TrialScene::new(name, scene.clone(), &job.view, shifts)).collect()
    };
    let mut trials = FormatTrials::new(job, demand, trial_scenes(seen, shifts)?, progress);
    let Some(searched) = search::search(&mut trials, demand, guard as i32)? else { return Ok(None) };
    let search::FormatSearch { quantities, found, uniform: best } = searched;
    // What stands beside: words that leave all formats to the scenes.
    let mut words = vec![best.saturating_sub(1), best, 12, 16, 20, 24, 28, 32];
    words.retain(|word| (WORDS.0..=WORDS.1).contains(word));
    words.sort_unstable_by(|a, b| b.cmp(a));
    words.dedup();
    let mut measure =
        |choice: FormatChoice| -> Result<ChoiceFigures, Failure> { Ok(ChoiceFigures::of(trials.measure(choice)?)) };
    let figures = measure(found)?;
    let layout = job.layout().name();
    let uniform = words.into_iter().map(|word| {
        let figures = measure(FormatChoice::uniform(word))?;
        Ok(UniformWord { word, layout, is_best: best == word, visit: job.kd_visit, figures })
    });
    let mut uniform = uniform.collect::<Result<Vec<_>, Failure>>()?;
    let share = UniformShare::new(&figures, &measure(FormatChoice::uniform(best))?);
    let visit = found.visit.unwrap_or(job.kd_visit);
    let in_tree = measure(FormatChoice { visit: found.visit, ..FormatChoice::uniform(best) })?;
    let share_of_tree = UniformShare::new(&figures, &in_tree);
    if visit != job.kd_visit {
        uniform.push(UniformWord { word: best, layout, is_best: false, visit, figures: in_tree });
    }
    // What each bit buys: one fewer, and one more.
    let mut bits = Vec::new();
    for (at, quantity) in quantities.iter().enumerate() {
        let is_given = found.bits[at].is_some();
        // A quantity that is left to the scenes has no bit to take away or to add.
        let mut step = |more: i32| -> Result<Option<ChoiceFigures>, Failure> {
            if !is_given {
                return Ok(None);
            }
            Ok(fitting(measure(found.with(at, quantity.fewest + more))?))
        };
        bits.push(QuantityBits {
            quantity: Overrides::NAMES[at],
            integer: Some(quantity.integer),
            estimate: Some(quantity.estimate),
            bits: quantity.fewest,
            is_given,
            fewer: step(-1)?,
            more: step(1)?,
        });
    }
    let word = |word: u32| (WORDS.0..=WORDS.1).contains(&word).then_some(FormatChoice { word, ..found });
    bits.push(QuantityBits {
        quantity: "word",
        integer: None,
        estimate: None,
        bits: found.word as i32,
        is_given: true,
        fewer: word(found.word - 1).map(&mut measure).transpose()?.and_then(fitting),
        more: word(found.word + 1).map(&mut measure).transpose()?.and_then(fitting),
    });
    let fields = fields(job, seen, &found);
    let (mut drawn, mut reused) = (trials.drawn, trials.reused);
    // Without packed structures a shorter word moves as many octets as a longer one.
    if job.layout() == Layout::Packed {
        let wide = Job { layout: Some(Layout::Wide), ..job.clone() };
        let mut trials = FormatTrials::new(&wide, demand, trial_scenes(seen, shifts)?, progress);
        let figures = ChoiceFigures::of(trials.measure(FormatChoice::uniform(best))?);
        drawn += trials.drawn;
        reused += trials.reused;
        let layout = Layout::Wide.name();
        uniform.push(UniformWord { word: best, layout, is_best: true, visit: job.kd_visit, figures });
    }
    // What the search did not see.
    let mut checked = |scenes: &NamedScenes| -> Result<Vec<TrialFigures>, Failure> {
        let mut trials = FormatTrials::new(job, demand, trial_scenes(scenes, &CHECKED_SHIFTS)?, progress);
        let figures = trials.measure(found)?;
        drawn += trials.drawn;
        reused += trials.reused;
        Ok(figures)
    };
    let (seen, unseen) = (checked(seen)?, checked(unseen)?);
    let (width, height) = job.view.size;
    Ok(Some(FormatsResult {
        schema: SCHEMA,
        demand: demand.to_string(),
        width,
        height,
        profile: job.kernels.profile.name(),
        layout: job.layout().name(),
        shifts: shifts.to_vec(),
        guard,
        quantities: bits,
        found: figures,
        share,
        visit,
        share_of_tree,
        fields,
        uniform,
        seen,
        unseen,
        drawn,
        reused,
    }))
}

impl UniformShare {
    /// The share that figures have in those of a word.
    fn new(found: &ChoiceFigures, word: &ChoiceFigures) -> UniformShare {
        let nj = [found.pixel_nj.least / word.pixel_nj.least, found.pixel_nj.most / word.pixel_nj.most];
        UniformShare { octets: found.octets / word.octets, nj }
    }
}

/// Figures of a choice that fits all scenes.
fn fitting(figures: ChoiceFigures) -> Option<ChoiceFigures> {
    figures.scenes.iter().all(|scene| scene.refused.is_none()).then_some(figures)
}

/// Bits of the fields of each scene in memory.
fn fields(job: &Job, scenes: &NamedScenes, choice: &FormatChoice) -> Vec<SceneFields> {
    let kd_visit = choice.visit.unwrap_or(job.kd_visit);
    let options = MemoryOptions { word: choice.word, formats: choice.overrides(), kd_visit, ..job.memory() };
    let of_scene = |(name, scene): &(String, Scene)| {
        let view = View { shift: SEARCHED_SHIFTS[0], ..job.view.clone() };
        let image = scenes::image::build(scene, &view, &options).ok()?;
        let widest = |structure: &scenes::layout::Structure| {
            (structure.name, structure.fields.iter().map(|field| field.bits).max().unwrap_or(0))
        };
        let bits = scenes::info::Named(image.structures.all().map(widest).to_vec());
        Some(SceneFields { scene: name.clone(), bits })
    };
    scenes.iter().filter_map(of_scene).collect()
}

impl ChoiceFigures {
    /// Figures of some scenes together.
    fn of(scenes: Vec<TrialFigures>) -> ChoiceFigures {
        let drawn = || scenes.iter().filter(|scene| scene.refused.is_none());
        let count = drawn().count().max(1) as f64;
        let mean = |part: &dyn Fn(&TrialFigures) -> f64| drawn().map(part).sum::<f64>() / count;
        ChoiceFigures {
            octets: mean(&|scene| scene.octets),
            clocks: mean(&|scene| scene.clocks),
            pixel_nj: FigureRange {
                least: mean(&|scene| scene.pixel_nj.least),
                most: mean(&|scene| scene.pixel_nj.most),
            },
            worst_psnr_db: drawn().filter_map(|scene| scene.error.psnr_db).min_by(f64::total_cmp),
            worst_off: drawn().map(|scene| scene.error.worst_off).max().unwrap_or(0),
            largest: drawn().map(|scene| scene.error.largest).fold(0.0, f64::max),
            is_kept: scenes.iter().all(|scene| scene.is_kept),
            scenes,
        }
    }
}
