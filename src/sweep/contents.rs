//! Contents of the files that points depend on, each read once; settings get their hashes and what goes by the scene.

use std::collections::HashMap;
use std::path::Path;
use std::sync::{Arc, Mutex};

use isa::Isa;
use kernels::Function;
use messages::Report;
use scenes::read::Loaded;

use crate::extension;
use crate::failure::Failure;
use crate::files;
use crate::job::Job;
use crate::settings::{CameraKind, FIELD, Settings, check_hash, hash};

/// Scenes by name and mesh.
type SceneTable = HashMap<(String, Option<String>), Arc<SceneContents>>;

/// Everything that was read.
#[derive(Default)]
pub struct Contents {
    scenes: Mutex<SceneTable>,
    files: Mutex<HashMap<String, Vec<u8>>>,
    extensions: Mutex<HashMap<String, String>>,
    kernels: Mutex<HashMap<String, String>>,
}

/// A scene with its hash.
pub struct SceneContents {
    /// The scene, with likely mistakes in its files.
    pub loaded: Loaded,
    /// SHA-256 of it.
    pub hash: String,
}

impl Contents {
    /// The scene of settings.
    ///
    /// # Errors
    /// Mistakes in the scene's files.
    pub fn scene(&self, settings: &Settings) -> Result<Arc<SceneContents>, Failure> {
        let name = (settings.scene.name.clone(), settings.scene.mesh.clone());
        let mut scenes = self.scenes.lock().expect("no reader panics");
        if let Some(known) = scenes.get(&name) {
            return Ok(known.clone());
        }
        // The size in the settings is no part of the scene.
        let mut plain = settings.clone();
        plain.view.size = None;
        let loaded = plain.scene()?;
        let hash = hash::scene(&loaded.scene);
        let known = Arc::new(SceneContents { loaded, hash });
        scenes.insert(name, known.clone());
        Ok(known)
    }

    /// Fills in what settings leave to the scene and to each other, and all hashes.
    ///
    /// # Errors
    /// Files that cannot be read, or that do not have the hash that the settings say; values out of their ranges.
    pub fn resolve(&self, settings: &mut Settings) -> Result<(), Failure> {
        settings.check()?;
        let scene = self.scene(settings)?;
        check_hash(&format!("the scene {}", settings.scene.name), settings.scene.hash.as_deref(), || {
            scene.hash.clone()
        })?;
        settings.scene.hash = Some(scene.hash.clone());
        let view = &mut settings.view;
        let size = *view.size.get_or_insert(scene.loaded.scene.size.into());
        view.check(size.into())?;
        let is_perspective = view.eye.is_some() || view.look.is_some() || view.fov.is_some();
        let kind = if is_perspective { CameraKind::Perspective } else { CameraKind::Orthographic };
        if *view.camera.get_or_insert(kind) == CameraKind::Perspective {
            view.fov.get_or_insert(FIELD);
        }
        let layout = *settings.layout.get_or_insert(settings.kernels.profile.layout());
        settings.tree.resolve(settings.kernels.profile);
        // Kernels: the user's files, then all that the set has beside them.
        let mut replaced = Vec::new();
        for (function, file) in &mut settings.kernels.replaced {
            let source = files::source_of(Path::new(&file.file), self.file(&file.file)?)?;
            let now = hash::texts([source.text.as_str()]);
            check_hash(&file.file, file.hash.as_deref(), || now.clone())?;
            file.hash = Some(now);
            let function: Function = function.parse().map_err(|message: Box<messages::Diagnostic>| *message)?;
            replaced.push((function, source));
        }
        for file in &mut settings.kernels.extensions {
            let now = self.extension(&file.file)?;
            check_hash(&file.file, file.hash.as_deref(), || now.clone())?;
            file.hash = Some(now);
        }
        let profile = settings.kernels.profile;
        let own: Vec<String> =
            settings.kernels.replaced.iter().map(|(function, file)| format!("{function}={:?}", file.hash)).collect();
        let name = format!("{profile} {} {}", layout.name(), own.join(" "));
        let mut kernels = self.kernels.lock().expect("no reader panics");
        let hash = kernels.entry(name).or_insert_with(|| hash::kernels(profile, layout, &replaced));
        settings.kernels.hash = Some(hash.clone());
        Ok(())
    }

    /// The job of settings, whose files are not read again.
    ///
    /// # Errors
    /// See [`Settings::job`].
    pub fn job(&self, settings: &Settings) -> Result<Job, Failure> {
        settings.job_by(self.scene(settings)?.loaded.clone(), &|name| self.file(name))
    }

    fn file(&self, name: &str) -> Result<Vec<u8>, Report> {
        let mut files = self.files.lock().expect("no reader panics");
        if let Some(known) = files.get(name) {
            return Ok(known.clone());
        }
        let octets = files::read(Path::new(name))?;
        files.insert(name.to_owned(), octets.clone());
        Ok(octets)
    }

    fn extension(&self, name: &str) -> Result<String, Failure> {
        let mut extensions = self.extensions.lock().expect("no reader panics");
        if let Some(known) = extensions.get(name) {
            return Ok(known.clone());
        }
        let (_, texts) = extension::extend_by(&mut Isa::base(), Path::new(name), self.file(name)?)?;
        let hash = hash::texts(texts.iter().map(|text| text.text.as_str()));
        extensions.insert(name.to_owned(), hash.clone());
        Ok(hash)
    }
}
