//! Journal of a set: while the files of one command take their places, a file beside them says which belongs where, so that the next run after a
//! kill in between puts the rest in place, and nobody keeps a half of a set.

use std::collections::BTreeMap;
use std::fs::{self, Metadata};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use serde::{Deserialize, Serialize};
use tempfile::NamedTempFile;

use super::folder_of;
use super::leftover::{temporary, writer};

/// Ending of the names of journals.
pub const ENDING: &str = ".set";

/// Octets of the largest journal that is read.
const LARGEST: u64 = 1 << 20;

/// A file of a set, by names within the journal's folder.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct JournalEntry {
    /// The file as it was written, whole.
    written: String,
    /// Name that it takes.
    place: String,
    /// The file that has that name before it; none where there is none.
    before: Option<FileState>,
}

/// State of a file that tells whether somebody has changed it since.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct FileState {
    octets: u64,
    /// Nanoseconds since 1970 at which it was changed.
    changed: u64,
}

impl FileState {
    fn of(metadata: &Metadata) -> FileState {
        let changed = metadata.modified().ok().and_then(|time| time.duration_since(UNIX_EPOCH).ok());
        FileState { octets: metadata.len(), changed: changed.map_or(0, |time| time.as_nanos() as u64) }
    }

    fn at(path: &Path) -> Option<FileState> {
        fs::metadata(path).ok().map(|metadata| FileState::of(&metadata))
    }
}

/// Journals of a set of files, one in each folder that has two of them or more; they are locked as long as the value lives, and go away with it.
///
/// Between two folders, a kill can still part a set: no rename spans them.
pub struct SetJournals {
    _files: Vec<NamedTempFile>,
}

impl SetJournals {
    /// Writes down which files will take which places.
    ///
    /// # Errors
    /// A disk or folder that cannot be written.
    pub fn write<'a>(files: impl Iterator<Item = (&'a Path, &'a Path)>) -> io::Result<SetJournals> {
        let mut folders: BTreeMap<PathBuf, Vec<JournalEntry>> = BTreeMap::new();
        for (written, place) in files {
            let name = |path: &Path| Some(path.file_name()?.to_str()?.to_owned());
            // Names that are no text have no journal: a file of their set may then stand alone after a kill.
            if let (Some(written), Some(name)) = (name(written), name(place)) {
                let entry = JournalEntry { written, place: name, before: FileState::at(place) };
                folders.entry(folder_of(place)).or_default().push(entry);
            }
        }
        folders.retain(|_, entries| entries.len() > 1);
        let journal = |(folder, entries): (&PathBuf, &Vec<JournalEntry>)| {
            let mut file = temporary().suffix(ENDING).tempfile_in(folder)?;
            // A journal that was cut short is no JSON, and then nothing has been renamed.
            file.write_all(&serde_json::to_vec(entries)?)?;
            // File systems that know no locks have the number of the process alone.
            let _ = file.as_file().try_lock();
            Ok(file)
        };
        let files = folders.iter().map(journal).collect::<io::Result<Vec<_>>>()?;
        Ok(SetJournals { _files: files })
    }
}

/// Puts the files of a journal in their places, unless somebody has changed one of these places since. False where a file that waits is not held, and
/// the journal is still to be done.
pub fn complete(path: &Path, is_held: &dyn Fn(&Path) -> bool) -> bool {
    let folder = folder_of(path);
    let Some(entries) = read(path) else { return true };
    let waiting: Vec<&JournalEntry> = entries.iter().filter(|entry| folder.join(&entry.written).is_file()).collect();
    let is_unchanged = |entry: &&JournalEntry| FileState::at(&folder.join(&entry.place)) == entry.before;
    if !waiting.iter().all(|entry| is_held(&folder.join(&entry.written))) {
        return false;
    }
    // Where nothing has been renamed, the set is whole as it was.
    if waiting.len() < entries.len() && waiting.iter().all(is_unchanged) {
        for entry in waiting {
            // What cannot be renamed is removed as every leftover.
            let _ = fs::rename(folder.join(&entry.written), folder.join(&entry.place));
        }
    }
    true
}

/// The entries of a journal of this user's; none of one that is not whole, or that names anything but leftovers of its own run.
fn read(path: &Path) -> Option<Vec<JournalEntry>> {
    let is_small = fs::metadata(path).is_ok_and(|metadata| metadata.len() <= LARGEST);
    // In a folder that others may write, a journal of theirs must move nothing.
    if !is_small || !is_own(path) {
        return None;
    }
    let process = writer(path.file_name()?.to_str()?);
    let entries: Vec<JournalEntry> = serde_json::from_slice(&fs::read(path).ok()?).ok()?;
    let is_name = |name: &str| Path::new(name).file_name().is_some_and(|last| last == name);
    let is_right = |entry: &JournalEntry| {
        let written = path.with_file_name(&entry.written);
        let is_there = fs::symlink_metadata(&written).is_ok();
        is_name(&entry.place)
            && is_name(&entry.written)
            && writer(&entry.written) == process
            && (!is_there || is_own(&written))
    };
    entries.iter().all(is_right).then_some(entries)
}

