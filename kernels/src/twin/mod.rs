//! The twins: every function of the kernels in Rust, bit for bit. They are written from the same formulas and roundings as the assembly
//! and share no code with it, so each is the other's test; together they draw whole pictures natively.
//!
//! A file has the name of the function that it is the twin of; small ones stand beside those that use them.

pub mod camera;
pub mod descend;
pub mod exact_triangle;
pub mod exit_face;
pub mod first_packet;
pub mod packets;
pub mod planes;
pub mod ray;
pub mod ray_tree;
pub mod reflect;
pub mod refract;
pub mod report;
pub mod samples;
mod shade;
pub mod stage;
pub mod surface;
mod trace;
pub mod triangle;
pub mod unit;
pub mod vector_arithmetic;

use std::fmt;

use isa::number::{Arithmetic, Modes, Nearest32, Vector};
use rayon::prelude::*;
use scenes::camera::RawCamera;
use scenes::image::MemoryImage;

use crate::build::{Crop, SceneFeatures};
use crate::constants::Constants;
use crate::set::{Decisions, KernelSet};
use ray::{Packet, Stuck, TwinRay};
use ray_tree::Branch;
use stage::TwinStage;

/// All that the twins of a scene's kernels share.
#[derive(Clone, Debug)]
pub struct Twin<A> {
    /// Set of the kernels whose twin it is.
    pub profile: KernelSet,
    /// Word and modes.
    pub arithmetic: A,
    /// Shifts and limits.
    pub constants: Constants,
    /// Features of the scene, by which rays have children or not.
    pub features: SceneFeatures,
    /// Tree, triangles, materials and lights.
    pub stage: TwinStage,
    /// Origins and directions of the camera rays.
    pub camera: RawCamera,
    /// Ambient intensity in the colour format.
    pub ambient: i32,
    /// Colour where a ray hits nothing, in the colour format.
    pub background: Vector,
}

/// Reason that there is no picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TwinFailure {
    /// The octets of the image hold no scene.
    NoScene,
    /// A ray of this pixel, counted from 0 row by row, visits more packets than there are.
    Stuck {
        /// The first such pixel.
        pixel: u32,
    },
}

impl fmt::Display for TwinFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TwinFailure::NoScene => f.write_str("the memory image holds no scene"),
            TwinFailure::Stuck { pixel } => write!(f, "a ray of pixel {pixel} visits more packets than there are"),
        }
    }
}

impl std::error::Error for TwinFailure {}

/// The frame that the machine draws: the pixels of `crop` in the colour format, row by row, on all host threads.
///
/// # Errors
/// An image that holds no scene, or a ray for which the machine traps.
pub fn render(
    image: &MemoryImage,
    features: &SceneFeatures,
    crop: &Crop,
    profile: KernelSet,
    modes: Modes,
) -> Result<Vec<Vector>, TwinFailure> {
    if modes == Modes::default() {
        Twin::new(image, features, profile, Nearest32).ok_or(TwinFailure::NoScene)?.render(crop)
    } else {
        Twin::new(image, features, profile, modes).ok_or(TwinFailure::NoScene)?.render(crop)
    }
}

impl<A: Arithmetic> Twin<A> {
    /// The twin of the kernels for an image, whose word the arithmetic has to have; `None` when its octets hold no scene.
    pub fn new(image: &MemoryImage, features: &SceneFeatures, profile: KernelSet, arithmetic: A) -> Option<Twin<A>> {
        Some(Twin {
            profile,
            arithmetic,
            constants: Constants::new(image),
            features: *features,
            stage: TwinStage::new(image)?,
            camera: image.camera,
            ambient: image.ambient,
            background: image.background,
        })
    }

    /// The pixels of `crop` in the colour format, row by row; the same for any number of host threads.
    ///
    /// # Errors
    /// A ray for which the machine traps.
    pub fn render(&self, crop: &Crop) -> Result<Vec<Vector>, TwinFailure>
    where
        A: Sync,
    {
        let rows: Vec<Result<Vec<Vector>, TwinFailure>> =
            (0..crop.height).into_par_iter().map(|row| self.row(crop, row)).collect();
        let mut pixels = Vec::with_capacity(crop.width as usize * crop.height as usize);
        for row in rows {
            pixels.extend(row?);
        }
        Ok(pixels)
    }

    fn row(&self, crop: &Crop, row: u32) -> Result<Vec<Vector>, TwinFailure> {
        let mut branches = Vec::new();
        let pixels = (0..crop.width).map(|column| {
            let pixel = |Stuck| TwinFailure::Stuck { pixel: row * crop.width + column };
            self.pixel(crop.column + column, crop.row + row, &mut branches).map_err(pixel)
        });
        pixels.collect()
    }

    /// The colour of a pixel. `branches` is room that pixels may share.
    fn pixel(&self, column: u32, row: u32, branches: &mut Vec<Branch>) -> Result<Vector, Stuck> {
        let ray = self.camera_ray(column, row);
        let first = self.camera_packet(&ray);
        self.ray_tree(ray, first, branches)
    }

    /// The ray of a pixel, row 0 on top.
    pub fn camera_ray(&self, column: u32, row: u32) -> TwinRay {
        camera::camera(
            &self.arithmetic,
            self.constants.formats.direction,
            &self.camera,
            &self.stage.bounds,
            column,
            row,
        )
    }

    /// The first packet of a camera ray; `None` when it misses the scene's box.
    pub fn camera_packet(&self, ray: &TwinRay) -> Option<Packet> {
        match self.profile.decisions() {
            Decisions::Rounded => report::first_packet(&self.arithmetic, &self.constants, &self.stage, ray),
            Decisions::Wide | Decisions::Exact => first_packet::first_packet(&self.arithmetic, &self.stage, ray),
        }
    }
}
