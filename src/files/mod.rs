//! Files that commands read and write: what is refused before anything is read or written. Writing itself is in `set`.

mod journal;
mod leftover;
pub mod map;
pub mod picture;
pub mod program;
mod set;

use std::fs;
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use messages::{Diagnostic, Report, Source, refuse_packed, refuse_utf16, with_plain_ends};

pub use self::set::{FileStream, write, write_all, write_through};

/// Octets of the largest file that is read: sources, programs, machines, memory.
const LARGEST: u64 = 64 << 20;

/// In the place of a file's name, standard input where it is read and standard output where it is written.
pub const STANDARD: &str = "-";

/// Name of a file in messages.
pub fn shown(path: &Path) -> String {
    if path == Path::new(STANDARD) { "<standard input>".to_owned() } else { path.display().to_string() }
}

/// All octets of a file, or of standard input where the name is [`STANDARD`].
///
/// # Errors
/// A file that is missing, too large, compressed, or cannot be read.
pub fn read(path: &Path) -> Result<Vec<u8>, Report> {
    read_up_to(LARGEST, path)
}

/// Opens a file that a user names, to be read a piece at a time.
///
/// # Errors
/// Those of the system.
pub fn open(path: &Path) -> io::Result<fs::File> {
    fs::File::open(path)
}

/// All octets of a file that may have no more than `largest`.
///
/// # Errors
/// See [`read`].
pub fn read_up_to(largest: u64, path: &Path) -> Result<Vec<u8>, Report> {
    let shown = shown(path);
    let refuse = |error: io::Error| match error.kind() {
        ErrorKind::NotFound => Diagnostic::error(format!("there is no file {shown}")),
        ErrorKind::PermissionDenied => Diagnostic::error(format!("{shown} must not be read by this user")),
        _ => Diagnostic::error(format!("{shown} cannot be read: {error}")),
    };
    if path.is_dir() {
        return Err(Diagnostic::error(format!("{shown} is a folder, not a file")).into());
    }
    if path == Path::new(STANDARD) {
        return scenes::read::standard_input(largest);
    }
    let size = if largest < 1 << 20 { format!("{} KiB", largest >> 10) } else { format!("{} MiB", largest >> 20) };
    let too_large = || Diagnostic::error(format!("{shown} is larger than {size}"));
    let input = fs::File::open(path).map_err(refuse)?;
    let length = input.metadata().map_or(0, |metadata| metadata.len());
    if length > largest {
        return Err(too_large().into());
    }
    let mut octets = Vec::with_capacity(length as usize);
    // Files that have no length, such as pipes, and those that grow.
    input.take(largest + 1).read_to_end(&mut octets).map_err(refuse)?;
    if octets.len() as u64 > largest { Err(too_large().into()) } else { Ok(octets) }
}

/// The text of a file; octets that are not UTF-8 are replaced.
///
/// # Errors
/// See [`read`].
pub fn source(path: &Path) -> Result<Arc<Source>, Report> {
    source_of(path, read(path)?)
}

/// The text of a file that has been read; a Ctrl-Z at its end is dropped, and what is not UTF-8 replaced.
///
/// # Errors
/// Compressed files and UTF-16, which are no text here.
pub fn source_of(path: &Path, octets: Vec<u8>) -> Result<Arc<Source>, Report> {
    let name = shown(path);
    refuse_packed(&octets, &name)?;
    refuse_utf16(&octets, &name)?;
    Ok(Source::new(name, with_plain_ends(text(octets))))
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
    if path == Path::new(STANDARD) {
        return Ok(());
    }
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

/// Check as [`check_target`] does, and that a file can be made there: a result of hours is not lost to a folder that cannot be written.
///
/// # Errors
/// See [`check_target`]; a folder or disk that takes no file.
pub fn check_writable(path: &Path) -> Result<(), Report> {
    check_target(path)?;
    // A pipe is opened once, by whoever writes to it.
    if path != Path::new(STANDARD) && fs::metadata(path).map_or(true, |metadata| metadata.is_file()) {
        FileStream::new(path)?;
    }
    Ok(())
}

fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
        _ => PathBuf::from("."),
    }
}

/// True where a result goes to standard output, so that nothing else is printed there.
///
/// # Errors
/// Two such results; `is_printed` says that what is printed is one by itself, such as JSON.
pub fn takes_output<'a>(results: impl IntoIterator<Item = &'a Path>, is_printed: bool) -> Result<bool, Report> {
    let named = results.into_iter().filter(|path| *path == Path::new(STANDARD)).count();
    if named + usize::from(is_printed) > 1 && named > 0 {
        let message = Diagnostic::error("two results would go to standard output");
        return Err(message.hint("one `-`, or one `--json`, at a time: name a file for the other").into());
    }
    Ok(named > 0)
}

/// One path for each file however it is spelt: links are followed, and a file that is not there yet has the path of its
/// folder. `None` for what cannot be overwritten, such as a pipe, a terminal or a standard stream.
fn identity(path: &Path) -> Option<PathBuf> {
    if path == Path::new(STANDARD) {
        return None;
    }
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
    fn two_results_do_not_share_a_file() {
        assert!(check_distinct([Path::new("a"), Path::new("b")]).is_ok());
        assert!(check_distinct([Path::new("a"), Path::new("b"), Path::new("a")]).is_err());
        assert!(check_distinct([Path::new("a"), Path::new("./a")]).is_err());
    }

    #[test]
    fn one_result_at_a_time_goes_to_standard_output() {
        let taken = |paths: &[&str], is_printed| takes_output(paths.iter().map(Path::new), is_printed).ok();
        assert_eq!(
            (taken(&["a"], true), taken(&[], true), taken(&["-", "a"], false)),
            (Some(false), Some(false), Some(true))
        );
        assert_eq!((taken(&["-", "-"], false), taken(&["-"], true)), (None, None));
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
