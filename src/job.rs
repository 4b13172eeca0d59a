//! A picture to be drawn: everything that decides its bits, its counts and its clocks. Nothing here runs anything.

use std::path::{Path, PathBuf};

use emu::engine::EngineKind;
use emu::machine::Config;
use isa::Isa;
use kernels::build::{Crop, KernelOptions};
use messages::Report;
use scenes::cadrage::Overrides;
use scenes::image::MemoryOptions;
use scenes::kdtree::{BuildMethod, Depth, VISIT};
use scenes::layout::Layout;
use scenes::model::{Scene, View};

use crate::machine;
use crate::settings::FileSettings;

/// Results of a picture beside its colours, counts and clocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    /// Totals of functions and regions, and least and most of one call, which take time.
    Extremes,
    /// Totals of functions and regions.
    Functions,
    /// Totals of functions and regions, and their clocks of computing and waiting, which take some time.
    Clocks,
    /// Totals and clocks of functions and regions, and the clocks of the bus over time.
    Course,
    /// Nothing more.
    Totals,
}

/// Name by which a scene was found.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SceneSource {
    /// File, or name of a generated scene.
    pub name: String,
    /// Mesh that was named beside it.
    pub mesh: Option<PathBuf>,
}

/// Everything that decides a picture and what it costs.
#[derive(Clone, Debug)]
pub struct Job {
    /// The scene that is drawn.
    pub scene: Scene,
    /// Name by which the scene was found.
    pub source: SceneSource,
    /// Camera, size, light and depth of the picture.
    pub view: View,
    /// Structures of global memory; `None` for those that the set of kernels is made for.
    pub layout: Option<Layout>,
    /// Levels of the kd tree below its root; `None` for those of the set of kernels.
    pub kd_depth: Option<Depth>,
    /// Way to build the kd tree; `None` for that of the set of kernels.
    pub kd_method: Option<BuildMethod>,
    /// Cost of visiting a node of the kd tree in percent of testing a triangle, for trees of the method `binned`.
    pub kd_visit: u32,
    /// Fraction bits that the scene does not choose.
    pub formats: Overrides,
    /// The instructions that there are.
    pub isa: Isa,
    /// Files from which some of them were loaded.
    pub extensions: Vec<FileSettings>,
    /// Choices for the kernels that draw it.
    pub kernels: KernelOptions,
    /// Name of the machine.
    pub machine_name: String,
    /// The machine.
    pub machine: Config,
    /// Engine that executes its programs.
    pub engine: EngineKind,
    /// Results beside colours, counts and clocks.
    pub detail: Detail,
    /// True where the picture is measured against double precision.
    pub error: bool,
    /// True where losses of results are counted.
    pub flags: bool,
    /// True where a picture's energy is told.
    pub energy: bool,
    /// True where a picture is run beside exact arithmetic.
    pub shadow: bool,
    /// Levels of secondary rays in double precision; `None` for as many as the picture has.
    pub reference_bounces: Option<u32>,
    /// Likely mistakes in the scene's files.
    pub warnings: Report,
    /// All files that were read for it.
    pub files: Vec<PathBuf>,
}

impl Job {
    /// A scene with the defaults of everything else.
    pub fn new(scene: Scene) -> Job {
        let view = View::new(scene.size);
        Job {
            source: SceneSource { name: scene.name.clone(), mesh: None },
            scene,
            view,
            layout: None,
            kd_depth: None,
            kd_method: None,
            kd_visit: VISIT,
            formats: Overrides::default(),
            isa: Isa::base(),
            extensions: Vec::new(),
            kernels: KernelOptions::default(),
            machine_name: machine::DEFAULT.to_owned(),
            machine: Config::default(),
            engine: EngineKind::default(),
            detail: Detail::Functions,
            error: true,
            flags: false,
            energy: false,
            shadow: false,
            reference_bounces: None,
            warnings: Report::default(),
            files: Vec::new(),
        }
    }

    /// The scene's layout in memory: in the machine's words, in the chosen structures or those of the kernels.
    pub fn memory(&self) -> MemoryOptions {
        MemoryOptions {
            word: self.machine.arithmetic.word,
            layout: self.layout(),
            kd_depth: self.kd_depth(),
            kd_method: self.kd_method(),
            kd_visit: self.kd_visit,
            formats: self.formats,
        }
    }

    /// Structures of global memory.
    pub fn layout(&self) -> Layout {
        self.layout.unwrap_or(self.kernels.profile.layout())
    }

    /// Levels of the kd tree below its root.
    pub fn kd_depth(&self) -> Depth {
        self.kd_depth.unwrap_or(self.kernels.profile.kd_depth())
    }

    /// Way to build the kd tree.
    pub fn kd_method(&self) -> BuildMethod {
        self.kd_method.unwrap_or(self.kernels.profile.kd_method())
    }

    /// The view of the picture in double precision.
    pub fn reference_view(&self) -> View {
        self.view_of(self.reference_bounces)
    }

    /// The view of a picture with so many levels of secondary rays, or as many as the job's has.
    pub fn view_of(&self, bounces: Option<u32>) -> View {
        View { bounces: bounces.unwrap_or(self.view.bounces), ..self.view.clone() }
    }

    /// The part of the picture that is drawn: all of it unless the user chose one.
    pub fn crop(&self) -> Crop {
        let (width, height) = self.view.size;
        self.kernels.crop.unwrap_or(Crop { column: 0, row: 0, width, height })
    }
}

/// A short name for results: the file's stem, or the generated scene's name.
pub fn result_name(scene: &Scene) -> String {
    let name = Path::new(&scene.name).file_name().map(|name| name.to_string_lossy().into_owned());
    name.filter(|name| !name.is_empty()).unwrap_or_else(|| "scene".to_owned())
}
