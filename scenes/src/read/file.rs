//! Opening the files that a user names: what can go wrong before their first octet is read.

use std::fs;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use messages::{Diagnostic, Report, nearest, question, refuse_packed};

use super::format::scene_extensions;

/// In the place of a file's name, standard input.
pub(super) const STANDARD: &str = "-";

/// Octets of the largest file that is read.
const LARGEST: u64 = 256 << 20;

/// Standard input has been read.
static IS_TAKEN: AtomicBool = AtomicBool::new(false);

/// All octets of standard input, up to `largest`. Whoever reads a file by the name `-` gets them here, once.
///
/// Errors: it has been read before, is larger, or cannot be read.
pub fn standard_input(largest: u64) -> Result<Vec<u8>, Report> {
    if IS_TAKEN.swap(true, Ordering::Relaxed) {
        let error = Diagnostic::error("standard input is named twice, and can be read once");
        return Err(error.hint("name a file, or `<(command)` in the shell, in one of the places").into());
    }
    let mut bytes = Vec::new();
    let read = std::io::stdin().lock().take(largest + 1).read_to_end(&mut bytes);
    read.map_err(|error| Diagnostic::error(format!("standard input cannot be read: {error}")))?;
    if bytes.len() as u64 > largest {
        let size = if largest < 1 << 20 { format!("{} KiB", largest >> 10) } else { format!("{} MiB", largest >> 20) };
        return Err(Diagnostic::error(format!("standard input is larger than {size}")).into());
    }
    Ok(bytes)
}

/// All octets of a file, or of standard input where the path is [`STANDARD`].
///
/// Errors: it is missing (with a name nearby that may be meant), a folder, too large, compressed, or cannot be read.
pub(super) fn read(path: &Path) -> Result<Vec<u8>, Report> {
    if path == Path::new(STANDARD) {
        let bytes = standard_input(LARGEST)?;
        refuse_packed(&bytes, "standard input")?;
        return Ok(bytes);
    }
    let shown = path.display();
    let metadata = fs::metadata(path).map_err(|error| refusal(path, &error))?;
    if metadata.is_dir() {
        let error = Diagnostic::error(format!("{shown} is a folder, not a scene file"));
        let names = scene_files(path, &scene_extensions());
        let hint = match names.is_empty() {
            true => "there is no .dsc in it, and no mesh".to_string(),
            false => format!("scene files in it: {}", listed(&names)),
        };
        return Err(error.hint(hint).into());
    }
    let too_large = || Diagnostic::error(format!("{shown} is larger than {} MiB", LARGEST >> 20));
    if metadata.len() > LARGEST {
        return Err(too_large().into());
    }
    let file = fs::File::open(path).map_err(|error| refusal(path, &error))?;
    // Pipes and terminals have no length: they are read up to their end, or the limit.
    let mut bytes = Vec::with_capacity(metadata.len() as usize);
    file.take(LARGEST + 1).read_to_end(&mut bytes).map_err(|error| refusal(path, &error))?;
    if bytes.len() as u64 > LARGEST {
        return Err(too_large().into());
    }
    refuse_packed(&bytes, &shown.to_string())?;
    Ok(bytes)
}

fn refusal(path: &Path, error: &std::io::Error) -> Report {
    let shown = path.display();
    let message = match error.kind() {
        ErrorKind::NotFound => {
            let missing = Diagnostic::error(format!("there is no file {shown}"));
            let there = path.parent().map(|folder| scene_files(folder, &scene_extensions())).unwrap_or_default();
            match near(path, &scene_extensions()) {
                Some(near) => missing.hint(question(&near.display().to_string())),
                None if there.is_empty() => missing,
                None => missing.hint(format!("scene files there: {}", listed(&there))),
            }
        }
        ErrorKind::PermissionDenied => Diagnostic::error(format!("{shown} must not be read by this user")),
        ErrorKind::NotADirectory => Diagnostic::error(format!("{shown} lies in something that is not a folder")),
        _ => Diagnostic::error(format!("{shown} cannot be read: {error}")),
    };
    message.into()
}

/// A file in the same folder whose name is nearly this one and has one of the `extensions`.
pub(super) fn near(path: &Path, extensions: &[&str]) -> Option<PathBuf> {
    let wanted = path.file_name()?.to_string_lossy().into_owned();
    let folder = path.parent()?;
    let names = scene_files(folder, extensions);
    let longer: Vec<String> = extensions.iter().map(|extension| format!("{wanted}.{extension}")).collect();
    let near = match longer.iter().find(|longer| names.contains(longer)) {
        Some(longer) => longer.as_str(),
        None => nearest(&wanted, names.iter().map(String::as_str))?,
    };
    Some(folder.join(near))
}

/// Names of the files in a folder that have one of the `extensions`, in order; none when it cannot be read.
fn scene_files(folder: &Path, extensions: &[&str]) -> Vec<String> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    // A folder of a million files must not make an error message slow.
    let names = entries.take(10_000).filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let is_wanted = |name: &String| {
        let extension = Path::new(name).extension().map(|text| text.to_string_lossy().to_ascii_lowercase());
        extension.is_some_and(|extension| extensions.contains(&extension.as_str()))
    };
    let mut names: Vec<String> = names.filter(is_wanted).collect();
    names.sort();
    names
}

/// The first few of many names.
fn listed(names: &[String]) -> String {
    let shown = names[..names.len().min(8)].join(", ");
    if names.len() > 8 { format!("{shown}, ...") } else { shown }
}
