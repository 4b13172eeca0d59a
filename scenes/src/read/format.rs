//! Which format a file has: by the extension of its name, else by what it starts with.

use std::path::Path;

use messages::{Diagnostic, Report};

use super::stl;

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    /// Scene description.
    Dsc,
    /// Mesh of Geomview.
    Off,
    /// Mesh of Wavefront.
    Obj,
    /// Mesh of Stanford.
    Ply,
    /// Mesh of 3D Systems.
    Stl,
}

/// Extensions and what they stand for.
const EXTENSIONS: [(&str, Format); 5] = [
    (SCENES[0], Format::Dsc),
    (SCENES[1], Format::Off),
    (SCENES[2], Format::Obj),
    (SCENES[3], Format::Ply),
    (SCENES[4], Format::Stl),
];

/// Extensions of all files that make up scenes.
pub(super) const SCENES: [&str; 5] = ["dsc", "off", "obj", "ply", "stl"];

/// Extensions of meshes, in the order in which one is looked for beside a `.dsc`.
pub(super) const MESHES: [&str; 4] = [SCENES[1], SCENES[2], SCENES[3], SCENES[4]];

/// First words of OBJ files.
const STATEMENTS: [&str; 9] = ["v", "vn", "vt", "f", "o", "g", "s", "usemtl", "mtllib"];

impl Format {
    /// The format of a file: by its name's extension, else by its first word.
    pub(super) fn of(path: &Path, bytes: &[u8]) -> Result<Format, Report> {
        let extension = path.extension().map(|text| text.to_string_lossy().to_ascii_lowercase());
        let known = EXTENSIONS.iter().find(|(text, _)| Some(*text) == extension.as_deref());
        if let Some(&(_, format)) = known {
            return Ok(format);
        }
        let start = String::from_utf8_lossy(&bytes[..bytes.len().min(4096)]);
        let lines = start.lines().map(|line| line.split('#').next().unwrap_or_default());
        let first = lines.flat_map(str::split_whitespace).next().unwrap_or_default();
        match first.trim_start_matches('\u{feff}') {
            _ if stl::is_binary(bytes) => Ok(Format::Stl),
            "DSC" => Ok(Format::Dsc),
            "ply" => Ok(Format::Ply),
            word if word.eq_ignore_ascii_case("solid") => Ok(Format::Stl),
            word if STATEMENTS.contains(&word) => Ok(Format::Obj),
            word if word.contains("OFF") => Ok(Format::Off),
            _ => {
                let error = Diagnostic::error(format!("{} is no scene file that is known here", path.display()));
                Err(error.hint("scene files end in .dsc, meshes in .off, .obj, .ply or .stl").into())
            }
        }
    }
}
