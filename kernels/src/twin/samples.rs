//! Camera rays on edges: what the kernels decide where double precision cannot, for the reference that pictures are measured against.

use isa::number::Modes;
use scenes::camera::RawCamera;
use scenes::grid::Grid;
use scenes::image::{MemoryImage, stored_place};
use scenes::kdtree::Bounds;
use scenes::layout::Layout;
use scenes::model::Scene;
use scenes::reference::Ties;

use super::camera::camera;
use super::trace::triangle;
use crate::constants::Constants;
use crate::set::KernelSet;

/// Camera rays and triangles of a scene as a set of kernels has them, without a copy of its memory.
#[derive(Clone, Debug)]
pub struct Samples<'a> {
    scene: &'a Scene,
    set: KernelSet,
    modes: Modes,
    constants: Constants,
    camera: RawCamera,
    root: Bounds,
    grid: Grid,
    layout: Layout,
}

impl<'a> Samples<'a> {
    /// The samples of a scene in memory, drawn by a set of kernels in these modes. The image's octets are not needed.
    pub fn new(scene: &'a Scene, image: &MemoryImage, set: KernelSet, modes: Modes) -> Samples<'a> {
        let constants = Constants::new(image);
        Samples {
            scene,
            set,
            modes,
            constants,
            camera: image.camera,
            root: image.bounds,
            grid: image.grid,
            layout: image.layout,
        }
    }
}

impl Ties for Samples<'_> {
    fn distance(&self, [column, row]: [u32; 2], index: u32) -> Option<i64> {
        let ray = camera(&self.modes, self.constants.formats.direction, &self.camera, &self.root, column, row);
        let corners = self.scene.triangles[index as usize].vertices;
        let corners = corners.map(|vertex| stored_place(&self.grid, self.layout, self.scene.vertices[vertex as usize]));
        let t = triangle(&self.modes, self.set.decisions(), &self.constants, &ray, &corners);
        (t < self.constants.missed).then_some(t.into())
    }
}
