//! The options that decide a picture, and the settings that they stand for.

use std::path::{Path, PathBuf};

use clap::Args;
use kernels::build::Crop;
use messages::Report;

use super::{EffortArguments, KernelArguments, MachineArguments, NumberArguments, ViewArguments, overrides};
use crate::failure::Failure;
use crate::job::Job;
use crate::settings::{
    EffortSettings, FileSettings, FormatSettings, KernelSettings, MachineSettings, ResultSettings, SceneSettings,
    Settings, ViewSettings,
};
use crate::sweep::contents::Contents;

/// The options that decide a picture.
#[derive(Args, Clone, Debug)]
pub struct JobArguments {
    /// Scene: a .dsc with its mesh beside it, a mesh, or the name of a generated scene such as cornell.
    pub scene: String,
    /// Mesh that belongs to the .dsc [default: the file of the same name beside it].
    #[arg(long, value_name = "FILE")]
    pub mesh: Option<PathBuf>,
    #[command(flatten)]
    #[allow(missing_docs, reason = "the group has its own")]
    pub view: ViewArguments,
    #[command(flatten)]
    #[allow(missing_docs, reason = "the group has its own")]
    pub kernels: KernelArguments,
    #[command(flatten)]
    #[allow(missing_docs, reason = "the group has its own")]
    pub machine: MachineArguments,
    #[command(flatten)]
    #[allow(missing_docs, reason = "the group has its own")]
    pub numbers: NumberArguments,
    #[command(flatten)]
    #[allow(missing_docs, reason = "the group has its own")]
    pub effort: EffortArguments,
}

impl JobArguments {
    /// The settings that a command line asks for: its options, then the changes of single keys. Reads the machine and nothing else.
    ///
    /// # Errors
    /// Mistakes in the machine's file, and changes of no key or to no value.
    pub fn settings(&self) -> Result<Settings, Report> {
        self.settings_on(self.chosen_machine()?)
    }

    /// The machine with what options say otherwise; changes of single keys are not made yet.
    ///
    /// # Errors
    /// Mistakes in the machine's file.
    pub fn chosen_machine(&self) -> Result<MachineSettings, Report> {
        self.machine.keys.chosen(&self.numbers.arithmetic)
    }

    /// The settings that a command line asks for on a machine that a command's own options have changed: changes of single keys come after those.
    ///
    /// # Errors
    /// Changes of no key or to no value.
    pub fn settings_on(&self, chosen: MachineSettings) -> Result<Settings, Report> {
        let JobArguments { scene, mesh, view, kernels, machine, numbers, effort } = self;
        let shown = |path: &Path| path.display().to_string();
        let file = |path: &PathBuf| FileSettings { file: shown(path), hash: None };
        // A pixel is a crop of 1 x 1, so that settings need one key for both.
        let pixel = view.pixel.map(|[column, row]| [column, row, 1, 1]);
        let crop = view.crop.map(|Crop { column, row, width, height }| [column, row, width, height]);
        // Hashes stay open, since scene and kernels have not been read yet.
        let settings = Settings {
            scene: SceneSettings { name: scene.clone(), mesh: mesh.as_deref().map(shown), hash: None },
            view: ViewSettings {
                size: view.size.map(Into::into),
                shift: view.shift,
                crop: crop.or(pixel),
                ambient: view.ambient,
                background: view.background,
                ..view.camera.settings()
            },
            kernels: KernelSettings {
                profile: kernels.profile,
                replaced: kernels
                    .files
                    .replaced
                    .iter()
                    .map(|(function, path)| (function.name().to_owned(), file(path)))
                    .collect(),
                hash: None,
                extensions: kernels.files.extensions.extensions.iter().map(file).collect(),
            },
            effort: EffortSettings {
                bounces: effort.bounces,
                weight_cutoff: effort.weight_cutoff,
                skips: effort.skips.skips(),
                interpolate: effort.interpolate,
            },
            tree: effort.tree.settings(),
            layout: machine.layout,
            formats: FormatSettings::from(&overrides::collect(&numbers.formats.formats)),
            machine: chosen,
            engine: machine.engine,
            results: ResultSettings::default(),
        };
        // `--set` comes last, since it changes what other options have chosen.
        settings.with(&machine.keys.sets.sets)
    }

    /// The job that a command line asks for; reads the scene, the machine and the user's kernels.
    ///
    /// # Errors
    /// Mistakes in the files of scene, machine and kernels, and options that do not go together.
    pub fn job(&self) -> Result<Job, Failure> {
        self.job_of(&self.settings()?)
    }

    /// The job of settings that come from these options; no result may overwrite the files that were read for it.
    ///
    /// # Errors
    /// See [`Settings::job`].
    pub fn job_of(&self, settings: &Settings) -> Result<Job, Failure> {
        self.with_files(settings.job()?)
    }

    /// The job of settings that come from these options, with contents that are not read again.
    ///
    /// # Errors
    /// See [`Settings::job`].
    pub fn job_by(&self, settings: &Settings, contents: &Contents) -> Result<Job, Failure> {
        self.with_files(contents.job(settings)?)
    }

    fn with_files(&self, mut job: Job) -> Result<Job, Failure> {
        let machine = &self.machine.keys;
        job.files.push(PathBuf::from(&machine.machine));
        job.files.extend(machine.sets.settings.settings.clone());
        Ok(job)
    }
}
