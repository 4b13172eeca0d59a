//! Recordings in a folder that processes share: each in a file of its own, whose name says all that it depends on. What is damaged is recorded
//! anew, and what was not used for the longest time makes room for others.

use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::sleep;
use std::time::{Duration, Instant, SystemTime};

use emu::machine::Setup;
use emu::octets::Memory;
use emu::replay::{RECORDING_FORMAT, Reason, Recorded};
use messages::{Diagnostic, Report};
use sha2::{Digest, Sha256};

use super::identity;
use crate::files;

/// Ending of the files' names.
pub const ENDING: &str = "recording";

/// First octets of every file.
const MAGIC: &[u8; 16] = b"lancer recording";

/// Octets of a file before those of the recording: the first ones, the format's version, the digest that names it, their number, and their SHA-256.
pub const HEAD: usize = MAGIC.len() + 4 + 32 + 8 + 32;

/// Folder of the locks, one for each first octet of a digest: their number has a bound, and none is ever removed while somebody may wait for it.
const LOCKS: &str = "locks";

/// Time for which a process waits for another one that makes the same recording, before it makes its own.
const PATIENCE: Duration = Duration::from_secs(60);

/// Time between two looks at a lock.
const PAUSE: Duration = Duration::from_millis(10);

/// A folder of recordings, and what came of it.
#[derive(Debug)]
pub struct RecordingStore {
    folder: PathBuf,
    /// Octets that the files may have together.
    limit: u64,
    patience: Duration,
    reused: AtomicU64,
    notes: Mutex<Vec<String>>,
}

impl RecordingStore {
    /// The store in a folder, which is made where it is not there. `limit` is in octets.
    ///
    /// # Errors
    /// A folder that cannot be made.
    pub fn open(folder: &Path, limit: u64) -> Result<RecordingStore, Report> {
        let refuse = |error: io::Error| {
            Diagnostic::error(format!("the folder {} for recordings cannot be made: {error}", folder.display()))
        };
        fs::create_dir_all(folder).map_err(refuse)?;
        let (reused, notes) = (AtomicU64::new(0), Mutex::new(Vec::new()));
        Ok(RecordingStore { folder: folder.to_owned(), limit, patience: PATIENCE, reused, notes })
    }

    /// The recording that has a digest: the one in the folder, else one that is made now and kept. Where another process is making it, that one is
    /// waited for.
    ///
    /// # Errors
    /// Reason for which the work items cannot be replayed.
    pub fn recording(&self, digest: &[u8; 32], setup: &Setup, memory: &Memory) -> Result<Recorded, Reason> {
        let mut found = self.read(digest, setup);
        let mut lock = None;
        if !matches!(found, Ok(Some(_))) {
            lock = self.lock(digest);
            // Whoever had the lock may have made it, or mended it.
            found = self.read(digest, setup);
        }
        match found {
            Ok(Some(recorded)) => {
                self.reused.fetch_add(1, Ordering::Relaxed);
                return Ok(recorded);
            }
            Ok(None) => {}
            Err(why) => self.note(format!("{} is recorded anew: {why}", self.path(digest).display())),
        }
        let recorded = Recorded::new(setup, memory)?;
        if let Some(octets) = recorded.encode() {
            self.keep(digest, &octets);
        }
        drop(lock);
        Ok(recorded)
    }

    /// Recordings that were in the folder.
    pub fn reused(&self) -> u64 {
        self.reused.load(Ordering::Relaxed)
    }

    /// Remarks on what could not be used or kept, each told once.
    pub fn take_notes(&self) -> Vec<String> {
        std::mem::take(&mut self.notes.lock().expect("no writer of a note panics"))
    }

    fn note(&self, text: String) {
        self.notes.lock().expect("no writer of a note panics").push(text);
    }

    /// Place of a recording. Versions of the format have files of their own, and that of the program is part of the digest.
    fn path(&self, digest: &[u8; 32]) -> PathBuf {
        self.folder.join(format!("{}-{RECORDING_FORMAT}.{ENDING}", identity::shown(digest)))
    }

