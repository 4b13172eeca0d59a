//! Suggestions as JSON.

use schemars::JsonSchema;
use serde::Serialize;

use super::Suggestions;
use crate::extension::ExtensionResult;
use crate::job::{Job, result_name};

/// Version of [`SuggestionResult`].
pub const SUGGESTION_SCHEMA: &str = "lancer-suggestion-1";

/// Instructions that would pay, and what they change.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SuggestionResult {
    /// Version of the result.
    #[schemars(extend("const" = SUGGESTION_SCHEMA))]
    pub schema: &'static str,
    /// Name of the scene.
    pub scene: String,
    /// Name of the kernels' profile.
    pub profile: &'static str,
    /// Name of the machine.
    pub machine: String,
    /// Cores of the machine.
    pub cores: u32,
    /// Size of the picture in pixels.
    pub size: [u32; 2],
    /// Instructions of all cores, without the suggestions.
    pub instructions: u64,
    /// Clocks that all cores together computed, without the suggestions.
    pub busy_clocks: u64,
    /// The instructions, the one that saves most time on the machine first.
    pub suggestions: Vec<SuggestionEntry>,
    /// Files that were written: the extension, then the functions.
    pub files: Vec<String>,
    /// The picture without and with them; null when there are none.
    pub comparison: Option<ExtensionResult>,
}

/// An instruction that would pay.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SuggestionEntry {
    /// Name of the suggested instruction.
    pub name: String,
    /// Row of the suggested instruction.
    pub row: String,
    /// The lines of its body.
    pub body: Vec<String>,
    /// The functions in which it stands.
    pub functions: Vec<&'static str>,
    /// Places of the program where it stands.
    pub places: u64,
    /// Places where other instructions stood between those of the sequence.
    pub apart: u64,
    /// Number of executions.
    pub executions: u64,
    /// Instructions that it saves.
    pub saved: u64,
    /// Clocks of computing that it saves at most.
    pub saved_clocks: u64,
    /// Clocks of its instructions, one after the other.
    pub serial_clocks: u64,
    /// Clocks along the longest chain of its results.
    pub critical_clocks: u64,
    /// Speed-up of the cores at most, when it takes as long as that chain.
    pub speedup: f64,
}

impl SuggestionResult {
    /// Suggestions for a picture.
    pub fn new(job: &Job, suggestions: &Suggestions, files: Vec<String>, comparison: Option<ExtensionResult>) -> Self {
        let entries = suggestions.found.iter().map(|found| SuggestionEntry {
            name: found.name.clone(),
            row: found.row.clone(),
            body: found.lines.clone(),
            functions: found.functions.clone(),
            places: found.places as u64,
            apart: found.apart as u64,
            executions: found.executions,
            saved: found.saved(),
            saved_clocks: found.saved_clocks(),
            serial_clocks: found.serial,
            critical_clocks: found.critical,
            speedup: suggestions.speedup(found),
        });
        SuggestionResult {
            schema: SUGGESTION_SCHEMA,
            scene: result_name(&job.scene),
            profile: job.kernels.profile.name(),
            machine: job.machine_name.clone(),
            cores: job.machine.cores,
            size: job.view.size.into(),
            instructions: suggestions.instructions,
            busy_clocks: suggestions.clocks,
            suggestions: entries.collect(),
            files,
            comparison,
        }
    }
}
