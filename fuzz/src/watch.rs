//! Limits of an input and all runs that it makes: a thread looks at the clock of the process and at what is allocated, and ends the process where one takes too much. What
//! is being tried stands in a file, so that it is known whatever the end is.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use peak_alloc::PeakAlloc;

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// Run that is under way, 0 between runs.
static RUN: AtomicU64 = AtomicU64::new(0);

/// Octets that were allocated before the input was tried.
static BEFORE: AtomicU64 = AtomicU64::new(0);

/// Time between two looks.
const LOOK: Duration = Duration::from_millis(100);

/// Exit code of a process that was ended by its watch.
pub const ENDED: i32 = 3;

/// CPU time of this process in milliseconds; none where the system does not tell.
fn cpu_time() -> Option<u64> {
    // Behind the name, which ends with `)`: fields 14 and 15 of proc(5) are ticks of 10 ms in user and system mode.
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    let fields: Vec<&str> = stat.rsplit(") ").next()?.split(' ').collect();
    Some(10 * (fields.get(11)?.parse::<u64>().ok()? + fields.get(12)?.parse::<u64>().ok()?))
}

/// Watch of one process.
pub struct RunWatch {
    file: File,
    path: PathBuf,
}

impl RunWatch {
    /// Starts to watch: an input may take so many milliseconds of CPU time, and many times the octets that are allowed before it is cut off.
    pub fn new(path: &Path, longest: u64, memory: usize) -> std::io::Result<RunWatch> {
        let file = File::create(path)?;
        std::thread::spawn(move || watch(longest, memory));
        Ok(RunWatch { file, path: path.to_owned() })
    }

    /// Notes the input that is tried next.
    pub fn begin(&mut self, run: u64, input: &[u8]) -> std::io::Result<()> {
        self.write(run, input)?;
        ALLOCATOR.reset_peak_usage();
        BEFORE.store(ALLOCATOR.current_usage() as u64, Ordering::Relaxed);
        RUN.store(run + 1, Ordering::Release);
        Ok(())
    }

    /// Ends an input and yields the octets that it had allocated at once.
    pub fn end(&mut self) -> usize {
        RUN.store(0, Ordering::Release);
        ALLOCATOR.peak_usage().saturating_sub(BEFORE.load(Ordering::Relaxed) as usize)
    }

    #[cfg(unix)]
    fn write(&mut self, run: u64, input: &[u8]) -> std::io::Result<()> {
        use std::os::unix::fs::FileExt;
        let head = [run.to_le_bytes(), (input.len() as u64).to_le_bytes()].concat();
        self.file.write_all_at(&[&head, input].concat(), 0)
    }

    #[cfg(not(unix))]
    fn write(&mut self, run: u64, input: &[u8]) -> std::io::Result<()> {
        use std::io::{Seek, SeekFrom};
        self.file.seek(SeekFrom::Start(0))?;
        let head = [run.to_le_bytes(), (input.len() as u64).to_le_bytes()].concat();
        self.file.write_all(&[&head, input].concat())
    }

    /// The file goes away with a process that ended well.
    pub fn finish(mut self) -> std::io::Result<()> {
        self.file.flush()?;
        std::fs::remove_file(self.path)
    }
}

/// The run and the input that a process was at.
pub fn last(path: &Path) -> Option<(u64, Vec<u8>)> {
    let octets = std::fs::read(path).ok()?;
    let number = |at: usize| Some(u64::from_le_bytes(octets.get(at..at + 8)?.try_into().ok()?));
    let length = number(8)? as usize;
    Some((number(0)?, octets.get(16..16 + length)?.to_vec()))
}

fn watch(longest: u64, memory: usize) {
    let mut run = 0;
    let mut since = 0;
    let mut looks = 0;
    loop {
        std::thread::sleep(LOOK);
        looks += 1;
        let now = cpu_time().unwrap_or(looks * LOOK.as_millis() as u64);
        let current = RUN.load(Ordering::Acquire);
        if current != run || current == 0 {
            (run, since) = (current, now);
        } else if now - since > longest {
            eprintln!("an input takes more than {longest} ms of CPU time");
            std::process::exit(ENDED);
        }
        let taken = (ALLOCATOR.current_usage() as u64).saturating_sub(BEFORE.load(Ordering::Relaxed));
        if current != 0 && taken > 4 * memory as u64 {
            eprintln!("an input has allocated {taken} octets, of which {memory} are allowed");
            std::process::exit(ENDED);
        }
    }
}
