//! Results as files: each is written beside its place and then renamed, so that no file is ever half-written, and those of
//! one command take their places together. What a killed run leaves is completed or removed by the next one.

use std::collections::BTreeSet;
use std::fs::{self, File, Permissions};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use messages::{Diagnostic, Report};
use tempfile::{NamedTempFile, TempPath};

use super::journal::SetJournals;
use super::leftover::{self, temporary};
use super::{STANDARD, check_target, folder_of};

/// Writes a file as a whole: beside its place first, then renamed. What is no regular file, such as a pipe or standard output
/// (`-`), is written in place.
///
/// # Errors
/// Places that [`check_target`] refuses, and a disk or folder that cannot be written.
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
        if path == Path::new(STANDARD) {
            in_place.push((path, octets));
            continue;
        }
        check_target(path)?;
        let target = behind_links(path);
        if fs::metadata(&target).is_ok_and(|metadata| !metadata.is_file()) {
            in_place.push((path, octets));
            continue;
        }
        leftover::clean(&folder_of(&target));
        let file = written_beside(&target, octets, durability).map_err(|error| refusal(path, &error))?;
        ready.push((file, target, path));
    }
    // Nothing more can fail but pipes and renames: hand over, then rename.
    for (path, octets) in in_place {
        written_in_place(path, octets).map_err(|error| refusal(path, &error))?;
    }
    let is_set = ready.len() > 1;
    let places = ready.iter().map(|(file, target, _)| (file.path(), target.as_path()));
    let journals = SetJournals::write(places.filter(|_| is_set)).map_err(|error| refusal(ready[0].2, &error))?;
    let mut placed: Vec<PlacedFile> = Vec::new();
    for (file, target, path) in ready {
        match PlacedFile::place(file, target, is_set) {
            Ok(one) => placed.push(one),
            Err(error) => {
                // Nothing of the set may be completed any more.
                drop(journals);
                placed.into_iter().rev().for_each(PlacedFile::take_back);
                return Err(refusal(path, &error).into());
            }
        }
    }
    if durability == Durability::Disk {
        for folder in placed.iter().map(|one| folder_of(&one.target)).collect::<BTreeSet<_>>() {
            // The new name is on the disk only when its folder is; a file system that cannot say so has done what it can.
            let _ = File::open(folder).and_then(|folder| folder.sync_all());
        }
    }
    Ok(())
}

/// A file that has taken its place.
struct PlacedFile {
    target: PathBuf,
    /// The file that it replaced, which is removed when the whole set has its places; `None` where there was none, or where the file system
    /// gives a file no second name.
    replaced: Option<TempPath>,
    is_new: bool,
}

impl PlacedFile {
    /// Renames a file; what it replaces is kept where others follow that could fail.
    fn place(file: NamedTempFile, target: PathBuf, is_set: bool) -> io::Result<PlacedFile> {
        let is_new = !target.exists();
        let replaced = if is_new || !is_set { None } else { second_name(&target) };
        file.persist(&target).map_err(|error| error.error)?;
        Ok(PlacedFile { target, replaced, is_new })
    }

    /// Puts back what was there before.
    fn take_back(self) {
        // The reason why the set fails is told; that this fails as well would only hide it.
        let _ = match self.replaced {
            Some(replaced) => replaced.persist(&self.target).map_err(|error| error.error),
            None if self.is_new => fs::remove_file(&self.target),
            None => Ok(()),
        };
    }
}

/// A second name of a file, beside it, which is removed with the value.
fn second_name(path: &Path) -> Option<TempPath> {
    let name = temporary().make_in(folder_of(path), |name| fs::hard_link(path, name)).ok()?;
    Some(name.into_temp_path())
}

/// A file that is written line by line, and takes its place as a whole when it is finished: for results that memory need not hold.
/// A pipe, or another place that is no regular file, gets them at once.
pub struct FileStream {
    writer: BufWriter<File>,
    /// The file beside its place, and the place.
    beside: Option<(NamedTempFile, PathBuf)>,
    /// The place as the user calls it.
    path: PathBuf,
}

impl FileStream {
    /// The beginning of a file.
    ///
    /// # Errors
    /// Places that [`check_target`] refuses, and a folder that cannot be written.
    pub fn new(path: &Path) -> Result<FileStream, Report> {
        check_target(path)?;
        let begun = || {
            let target = behind_links(path);
            if fs::metadata(&target).is_ok_and(|metadata| !metadata.is_file()) {
                return Ok((File::create(&target)?, None));
            }
            leftover::clean(&folder_of(&target));
            let file = begun_beside(&target)?;
            Ok((file.reopen()?, Some((file, target))))
        };
        let (file, beside) = begun().map_err(|error: io::Error| refusal(path, &error))?;
        Ok(FileStream { writer: BufWriter::new(file), beside, path: path.to_owned() })
    }

