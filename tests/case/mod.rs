//! A case: a small program of `cases/` with what it should do beside its lines. The syntax is described in `cases.rs`.

pub mod bless;
pub mod claim;
pub mod observation;
pub mod verdict;

use std::path::{Path, PathBuf};

use claim::{Claim, Comment};

/// One file of `cases/`.
pub struct Case {
    /// Room and name, such as `vector/sums.s`.
    pub name: String,
    /// Path of the file.
    pub path: PathBuf,
    /// Text of the file.
    pub text: String,
    /// Comments that say something to the runner, in the order of the text.
    pub comments: Vec<Comment>,
    /// Keys of the machine that differ from the default, as TOML.
    pub machine: String,
    /// Octets of global memory, all 0 at the start.
    pub memory: usize,
}

/// Instructions that a case may take where it says nothing else.
const STEP_LIMIT: u64 = 2_000;

/// Octets of global memory of a case that says nothing else.
const MEMORY: usize = 64;

impl Case {
    /// Reads a case.
    ///
    /// # Errors
    /// A comment beside a statement that is no claim.
    pub fn parse(name: String, path: PathBuf, text: String) -> Result<Case, String> {
        let mut case = Case { name, path, text, comments: Vec::new(), machine: String::new(), memory: MEMORY };
        for (number, line) in (1..).zip(case.text.lines()) {
            let (code, Some(comment)) = claim::split_comment(line) else { continue };
            let setting =
                |key: &str| comment.trim().strip_prefix(key).map(str::trim).filter(|_| code.trim().is_empty());
            if let Some(toml) = setting("machine:") {
                case.machine += &format!("{toml}\n");
            } else if let Some(octets) = setting("memory:") {
                case.memory = octets.parse().map_err(|_| format!("{}:{number}: `{octets}` octets", case.name))?;
            } else if let Some(comment) = Comment::parse(number, code, comment)
                .map_err(|piece| format!("{}:{number}: `{piece}` is no claim; prose goes behind ` -- `", case.name))?
            {
                case.comments.push(comment);
            }
        }
        if !case.machine.contains("step_limit") {
            case.machine.insert_str(0, &format!("step_limit = {STEP_LIMIT}\n"));
        }
        Ok(case)
    }

    /// All claims.
    pub fn claims(&self) -> impl Iterator<Item = &Claim> {
        self.comments.iter().flat_map(|comment| &comment.claims)
    }

    /// The room, which is the folder.
    pub fn room(&self) -> &str {
        self.name.split('/').next().unwrap_or_default()
    }

    /// True where it is about something that goes wrong.
    pub fn is_about_an_error(&self) -> bool {
        self.claims().any(Claim::is_about_an_error)
    }
}

/// All cases, sorted by name.
///
/// # Panics
/// When a file cannot be read or is not a case.
pub fn all() -> Vec<Case> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases");
    let mut cases = Vec::new();
    for room in entries(&folder) {
        for path in entries(&room) {
            let name = path.strip_prefix(&folder).unwrap().to_string_lossy().replace('\\', "/");
            let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{name}: {error}"));
            cases.push(Case::parse(name, path, text).unwrap_or_else(|message| panic!("{message}")));
        }
    }
    cases
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}
