//! Files that commands read and write. A result is written beside its place and then renamed, so that no file is ever
//! half-written.

pub mod map;
pub mod picture;
pub mod program;

use std::fs::{self, Permissions};
use std::io::{self, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use messages::{Diagnostic, Report, Source};
use tempfile::{Builder, NamedTempFile};

/// Octets of the largest file that is read: sources, programs, machines, memory.
const LARGEST: u64 = 64 << 20;

/// All octets of a file.
///
/// # Errors
/// A file that is missing, too large or cannot be read.
pub fn read(path: &Path) -> Result<Vec<u8>, Report> {
    let shown = path.display();
    let refuse = |error: io::Error| match error.kind() {
        ErrorKind::NotFound => Diagnostic::error(format!("there is no file {shown}")),
        ErrorKind::PermissionDenied => Diagnostic::error(format!("{shown} must not be read by this user")),
        _ => Diagnostic::error(format!("{shown} cannot be read: {error}")),
    };
    if path.is_dir() {
        return Err(Diagnostic::error(format!("{shown} is a folder, not a file")).into());
    }
    let too_large = || Diagnostic::error(format!("{shown} is larger than {} MiB", LARGEST >> 20));
    let file = fs::File::open(path).map_err(refuse)?;
    let length = file.metadata().map_or(0, |metadata| metadata.len());
    if length > LARGEST {
        return Err(too_large().into());
    }
    let mut octets = Vec::with_capacity(length as usize);
    // Files that have no length, such as pipes, and those that grow.
    file.take(LARGEST + 1).read_to_end(&mut octets).map_err(refuse)?;
    if octets.len() as u64 > LARGEST { Err(too_large().into()) } else { Ok(octets) }
}

/// The text of a file; octets that are not UTF-8 are replaced.
///
/// # Errors
/// See [`read`].
pub fn source(path: &Path) -> Result<Arc<Source>, Report> {
    Ok(Source::new(path.display().to_string(), text(read(path)?)))
}

/// Octets as text; those that are not UTF-8 are replaced.
pub fn text(octets: Vec<u8>) -> String {
    // A copy is only made where something is replaced.
    String::from_utf8(octets).unwrap_or_else(|error| String::from_utf8_lossy(error.as_bytes()).into_owned())
}

/// Check that a result could be written to a place, so that a command fails before its work and not after it.
///
/// # Errors
/// A folder that does not exist, or a folder in the place of the file.
pub fn check_target(path: &Path) -> Result<(), Report> {
    let shown = path.display();
    if path.is_dir() {
        return Err(Diagnostic::error(format!("{shown} is a folder, not a place for a file")).into());
    }
    let folder = folder_of(path);
    if !folder.is_dir() {
        let message = Diagnostic::error(format!("there is no folder {} for {shown}", folder.display()));
        return Err(message.hint(format!("make it first: mkdir -p {}", folder.display())).into());
    }
    Ok(())
}

/// Writes a file as a whole: beside its place first, then renamed. What is no regular file, such as a pipe, is written
/// in place.
///
/// # Errors
/// What [`check_target`] refuses, and a disk or folder that cannot be written.
pub fn write(path: &Path, octets: &[u8]) -> Result<(), Report> {
    write_all(&[(path, octets)])
}

/// Writes files that belong together: the first one takes its place when the last one has been written as a whole.
///
/// # Errors
/// See [`write()`].
pub fn write_all(files: &[(impl AsRef<Path>, impl AsRef<[u8]>)]) -> Result<(), Report> {
    let mut ready = Vec::new();
    for (path, octets) in files {
        let path = path.as_ref();
        check_target(path)?;
        // A link keeps leading to the file.
        let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let octets = octets.as_ref();
        let written = match fs::metadata(&path).is_ok_and(|metadata| !metadata.is_file()) {
            true => fs::write(&path, octets).map(|()| None),
            false => written_beside(&path, octets).map(Some),
        };
        ready.push((written.map_err(|error| refusal(&path, &error))?, path));
    }
    for (file, path) in ready {
        if let Some(file) = file {
            file.persist(&path).map_err(|error| refusal(&path, &error.error))?;
        }
    }
    Ok(())
}

fn refusal(path: &Path, error: &io::Error) -> Diagnostic {
    let reason = match error.kind() {
        ErrorKind::PermissionDenied => "this user must not write there".to_owned(),
        _ => error.to_string(),
    };
    Diagnostic::error(format!("{} cannot be written: {reason}", path.display()))
}

fn written_beside(path: &Path, octets: &[u8]) -> io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    builder.prefix(".lancer-");
    let permissions = fresh_permissions();
    if let Some(permissions) = &permissions {
        builder.permissions(permissions.clone());
    }
    let mut file = builder.tempfile_in(folder_of(path))?;
    file.write_all(octets)?;
    Ok(file)
}

