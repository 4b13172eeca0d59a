//! State of a run of the catalogue, as it is kept in a file between the parts of a run.

use std::collections::BTreeMap;
use std::sync::Arc;

use messages::{Diagnostic, Report, Source};
use serde::{Deserialize, Serialize};

use super::{CatalogueSize, TrialTally, find};

/// Version of the file that a run is taken up from.
const STATE: &str = "lancer-stress-state-1";

/// Progress of a run.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunProgress {
    schema: String,
    size: CatalogueSize,
    /// Cases that were begun, by name.
    pub cases: BTreeMap<String, CaseProgress>,
}

/// Progress of a case: its first trials are done.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CaseProgress {
    /// Beginning of the series of random numbers.
    pub seed: u64,
    /// Outcome of the trials that are done.
    pub tally: TrialTally,
}

impl RunProgress {
    /// A run of which nothing is done.
    pub fn new(size: CatalogueSize) -> RunProgress {
        RunProgress { schema: STATE.to_owned(), size, cases: BTreeMap::new() }
    }

    /// The state that a former run has left.
    ///
    /// # Errors
    /// A text that is no state, and the state of a run of another size or of other seeds.
    pub fn parse(source: &Arc<Source>, size: CatalogueSize) -> Result<RunProgress, Report> {
        let shown = &source.name;
        let state: RunProgress = serde_json::from_str(&source.text)
            .map_err(|error| Diagnostic::error(format!("{shown} is no state of `lancer stress`: {error}")))?;
        // A state of other seeds or sizes would be added to trials that are not the same.
        let fits = |(name, done): (&String, &CaseProgress)| {
            find(name).is_ok_and(|case| case.seed == done.seed && done.tally.trials <= case.trials(size))
        };
        if state.schema == STATE && state.size == size && state.cases.iter().all(fits) {
            return Ok(state);
        }
        let message = Diagnostic::error(format!("{shown} is the state of another run"));
        Err(message.hint("choose the size that it was made with, or another file").into())
    }
}
