//! A result with what it came from: the version of this program and all settings.

use schemars::JsonSchema;
use serde::Serialize;

use crate::drawing::Drawing;
use crate::job::Job;
use crate::settings::{Settings, VERSION};

/// A result with the version and the settings that give it again.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct WithSettings<R, S> {
    /// The result.
    #[serde(flatten)]
    pub result: R,
    /// Version of this program.
    pub version: &'static str,
    /// Settings that give the result again: `--settings` reads them.
    pub settings: S,
}

impl<R, S> WithSettings<R, S> {
    /// A result of this version.
    pub fn new(result: R, settings: S) -> WithSettings<R, S> {
        WithSettings { result, version: VERSION, settings }
    }
}

/// The settings of a drawing: those of its job, with what was measured.
pub(super) fn settings(job: &Job, drawing: &Drawing) -> Settings {
    let mut settings = Settings::of(job);
    settings.results.error = drawing.reference.is_some();
    settings
}