/// Permissions of a new file before the user's mask; temporary files are private otherwise.
#[cfg(unix)]
fn fresh_permissions() -> Option<Permissions> {
    use std::os::unix::fs::PermissionsExt;
    Some(Permissions::from_mode(0o666))
}

#[cfg(not(unix))]
fn fresh_permissions() -> Option<Permissions> {
    None
}

fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
        _ => PathBuf::from("."),
    }
}

/// One path for each file however it is spelt: links are followed, and a file that is not there yet has the path of its
/// folder. `None` for what cannot be overwritten, such as a pipe or a terminal.
fn identity(path: &Path) -> Option<PathBuf> {
    if fs::metadata(path).is_ok_and(|metadata| !metadata.is_file()) {
        return None;
    }
    let in_folder = || Some(fs::canonicalize(folder_of(path)).ok()?.join(path.file_name()?));
    Some(fs::canonicalize(path).ok().or_else(in_folder).unwrap_or_else(|| path.to_owned()))
}

/// Refuses two results for the same file.
///
/// # Errors
/// The path that is named twice, in whatever spelling.
pub fn check_distinct<'a>(paths: impl IntoIterator<Item = &'a Path>) -> Result<(), Report> {
    let mut seen: Vec<PathBuf> = Vec::new();
    for path in paths {
        let Some(file) = identity(path) else { continue };
        if seen.contains(&file) {
            return Err(Diagnostic::error(format!("{} would be written twice", path.display())).into());
        }
        seen.push(file);
    }
    Ok(())
}

/// Refuses results in the place of files that were read.
///
/// # Errors
/// The first such path, in whatever spelling.
pub fn check_spared<'a>(
    results: impl IntoIterator<Item = &'a Path>,
    read: impl IntoIterator<Item = impl AsRef<Path>>,
) -> Result<(), Report> {
    let inputs: Vec<PathBuf> = read.into_iter().filter_map(|path| identity(path.as_ref())).collect();
    let is_input = |path: &&Path| identity(path).is_some_and(|file| inputs.contains(&file));
    let Some(path) = results.into_iter().find(is_input) else { return Ok(()) };
    let message = Diagnostic::error(format!("{} is read, and would be overwritten", path.display()));
    Err(message.hint("choose another name for the result").into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_as_a_whole_and_nothing_stays_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        write(&path, b"first").unwrap();
        write(&path, b"second").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"second");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn files_that_belong_together_come_together() {
        let folder = tempfile::tempdir().unwrap();
        let (good, bad) = (folder.path().join("a.mtl"), folder.path().join("no/such/a.obj"));
        assert!(write_all(&[(&good, b"1"), (&bad, b"2")]).is_err());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        write_all(&[(&good, b"1"), (&folder.path().join("a.obj"), b"2")]).unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    }

    #[test]
    fn a_missing_folder_is_named_with_what_to_do() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("no/such/a.txt");
        let message = write(&path, b"").unwrap_err().render(false);
        assert!(message.contains("there is no folder") && message.contains("mkdir -p"), "{message}");
        assert!(write(folder.path(), b"").unwrap_err().render(false).contains("is a folder"));
    }

    #[cfg(unix)]
    #[test]
    fn a_link_keeps_leading_to_its_file() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, "old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        write(&link, b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&file).unwrap(), b"new");
    }

    #[test]
    fn two_results_do_not_share_a_file() {
        assert!(check_distinct([Path::new("a"), Path::new("b")]).is_ok());
        assert!(check_distinct([Path::new("a"), Path::new("b"), Path::new("a")]).is_err());
        assert!(check_distinct([Path::new("a"), Path::new("./a")]).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn what_is_read_is_spared_in_every_spelling() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("a.s"), folder.path().join("link"));
        fs::write(&file, "nop").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        let name = folder.path().file_name().unwrap();
        for result in [file.clone(), link, folder.path().join("./a.s"), folder.path().join("..").join(name).join("a.s")]
        {
            assert!(check_spared([result.as_path()], [&file]).is_err(), "{}", result.display());
        }
        assert!(check_spared([folder.path().join("b.s").as_path()], [&file]).is_ok());
        assert!(check_spared([Path::new("/dev/null")], [Path::new("/dev/null")]).is_ok());
        assert!(check_distinct([Path::new("/dev/null"), Path::new("/dev/null")]).is_ok());
    }
}
