//! Trials that take long where they are many: runs that are killed while they write, and the same run again under other circumstances. `cargo test`
//! makes a few of each; with `LANCER_RUNS=1000 cargo test -p lancer --test endurance -- --nocapture` they are a thousand, and a table says what came
//! of them. Nothing of the workspace is linked here: what is tried is the program.

#[cfg(target_os = "linux")]
mod kills;
mod repeats;

use std::path::Path;
use std::process::{Command, Stdio};

/// Variable that says how many runs there are.
const RUNS: &str = "LANCER_RUNS";

/// The number of runs that is asked for; none where a few will do.
fn runs() -> Option<usize> {
    let text = std::env::var(RUNS).ok()?;
    Some(text.parse().unwrap_or_else(|_| panic!("{RUNS} is a number of runs, not `{text}`")))
}

/// A command of a program with arguments between blanks, ready to be started in a folder and quiet.
fn command(program: &str, arguments: &str, folder: &Path) -> Command {
    let mut command = Command::new(program);
    command.args(arguments.split_whitespace()).current_dir(folder);
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command
}

/// Runs `lancer` in a folder, which must succeed.
fn succeed(arguments: &str, folder: &Path) {
    let status = command(env!("CARGO_BIN_EXE_lancer"), arguments, folder).status().expect("the program can be started");
    assert!(status.success(), "lancer {arguments}: {status}");
}