    /// A recording in the folder; `None` where there is none.
    ///
    /// # Errors
    /// Reason for which its file is none.
    fn read(&self, digest: &[u8; 32], setup: &Setup) -> Result<Option<Recorded>, String> {
        let path = self.path(digest);
        // A pipe of that name would never be opened.
        if path.metadata().is_ok_and(|metadata| !metadata.is_file()) {
            return Err("it is no file".to_owned());
        }
        // A file that is open stays whole, whoever removes it or puts another one in its place.
        let file = match File::open(path) {
            Ok(file) => file,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(unreadable(error)),
        };
        let length = file.metadata().map_err(unreadable)?.len();
        let octets = unsealed(&file, length, digest, self.limit)?;
        let recorded = Recorded::decode(setup, &octets)?;
        // The time of the last use says which one makes room; where it cannot be set, that of writing does.
        let _ = file.set_modified(SystemTime::now());
        Ok(Some(recorded))
    }

    /// Writes a recording, and removes others where all together would be too large. What cannot be written is none of the study's business.
    fn keep(&self, digest: &[u8; 32], octets: &[u8]) {
        let size = (HEAD + octets.len()) as u64;
        if size > self.limit {
            return self.note(format!(
                "a recording of {} MiB is not kept: the folder may have {} MiB",
                size.div_ceil(1 << 20),
                self.limit >> 20
            ));
        }
        let whole = sealed(octets, digest);
        // Making room and taking it is one step, or two processes would take the same room.
        let room = self.lock_named("room");
        let path = self.path(digest);
        let kept = self.make_room(size, &path).map_err(|error| error.to_string()).and_then(|()| {
            files::write(&path, &whole)
                .map_err(|report| report.0.into_iter().map(|message| message.message).collect::<Vec<_>>().join("; "))
        });
        drop(room);
        if let Err(why) = kept {
            self.note(format!("a recording is not kept: {why}"));
        }
    }

    /// Removes files, the one that was not used for the longest time first, until so many octets more fit in. What `place` holds will be replaced
    /// and needs no room.
    fn make_room(&self, size: u64, place: &Path) -> io::Result<()> {
        let mut kept = Vec::new();
        for entry in fs::read_dir(&self.folder)? {
            let path = entry?.path();
            if path.extension().is_some_and(|ending| ending == ENDING) && path != place {
                // Another process may have removed it.
                let Ok(metadata) = fs::symlink_metadata(&path) else { continue };
                if metadata.is_file() {
                    kept.push((metadata.modified().unwrap_or(SystemTime::UNIX_EPOCH), path, metadata.len()));
                }
            }
        }
        kept.sort();
        let mut all: u64 = kept.iter().map(|(.., octets)| octets).sum();
        for (_, path, octets) in kept {
            if all + size <= self.limit {
                break;
            }
            fs::remove_file(path)
                .or_else(|error| if error.kind() == ErrorKind::NotFound { Ok(()) } else { Err(error) })?;
            all -= octets;
        }
        Ok(())
    }

    /// The right to make recordings whose digest begins with this octet. `None` where locks do not work here, or somebody has it for too long:
    /// two recordings of the same do no harm.
    fn lock(&self, digest: &[u8; 32]) -> Option<File> {
        self.lock_named(&format!("{:02x}", digest[0]))
    }

    /// A lock by its name; the system takes it back when its process ends, however that ends.
    fn lock_named(&self, name: &str) -> Option<File> {
        let folder = self.folder.join(LOCKS);
        fs::create_dir_all(&folder).ok()?;
        let file = File::options().write(true).create(true).truncate(false).open(folder.join(name)).ok()?;
        let start = Instant::now();
        loop {
            match file.try_lock() {
                Ok(()) => return Some(file),
                Err(TryLockError::WouldBlock) if start.elapsed() < self.patience => sleep(PAUSE),
                Err(_) => return None,
            }
        }
    }
}

fn unreadable(error: io::Error) -> String {
    format!("it cannot be read: {error}")
}

/// The file of a recording's octets: behind a head that has their SHA-256 and the digest that names them.
pub fn sealed(octets: &[u8], digest: &[u8; 32]) -> Vec<u8> {
    let mut whole = Vec::with_capacity(HEAD + octets.len());
    whole.extend_from_slice(MAGIC);
    whole.extend_from_slice(&RECORDING_FORMAT.to_le_bytes());
    whole.extend_from_slice(digest);
    whole.extend_from_slice(&(octets.len() as u64).to_le_bytes());
    whole.extend_from_slice(&Sha256::digest(octets));
    whole.extend_from_slice(octets);
    whole
}

