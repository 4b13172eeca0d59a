//! `lancer scene`: scenes as files and as figures.

mod convert;
mod generate;
mod info;

use std::path::PathBuf;

use clap::{Args, Subcommand};
use scenes::model::Scene;
use schemars::JsonSchema;
use serde::Serialize;

use super::invocation::CommandSettings;
use crate::failure::{Exit, Failure};
use crate::job::result_name;
use crate::numeral::count;
use crate::terminal::Terminal;

const EXAMPLES: &str = "\
Examples:
  lancer scene generate cornell -o rooms
  lancer scene info rooms/cornell.dsc
  lancer scene convert rooms/cornell.dsc room.obj";

/// Generates scenes, says what is in them, and converts them.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct SceneArguments {
    #[command(subcommand)]
    command: SceneCommand,
}

#[derive(Subcommand, Debug)]
enum SceneCommand {
    Generate(generate::GenerateArguments),
    Info(Box<info::InfoArguments>),
    Convert(convert::ConvertArguments),
}

/// Executes one of the commands.
pub(super) fn execute(
    arguments: &SceneArguments,
    given: &CommandSettings,
    terminal: &mut Terminal,
) -> Result<Exit, Failure> {
    match &arguments.command {
        SceneCommand::Generate(arguments) => generate::execute(arguments, given, terminal),
        SceneCommand::Info(arguments) => info::execute(arguments, given, terminal),
        SceneCommand::Convert(arguments) => convert::execute(arguments, given, terminal),
    }
}

/// Version of [`WrittenScene`].
pub(super) const SCHEMA: &str = "lancer-written-scene-1";

/// A scene that was written.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(super) struct WrittenScene {
    /// Version of the result: a key that goes away or changes its meaning changes it, a new key does not.
    #[schemars(extend("const" = SCHEMA))]
    schema: &'static str,
    /// Name of the scene.
    scene: String,
    /// Width of its picture in pixels.
    width: u32,
    /// Height of its picture in pixels.
    height: u32,
    /// Number of triangles.
    triangles: usize,
    /// Number of materials.
    materials: usize,
    /// Number of lights.
    lights: usize,
    /// Files that were written, the one that names the others first.
    written: Vec<String>,
}

impl WrittenScene {
    fn new<'a>(scene: &Scene, paths: impl IntoIterator<Item = &'a PathBuf>) -> WrittenScene {
        WrittenScene {
            schema: SCHEMA,
            scene: result_name(scene),
            width: scene.size.0,
            height: scene.size.1,
            triangles: scene.triangles.len(),
            materials: scene.materials.len(),
            lights: scene.lights.len(),
            written: paths.into_iter().map(|path| path.display().to_string()).collect(),
        }
    }
}

/// Contents of a scene, in short.
fn parts(scene: &Scene) -> String {
    format!(
        "{}, {}, {}",
        count(scene.triangles.len() as u64, "triangle", "triangles"),
        count(scene.materials.len() as u64, "material", "materials"),
        count(scene.lights.len() as u64, "light", "lights"),
    )
}
