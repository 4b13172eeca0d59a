//! The loop: change a kept input, try it, keep it where it leads to a new place.

use std::collections::HashSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::{Duration, Instant};

use random::SplitMix64;

use crate::find::Find;
use crate::mutate::{Mutator, words};
use crate::seen::{Seen, hash};
use crate::surface::{InputForm, Surface};
use crate::watch::RunWatch;

/// Inputs between two looks at the clock.
const LOOK: u64 = 32;

/// Most inputs that are kept of a surface. Beyond that a new one takes the place of any other.
const MOST_KEPT: usize = 20_000;

/// Most places that are told apart; beyond that nothing is new.
const MOST_PLACES: usize = 1 << 20;

/// The last panic: what it said and where.
static PANIC: Mutex<String> = Mutex::new(String::new());

/// End of a worker.
pub enum End {
    /// All runs went well.
    Clean,
    /// A run did not.
    Found(Find),
}

/// Wishes for a worker.
pub struct Wishes {
    /// Seed of the random numbers.
    pub seed: u64,
    /// Runs to make at most.
    pub runs: u64,
    /// Time to take at most.
    pub time: Duration,
    /// CPU time that a run may take, in milliseconds.
    pub longest: u64,
    /// Planted faults happen.
    pub has_planted: bool,
    /// Folder in which inputs are kept from one call to the next.
    pub corpus: Option<PathBuf>,
}

/// Keeps what panics say instead of printing it.
pub fn hold_panics() {
    std::panic::set_hook(Box::new(|info| {
        let mut panic = PANIC.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        // The first panic of a run is its cause.
        if panic.is_empty() {
            *panic = info.to_string();
        }
    }));
}

/// Tries one input: an error is what the panic said.
pub fn attempt(surface: &Surface, input: &[u8], seen: &mut Seen) -> Result<(), String> {
    PANIC.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).clear();
    catch_unwind(AssertUnwindSafe(|| (surface.run)(input, seen)))
        .map_err(|_| PANIC.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).clone())
}

/// Inputs of a folder, in the order of their names, which follow from what they hold; no more than are kept.
fn kept_in(folder: &Path) -> Vec<Vec<u8>> {
    paths_in(folder).iter().take(MOST_KEPT).filter_map(|path| std::fs::read(path).ok()).collect()
}

/// Paths of a folder, in order.
fn paths_in(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    paths
}

/// Name of the file of a kept input.
fn file_name(input: &[u8]) -> String {
    format!("{:016x}", hash(input.iter().copied()))
}

/// Writes kept inputs into a folder, and removes those of the tried seeds that lead nowhere new.
fn keep(folder: &Path, kept: &[Vec<u8>], tried: &[String]) -> std::io::Result<()> {
    std::fs::create_dir_all(folder)?;
    let names: HashSet<String> = kept.iter().map(|input| file_name(input)).collect();
    for input in kept {
        std::fs::write(folder.join(file_name(input)), input)?;
    }
    for name in tried.iter().filter(|name| !names.contains(*name)) {
        // Another process may have removed it.
        let _ = std::fs::remove_file(folder.join(name));
    }
    // Seeds that there was no time for may be too many with the new ones.
    for path in paths_in(folder).into_iter().skip(MOST_KEPT) {
        let _ = std::fs::remove_file(path);
    }
    Ok(())
}

/// Fuzzes a surface; `current` is the file of the input that is tried.
pub fn run(surface: &Surface, wishes: &Wishes, current: &Path) -> std::io::Result<End> {
    let start = Instant::now();
    let mut random = SplitMix64::new(wishes.seed ^ hash(surface.name.bytes()));
    let folder = wishes.corpus.as_ref().map(|corpus| corpus.join(surface.name));
    let mut seeds = (surface.seeds)();
    let from_project = seeds.len();
    hold_panics();
    seeds.extend(folder.as_deref().map(kept_in).unwrap_or_default());
    let mutator = Mutator {
        form: surface.form,
        longest: surface.longest.max(seeds.iter().map(Vec::len).max().unwrap_or(0)),
        words: words(&seeds),
    };
    let (mut kept, mut known): (Vec<Vec<u8>>, HashSet<u64>) = Default::default();
    let mut watch = RunWatch::new(current, wishes.longest, surface.memory)?;
    let (mut runs, mut inputs) = (0, 0);
    let seeds_read = seeds.len();
    let (mut seeds, mut tried) = (seeds.into_iter(), Vec::new());
    while runs < wishes.runs {
        if inputs % LOOK == 0 && start.elapsed() >= wishes.time {
            break;
        }
        let seed = seeds.next();
        let is_seed = seed.is_some();
        let input = seed.unwrap_or_else(|| mutator.next(&mut random, &kept));
        if is_seed {
            tried.push(file_name(&input));
        }
        watch.begin(inputs, &input)?;
        // Planted faults are for the harness to find, not for the seeds.
        let mut seen = Seen::new(&input, wishes.has_planted && !is_seed);
        let result = attempt(surface, &input, &mut seen);
        let octets = watch.end();
        let why = match result {
            Err(panic) => Some(panic),
            Ok(()) if octets > surface.memory => {
                Some(format!("{octets} octets were allocated at once, of which {} are allowed", surface.memory))
            }
            Ok(()) => None,
        };
        if let Some(why) = why {
            watch.finish()?;
            return Ok(End::Found(Find {
                target: surface.name.to_owned(),
                seed: wishes.seed,
                run: inputs,
                why,
                input,
            }));
        }
        runs += seen.runs();
        inputs += 1;
        let mut is_new = false;
        for &mark in seen.marks() {
            is_new |= known.len() < MOST_PLACES && known.insert(mark);
        }
        if is_new && surface.form != InputForm::Number {
            if kept.len() == MOST_KEPT {
                kept.swap_remove(random.below(MOST_KEPT as u64) as usize);
            }
            kept.push(input);
        }
    }
    watch.finish()?;
    if let Some(folder) = folder.filter(|_| surface.form != InputForm::Number) {
        keep(&folder, &kept, &tried)?;
    }
    let seconds = start.elapsed().as_secs_f64();
    println!(
        "{:<11} {runs:>10} runs of {inputs} inputs {seconds:>7.1} s {:>8.0} a second, seed {}, {from_project} + {} seeds, {} places, {} kept, no find",
        surface.name,
        runs as f64 / seconds,
        wishes.seed,
        seeds_read - from_project,
        known.len(),
        kept.len()
    );
    Ok(End::Clean)
}
