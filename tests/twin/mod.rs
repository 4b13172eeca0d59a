//! A scene as the tests use it; what is compared stands in the modules.

mod accuracy;
mod bench;
mod functions;
mod operands;
mod pictures;
mod ray_unit;
mod report;
mod surfaces;
mod vectors;

use isa::number::Modes;
use kernels::build::{KernelOptions, SceneFeatures};
use kernels::twin::Twin;
use kernels::{KernelSet, Skips};
use messages::Report;
use scenes::image::{self, MemoryImage};
use scenes::model::{Scene, View};

/// A scene on a machine with certain modes.
struct Subject {
    scene: Scene,
    view: View,
    image: MemoryImage,
    features: SceneFeatures,
    modes: Modes,
    profile: KernelSet,
}

impl Subject {
    fn new(scene: Scene, view: View, modes: Modes, options: image::MemoryOptions) -> Result<Subject, Report> {
        let image = image::build(&scene, &view, &image::MemoryOptions { word: modes.word, ..options })?;
        let features = SceneFeatures::new(&scene, &view, &image.formats, &KernelOptions::default());
        Ok(Subject { scene, view, image, features, modes, profile: KernelSet::Vector })
    }

    /// The subject with other kernels.
    fn with(self, profile: KernelSet) -> Subject {
        let features = SceneFeatures { skips: Skips::default().known_to(profile), ..self.features };
        Subject { features, profile, ..self }
    }

    fn twin(&self) -> Twin<Modes> {
        Twin::new(&self.image, &self.features, self.profile, self.modes).expect("an image that was built can be read")
    }

    fn machine(&self) -> emu::machine::Config {
        let mut config = emu::machine::Config::default();
        config.arithmetic.word = self.modes.word;
        config.arithmetic.quantization = self.modes.quantization;
        config.arithmetic.overflow = self.modes.overflow;
        config
    }
}
