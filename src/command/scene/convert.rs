//! `lancer scene convert`: a scene from one file format to another.

use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use messages::{Diagnostic, Report};
use scenes::read::Loaded;
use scenes::write::{self, MeshFormat};

use super::super::invocation::{CommandSettings, scene_hashes};
use super::{WrittenScene, parts};
use crate::failure::{Exit, Failure};
use crate::result::WithSettings;
use crate::terminal::Terminal;
use crate::{files, input, result};

const EXAMPLES: &str = "\
Examples:
  lancer scene convert house.dsc house.obj           # with house.mtl; the lights are lost, which is said
  lancer scene convert house.dsc new.obj --dsc       # with new.mtl and new.dsc: nothing is lost
  lancer scene convert bunny.ply bunny.dsc           # with bunny.off, so that materials and lights can be edited
  lancer scene convert bunny.stl bunny.off
  lancer scene convert cornell - --to stl > room.stl
  lancer scene convert cornell room --to ply         # a generated scene; the name does not say the format

Nothing is written unless all files are whole. A file that is read is never overwritten.
Exit codes: 0 done, 1 errors in the input, 2 usage.";

/// Writes a scene in another file format, and says what that cannot hold.
///
/// Triangles and their order stay the same in all formats. docs/formats.md has what each format holds.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct ConvertArguments {
    /// Scene: a .dsc with its mesh beside it, a mesh, or the name of a generated scene such as cornell.
    #[arg(value_name = "IN")]
    scene: String,
    /// File to write; a .dsc gets an .off of the same name beside it, an .obj a .mtl.
    #[arg(value_name = "OUT")]
    output: PathBuf,
    /// Mesh that belongs to the .dsc IN [default: the file of the same name beside it].
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    /// Format of OUT [default: by its extension].
    #[arg(long, value_name = "FORMAT", ignore_case = true, value_parser = target())]
    to: Option<ConversionTarget>,
    /// Writes a .dsc beside the mesh OUT too, with the size of the picture, all materials and the lights.
    #[arg(long)]
    dsc: bool,
    /// Prints as JSON what was written.
    #[arg(long)]
    json: bool,
}

/// Formats that a scene is converted to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ConversionTarget {
    /// A description with its mesh.
    Description,
    /// A mesh.
    Mesh(MeshFormat),
}

impl ConversionTarget {
    fn named(name: &str) -> Option<ConversionTarget> {
        let mesh = MeshFormat::ALL.into_iter().find(|format| format.name() == name);
        mesh.map(ConversionTarget::Mesh).or((name == "dsc").then_some(ConversionTarget::Description))
    }

    /// The format that a file's name asks for.
    fn of(path: &Path) -> Result<ConversionTarget, Report> {
        let extension = path.extension().map(|text| text.to_string_lossy().to_ascii_lowercase());
        extension.as_deref().and_then(ConversionTarget::named).ok_or_else(|| {
            let message = format!("{} does not end in .{}", path.display(), names().collect::<Vec<_>>().join(", ."));
            Diagnostic::error(message).hint("choose a format with `--to`").into()
        })
    }
}

fn names() -> impl Iterator<Item = &'static str> {
    std::iter::once("dsc").chain(MeshFormat::ALL.iter().map(|format| format.name()))
}

fn target() -> impl TypedValueParser<Value = ConversionTarget> {
    let names = PossibleValuesParser::new(names().map(PossibleValue::new));
    names.map(|name| ConversionTarget::named(&name.to_ascii_lowercase()).expect("the parser lets only names pass"))
}

