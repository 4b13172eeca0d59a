//! The options that decide a picture, and the job that they ask for.

use std::path::PathBuf;

use clap::Args;
use emu::machine::Config;
use kernels::build::Crop;
use messages::Diagnostic;
use scenes::model::{Camera, View};

use super::{
    CameraKind, EffortArguments, KernelArguments, MachineArguments, NumberArguments, ViewArguments, overrides,
};
use crate::failure::Failure;
use crate::job::Job;
use crate::numeral::grouped;
use crate::{files, input, machine};

/// Pixels of the largest picture.
const MOST_PIXELS: u64 = 1 << 24;

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
    /// The job that a command line asks for; reads the scene, the machine and the user's kernels.
    ///
    /// # Errors
    /// What is wrong in those files, and options that do not go together.
    pub fn job(&self) -> Result<Job, Failure> {
        let arguments = self;
        let camera = camera(&arguments.view)?;
        // Read the scene, and remember all files for the message that a result would overwrite one.
        let loaded = input::scene(&arguments.scene, arguments.mesh.as_deref(), arguments.view.size)?;
        let mut job = Job::new(loaded.scene);
        job.warnings = loaded.warnings;
        job.files = loaded.files;
        job.files.extend(arguments.kernels.replaced.iter().map(|(_, path)| path.clone()));
        job.files.push(PathBuf::from(&arguments.machine.machine));
        job.files.extend(arguments.kernels.extensions.extensions.iter().cloned());
        job.isa = arguments.kernels.extensions.isa()?;
        // Look at it.
        job.view = View {
            size: arguments.view.size.unwrap_or(job.scene.size),
            camera,
            shift: arguments.view.shift,
            ambient: arguments.view.ambient,
            background: arguments.view.background,
            bounces: arguments.effort.bounces,
        };
        check_size(job.view.size)?;
        // Choose the machine and change what options say otherwise.
        (job.machine_name, job.machine) = machine::find(&arguments.machine.machine)?;
        job.engine = arguments.machine.engine;
        adjust(&mut job.machine, &arguments.machine, &arguments.numbers);
        job.layout = arguments.machine.layout;
        job.kd_depth = arguments.effort.tree.kd_depth;
        job.kd_method = arguments.effort.tree.kd_build;
        job.formats = overrides::collect(&arguments.numbers.formats);
        // Choose the kernels; files that replace functions are read here.
        job.kernels.profile = arguments.kernels.profile;
        job.kernels.interpolate = arguments.effort.interpolate;
        job.kernels.skips = arguments.effort.skips();
        job.kernels.weight_cutoff = arguments.effort.weight_cutoff;
        for (function, path) in &arguments.kernels.replaced {
            job.kernels.replaced.push((*function, files::source(path)?));
        }
        job.kernels.crop = crop(&arguments.view, job.view.size)?;
        Ok(job)
    }
}

/// Changes what the command line says otherwise than the machine's file.
fn adjust(config: &mut Config, machine: &MachineArguments, numbers: &NumberArguments) {
    config.cores = machine.cores.unwrap_or(config.cores);
    let arithmetic = &mut config.arithmetic;
    arithmetic.word = numbers.word.unwrap_or(arithmetic.word);
    arithmetic.quantization = numbers.rounding.unwrap_or(arithmetic.quantization);
    arithmetic.overflow = numbers.overflow.unwrap_or(arithmetic.overflow);
}

/// Refuses pictures that would fill the host's memory.
fn check_size((width, height): (u32, u32)) -> Result<(), Failure> {
    if u64::from(width) * u64::from(height) <= MOST_PIXELS {
        return Ok(());
    }
    let message = format!("a picture of {width} x {height} pixels has more than {}", grouped(MOST_PIXELS));
    Err(Diagnostic::error(message).hint("choose a smaller one with `--size WxH`").into())
}

/// The camera; options that only a perspective one has imply it.
fn camera(view: &ViewArguments) -> Result<Camera, Failure> {
    let given = [("--eye", view.eye.is_some()), ("--look", view.look.is_some()), ("--fov", view.fov.is_some())];
    let first = given.into_iter().find(|(_, is_given)| *is_given).map(|(name, _)| name);
    match (view.camera, first) {
        (Some(CameraKind::Orthographic), Some(option)) => {
            let message = Diagnostic::error(format!("`{option}` has no meaning for an orthographic camera"));
            Err(Failure::usage(message.hint("choose `--camera perspective`")))
        }
        (Some(CameraKind::Orthographic), None) | (None, None) => Ok(Camera::Orthographic),
        (Some(CameraKind::Perspective), _) | (None, Some(_)) => {
            Ok(Camera::Perspective { eye: view.eye, look: view.look, field: view.fov.unwrap_or(45.0) })
        }
    }
}

/// The part that is drawn, which must lie inside the picture.
fn crop(view: &ViewArguments, (width, height): (u32, u32)) -> Result<Option<Crop>, Failure> {
    let pixel = view.pixel.map(|[column, row]| Crop { column, row, width: 1, height: 1 });
    let Some(crop) = view.crop.or(pixel) else { return Ok(None) };
    let is_inside = |first: u32, length: u32, whole: u32| u64::from(first) + u64::from(length) <= u64::from(whole);
    match is_inside(crop.column, crop.width, width) && is_inside(crop.row, crop.height, height) {
        true => Ok(Some(crop)),
        false => {
            let Crop { column, row, width: w, height: h } = crop;
            let asked = match view.pixel {
                Some(_) => format!("pixel {column},{row} lies"),
                None => format!("{w} x {h} pixels from {column},{row} on lie"),
            };
            let message = format!("{asked} outside a picture of {width} x {height} pixels");
            Err(Failure::usage(Diagnostic::error(message).hint("columns and rows count from 0, at the top left")))
        }
    }
}
