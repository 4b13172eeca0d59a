//! From settings to a job and back. A job that is made of settings has just these, with what goes by the scene filled in.

use std::path::Path;
use std::sync::Arc;

use kernels::build::{Crop, KernelOptions};
use kernels::{Function, KernelSet};
use messages::{Diagnostic, Report, Source};
use scenes::cadrage::Overrides;
use scenes::kdtree::VISIT;
use scenes::model::{Camera, View};
use scenes::read::Loaded;

use super::{
    CameraKind, EffortSettings, FIELD, FileSettings, FormatSettings, KernelSettings, MachineSettings, ResultSettings,
    SceneSettings, Settings, TreeSettings, ViewSettings, hash,
};
use crate::extension;
use crate::failure::Failure;
use crate::job::{Job, SceneSource};
use crate::numeral::grouped;
use crate::{files, input};

/// Pixels of the largest picture.
const MOST_PIXELS: u64 = 1 << 24;

/// Largest width or height of a picture in pixels.
pub const LONGEST: u32 = 16_384;

/// Most levels of reflected and refracted rays.
pub const MOST_BOUNCES: u32 = 30;

impl TreeSettings {
    /// Puts those of the kernels where nothing was chosen.
    pub fn resolve(&mut self, kernels: KernelSet) {
        self.depth.get_or_insert(kernels.kd_depth());
        self.build.get_or_insert(kernels.kd_method());
    }

    /// Puts the choices into a job.
    pub fn choose(&self, job: &mut Job) {
        (job.kd_depth, job.kd_method, job.kd_visit) = (self.depth, self.build, self.visit);
    }
}

impl Settings {
    /// Settings that give a job again, with everything that it depends on.
    pub fn of(job: &Job) -> Settings {
        // Every part of a job is named here, so that a new one does not compile before it has its key.
        let Job {
            scene,
            source,
            view,
            layout: _,
            kd_depth: _,
            kd_method: _,
            kd_visit,
            formats,
            isa: _,
            extensions,
            kernels,
            machine_name,
            machine,
            engine,
            detail: _,
            error,
            flags,
            energy,
            shadow,
            reference_bounces,
            warnings: _,
            files: _,
        } = job;
        let View { size, camera, shift, ambient, background, bounces } = view;
        let KernelOptions { profile, replaced, crop, weight_cutoff, skips, interpolate } = kernels;
        let (kind, eye, look, fov) = match *camera {
            Camera::Orthographic => (CameraKind::Orthographic, None, None, None),
            Camera::Perspective { eye, look, field } => (CameraKind::Perspective, eye, look, Some(field)),
        };
        let file = |source: &Arc<Source>| FileSettings {
            file: source.name.clone(),
            hash: Some(hash::texts([source.text.as_str()])),
        };
        Settings {
            scene: SceneSettings {
                name: source.name.clone(),
                mesh: source.mesh.as_ref().map(|path| path.display().to_string()),
                hash: Some(hash::scene(scene)),
            },
            view: ViewSettings {
                camera: Some(kind),
                eye,
                look,
                fov,
                size: Some((*size).into()),
                shift: *shift,
                crop: crop.map(|Crop { column, row, width, height }| [column, row, width, height]),
                ambient: *ambient,
                background: *background,
            },
            kernels: KernelSettings {
                profile: *profile,
                replaced: replaced
                    .iter()
                    .map(|(function, source)| (function.name().to_owned(), file(source)))
                    .collect(),
                hash: Some(hash::kernels(*profile, job.layout(), replaced)),
                extensions: extensions.clone(),
            },
            effort: EffortSettings {
                bounces: *bounces,
                weight_cutoff: *weight_cutoff,
                skips: *skips,
                interpolate: *interpolate,
            },
            tree: TreeSettings { depth: Some(job.kd_depth()), build: Some(job.kd_method()), visit: *kd_visit },
            layout: Some(job.layout()),
            formats: FormatSettings::from(formats),
            machine: MachineSettings { name: machine_name.clone(), config: machine.clone() },
            engine: *engine,
            results: ResultSettings {
                error: *error,
                flags: *flags,
                energy: *energy,
                shadow: *shadow,
                reference_bounces: *reference_bounces,
            },
        }
    }

    /// The job of the settings; reads the scene and the user's kernels and extensions.
    ///
    /// # Errors
    /// Errors in those files, a file that is not the one of which the settings have the hash, values out of their ranges or that do not go together.
    pub fn job(&self) -> Result<Job, Failure> {
        self.job_of(self.scene()?)
    }

    /// The scene as it is read, without a look at its hash.
    ///
    /// # Errors
    /// Errors in its files, and settings that name none.
    pub fn scene(&self) -> Result<Loaded, Report> {
        if self.scene.name.is_empty() {
            let message = Diagnostic::error("the settings name no scene");
            return Err(message.hint("add `scene.name`, a file or a generated scene such as cornell").into());
        }
        let size = self.view.size.map(<(u32, u32)>::from);
        input::scene(&self.scene.name, self.scene.mesh.as_deref().map(Path::new), size)
    }