/// Reads, converts and writes.
pub(super) fn execute(
    arguments: &ConvertArguments,
    given: &CommandSettings,
    terminal: &mut Terminal,
) -> Result<Exit, Failure> {
    let output = &arguments.output;
    // Name the files, and refuse places where they cannot go
    let target = arguments.to.map_or_else(|| ConversionTarget::of(output), Ok).map_err(Failure::usage)?;
    let has_description = arguments.dsc || target == ConversionTarget::Description;
    let paths = paths(output, target, has_description);
    let is_taken = files::takes_output([output.as_path()], arguments.json).map_err(Failure::usage)?;
    if is_taken && paths.len() > 1 {
        let message = Diagnostic::error("a scene of several files does not go to standard output");
        return Err(Failure::usage(message.hint("a mesh alone does: `--to off`, `--to ply` or `--to stl`")));
    }
    files::check_distinct(paths.iter().map(PathBuf::as_path)).map_err(Failure::usage)?;
    for path in &paths {
        files::check_target(path)?;
    }
    let loaded = input::scene(&arguments.scene, arguments.mesh.as_deref(), None)?;
    files::check_spared(paths.iter().map(PathBuf::as_path), &loaded.files).map_err(Failure::usage)?;
    terminal.show(&loaded.warnings);
    let scene = &loaded.scene;
    // Convert everything before the first file is written, so that an error leaves none
    let contents = contents(&loaded, target, has_description, &paths)
        .map_err(|error| Diagnostic::error(format!("the scene cannot be written: {error}")))?;
    files::write_all(&paths.iter().zip(contents).collect::<Vec<_>>())?;
    // Say what the format cannot hold; a description beside the mesh holds more
    match target {
        ConversionTarget::Mesh(format) if has_description => {
            terminal.show(&write::losses_beside_description(&loaded, format))
        }
        ConversionTarget::Mesh(format) => terminal.show(&write::losses(&loaded, format)),
        ConversionTarget::Description => terminal.show(&write::losses_beside_description(&loaded, MeshFormat::Off)),
    }
    // Name the files from the outside in: a description, its mesh, the library of that.
    let shown: Vec<String> = paths.iter().rev().map(|path| path.display().to_string()).collect();
    match (is_taken, arguments.json) {
        (true, _) => {}
        (false, true) => {
            let hashes = scene_hashes(std::slice::from_ref(&arguments.scene), std::slice::from_ref(scene));
            let settings = given.clone().with_scenes(&hashes);
            let written = WrittenScene::new(scene, paths.iter().rev());
            terminal.print(&result::json(&WithSettings::new(&written, settings)))?;
        }
        (false, false) => terminal.print(&format!("{}: {}\n", shown.join(" and "), parts(scene)))?,
    }
    Ok(Exit::Done)
}

/// The files of a result, in the order in which they take their places: what names another one comes after it.
fn paths(output: &Path, target: ConversionTarget, has_description: bool) -> Vec<PathBuf> {
    let companion = match target {
        ConversionTarget::Mesh(MeshFormat::Obj) => Some(output.with_extension("mtl")),
        ConversionTarget::Description => Some(output.with_extension("off")),
        ConversionTarget::Mesh(_) => None,
    };
    let description =
        (has_description && target != ConversionTarget::Description).then(|| output.with_extension("dsc"));
    companion.into_iter().chain([output.to_owned()]).chain(description).collect()
}

/// The octets of these files.
fn contents(
    loaded: &Loaded,
    target: ConversionTarget,
    has_description: bool,
    paths: &[PathBuf],
) -> std::io::Result<Vec<Vec<u8>>> {
    let scene = &loaded.scene;
    let mut description = Vec::new();
    if has_description {
        write::dsc(scene, &mut description)?;
    }
    // The order is that of `paths`: x.mtl is named by x.obj, and that by x.dsc.
    let mut files = match target {
        ConversionTarget::Mesh(MeshFormat::Obj) => {
            let (mut library, mut mesh) = (Vec::new(), Vec::new());
            write::mtl(scene, &loaded.material_names, &mut library)?;
            write::obj(scene, &loaded.material_names, &library_name(&paths[0])?, &mut mesh)?;
            vec![library, mesh]
        }
        ConversionTarget::Mesh(format) => {
            write::mesh(scene, format, "")?.into_iter().map(|(_, octets)| octets).collect()
        }
        ConversionTarget::Description => {
            let mut mesh = Vec::new();
            write::off(scene, &mut mesh)?;
            vec![mesh]
        }
    };
    files.extend(has_description.then_some(description));
    Ok(files)
}

/// The name by which an `.obj` calls its library, which lies beside it.
fn library_name(path: &Path) -> std::io::Result<String> {
    let name = path.file_name().unwrap_or_default().to_str().unwrap_or_default();
    // A statement ends at a line's end or a comment; blanks around a name and a backslash are not part of it.
    if name.is_empty() || name.trim() != name || name.contains(['#', '\\', '\n', '\r']) {
        let message = format!("an .obj cannot name {}", path.display());
        return Err(std::io::Error::new(std::io::ErrorKind::InvalidInput, message));
    }
    Ok(name.to_owned())
}
