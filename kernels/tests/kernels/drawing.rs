//! Scenes and pictures that several tests of kernels draw.

use isa::number::Modes;
use kernels::build::{Crop, KernelOptions, SceneFeatures};
use kernels::twin::samples::Samples;
use kernels::{KernelSet, twin};
use scenes::generate::{self, GenerateOptions, SCENES};
use scenes::image::{self, MemoryImage, MemoryOptions};
use scenes::metrics::{self, PictureError};
use scenes::model::{Picture, Scene, View};
use scenes::reference::{Reference, SearchMethod};

/// A scene of the list, coarse: its least level, or about so many triangles.
pub fn coarse(number: usize, triangles: u32, size: (u32, u32)) -> Scene {
    let generator = &SCENES[number];
    let level = generator.level.as_ref().map(|level| (*level.range.start()).max(1));
    let triangles = generator.triangles.as_ref().map(|_| triangles);
    generate::scene(generator.name, &GenerateOptions { level, triangles, size }).expect("a scene of the list")
}

/// The memory image of a scene and the picture that the twins of a set draw from it, in real numbers.
pub fn twin_picture(scene: &Scene, view: &View, set: KernelSet, modes: Modes) -> (MemoryImage, Picture) {
    let options = MemoryOptions { word: modes.word, layout: set.layout(), ..MemoryOptions::default() };
    let image = image::build(scene, view, &options).expect("the scene fits the word");
    let options = KernelOptions { profile: set, ..KernelOptions::default() };
    let features = SceneFeatures::new(scene, view, &image.formats, &options);
    let (width, height) = view.size;
    let crop = Crop { column: 0, row: 0, width, height };
    let pixels = twin::render(&image, &features, &crop, set, modes).expect("no ray is stuck");
    let step = (-f64::from(image.formats.colour)).exp2();
    let pixels = pixels.iter().map(|pixel| pixel.map(|raw| f64::from(raw) * step)).collect();
    (image, Picture { size: view.size, pixels })
}

/// A picture of a set and that of double precision.
pub fn pair(scene: &Scene, view: &View, set: KernelSet, modes: Modes) -> [Picture; 2] {
    let (image, picture) = twin_picture(scene, view, set, modes);
    let reference = Reference::new(scene, view, SearchMethod::Hierarchy).expect("the reference draws any scene");
    let exact = reference.picture(Some(&Samples::new(scene, &image, set, modes))).picture;
    [picture, exact]
}

/// The difference of a set's picture from double precision.
pub fn error(scene: &Scene, view: &View, set: KernelSet, modes: Modes) -> PictureError {
    let [picture, exact] = pair(scene, view, set, modes);
    metrics::compare(&picture, &exact).expect("pictures of one size")
}
