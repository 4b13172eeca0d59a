//! Results as files: each is written beside its place and then renamed, so that no file is ever half-written, and those of
//! one command take their places together. Leftovers of runs that were killed are removed by the next run.

use std::fs::{self, Permissions};
use std::io::{self, ErrorKind, Write};
use std::path::Path;

use messages::{Diagnostic, Report};
use tempfile::{Builder, NamedTempFile};

use super::{check_target, folder_of};

/// First part of the names of files that are being written.
const PREFIX: &str = ".lancer-";

/// Entries of a folder among which leftovers are looked for: a folder of a million files must not make a result slow.
const MOST_ENTRIES: usize = 10_000;

/// Writes a file as a whole: beside its place first, then renamed. What is no regular file, such as a pipe, is written
/// in place.
///
/// # Errors
/// What [`check_target`] refuses, and a disk or folder that cannot be written.
pub fn write(path: &Path, octets: &[u8]) -> Result<(), Report> {
    write_all(&[(path, octets)])
}

/// Writes a file as [`write()`] does, and lets it take its place only when the disk has it: for results of hours.
///
/// # Errors
/// See [`write()`].
pub fn write_through(path: &Path, octets: &[u8]) -> Result<(), Report> {
    place(&[(path, octets)], Durability::Disk)
}

/// Writes files that belong together: the first one takes its place when the last one has been written as a whole.
///
/// # Errors
/// See [`write()`].
pub fn write_all(files: &[(impl AsRef<Path>, impl AsRef<[u8]>)]) -> Result<(), Report> {
    place(files, Durability::Cache)
}

/// Place in which octets must be before a file is renamed.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Durability {
    /// In the system's memory: a crash of the host may lose them.
    Cache,
    /// On the disk.
    Disk,
}

fn place(files: &[(impl AsRef<Path>, impl AsRef<[u8]>)], durability: Durability) -> Result<(), Report> {
    // Write all regular files beside their places.
    let (mut ready, mut in_place) = (Vec::new(), Vec::new());
    for (path, octets) in files {
        let (path, octets) = (path.as_ref(), octets.as_ref());
        check_target(path)?;
        // A link keeps leading to the file.
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        if fs::metadata(&target).is_ok_and(|metadata| !metadata.is_file()) {
            in_place.push((path, octets));
            continue;
        }
        remove_leftovers(&folder_of(&target));
        let file = written_beside(&target, octets, durability).map_err(|error| refusal(path, &error))?;
        ready.push((file, target, path));
    }
    // Nothing more can fail but pipes and renames: hand over, then rename.
    for (path, octets) in in_place {
        fs::write(path, octets).map_err(|error| refusal(path, &error))?;
    }
    for (file, target, path) in ready {
        file.persist(&target).map_err(|error| refusal(path, &error.error))?;
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

/// A file beside its place, locked for as long as this run lives, with the permissions of the file that it replaces.
fn written_beside(path: &Path, octets: &[u8], durability: Durability) -> io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    let prefix = format!("{PREFIX}{}-", std::process::id());
    builder.prefix(&prefix);
    let permissions = fresh_permissions();
    if let Some(permissions) = &permissions {
        builder.permissions(permissions.clone());
    }
    let mut file = builder.tempfile_in(folder_of(path))?;
    // A file system without locks has its leftovers told by the number of the process alone.
    let _ = file.as_file().try_lock();
    file.write_all(octets)?;
    if let Ok(replaced) = fs::metadata(path) {
        file.as_file().set_permissions(replaced.permissions())?;
    }
    if durability == Durability::Disk {
        file.as_file().sync_all()?;
    }
    Ok(file)
}

/// Removes what killed runs have left in a folder, as far as that is possible.
fn remove_leftovers(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.take(MOST_ENTRIES).flatten() {
        let name = entry.file_name();
        let Some(rest) = name.to_str().and_then(|name| name.strip_prefix(PREFIX)) else { continue };
        if !is_owned(rest) && is_unlocked(&entry.path()) {
            // Another run may have been faster.
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// True where the process that a temporary file's name begins with may still be there.
fn is_owned(rest: &str) -> bool {
    let Some((process, _)) = rest.split_once('-') else { return false };
    process.parse().is_ok_and(|process: u32| process == std::process::id()) || Path::new("/proc").join(process).is_dir()
}

/// True of a regular file that no run has locked.
fn is_unlocked(path: &Path) -> bool {
    let is_file = fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_file());
    is_file && fs::File::open(path).is_ok_and(|file| file.try_lock().is_ok())
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
    fn a_set_that_cannot_be_written_as_a_whole_changes_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let (first, second) = (folder.path().join("a"), folder.path().join("no/b"));
        fs::write(&first, "old").unwrap();
        assert!(write_all(&[(&first, "new"), (&second, "new")]).is_err());
        assert_eq!(fs::read(&first).unwrap(), b"old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn leftovers_of_killed_runs_are_removed_and_files_of_running_ones_are_not() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        // No process has this number on a host with /proc; the second is as an older version named its files.
        for name in [".lancer-4294967295-abc", ".lancer-FfrhI4", ".lancer-locked", ".other"] {
            fs::write(at(name), "half").unwrap();
        }
        let running = at(&format!(".lancer-{}-abc", std::process::id()));
        fs::write(&running, "half").unwrap();
        let locked = fs::File::open(at(".lancer-locked")).unwrap();
        locked.lock().unwrap();
        write(&at("a.txt"), b"whole").unwrap();
        let mut left: Vec<String> = fs::read_dir(folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        left.sort();
        let running = running.file_name().unwrap().to_str().unwrap();
        assert_eq!(left, [running, ".lancer-locked", ".other", "a.txt"]);
    }

    #[cfg(unix)]
    #[test]
    fn the_mode_of_a_file_is_kept_when_it_is_overwritten() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        for mode in [0o600, 0o640, 0o755] {
            fs::write(&path, "old").unwrap();
            fs::set_permissions(&path, Permissions::from_mode(mode)).unwrap();
            write(&path, b"new").unwrap();
            assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, mode);
        }
    }
}
