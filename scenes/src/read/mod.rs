//! Scene files: a `.dsc` with its mesh beside it, or a mesh alone (report 5.2). Each format has a module of its own
//! that works on text or octets; only this module and `file` touch the disk.

mod colour;
pub mod dsc;
mod faces;
mod file;
mod format;
pub(crate) mod join;
pub mod mesh;
pub mod obj;
pub mod off;
pub mod ply;
mod polygon;
pub mod stl;
mod words;

use std::path::{Path, PathBuf};

use messages::{Diagnostic, Report, question};

pub use self::file::standard_input;
use self::format::{MeshReader, SceneFormat};
use self::mesh::Mesh;
use crate::model::Scene;

/// A scene and what is likely a mistake in its files.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The scene that is drawn.
    pub scene: Scene,
    /// Warnings, in the order of the files' texts; never errors.
    pub warnings: Report,
    /// Names of the scene's materials, empty for one without; no names at all where the files have none.
    pub material_names: Vec<String>,
    /// All files that were read, as their paths were found.
    pub files: Vec<PathBuf>,
}

impl From<Scene> for Loaded {
    /// A scene that is in no file.
    fn from(scene: Scene) -> Loaded {
        Loaded { scene, warnings: Report::default(), material_names: Vec::new(), files: Vec::new() }
    }
}

/// Reads the scene `path`: a `.dsc` with the mesh `mesh`, or with the `.off`, `.obj`, `.ply` or `.stl` of the same name
/// beside it; or a mesh alone, which gets its own colours or one grey material, one light above the camera and
/// 320 x 240 pixels.
///
/// Errors: everything that is wrong in both files, each with its place.
pub fn load(path: &Path, mesh: Option<&Path>) -> Result<Loaded, Report> {
    let mut files = vec![path.to_owned()];
    let loaded = load_listing(path, mesh, &mut files)?;
    Ok(Loaded { files, ..loaded })
}

/// Reads a scene as [`load`] does, and puts all files but the first on a list.
fn load_listing(path: &Path, mesh: Option<&Path>, files: &mut Vec<PathBuf>) -> Result<Loaded, Report> {
    let bytes = file::read(path)?;
    let stem = path.file_stem().filter(|stem| *stem != file::STANDARD);
    let name = stem.map_or_else(|| "scene".to_string(), |stem| stem.to_string_lossy().into_owned());
    if let SceneFormat::Mesh(format) = SceneFormat::of(path, &bytes)? {
        return match mesh {
            Some(mesh) => {
                let message = format!("{} and {} are both meshes", path.display(), mesh.display());
                Err(Diagnostic::error(message).hint("a mesh belongs to a .dsc, or stands alone").into())
            }
            None => Ok(join::alone(name, parse_mesh(format, bytes, path, Some(files))?)),
        };
    }
    messages::refuse_utf16(&bytes, &path.display().to_string())?;
    let source = words::source(&path.display().to_string(), bytes.into());
    let description = dsc::parse(&source);
    let mesh = match mesh {
        Some(mesh) => load_mesh(mesh, files),
        None => beside(path).and_then(|mesh| load_mesh(&mesh, files)),
    };
    match (description, mesh) {
        (Ok(description), Ok(mesh)) => join::described(name, description, mesh),
        (Err(mut first), Err(mut second)) => {
            first.0.append(&mut second.0);
            Err(first)
        }
        (Err(report), Ok(_)) | (Ok(_), Err(report)) => Err(report),
    }
}

/// The mesh of a `.dsc`.
fn load_mesh(path: &Path, files: &mut Vec<PathBuf>) -> Result<Mesh, Report> {
    files.push(path.to_owned());
    let bytes = file::read(path)?;
    let SceneFormat::Mesh(format) = SceneFormat::of(path, &bytes)? else {
        let error = Diagnostic::error(format!("{} is a scene description, not a mesh", path.display()));
        return Err(error.hint("the mesh of a .dsc is a file such as an .off").into());
    };
    parse_mesh(format, bytes, path, None)
}

/// Reads a mesh. Its material libraries are opened, and put on the list, where there is one: a `.dsc` has materials of
/// its own.
fn parse_mesh(
    format: &MeshReader,
    bytes: Vec<u8>,
    path: &Path,
    files: Option<&mut Vec<PathBuf>>,
) -> Result<Mesh, Report> {
    let name = path.display().to_string();
    let mesh = match files {
        None => (format.parse)(bytes, &name, None),
        Some(files) => {
            let mut open = |library: &str| {
                // Some programs write the names as they are on their own system.
                let library = library.replace('\\', "/");
                let path = path.parent().unwrap_or(Path::new("")).join(library);
                if !path.exists() {
                    let missing = Diagnostic::error(format!("there is no file {}", path.display()));
                    return Err(match file::near(&path, &["mtl"]) {
                        Some(near) => missing.hint(format!("is `{}` meant?", near.display())).into(),
                        None => missing.into(),
                    });
                }
                files.push(path.clone());
                Ok((path.display().to_string(), file::read(&path)?))
            };
            (format.parse)(bytes, &name, Some(&mut open))
        }
    }?;
    if mesh.warnings.has_errors() { Err(mesh.warnings) } else { Ok(mesh) }
}

/// The mesh beside a `.dsc`: the same name with a mesh's extension.
fn beside(path: &Path) -> Result<PathBuf, Report> {
    let meshes = format::mesh_extensions();
    let candidates: Vec<PathBuf> = meshes
        .iter()
        .flat_map(|extension| [extension.to_string(), extension.to_ascii_uppercase()])
        .map(|extension| path.with_extension(extension))
        .collect();
    if let Some(found) = candidates.iter().find(|candidate| candidate.exists()) {
        return Ok(found.clone());
    }
    let wanted = &candidates[0];
    let error = Diagnostic::error(format!("{} has no mesh: {} is not there", path.display(), wanted.display()));
    let hint = match file::near(wanted, &meshes) {
        Some(near) => question(&format!("--mesh {}", near.display())),
        None => format!("put it beside the .dsc, as {}, or name another by `--mesh`", format::listed_extensions()),
    };
    Err(error.hint(hint).into())
}