    /// The job of the settings with a scene that has been read.
    ///
    /// # Errors
    /// See [`Settings::job`].
    pub fn job_of(&self, loaded: Loaded) -> Result<Job, Failure> {
        self.job_by(loaded, &|file| files::read(Path::new(file)))
    }

    /// The job of the settings with a scene that has been read, and with whoever reads other files by their names.
    ///
    /// # Errors
    /// See [`Settings::job`].
    pub fn job_by(&self, loaded: Loaded, read: &dyn Fn(&str) -> Result<Vec<u8>, Report>) -> Result<Job, Failure> {
        let Settings { scene, view, kernels, effort, tree, layout, formats, machine, engine, results } = self;
        self.check()?;
        let camera = view.camera()?;
        let mut job = Job::new(loaded.scene);
        check_hash(&format!("the scene {}", scene.name), scene.hash.as_deref(), || hash::scene(&job.scene))?;
        job.source = SceneSource { name: scene.name.clone(), mesh: scene.mesh.as_ref().map(Into::into) };
        (job.warnings, job.files) = (loaded.warnings, loaded.files);
        // Look at it.
        let size = view.size.map_or(job.scene.size, <(u32, u32)>::from);
        check_size(size)?;
        let (shift, ambient, background, bounces) = (view.shift, view.ambient, view.background, effort.bounces);
        job.view = View { size, camera, shift, ambient, background, bounces };
        // Put it into memory and on the machine.
        job.layout = *layout;
        tree.choose(&mut job);
        job.formats = formats.overrides();
        (job.machine_name, job.machine) = (machine.name.clone(), machine.config.clone());
        job.engine = *engine;
        (job.error, job.flags, job.energy, job.shadow) = (results.error, results.flags, results.energy, results.shadow);
        job.reference_bounces = results.reference_bounces;
        // Choose the kernels; files of extensions and those that replace functions are read here.
        for FileSettings { file, hash } in &kernels.extensions {
            let texts = extension::extend_by(&mut job.isa, Path::new(file), read(file)?)?.1;
            let now = hash::texts(texts.iter().map(|text| text.text.as_str()));
            check_hash(file, hash.as_deref(), || now.clone())?;
            job.files.push(file.into());
            job.extensions.push(FileSettings { file: file.clone(), hash: Some(now) });
        }
        let KernelSettings { profile, replaced, hash: wanted, .. } = kernels;
        job.kernels = KernelOptions {
            profile: *profile,
            replaced: Vec::new(),
            crop: view.crop(size)?,
            weight_cutoff: effort.weight_cutoff,
            skips: effort.skips,
            interpolate: effort.interpolate,
        };
        for (function, FileSettings { file, hash }) in replaced {
            let function: Function = function.parse().map_err(|message: Box<Diagnostic>| *message)?;
            let source = files::source_of(Path::new(file), read(file)?)?;
            check_hash(file, hash.as_deref(), || hash::texts([source.text.as_str()]))?;
            job.files.push(file.into());
            job.kernels.replaced.push((function, source));
        }
        let now = hash::kernels(*profile, job.layout(), &job.kernels.replaced);
        if wanted.as_ref().is_some_and(|wanted| *wanted != now) {
            let message = format!("the kernels of the set {profile} are not those of the settings");
            let hint = "another version of this program has written them; counts and clocks may differ";
            job.warnings.0.push(Diagnostic::warning(message).hint(hint));
        }
        Ok(job)
    }

    /// Pixels of the drawn part; 0 where the size is left to the scene.
    pub fn pixels(&self) -> u64 {
        let [.., width, height] = self.view.crop.unwrap_or_else(|| {
            let [width, height] = self.view.size.unwrap_or_default();
            [0, 0, width, height]
        });
        u64::from(width) * u64::from(height)
    }

