//! Puts a program together: the prelude of the scene, the names of registers, one file a function; and assembles it.

use std::collections::BTreeMap;
use std::sync::Arc;

use isa::{Isa, Program};
use messages::{Diagnostic, Report, Source};
use scenes::cadrage::Formats;
use scenes::image::MemoryImage;
use scenes::model::{Scene, View};

use crate::function::Function;
use crate::prelude;
use crate::set::KernelSet;
use crate::skip::{Skip, Skips};

/// Features of a scene that decide which code its programs contain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SceneFeatures {
    /// Some triangle's material reflects.
    pub has_mirror: bool,
    /// Some triangle's material is transparent.
    pub is_transparent: bool,
    /// Levels of secondary rays.
    pub bounces: u32,
    /// Weight (in the weight format) that a secondary ray must exceed.
    pub cutoff: i32,
    /// Skips: what its programs leave out.
    pub skips: Skips,
    /// Block loads of its programs need not be over when the core goes on: they wait where they use the data.
    pub loads_ahead: bool,
    /// Difference of a component (in the colour format) up to which the corners around a pixel agree, so that it is interpolated; `None`
    /// when every pixel has its ray.
    pub agreement: Option<i32>,
}

impl SceneFeatures {
    /// The features of a scene.
    pub fn new(scene: &Scene, view: &View, formats: &Formats, options: &KernelOptions) -> SceneFeatures {
        // Rounded down: a whole number exceeds a limit just when it exceeds the limit rounded down.
        let raw = |value: f64, bits: u32| (value * f64::from(bits).exp2()).floor() as i32;
        let any =
            |test: &dyn Fn(usize) -> bool| scene.triangles.iter().any(|triangle| test(triangle.material as usize));
        SceneFeatures {
            has_mirror: any(&|m| scene.materials[m].reflection > 0.0),
            is_transparent: any(&|m| scene.materials[m].transmission() > 0.0),
            bounces: view.bounces,
            cutoff: raw(options.weight_cutoff, formats.weight),
            skips: options.skips.known_to(options.profile),
            loads_ahead: options.profile.loads_ahead(),
            agreement: options.interpolate.map(|difference| raw(difference, formats.colour)),
        }
    }

    /// Some ray has children.
    pub fn has_tree(&self) -> bool {
        self.bounces > 0 && (self.has_mirror || self.is_transparent || !self.skips.has(Skip::Features))
    }

    /// Some ray is refracted.
    pub fn has_glass(&self) -> bool {
        self.bounces > 0 && (self.is_transparent || !self.skips.has(Skip::Features))
    }

    /// Weight that a secondary ray must exceed to be followed; -1 where one of weight 0 is followed, too.
    pub fn least_weight(&self) -> i32 {
        if self.cutoff == 0 && !self.skips.has(Skip::Weightless) { -1 } else { self.cutoff }
    }
}

/// The part of the picture that is drawn, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    /// First column.
    pub column: u32,
    /// First row, row 0 on top.
    pub row: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// Choices of a user for the kernels.
#[derive(Clone, Debug)]
pub struct KernelOptions {
    /// Set of kernels: the file that serves each function.
    pub profile: KernelSet,
    /// Files of the user's own that serve a function instead.
    pub replaced: Vec<(Function, Arc<Source>)>,
    /// The part of the picture that is drawn; `None` for all of it.
    pub crop: Option<Crop>,
    /// Weight that a secondary ray must exceed, in [0, 1].
    pub weight_cutoff: f64,
    /// Skips: what is left out because the scene or a ray does not need it.
    pub skips: Skips,
    /// Difference of a component up to which the corners around a pixel agree, so that it is interpolated; `None` when every pixel has its
    /// ray (report 6.4).
    pub interpolate: Option<f64>,
}