    /// Adds a line.
    ///
    /// # Errors
    /// A disk that is full, and a reader that went away.
    pub fn line(&mut self, text: &str) -> Result<(), Report> {
        writeln!(self.writer, "{text}").map_err(|error| refusal(&self.path, &error).into())
    }

    /// Lets the file take its place.
    ///
    /// # Errors
    /// A disk that is full, or a place that cannot be written.
    pub fn finish(mut self) -> Result<(), Report> {
        self.writer.flush().map_err(|error| refusal(&self.path, &error))?;
        if let Some((file, target)) = self.beside {
            file.persist(&target).map_err(|error| refusal(&self.path, &error.error))?;
        }
        Ok(())
    }
}

/// Writes what has no file to be renamed: standard output, pipes, terminals. A reader that went away wants no more.
fn written_in_place(path: &Path, octets: &[u8]) -> io::Result<()> {
    let written = match path == Path::new(STANDARD) {
        true => {
            let mut out = io::stdout().lock();
            out.write_all(octets).and_then(|()| out.flush())
        }
        false => fs::write(path, octets),
    };
    written.or_else(|error| if error.kind() == ErrorKind::BrokenPipe { Ok(()) } else { Err(error) })
}

/// Links that are followed at most, as Linux does.
const MOST_LINKS: usize = 40;

/// The file to which a path leads through links, there or not: a link keeps leading to the file that is written.
fn behind_links(path: &Path) -> PathBuf {
    if let Ok(target) = fs::canonicalize(path) {
        return target;
    }
    // What the last link names is not there yet, so the links are followed one by one.
    let mut target = path.to_owned();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&target) {
            Ok(next) => target = folder_of(&target).join(next),
            Err(_) => break,
        }
    }
    target
}

fn refusal(path: &Path, error: &io::Error) -> Diagnostic {
    let reason = match error.kind() {
        ErrorKind::PermissionDenied => "this user must not write there".to_owned(),
        // Errors of `tempfile` name the temporary file, which means nothing to a user.
        _ => error.to_string().split(" at path ").next().unwrap_or_default().to_owned(),
    };
    match path == Path::new(STANDARD) {
        true => Diagnostic::error(format!("standard output cannot be written: {reason}")),
        false => Diagnostic::error(format!("{} cannot be written: {reason}", path.display())),
    }
}

/// An empty file beside its place, locked for as long as this run lives, with the permissions of the file that it replaces.
fn begun_beside(path: &Path) -> io::Result<NamedTempFile> {
    let mut builder = temporary();
    let permissions = fresh_permissions();
    if let Some(permissions) = &permissions {
        builder.permissions(permissions.clone());
    }
    let file = builder.tempfile_in(folder_of(path))?;
    // A file system without locks has its leftovers told by the number of the process alone.
    let _ = file.as_file().try_lock();
    if let Ok(replaced) = fs::metadata(path) {
        file.as_file().set_permissions(replaced.permissions())?;
    }
    Ok(file)
}

/// A file beside its place with all of its octets.
fn written_beside(path: &Path, octets: &[u8], durability: Durability) -> io::Result<NamedTempFile> {
    let mut file = begun_beside(path)?;
    file.write_all(octets)?;
    if durability == Durability::Disk {
        file.as_file().sync_all()?;
    }
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
    fn what_was_there_comes_back_where_a_set_fails_in_the_middle() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("old"), "old").unwrap();
        let file = |name: &str| written_beside(&at(name), b"new", Durability::Cache).unwrap();
        let placed = ["old", "fresh"].map(|name| PlacedFile::place(file(name), at(name), true).unwrap());
        assert_eq!((fs::read(at("old")).unwrap(), fs::read(at("fresh")).unwrap()), (b"new".to_vec(), b"new".to_vec()));
        placed.into_iter().for_each(PlacedFile::take_back);
        assert_eq!(fs::read(at("old")).unwrap(), b"old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "only what was there before");
    }

    #[test]
    fn a_stream_has_its_place_when_it_is_finished_and_leaves_nothing_when_it_is_dropped() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("lines");
        let mut stream = FileStream::new(&path).unwrap();
        stream.line("one").unwrap();
        assert!(!path.exists());
        stream.finish().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"one\n");
        FileStream::new(&path).unwrap().line("two").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"one\n");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
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
        // The same where the file is not there yet.
        fs::remove_file(&file).unwrap();
        write(&link, b"newer").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&file).unwrap(), b"newer");
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
