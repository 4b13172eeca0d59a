//! Fuzzes everything that takes inputs from outside, and holds the engines against each other. Each surface is tried by a process of its own, so
//! that an abort, an overflow of the stack or a run without end is a find, too.

mod find;
mod harness;
mod mutate;
mod project;
mod seen;
mod surface;
mod surfaces;
mod watch;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use std::time::Duration;

use clap::Parser;

use crate::find::Find;
use crate::harness::{End, Wishes};
use crate::seen::Seen;
use crate::surface::{SURFACES, Surface};

/// Fuzzes readers and engines. The same seed tries the same inputs; a find is written to a file, and the exit code is 1.
#[derive(Parser, Clone, Debug)]
struct FuzzArguments {
    /// Surface; may be repeated [default: all].
    #[arg(long, value_name = "NAME")]
    target: Vec<String>,
    /// Seed of the random numbers.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Runs of each surface, of which the engines' surfaces make several of an input: no further input is tried once there are so many.
    #[arg(long, value_name = "N", default_value_t = u64::MAX, hide_default_value = true)]
    runs: u64,
    /// Seconds for each surface.
    #[arg(long, value_name = "SECONDS", default_value_t = 60)]
    time: u64,
    /// CPU time that an input may take with all its runs, in milliseconds.
    #[arg(long, value_name = "MILLISECONDS", default_value_t = 5_000)]
    longest: u64,
    /// Tries the input of a find again and says what goes wrong.
    #[arg(long, value_name = "FILE", conflicts_with = "target")]
    replay: Option<PathBuf>,
    /// Tries surfaces with a planted fault each, which must be found.
    #[arg(long)]
    self_check: bool,
    /// Folder in which inputs are kept from one call to the next; without it the inputs follow from the seed alone.
    #[arg(long, value_name = "FOLDER")]
    corpus: Option<PathBuf>,
    /// Folder for finds.
    #[arg(long, value_name = "FOLDER", default_value = "out/finds")]
    finds: PathBuf,
    /// Lists surfaces with the files of their readers.
    #[arg(long)]
    list: bool,
    /// Works on one surface in this process.
    #[arg(long, hide = true)]
    worker: bool,
}

fn main() -> ExitCode {
    match execute(&FuzzArguments::parse()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
    }
}

/// True where all went as it should.
fn execute(arguments: &FuzzArguments) -> Result<bool, String> {
    if let Some(path) = &arguments.replay {
        return replay(path);
    }
    let surfaces: Vec<&Surface> = match arguments.target.is_empty() {
        true => SURFACES.iter().collect(),
        false => arguments.target.iter().map(|name| named(name)).collect::<Result<_, _>>()?,
    };
    if arguments.list {
        surfaces.iter().for_each(|surface| println!("{} {}", surface.name, surface.reader.join(" ")));
        return Ok(true);
    }
    if arguments.worker {
        return work(surfaces[0], arguments);
    }
    let mut is_right = true;
    for surface in surfaces {
        is_right &= supervise(surface, arguments)?;
    }
    Ok(is_right)
}

fn named(name: &str) -> Result<&'static Surface, String> {
    let names: Vec<&str> = SURFACES.iter().map(|surface| surface.name).collect();
    SURFACES.iter().find(|surface| surface.name == name).ok_or_else(|| format!("the surfaces are {}", names.join(", ")))
}

/// File of the input that a worker tries.
fn current(surface: &Surface, arguments: &FuzzArguments) -> PathBuf {
    arguments.finds.join(format!("{}-{}.current", surface.name, arguments.seed))
}

fn work(surface: &Surface, arguments: &FuzzArguments) -> Result<bool, String> {
    let wishes = Wishes {
        seed: arguments.seed,
        runs: arguments.runs,
        time: Duration::from_secs(arguments.time),
        longest: arguments.longest,
        has_planted: arguments.self_check,
        corpus: arguments.corpus.clone(),
    };
    std::fs::create_dir_all(&arguments.finds).map_err(|error| error.to_string())?;
    match harness::run(surface, &wishes, &current(surface, arguments)).map_err(|error| error.to_string())? {
        End::Clean => Ok(true),
        End::Found(find) => tell(&find, &arguments.finds).map(|()| false),
    }
}

fn tell(find: &Find, folder: &Path) -> Result<(), String> {
    let path = find.write(folder).map_err(|error| error.to_string())?;
    println!(
        "{:<11} input {} of seed {}: {}\n{:11} {}",
        find.target,
        find.run,
        find.seed,
        find.why,
        "",
        path.display()
    );
    Ok(())
}

/// Lets a process try a surface; where it ends without a word, its last input is the find.
fn supervise(surface: &Surface, arguments: &FuzzArguments) -> Result<bool, String> {
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    // What is found on purpose is none of the finds.
    let folder = if arguments.self_check { arguments.finds.join("planted") } else { arguments.finds.clone() };
    let arguments = &FuzzArguments { finds: folder, ..arguments.clone() };
    let number = |option: &str, value: u64| format!("--{option}={value}");
    let mut command = Command::new(program);
    command.args(["--worker", "--target", surface.name]).arg("--finds").arg(&arguments.finds).args([
        number("seed", arguments.seed),
        number("runs", arguments.runs),
        number("time", arguments.time),
        number("longest", arguments.longest),
    ]);
    if let Some(corpus) = arguments.corpus.as_ref().filter(|_| !arguments.self_check) {
        command.arg("--corpus").arg(corpus);
    }
    command.args(arguments.self_check.then_some("--self-check"));
    // A command line may name standard input, which nobody must have to type.
    let status = command.stdin(Stdio::null()).status().map_err(|error| error.to_string())?;
    let is_clean = match status.code() {
        Some(0) => true,
        Some(1) => false,
        Some(2) => return Err(format!("{} could not be tried", surface.name)),
        _ => {
            let path = current(surface, arguments);
            let (run, input) = watch::last(&path).ok_or("the last input is not known")?;
            let why = format!("the process ended: {status}");
            tell(&Find { target: surface.name.to_owned(), seed: arguments.seed, run, why, input }, &arguments.finds)?;
            let _ = std::fs::remove_file(path);
            false
        }
    };
    match arguments.self_check {
        true if is_clean => println!("{:<11} the planted fault was not found", surface.name),
        true => println!("{:<11} the planted fault was found", surface.name),
        false => {}
    }
    Ok(is_clean != arguments.self_check)
}

/// Tries the input of a find again.
fn replay(path: &Path) -> Result<bool, String> {
    let find = Find::read(path)?;
    let surface = named(&find.target)?;
    let mut seen = Seen::new(&find.input, false);
    harness::hold_panics();
    match harness::attempt(surface, &find.input, &mut seen) {
        Ok(()) => println!("{}: nothing goes wrong; then it was: {}", find.target, find.why),
        Err(panic) => println!("{}: {panic}", find.target),
    }
    Ok(false)
}
