//! The programs that measure the rows: the kernels of the profile `report` as a small scene in the report's layout asks for them, and a
//! driver instead of the main program.

use std::ops::RangeInclusive;
use std::sync::Arc;

use isa::{Isa, Program};
use messages::{Report, Source};
use scenes::image::{self, MemoryImage};
use scenes::layout::Layout;
use scenes::model::{Light, Material, Scene, Triangle, View};

use super::Row;
use crate::build::{Crop, KernelOptions, SceneFeatures};
use crate::function::Function;
use crate::prelude;
use crate::set::KernelSet;
use crate::skip::Skips;

/// Octets of global memory that every driver is content with.
pub const MEMORY: usize = 128 << 10;

macro_rules! files {
    ($($path:literal)*) => {
        &[$(($path, include_str!(concat!("../../asm/", $path)))),*]
    };
}

/// The drivers, and what they share.
const DRIVERS: &[(&str, &str)] = files! {
    "annex/world.inc" "annex/sqrt.s" "annex/triangle.s" "annex/packet.s" "annex/normal.s" "annex/exit_face.s" "annex/descend.s"
    "annex/first_packet.s" "annex/next_packet.s" "annex/node.s" "annex/pixel.s" "report.inc" "scalar.inc"
    "surface.inc"
};

/// A scene that needs every function.
const EVERYTHING: SceneFeatures = SceneFeatures {
    has_mirror: true,
    is_transparent: true,
    bounces: 1,
    cutoff: 0,
    skips: Skips::ALL,
    loads_ahead: false,
    agreement: None,
};

/// The functions that a driver may call.
fn functions() -> impl Iterator<Item = (&'static str, &'static str)> {
    // A driver takes the place of `pixel`, and calls the first packet from a core, which only the main processor does else.
    let core = Function::of_program(false, &EVERYTHING).filter(|&function| function != Function::Pixel);
    core.chain([Function::FirstPacket]).filter_map(|function| KernelSet::Report.file(function, &[]))
}

/// A file of the kernels, path and text, by its path below their folder.
pub(super) fn file(path: &str) -> Option<(&'static str, &'static str)> {
    functions().chain(DRIVERS.iter().copied()).find(|(name, _)| *name == path)
}

/// One light, one material that reflects and lets light through, a triangle that fills the box from -1 to 1: its coordinates have 29
/// fraction bits, of which 13 are stored.
pub(super) fn scene() -> Scene {
    Scene {
        name: "annex".into(),
        size: (1, 1),
        materials: vec![Material { colour: [1.0; 3], reflection: 0.25, intensity: 0.5, index: 1.5 }],
        lights: vec![Light { position: [0.25, 0.5, 1.5], colour: [1.0; 3] }],
        vertices: vec![[-1.0, -1.0, -1.0], [1.0, -1.0, 1.0], [0.0, 1.0, 0.0]],
        triangles: vec![Triangle { vertices: [0, 1, 2], material: 0 }],
    }
}

fn image(scene: &Scene, view: &View) -> Result<MemoryImage, Report> {
    image::build(scene, view, &image::MemoryOptions { layout: Layout::Report, ..image::MemoryOptions::default() })
}

impl Row {
    /// The numbers that the driver is tried with, in order: one for rows without a search, which know no number.
    pub fn tries(&self) -> RangeInclusive<u32> {
        1..=self.search.as_ref().map_or(1, |search| search.most)
    }

    /// The program that measures the row, tried with a number, and the global memory that it starts with. It needs no other core.
    ///
    /// # Errors
    /// What the assembler finds; our own kernels have no errors.
    pub fn program(&self, number: u32, isa: &Isa) -> Result<(Program, Vec<u8>), Report> {
        let scene = scene();
        let view = View::new(scene.size);
        let mut image = image(&scene, &view)?;
        let options = KernelOptions { profile: KernelSet::Report, ..KernelOptions::default() };
        let features = SceneFeatures::new(&scene, &view, &image.formats, &options);
        let crop = Crop { column: 0, row: 0, width: 1, height: 1 };
        // The prelude of a core with the whole scene, then the number that is tried: a driver knows it as a constant.
        let mut text = prelude::text(&image, &features, &crop, KernelSet::Report.walk(&[]), false);
        if let Some(search) = &self.search {
            text += &format!(".equ {}, {number}\n", search.constant);
        }
        let mut files: Vec<Arc<Source>> = vec![Source::new("<assumptions>", text)];
        files.extend(prelude::included(Layout::Report));
        let driver = format!("annex/{}.s", self.driver);
        for (path, text) in functions().chain(file("annex/world.inc")).chain(file(&driver)) {
            files.push(Source::new(format!("kernels/asm/{path}"), text));
        }
        let program = prelude::assemble("<annex>", &files, isa)?.program;
        // Drivers build trees and packets of their own behind the scene.
        image.bytes.resize(MEMORY, 0);
        Ok((program, image.bytes))
    }

    /// The row's program, changed to walk to the right at so many levels, the first ones; as it is where the row has no spread.
    ///
    /// # Panics
    /// A driver without the word that its row's spread names; a test looks at all of them.
    pub fn to_the_right(&self, program: &Program, levels: u32) -> Program {
        let mut program = program.clone();
        if let Some(spread) = &self.spread {
            let at =
                usize::try_from(program.symbols[&spread.constant]).expect("a label of the buffer is an address of it");
            program.buffer[at..at + 4].copy_from_slice(&levels.to_le_bytes());
        }
        program
    }
}