/// True of a file of the user that runs this; false where the system does not say.
#[cfg(unix)]
fn is_own(path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let user = |path: &Path| fs::symlink_metadata(path).ok().map(|metadata| metadata.uid());
    user(path).is_some_and(|owner| fs::metadata("/proc/self").is_ok_and(|own| own.uid() == owner))
}

#[cfg(not(unix))]
fn is_own(_: &Path) -> bool {
    false
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::super::write;
    use super::*;

    const JOURNAL: &str = ".lancer-4294967295-Ab3dE9.set";

    /// A folder as a killed run leaves it after the first of two renames: `a` is new, `b` old, and the new `b` is beside it.
    fn halfway(entries: impl Fn(&Path) -> Vec<JournalEntry>) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        for (name, text) in [("a", "new"), ("b", "old"), (".lancer-4294967295-bbbbbb", "new")] {
            fs::write(at(name), text).unwrap();
        }
        fs::write(at(JOURNAL), serde_json::to_vec(&entries(folder.path())).unwrap()).unwrap();
        folder
    }

    fn entries(folder: &Path) -> Vec<JournalEntry> {
        let entry = |name: &str, place: &str| JournalEntry {
            written: format!(".lancer-4294967295-{name}"),
            place: place.to_owned(),
            before: FileState::at(&folder.join(place)),
        };
        vec![entry("aaaaaa", "a"), entry("bbbbbb", "b")]
    }

    /// The text of `b` after the next run, which must leave nothing beside it.
    fn after(folder: &Path) -> String {
        write(&folder.join("c"), b"next").unwrap();
        let mut names: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        assert_eq!(names, ["a", "b", "c"]);
        fs::read_to_string(folder.join("b")).unwrap()
    }

    #[test]
    fn the_next_run_completes_a_set() {
        assert_eq!(after(halfway(entries).path()), "new");
    }

    /// Another run that begins at the same time has a lock on the journal, or on what waits: the rest is its to complete.
    #[test]
    fn a_set_that_another_run_completes_is_left_to_it() {
        for held in [JOURNAL, ".lancer-4294967295-bbbbbb"] {
            let folder = halfway(entries);
            let other = fs::File::open(folder.path().join(held)).unwrap();
            other.lock().unwrap();
            write(&folder.path().join("c"), b"next").unwrap();
            assert_eq!(fs::read_to_string(folder.path().join("b")).unwrap(), "old", "{held}");
            assert!(folder.path().join(".lancer-4294967295-bbbbbb").exists(), "{held}");
            // With both free, the next run completes it.
            drop(other);
            fs::remove_file(folder.path().join("c")).unwrap();
            assert_eq!(after(folder.path()), "new", "{held}");
        }
    }

    #[test]
    fn a_place_that_somebody_has_changed_is_kept() {
        let folder = halfway(entries);
        fs::write(folder.path().join("b"), "changed").unwrap();
        assert_eq!(after(folder.path()), "changed");
    }

    #[test]
    fn a_set_of_which_nothing_was_renamed_stays_as_it_was() {
        let folder = halfway(entries);
        fs::write(folder.path().join(".lancer-4294967295-aaaaaa"), "new").unwrap();
        assert_eq!(after(folder.path()), "old");
    }

    #[test]
    fn a_journal_that_is_cut_short_or_names_what_is_elsewhere_moves_nothing() {
        let folder = halfway(entries);
        let whole = fs::read(folder.path().join(JOURNAL)).unwrap();
        fs::write(folder.path().join(JOURNAL), &whole[..whole.len() - 1]).unwrap();
        assert_eq!(after(folder.path()), "old");
        for (written, place) in [("bbbbbb", "../b"), ("../../b", "b"), ("bbbbbb/", "b")] {
            let folder = halfway(|folder| {
                let before = FileState::at(&folder.join("b"));
                let entry = |written: &str, place: &str| JournalEntry {
                    written: format!(".lancer-4294967295-{written}"),
                    place: place.to_owned(),
                    before: FileState::at(&folder.join(place)),
                };
                assert!(before.is_some());
                vec![entry("aaaaaa", "a"), entry("bbbbbb", "b"), entry(written, place)]
            });
            assert_eq!(after(folder.path()), "old", "{written} {place}");
        }
    }

    #[test]
    fn journals_stand_beside_two_files_or_more_and_go_away() {
        let folder = tempfile::tempdir().unwrap();
        let names = ["a", "b"].map(|name| folder.path().join(name));
        let count = || fs::read_dir(folder.path()).unwrap().count();
        let journals = SetJournals::write(names.iter().map(|name| (name.as_path(), name.as_path()))).unwrap();
        assert_eq!(count(), 1);
        let journal = fs::read_dir(folder.path()).unwrap().next().unwrap().unwrap().path();
        assert!(fs::File::open(&journal).unwrap().try_lock().is_err(), "a journal is locked while its run lives");
        drop(journals);
        drop(SetJournals::write(names.iter().take(1).map(|name| (name.as_path(), name.as_path()))).unwrap());
        assert_eq!(count(), 0);
    }
}
