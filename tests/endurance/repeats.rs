//! Repeats of a run under other circumstances: numbers of host threads, engines, folders and builds. Every result has the same octets.
//!
//! With `LANCER_OTHER=target/release/lancer`, half of the runs are those of another build of the program.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use super::{command, runs};

/// A command that prints JSON or a table, and the files that it writes.
struct RepeatedCommand {
    words: &'static str,
    files: &'static [&'static str],
    /// `--engine` is an option of it.
    has_engine: bool,
}

/// A picture that is replayed, one of kernels that follow the report with all maps, one that is stepped, a study, a run of the catalogue.
const COMMANDS: [RepeatedCommand; 5] = [
    RepeatedCommand {
        words: "render cornell --size 16x12 --json -o a.png --heat h.png --error e.png",
        files: &["a.png", "h.png", "e.png"],
        has_engine: true,
    },
    RepeatedCommand {
        words: "render slabs --size 12x9 --profile report --word 28 --cores 3 --arbiter tdma --json -o a.ppm",
        files: &["a.ppm"],
        has_engine: true,
    },
    RepeatedCommand {
        words: "cores triangle --size 8x6 --cores 1,2,5 --svg c.svg",
        files: &["c.svg", "c.csv"],
        has_engine: false,
    },
    RepeatedCommand {
        words: "accuracy triangle --size 8x6 --words 32,20 --profiles ray,vector --svg a.svg",
        files: &["a.svg", "a.csv"],
        has_engine: false,
    },
    RepeatedCommand { words: "stress --case colours --json", files: &[], has_engine: false },
];

const THREADS: [u32; 5] = [1, 2, 3, 5, 16];
const ENGINES: [&str; 2] = ["native", "checked"];
const FOLDERS: [&str; 5] = ["plain", "a b", "é/ü", "a/b/c/d/e/f/g/h", "'$(quoted)"];

/// Runs of each command where no number is asked for.
const FEW: usize = 4;

/// Removes what says which host and which engine computed a result.
fn without_host(value: &mut Value) {
    match value {
        Value::Object(keys) => {
            ["host", "engine", "timing", "threads"].iter().for_each(|key| drop(keys.remove(*key)));
            keys.values_mut().for_each(without_host);
        }
        Value::Array(items) => items.iter_mut().for_each(without_host),
        _ => {}
    }
}

/// Printed text and files of a run.
fn outcome(program: &str, tried: &RepeatedCommand, options: &str, folder: &Path) -> Vec<Vec<u8>> {
    let words = format!("{} {options}", tried.words);
    let mut command: Command = command(program, &words, folder);
    let output =
        command.stdout(std::process::Stdio::piped()).output().unwrap_or_else(|error| panic!("{program}: {error}"));
    assert!(output.status.success(), "{program} {words}: {}", output.status);
    let printed = match serde_json::from_slice::<Value>(&output.stdout) {
        Err(_) => output.stdout,
        Ok(mut value) => {
            without_host(&mut value);
            value.to_string().into_bytes()
        }
    };
    let files =
        tried.files.iter().map(|name| fs::read(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}")));
    [printed].into_iter().chain(files).collect()
}

#[test]
fn results_depend_on_no_thread_no_folder_no_engine_and_no_build() {
    let own = env!("CARGO_BIN_EXE_lancer").to_owned();
    let other = std::env::var("LANCER_OTHER").ok();
    let other = other.map(|path| fs::canonicalize(&path).unwrap_or_else(|error| panic!("{path}: {error}")));
    let programs: Vec<String> = [own].into_iter().chain(other.map(|path| path.display().to_string())).collect();
    let root = tempfile::tempdir().unwrap();
    for tried in &COMMANDS {
        let mut first = None;
        let all = runs().unwrap_or(FEW);
        for number in 0..all {
            // Each number goes through its list at a pace of its own: with 100 runs every pair of values is met.
            let threads = THREADS[number % THREADS.len()];
            let folder = root.path().join(FOLDERS[number / 5 % FOLDERS.len()]);
            let engine = ENGINES[(number + number / 25) % ENGINES.len()];
            let program = &programs[(number + number / 50) / 2 % programs.len()];
            fs::create_dir_all(&folder).unwrap();
            let engine = if tried.has_engine { format!("--engine {engine}") } else { String::new() };
            let options = format!("--threads {threads} {engine}");
            let outcome = outcome(program, tried, &options, &folder);
            let first = first.get_or_insert_with(|| outcome.clone());
            assert!(*first == outcome, "{program} {} {options} in {}: another result", tried.words, folder.display());
        }
        println!("{all:>5} runs, one result: {}", tried.words);
    }
}
