//! Scene files: a `.dsc` with its mesh beside it, or a mesh alone (report 5.2). Each format has a module of its own
//! that works on text or octets; only this module and `file` touch the disk.

pub mod dsc;
mod file;
mod join;
pub mod mesh;
pub mod off;
mod polygon;
mod words;

use std::path::{Path, PathBuf};

use isa::diagnostic::{Diagnostic, Report};

use self::mesh::Mesh;
use crate::model::Scene;

/// A scene and what is likely a mistake in its files.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// What is drawn.
    pub scene: Scene,
    /// Warnings, in the order of the files' texts; never errors.
    pub warnings: Report,
}

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    /// Scene description.
    Dsc,
    /// Mesh.
    Off,
}

impl Format {
    /// Extensions and what they stand for.
    const EXTENSIONS: [(&str, Format); 2] = [("dsc", Format::Dsc), ("off", Format::Off)];

    /// The format of a file: by its name's extension, else by its first word.
    fn of(path: &Path, bytes: &[u8]) -> Result<Format, Report> {
        let extension = path.extension().map(|text| text.to_string_lossy().to_ascii_lowercase());
        let known = Format::EXTENSIONS.iter().find(|(text, _)| Some(*text) == extension.as_deref());
        if let Some(&(_, format)) = known {
            return Ok(format);
        }
        let start = String::from_utf8_lossy(&bytes[..bytes.len().min(4096)]);
        let lines = start.lines().map(|line| line.split('#').next().unwrap_or_default());
        let first = lines.flat_map(str::split_whitespace).next().unwrap_or_default();
        match first.trim_start_matches('\u{feff}') {
            "DSC" => Ok(Format::Dsc),
            word if word.contains("OFF") => Ok(Format::Off),
            _ => {
                let error = Diagnostic::error(format!("{} is no scene file that is known here", path.display()));
                Err(error.hint("scene files end in .dsc, meshes in .off").into())
            }
        }
    }
}

/// Reads the scene `path`: a `.dsc` with the mesh `mesh`, or with the `.off` of the same name beside it; or a mesh
/// alone, which gets one grey material (or those of its face colours), one light above the camera and 320 x 240 pixels.
///
/// Errors: everything that is wrong in both files, each with its place.
pub fn load(path: &Path, mesh: Option<&Path>) -> Result<Loaded, Report> {
    let bytes = file::read(path)?;
    let name = path.file_stem().map_or_else(|| "scene".to_string(), |stem| stem.to_string_lossy().into_owned());
    match Format::of(path, &bytes)? {
        Format::Dsc => {
            let source = words::source(&path.display().to_string(), bytes.into());
            let description = dsc::parse(&source);
            let mesh = match mesh {
                Some(mesh) => load_mesh(mesh),
                None => beside(path).and_then(|mesh| load_mesh(&mesh)),
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
        Format::Off => match mesh {
            Some(mesh) => {
                let message = format!("{} and {} are both meshes", path.display(), mesh.display());
                Err(Diagnostic::error(message).hint("a mesh belongs to a .dsc, or stands alone").into())
            }
            None => Ok(join::alone(name, off::parse(bytes, &path.display().to_string())?)),
        },
    }
}

fn load_mesh(path: &Path) -> Result<Mesh, Report> {
    let bytes = file::read(path)?;
    match Format::of(path, &bytes)? {
        Format::Off => off::parse(bytes, &path.display().to_string()),
        Format::Dsc => {
            let error = Diagnostic::error(format!("{} is a scene description, not a mesh", path.display()));
            Err(error.hint("the mesh of a .dsc is a file such as an .off").into())
        }
    }
}

/// The mesh beside a `.dsc`: the same name with a mesh's extension.
fn beside(path: &Path) -> Result<PathBuf, Report> {
    let meshes: Vec<&str> =
        Format::EXTENSIONS.iter().filter(|(_, f)| *f != Format::Dsc).map(|(text, _)| *text).collect();
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
        Some(near) => format!("did you mean `--mesh {}`?", near.display()),
        None => "put it beside the .dsc, or name another by `--mesh`".to_string(),
    };
    Err(error.hint(hint).into())
}
