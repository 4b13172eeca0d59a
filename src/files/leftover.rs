//! Leftovers of runs that were killed: their names, and the next run in a folder that completes what only had to be renamed and removes the rest.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use tempfile::Builder;

use super::journal::{ENDING, complete};

/// First part of the names of files that are being written.
const PREFIX: &str = ".lancer-";

/// Entries of a folder among which leftovers are looked for: a folder of a million files must not make a result slow.
const MOST_ENTRIES: usize = 10_000;

/// Names of files that are being written, with the number of this process.
pub fn temporary() -> Builder<'static, 'static> {
    static NAME: LazyLock<String> = LazyLock::new(|| format!("{PREFIX}{}-", std::process::id()));
    let mut builder = Builder::new();
    builder.prefix(NAME.as_str());
    builder
}

/// Completes and removes what killed runs have left in a folder, as far as that is possible; nothing in a folder with more entries than are looked at.
///
/// Leftovers stay locked until the end, so that of two runs which begin at once one has each file and the other leaves it. A file of a set waits for its
/// journal: it is removed by a run that has both, or that sees no journal of the same writer.
pub fn clean(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    let mut paths: Vec<PathBuf> = entries.take(MOST_ENTRIES + 1).flatten().map(|entry| entry.path()).collect();
    if paths.len() > MOST_ENTRIES {
        return;
    }
    paths.retain(|path| writer_of(path).is_some_and(|process| !is_running(process)));
    let is_journal = |path: &Path| path.extension().is_some_and(|ending| ending == &ENDING[1..]);
    let held: BTreeMap<PathBuf, File> = paths.iter().filter_map(|path| Some((path.clone(), locked(path)?))).collect();
    // Complete the sets of which everything that waits is held; the others are another run's, or the next one's.
    let is_done =
        |journal: &&PathBuf| held.contains_key(*journal) && complete(journal, &|file| held.contains_key(file));
    let journals = paths.iter().filter(|path| is_journal(path));
    let (done, open): (Vec<&PathBuf>, Vec<&PathBuf>) = journals.partition(is_done);
    let open: BTreeSet<Option<u32>> = open.into_iter().map(|path| writer_of(path)).collect();
    let rest = held.keys().filter(|path| !is_journal(path) && !open.contains(&writer_of(path)));
    for path in rest.chain(done) {
        // What has taken its place is no leftover any more.
        let _ = fs::remove_file(path);
    }
}

fn writer_of(path: &Path) -> Option<u32> {
    writer(path.file_name()?.to_str()?)
}

/// Number of the process that writes a file, by the file's name; `None` for a name that no run gives: `.lancer-217-a8Kd0z` is one of
/// process 217, with `.set` behind it the journal of a set, and `.lancer-notes` is a user's.
pub fn writer(name: &str) -> Option<u32> {
    let (process, random) = name.strip_suffix(ENDING).unwrap_or(name).strip_prefix(PREFIX)?.split_once('-')?;
    let is_given = random.len() == 6 && random.bytes().all(|octet| octet.is_ascii_alphanumeric());
    process.parse().ok().filter(|_| is_given)
}

/// True where a process may still be there.
fn is_running(process: u32) -> bool {
    process == std::process::id() || Path::new("/proc").join(process.to_string()).is_dir()
}

/// A regular file, locked; `None` of anything else, and of one that another run has locked.
fn locked(path: &Path) -> Option<File> {
    let is_file = fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_file());
    let file = is_file.then(|| File::open(path).ok()).flatten()?;
    file.try_lock().is_ok().then_some(file)
}

#[cfg(test)]
mod tests {
    use super::super::write;
    use super::*;

    #[test]
    fn leftovers_of_killed_runs_are_removed_and_files_of_running_ones_are_not() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        // No process has these numbers on a host with /proc; the last three are names that a user may give.
        let (left_over, locked) = (".lancer-4294967295-Ab3dE9", ".lancer-4294967294-Ab3dE9");
        let of_users = [".lancer-notes", ".lancer-4294967295-my.toml", ".other"];
        for name in [left_over, locked].iter().chain(&of_users) {
            fs::write(at(name), "half").unwrap();
        }
        let running = format!(".lancer-{}-Ab3dE9", std::process::id());
        fs::write(at(&running), "half").unwrap();
        let locked_file = File::open(at(locked)).unwrap();
        locked_file.lock().unwrap();
        write(&at("a.txt"), b"whole").unwrap();
        let mut left: Vec<String> = fs::read_dir(folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        left.sort();
        let mut expected = [&[running.as_str(), locked, "a.txt"], &of_users[..]].concat();
        expected.sort();
        assert_eq!(left, expected);
    }
}