impl Default for KernelOptions {
    fn default() -> KernelOptions {
        KernelOptions {
            profile: KernelSet::default(),
            replaced: Vec::new(),
            crop: None,
            weight_cutoff: 0.0,
            skips: Skips::default(),
            interpolate: None,
        }
    }
}

/// The programs that draw a scene.
#[derive(Clone, Debug)]
pub struct Build {
    /// The program of each core.
    pub cores: Program,
    /// The program of the main processor.
    pub main: Program,
    /// The part of the picture that is drawn.
    pub crop: Crop,
    /// Warnings of the assembler.
    pub warnings: Report,
}

/// Assembles the programs for a scene in memory.
///
/// # Errors
/// A layout that the set of kernels does not read; what the assembler finds in the user's own kernels, or in ours where a format leaves no room for a shift.
pub fn build(
    scene: &Scene,
    view: &View,
    image: &MemoryImage,
    isa: &Isa,
    options: &KernelOptions,
) -> Result<Build, Report> {
    if let Some(reason) = options.profile.refusal(image.layout) {
        let refusal =
            format!("the kernels of `{}` do not read the layout `{}`: {reason}", options.profile, image.layout);
        return Err(Diagnostic::error(refusal).hint("use --layout wide, or --profile vector, ray or packet").into());
    }
    let features = SceneFeatures::new(scene, view, &image.formats, options);
    // The crop goes into the programs alone; the memory image is the same for all crops.
    let crop = options.crop.unwrap_or(Crop { column: 0, row: 0, width: image.size.0, height: image.size.1 });
    let mut warnings = Report::default();
    let mut program = |is_main: bool| -> Result<Program, Report> {
        let mut assembled = assemble(image, &features, &crop, isa, options, is_main)?;
        warnings.0.extend(assembled.warnings.0);
        assembled.program.shown_formats = shown_formats(&image.formats);
        Ok(assembled.program)
    };
    // Each is assembled by itself, so functions that both contain have addresses of their own in each.
    let (cores, main) = (program(false)?, program(true)?);
    Ok(Build { cores, main, crop, warnings })
}

/// Formats of which the prelude writes others.
fn shown_formats(formats: &Formats) -> BTreeMap<String, i32> {
    let both = formats.entries().into_iter().zip(prelude::written_formats(formats).entries());
    both.filter(|(own, written)| own != written).map(|((name, bits), _)| (name.to_owned(), bits)).collect()
}

/// A file says, in a line `; team: ray`, that it keeps to what the files of that profile agree on between them.
fn keeps_to_team(source: &Source, profile: KernelSet) -> bool {
    source.text.lines().any(|line| line.strip_prefix("; team: ") == Some(profile.name()))
}

fn assemble(
    image: &MemoryImage,
    features: &SceneFeatures,
    crop: &Crop,
    isa: &Isa,
    options: &KernelOptions,
    is_main: bool,
) -> Result<asm::Assembled, Report> {
    // Files that keep to a team replace its members without breaking it up.
    let strangers = options.replaced.iter().filter(|(_, source)| !keeps_to_team(source, options.profile));
    let replaced: Vec<Function> = strangers.map(|&(function, _)| function).collect();
    let walk = options.profile.walk(&replaced);
    // The prelude comes first, because files test its names in `.if`.
    let mut files: Vec<Arc<Source>> = vec![Source::new("<scene>", prelude::text(image, features, crop, walk, is_main))];
    files.extend(prelude::included(image.layout));
    for function in Function::of_program(is_main, features) {
        // The last file for a function counts, as the last of options that contradict each other does.
        let own = options.replaced.iter().rev().find(|(other, _)| *other == function).map(|(_, source)| source.clone());
        // No file means that the file of another function does this one's work.
        let ours = || {
            let (path, text) = options.profile.file(function, &replaced)?;
            Some(Source::new(format!("kernels/asm/{path}"), text))
        };
        files.extend(own.or_else(ours));
    }
    prelude::assemble(if is_main { "<main>" } else { "<core>" }, &files, isa)
}
