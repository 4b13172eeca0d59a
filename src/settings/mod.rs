//! Settings: everything that decides a result, in one form that results carry and commands read back. Paths of results, times and numbers of
//! threads are no settings.

pub mod apply;
pub mod command_line;
pub mod hash;
mod job;
pub mod key;
mod machine;
pub mod named;
pub mod read;

use std::collections::BTreeMap;

use emu::engine::EngineKind;
use kernels::{KernelSet, Skips};
use scenes::kdtree::{BuildMethod, Depth, VISIT};
use scenes::layout::Layout;
use scenes::model::View;
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};

pub(crate) use job::check_hash;
pub use job::{LONGEST, MOST_BOUNCES};
pub use machine::{FROM, MachineSettings, NAME};

/// Version of this program, which results carry beside their settings.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Everything that decides a picture, its counts and its clocks; a key that is null goes by the others or by the scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// The scene.
    pub scene: SceneSettings,
    /// Camera, size and light.
    pub view: ViewSettings,
    /// The kernels and the instructions that they may use.
    pub kernels: KernelSettings,
    /// Effort: how much is computed.
    pub effort: EffortSettings,
    /// The kd tree.
    pub tree: TreeSettings,
    /// Structures of global memory: report, wide, packet or packed; null for those of the kernels.
    #[serde(with = "named::option")]
    #[schemars(with = "Option<String>")]
    pub layout: Option<Layout>,
    /// Fraction bits that were chosen; null where the scene chooses.
    pub formats: FormatSettings,
    /// The machine, key by key.
    pub machine: MachineSettings,
    /// Engine that is asked for; nothing but the host's time depends on it.
    #[serde(with = "named")]
    #[schemars(with = "String")]
    pub engine: EngineKind,
    /// Results beside picture, counts and clocks.
    pub results: ResultSettings,
}

/// The scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SceneSettings {
    /// File, or name of a generated scene, as it was given.
    pub name: String,
    /// Mesh that was named beside a .dsc.
    pub mesh: Option<String>,
    /// SHA-256 of the scene's contents; a scene that is read must have it, where it is given.
    pub hash: Option<String>,
}

/// Camera, size and light of a picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ViewSettings {
    /// Camera: orthographic or perspective; null for what the other keys imply.
    #[schemars(with = "Option<String>")]
    pub camera: Option<CameraKind>,
    /// Position of the eye, in scene units; null for in front of the box.
    pub eye: Option<[f64; 3]>,
    /// Point that the centre shows, in scene units; null for the box's centre.
    pub look: Option<[f64; 3]>,
    /// Vertical field of view in degrees; null for an orthographic camera.
    pub fov: Option<f64>,
    /// Width and height in pixels.
    pub size: Option<[u32; 2]>,
    /// Place of a ray in its pixel, in pixels to the right of the middle and above it.
    pub shift: [f64; 2],
    /// First column, first row, width and height of the drawn part; null for all of it.
    pub crop: Option<[u32; 4]>,
    /// Ambient intensity.
    pub ambient: f64,
    /// Colour where a ray hits nothing.
    pub background: [f64; 3],
}

/// A camera by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum CameraKind {
    /// Parallel rays along -z, centred on the scene's box.
    Orthographic,
    /// Rays from one eye.
    Perspective,
}

/// The kernels.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct KernelSettings {
    /// Set of kernels.
    #[serde(with = "named")]
    #[schemars(with = "String")]
    pub profile: KernelSet,
    /// Files that serve a function instead of the set's own, by the function's name.
    pub replaced: BTreeMap<String, FileSettings>,
    /// SHA-256 of all assembly that the programs may be put together from; another version of this program may have another.
    pub hash: Option<String>,
    /// Files of instructions that are added to the table's, in the order in which they are loaded.
    pub extensions: Vec<FileSettings>,
}

/// A file that a result depends on.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct FileSettings {
    /// The file, as it was given.
    pub file: String,
    /// SHA-256 of its text and those that it includes; a file that is read must have it, where it is given.
    pub hash: Option<String>,
}

/// A file by its name alone, or with its hash.
#[derive(Deserialize)]
#[serde(untagged)]
enum FileForm {
    Name(String),
    Hashed { file: String, hash: Option<String> },
}

impl<'de> Deserialize<'de> for FileSettings {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<FileSettings, D::Error> {
        FileForm::deserialize(deserializer).map(|form| match form {
            FileForm::Name(file) => FileSettings { file, hash: None },
            FileForm::Hashed { file, hash } => FileSettings { file, hash },
        })
    }
}

/// Effort of a picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct EffortSettings {
    /// Levels of reflected and refracted rays below the camera ray.
    pub bounces: u32,
    /// Weight that such a ray must exceed to be followed.
    pub weight_cutoff: f64,
    /// Skips: what is left out, by the names that `lancer skips` lists.
    #[serde(with = "named::skips")]
    #[schemars(with = "Vec<String>")]
    pub skips: Skips,
    /// Difference up to which four corners agree, so that the pixels between are interpolated; null for a ray a pixel.
    pub interpolate: Option<f64>,
}

/// The kd tree.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct TreeSettings {
    /// Levels below the root, or `auto`; results have those of the kernels where none were chosen.
    #[serde(with = "named::depth")]
    #[schemars(schema_with = "levels")]
    pub depth: Option<Depth>,
    /// Way to build it: report, exact or binned; results have that of the kernels where none was chosen.
    #[serde(with = "named::option")]
    #[schemars(with = "Option<String>")]
    pub build: Option<BuildMethod>,
    /// Cost of visiting a node in percent of testing a triangle, 1 to 100, by which the method binned chooses planes.
    pub visit: u32,
}

impl Default for TreeSettings {
    fn default() -> TreeSettings {
        TreeSettings { depth: None, build: None, visit: VISIT }
    }
}

fn levels(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
    schemars::json_schema!({ "type": ["integer", "string", "null"] })
}

/// Fraction bits by quantity.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FormatSettings {
    /// Positions.
    pub pos: Option<i32>,
    /// Directions and normals.
    pub dir: Option<i32>,
    /// Barycentric coordinates.
    pub bary: Option<i32>,
    /// Distances along rays.
    pub t: Option<i32>,
    /// Coefficients and weights.
    pub weight: Option<i32>,
    /// Intensities.
    pub colour: Option<i32>,
}

/// Results beside picture, counts and clocks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ResultSettings {
    /// True where the picture is measured against double precision.
    pub error: bool,
    /// True where results that lost bits are counted.
    pub flags: bool,
    /// True where a picture's energy and the machine's area are told.
    pub energy: bool,
    /// True where a picture is run beside exact arithmetic.
    pub shadow: bool,
    /// Levels of reflected and refracted rays in double precision; null for as many as the picture has.
    pub reference_bounces: Option<u32>,
}

impl Default for ViewSettings {
    fn default() -> ViewSettings {
        let View { shift, ambient, background, .. } = View::new((1, 1));
        ViewSettings {
            camera: None,
            eye: None,
            look: None,
            fov: None,
            size: None,
            shift,
            crop: None,
            ambient,
            background,
        }
    }
}

impl Default for EffortSettings {
    fn default() -> EffortSettings {
        let View { bounces, .. } = View::new((1, 1));
        EffortSettings { bounces, weight_cutoff: 0.0, skips: Skips::default(), interpolate: None }
    }
}

impl Default for ResultSettings {
    fn default() -> ResultSettings {
        ResultSettings { error: true, flags: false, energy: false, shadow: false, reference_bounces: None }
    }
}

/// Field of view of a perspective camera that names none, in degrees.
pub const FIELD: f64 = 45.0;