/// The octets of a recording in a file of so many octets, which has the digest as its name. Those of the file may be no more than `limit`.
///
/// # Errors
/// Reason for which the file is not as it was written, or is another one.
pub fn unsealed(mut file: impl Read, length: u64, digest: &[u8; 32], limit: u64) -> Result<Vec<u8>, String> {
    if length < HEAD as u64 {
        return Err("it is cut short".to_owned());
    }
    if length > limit {
        return Err(format!("it is larger than {} MiB, which the folder may have", limit >> 20));
    }
    let mut head = [0; HEAD];
    file.read_exact(&mut head).map_err(unreadable)?;
    let mut rest = &head[..];
    let mut part = |octets: usize| rest.split_off(..octets).expect("the head has all its parts");
    let (magic, version, name, octets, sum) = (part(MAGIC.len()), part(4), part(32), part(8), part(32));
    if magic != MAGIC {
        return Err("it is no recording".to_owned());
    }
    if version != RECORDING_FORMAT.to_le_bytes() {
        return Err("it has another version of the format".to_owned());
    }
    if name != digest {
        return Err("it is another recording under this name".to_owned());
    }
    if octets != (length - HEAD as u64).to_le_bytes() {
        return Err("it is cut short, or longer than it says".to_owned());
    }
    // No more is read than the file had when it was looked at, in case it grows.
    let mut octets = Vec::with_capacity((length - HEAD as u64) as usize);
    file.take(length - HEAD as u64).read_to_end(&mut octets).map_err(unreadable)?;
    if Sha256::digest(&octets)[..] != *sum {
        return Err("it was changed, or cut short".to_owned());
    }
    Ok(octets)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A store of so many octets in a folder of its own, with digests that begin with other octets.
    fn store(limit: u64) -> (tempfile::TempDir, RecordingStore) {
        let folder = tempfile::tempdir().unwrap();
        let store = RecordingStore::open(&folder.path().join("made/here"), limit).unwrap();
        (folder, RecordingStore { patience: Duration::from_millis(30), ..store })
    }

    #[test]
    fn what_was_not_used_for_the_longest_time_makes_room() {
        const SIZE: u64 = HEAD as u64 + 100;
        let (_folder, store) = store(3 * SIZE);
        let is_there = |digit: u8| store.path(&[digit; 32]).exists();
        for digit in 1..=3 {
            store.keep(&[digit; 32], &[digit; 100]);
            let file = File::options().write(true).open(store.path(&[digit; 32])).unwrap();
            file.set_modified(SystemTime::UNIX_EPOCH + Duration::from_secs(digit.into())).unwrap();
        }
        // The first one is used again, so the second one is the oldest.
        let first = File::open(store.path(&[1; 32])).unwrap();
        assert_eq!(unsealed(&first, SIZE, &[1; 32], store.limit), Ok(vec![1; 100]));
        first.set_modified(SystemTime::UNIX_EPOCH + Duration::from_secs(9)).unwrap();
        store.keep(&[4; 32], &[4; 100]);
        assert_eq!([1, 2, 3, 4].map(is_there), [true, false, true, true]);
        // One in the place of another needs no more room than that.
        store.keep(&[4; 32], &[5; 100]);
        assert_eq!([1, 2, 3, 4].map(is_there), [true, false, true, true]);
        // A file that is open stays whole when it makes room; what is no recording stays.
        let third = File::open(store.path(&[3; 32])).unwrap();
        fs::write(store.folder.join("notes"), [0; 5_000]).unwrap();
        store.keep(&[6; 32], &[6; 250]);
        assert_eq!([1, 3, 4, 6].map(is_there), [false, false, true, true]);
        assert_eq!(unsealed(&third, SIZE, &[3; 32], store.limit), Ok(vec![3; 100]));
        assert!(store.folder.join("notes").exists() && store.take_notes().is_empty());
    }

    #[test]
    fn a_lock_that_somebody_keeps_is_waited_for_and_then_done_without() {
        let (_folder, store) = store(1 << 20);
        let lock = store.lock(&[7; 32]).unwrap();
        assert!(store.lock(&[7; 32]).is_none() && store.lock(&[8; 32]).is_some());
        drop(lock);
        assert!(store.lock(&[7; 32]).is_some());
    }
}
