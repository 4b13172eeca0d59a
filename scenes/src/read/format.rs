//! The formats of scene files, one row each, and the choice between them: by the extension of a file's name, else by its start.

use std::path::Path;

use messages::{Diagnostic, Report};

use super::mesh::Mesh;
use super::obj::Libraries;
use super::{obj, off, ply, stl};

/// Extension of scene descriptions.
pub(super) const DESCRIPTION: &str = "dsc";

/// Reading of the octets of a file with a name for messages; libraries of materials are opened where the caller has an opener.
pub(super) type Parse = fn(Vec<u8>, &str, Option<&mut Libraries<'_>>) -> Result<Mesh, Report>;

/// A reader of meshes: its row in [`MESH_READERS`].
pub(super) struct MeshReader {
    /// Extensions of its files, in lower case; the first is its name.
    pub extensions: &'static [&'static str],
    /// Likelihood that a file without a known extension has the format, from its octets and its first word (comments left out).
    pub sniff: fn(&[u8], &str) -> Likelihood,
    /// Reads the octets of a file with a name for messages. Libraries of materials are opened where the caller has an opener.
    pub parse: Parse,
}

/// All readers of meshes, in the order in which one is looked for beside a `.dsc`.
pub(super) static MESH_READERS: [&MeshReader; 4] = [&off::READER, &obj::READER, &ply::READER, &stl::READER];

/// Likelihood that a file has a format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Likelihood {
    /// Nothing speaks for the format.
    None,
    /// The first word is one of the format's.
    Likely,
    /// No other format has such octets.
    Certain,
}

impl Likelihood {
    /// Likely when the claim holds.
    pub(super) fn likely_if(claim: bool) -> Likelihood {
        if claim { Likelihood::Likely } else { Likelihood::None }
    }
}

/// Format of a scene file.
pub(super) enum SceneFormat {
    /// A scene description.
    Description,
    /// A mesh.
    Mesh(&'static MeshReader),
}

impl SceneFormat {
    /// The format of a file: by its name's extension, else by its start.
    pub(super) fn of(path: &Path, bytes: &[u8]) -> Result<SceneFormat, Report> {
        let extension = path.extension().map(|text| text.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
        if extension == DESCRIPTION {
            return Ok(SceneFormat::Description);
        }
        if let Some(format) = MESH_READERS.iter().find(|format| format.extensions.contains(&extension.as_str())) {
            return Ok(SceneFormat::Mesh(format));
        }
        let start = String::from_utf8_lossy(&bytes[..bytes.len().min(4096)]);
        let lines = start.lines().map(|line| line.split('#').next().unwrap_or_default());
        let first = lines.flat_map(str::split_whitespace).next().unwrap_or_default().trim_start_matches('\u{feff}');
        let guesses = MESH_READERS.iter().map(|format| ((format.sniff)(bytes, first), *format));
        match guesses.max_by_key(|(likelihood, _)| *likelihood) {
            Some((Likelihood::Certain, format)) => Ok(SceneFormat::Mesh(format)),
            _ if first == "DSC" => Ok(SceneFormat::Description),
            Some((Likelihood::Likely, format)) => Ok(SceneFormat::Mesh(format)),
            _ => {
                let error = Diagnostic::error(format!("{} is no scene file that is known here", path.display()));
                let meshes = listed_extensions();
                Err(error.hint(format!("scene files end in .{DESCRIPTION}, meshes in {meshes}")).into())
            }
        }
    }
}

/// Extensions of meshes, in the order in which one is looked for beside a `.dsc`.
pub(super) fn mesh_extensions() -> Vec<&'static str> {
    MESH_READERS.iter().flat_map(|format| format.extensions).copied().collect()
}

/// Extensions of all files that make up scenes.
pub(super) fn scene_extensions() -> Vec<&'static str> {
    std::iter::once(DESCRIPTION).chain(mesh_extensions()).collect()
}

/// Extensions of meshes for a sentence, such as `.off, .obj or .ply`.
pub(super) fn listed_extensions() -> String {
    let extensions: Vec<String> = mesh_extensions().iter().map(|extension| format!(".{extension}")).collect();
    match extensions.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{} or {last}", others.join(", ")),
        _ => extensions.concat(),
    }
}