    /// Check that every number lies in its range, as the options of the command line do.
    ///
    /// # Errors
    /// One message for each that does not.
    pub fn check(&self) -> Result<(), Report> {
        let mut messages = self.machine.config.check().err().unwrap_or_default().0;
        let mut check = |key: &str, is_right: bool, expected: &str| {
            if !is_right {
                messages.push(Diagnostic::error(format!("`{key}` is out of its range")).hint(expected));
            }
        };
        let ViewSettings { fov, size, ambient, background, .. } = &self.view;
        let in_one = |value: &f64| (0.0..=1.0).contains(value);
        check("view.fov", fov.is_none_or(|field| field > 0.0 && field < 180.0), "between 0 and 180 degrees");
        let is_size = size.is_none_or(|size| size.iter().all(|side| (1..=LONGEST).contains(side)));
        check("view.size", is_size, &format!("width and height lie in 1 to {LONGEST}"));
        check("view.ambient", *ambient >= 0.0 && ambient.is_finite(), "an intensity is at least 0");
        check("view.background", background.iter().all(in_one), "the components of a colour lie in 0 to 1");
        check("tree.visit", (1..=VISIT).contains(&self.tree.visit), &format!("1 to {VISIT} percent of a test"));
        let levels = format!("0 to {MOST_BOUNCES} levels");
        check("effort.bounces", self.effort.bounces <= MOST_BOUNCES, &levels);
        let bounces = self.results.reference_bounces;
        check("results.reference_bounces", bounces.is_none_or(|bounces| bounces <= MOST_BOUNCES), &levels);
        check("effort.weight_cutoff", in_one(&self.effort.weight_cutoff), "a weight lies in 0 to 1");
        check("effort.interpolate", self.effort.interpolate.as_ref().is_none_or(in_one), "a difference lies in 0 to 1");
        for function in self.kernels.replaced.keys() {
            messages.extend(function.parse::<Function>().err().map(|message| *message));
        }
        if messages.is_empty() { Ok(()) } else { Err(Report(messages)) }
    }
}

/// Refuses contents of another hash than the settings have.
pub(crate) fn check_hash(what: &str, wanted: Option<&str>, now: impl FnOnce() -> String) -> Result<(), Report> {
    let Some(wanted) = wanted else { return Ok(()) };
    let now = now();
    if wanted == now {
        return Ok(());
    }
    let message = format!("{what} is not what the settings were written for: its hash is {now}, not {wanted}");
    Err(Diagnostic::error(message).hint("leave the key `hash` out of the settings to take what is there now").into())
}

/// Refuses pictures that would fill the host's memory.
fn check_size((width, height): (u32, u32)) -> Result<(), Failure> {
    if u64::from(width) * u64::from(height) <= MOST_PIXELS {
        return Ok(());
    }
    let message = format!("a picture of {width} x {height} pixels has more than {}", grouped(MOST_PIXELS));
    Err(Diagnostic::error(message).hint("choose a smaller one with `--size WxH`").into())
}

impl ViewSettings {
    /// Check that a picture of this size can be drawn: with the camera, and as the part that is asked for.
    ///
    /// # Errors
    /// Pictures that would fill the host's memory, a part outside of the picture, settings of another camera.
    pub fn check(&self, size: (u32, u32)) -> Result<(), Failure> {
        check_size(size)?;
        self.camera()?;
        self.crop(size)?;
        Ok(())
    }

    /// The part that is drawn of a picture of this size, which must lie inside of it.
    fn crop(&self, (width, height): (u32, u32)) -> Result<Option<Crop>, Failure> {
        let Some([column, row, w, h]) = self.crop else { return Ok(None) };
        let is_inside = |first: u32, length: u32, whole: u32| {
            length > 0 && u64::from(first) + u64::from(length) <= u64::from(whole)
        };
        if is_inside(column, w, width) && is_inside(row, h, height) {
            return Ok(Some(Crop { column, row, width: w, height: h }));
        }
        let asked = match (w, h) {
            (1, 1) => format!("pixel {column},{row} lies"),
            _ => format!("{w} x {h} pixels from {column},{row} on lie"),
        };
        let message = format!("{asked} outside a picture of {width} x {height} pixels");
        Err(Failure::usage(Diagnostic::error(message).hint("columns and rows count from 0, at the top left")))
    }

    /// The camera; settings that only a perspective one has imply it.
    ///
    /// # Errors
    /// Settings of a perspective camera beside an orthographic one.
    pub fn camera(&self) -> Result<Camera, Failure> {
        let given = [("--eye", self.eye.is_some()), ("--look", self.look.is_some()), ("--fov", self.fov.is_some())];
        let first = given.into_iter().find(|(_, is_given)| *is_given).map(|(name, _)| name);
        match (self.camera, first) {
            (Some(CameraKind::Orthographic), Some(option)) => {
                let message = Diagnostic::error(format!("`{option}` has no meaning for an orthographic camera"));
                Err(Failure::usage(message.hint("choose `--camera perspective`")))
            }
            (Some(CameraKind::Orthographic), None) | (None, None) => Ok(Camera::Orthographic),
            (Some(CameraKind::Perspective), _) | (None, Some(_)) => {
                Ok(Camera::Perspective { eye: self.eye, look: self.look, field: self.fov.unwrap_or(FIELD) })
            }
        }
    }
}

impl FormatSettings {
    fn overrides(&self) -> Overrides {
        let FormatSettings { pos, dir, bary, t, weight, colour } = *self;
        Overrides { position: pos, direction: dir, barycentric: bary, t, weight, colour }
    }
}

impl From<&Overrides> for FormatSettings {
    fn from(formats: &Overrides) -> FormatSettings {
        let Overrides { position, direction, barycentric, t, weight, colour } = *formats;
        FormatSettings { pos: position, dir: direction, bary: barycentric, t, weight, colour }
    }
}
