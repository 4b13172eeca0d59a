//! Opening the files that a user names: what can go wrong before their first octet is read.

use std::fs;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

use isa::diagnostic::{Diagnostic, Report, did_you_mean};

/// Octets of the largest file that is read.
const LARGEST: u64 = 1 << 30;

/// All octets of a file.
///
/// Errors: it is missing (with a name nearby that may be meant), no file, too large, or cannot be read.
pub(super) fn read(path: &Path) -> Result<Vec<u8>, Report> {
    let shown = path.display();
    let metadata = fs::metadata(path).map_err(|error| refusal(path, &error))?;
    if metadata.is_dir() {
        let error = Diagnostic::error(format!("{shown} is a folder, not a scene file"));
        let names: Vec<String> = scene_files(path).into_iter().take(8).collect();
        let hint = match names.is_empty() {
            true => "there is no .dsc or .off in it".to_string(),
            false => format!("scene files in it: {}", names.join(", ")),
        };
        return Err(error.hint(hint).into());
    }
    if !metadata.is_file() {
        return Err(Diagnostic::error(format!("{shown} is not a regular file")).into());
    }
    let too_large = || Diagnostic::error(format!("{shown} is larger than {} MiB", LARGEST >> 20));
    if metadata.len() > LARGEST {
        return Err(too_large().into());
    }
    let file = fs::File::open(path).map_err(|error| refusal(path, &error))?;
    let mut bytes = Vec::with_capacity(metadata.len() as usize);
    file.take(LARGEST + 1).read_to_end(&mut bytes).map_err(|error| refusal(path, &error))?;
    if bytes.len() as u64 > LARGEST { Err(too_large().into()) } else { Ok(bytes) }
}

fn refusal(path: &Path, error: &std::io::Error) -> Report {
    let shown = path.display();
    let message = match error.kind() {
        ErrorKind::NotFound => {
            let missing = Diagnostic::error(format!("there is no file {shown}"));
            match near(path) {
                Some(near) => missing.hint(format!("did you mean `{}`?", near.display())),
                None => missing,
            }
        }
        ErrorKind::PermissionDenied => Diagnostic::error(format!("{shown} must not be read by this user")),
        ErrorKind::NotADirectory => Diagnostic::error(format!("{shown} lies in something that is not a folder")),
        _ => Diagnostic::error(format!("{shown} cannot be read: {error}")),
    };
    message.into()
}

/// A scene file in the same folder whose name is nearly this one.
pub(super) fn near(path: &Path) -> Option<PathBuf> {
    let wanted = path.file_name()?.to_string_lossy().into_owned();
    let folder = path.parent()?;
    let names = scene_files(folder);
    let longer = ["dsc", "off"].map(|extension| format!("{wanted}.{extension}"));
    let near = match longer.iter().find(|longer| names.contains(longer)) {
        Some(longer) => longer.as_str(),
        None => did_you_mean(&wanted, names.iter().map(String::as_str))?,
    };
    Some(folder.join(near))
}

/// Names of the scene files in a folder, in order; none when it cannot be read.
fn scene_files(folder: &Path) -> Vec<String> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    // A folder of a million files must not make an error message slow.
    let names = entries.take(10_000).filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let is_scene = |name: &String| {
        let lower = name.to_ascii_lowercase();
        lower.ends_with(".dsc") || lower.ends_with(".off")
    };
    let mut names: Vec<String> = names.filter(is_scene).collect();
    names.sort();
    names
}
