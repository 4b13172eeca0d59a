//! `lancer scene generate`: a scene made by the program, as files.

use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser};
use messages::{Diagnostic, Report};
use scenes::generate::{self, GenerateOptions, SCENES};
use scenes::write;

use super::super::invocation::CommandSettings;
use super::{WrittenScene, parts};
use crate::arguments::{self, Size};
use crate::failure::{Exit, Failure};
use crate::result::WithSettings;
use crate::terminal::Terminal;
use crate::{files, result};

const EXAMPLES: &str = "\
Examples:
  lancer scene generate cornell
  lancer scene generate terrain --triangles 5000 -o rooms
  lancer scene generate sphereflake --level 3 --size 640x480";

/// Writes a scene as NAME.dsc and NAME.off, the same octets on every run.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct GenerateArguments {
    /// Scene.
    #[arg(value_name = "NAME", value_parser = PossibleValuesParser::new(names()))]
    name: String,
    /// Folder for the files; it is made where only the last part of its path is missing [default: the current one].
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    /// Fineness, for scenes that have one: what it counts and its range depend on the scene.
    #[arg(long, value_name = "N", long_help = level_help())]
    level: Option<u32>,
    /// Number of triangles, for scenes that can be cut to any.
    #[arg(long, value_name = "N", long_help = triangles_help())]
    triangles: Option<u32>,
    /// Size of the picture in the .dsc, in pixels.
    #[arg(long, value_name = "WxH", value_parser = arguments::size, default_value = "320x240")]
    size: Size,
    /// Prints as JSON what was written.
    #[arg(long)]
    json: bool,
}

fn names() -> impl Iterator<Item = PossibleValue> {
    SCENES.iter().map(|scene| PossibleValue::new(scene.name).help(scene.description))
}

fn level_help() -> String {
    let known = SCENES.iter().filter_map(|scene| Some((scene.name, scene.level.as_ref()?)));
    settings("Fineness, for scenes that have one:", known)
}

fn triangles_help() -> String {
    let known = SCENES.iter().filter_map(|scene| Some((scene.name, scene.triangles.as_ref()?)));
    settings("Number of triangles, for scenes that can be cut to any:", known)
}

fn settings(title: &str, known: impl Iterator<Item = (&'static str, &'static generate::Setting)>) -> String {
    let line = |(name, setting): (&str, &generate::Setting)| {
        let (least, most) = (setting.range.start(), setting.range.end());
        format!("\n{name}: {}, {least} to {most} [default: {}]", setting.meaning, setting.default)
    };
    title.to_owned() + &known.map(line).collect::<String>()
}

/// Refuses a file in the place of the folder.
fn check_folder(folder: &Path) -> Result<(), Report> {
    if folder.as_os_str().is_empty() || folder.is_dir() {
        return Ok(());
    }
    let message = Diagnostic::error(format!("{} is a file, not a folder", folder.display()));
    Err(message.hint("`-o` names the folder for NAME.dsc and NAME.off").into())
}

/// Generates and writes.
pub(super) fn execute(
    arguments: &GenerateArguments,
    given: &CommandSettings,
    terminal: &mut Terminal,
) -> Result<Exit, Failure> {
    let options = GenerateOptions { level: arguments.level, triangles: arguments.triangles, size: arguments.size };
    let folder = arguments.output.clone().unwrap_or_default();
    if folder == Path::new(files::STANDARD) {
        let message = Diagnostic::error("a scene of two files does not go to standard output");
        let hint = format!("a mesh does: lancer scene convert {} - --to off", arguments.name);
        return Err(Failure::usage(message.hint(hint)));
    }
    let paths = ["dsc", "off"].map(|extension| folder.join(format!("{}.{extension}", arguments.name)));
    let is_new = !folder.as_os_str().is_empty() && !folder.exists();
    if is_new {
        // Made when the scene is there; the folder around it must exist.
        files::check_target(&folder)?;
    } else {
        check_folder(&folder)?;
        for path in &paths {
            files::check_target(path)?;
        }
    }
    let scene = generate::scene(&arguments.name, &options)?;
    let (mut description, mut mesh) = (Vec::new(), Vec::new());
    let written = write::dsc(&scene, &mut description).and_then(|()| write::off(&scene, &mut mesh));
    written.map_err(|error| Diagnostic::error(format!("the scene cannot be written: {error}")))?;
    let [description_path, mesh_path] = &paths;
    if is_new {
        let refusal = |error| Diagnostic::error(format!("the folder {} cannot be made: {error}", folder.display()));
        std::fs::create_dir(&folder).map_err(refusal)?;
    }
    // The mesh first: a .dsc without its mesh would be no scene.
    files::write_all(&[(mesh_path, &mesh), (description_path, &description)])?;
    terminal.print(&match arguments.json {
        true => result::json(&WithSettings::new(&WrittenScene::new(&scene, &paths), given.clone())),
        false => format!("{} and {}: {}\n", description_path.display(), mesh_path.display(), parts(&scene)),
    })?;
    Ok(Exit::Done)
}
