//! `lancer scene`: scenes as files and as figures.

mod convert;
mod generate;
mod info;

use super::invocation::CommandSettings;
use clap::{Args, Subcommand};

use scenes::model::Scene;

use crate::failure::{Exit, Failure};
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
        SceneCommand::Generate(arguments) => generate::execute(arguments, terminal),
        SceneCommand::Info(arguments) => info::execute(arguments, given, terminal),
        SceneCommand::Convert(arguments) => convert::execute(arguments, terminal),
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
