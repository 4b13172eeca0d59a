//! The image of global memory that a machine starts with: kd tree, triangles, materials, lights and an empty frame, and what the kernels
//! have to be told beside it. How structures look is said in [`crate::layout`].

mod arrange;
mod blocks;
mod decode;
mod encode;
#[cfg(test)]
mod tests;

use std::ops::Range;

use messages::{Diagnostic, Report};

use crate::cadrage::{self, Formats, Overrides};
use crate::camera::{self, RawCamera, Rays};
use crate::grid::Grid;
use crate::kdtree::{self, Bounds, Statistics, Triangles};
use crate::layout::{FAR_LIGHT, Layout, StructureSet};
use crate::model::{Scene, Triangle, Vec3, View};
pub use decode::{DecodedImage, StoredTriangle};

/// Octets from address 0 that are never used, so that 0 is no structure's address.
pub const HEADER: u32 = 16;

/// Choices of a user for an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MemoryOptions {
    /// Bits of a register: 8 to 32.
    pub word: u32,
    /// The layout of triangles and tree.
    pub layout: Layout,
    /// The height that the kd tree may have.
    pub kd_depth: kdtree::Depth,
    /// The method by which the kd tree is built.
    pub kd_method: kdtree::BuildMethod,
    /// Cost of visiting a node of the kd tree in percent of testing a triangle, 1 to [`kdtree::VISIT`]; trees of [`kdtree::BuildMethod::Binned`] go by it.
    pub kd_visit: u32,
    /// Fraction bits set by the user.
    pub formats: Overrides,
}

impl Default for MemoryOptions {
    fn default() -> MemoryOptions {
        MemoryOptions {
            word: 32,
            layout: Layout::Wide,
            kd_depth: kdtree::Depth::default(),
            kd_method: kdtree::BuildMethod::default(),
            kd_visit: kdtree::VISIT,
            formats: Overrides::default(),
        }
    }
}

/// The contents of a range of addresses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MemoryKind {
    /// Nothing: no address in it is valid.
    Header,
    /// Nodes of the kd tree, level by level; the root is the first.
    Nodes,
    /// References of the leaves, leaf by leaf.
    References,
    /// Triangles, by index.
    Triangles,
    /// Materials, by number.
    Materials,
    /// Lights, by number.
    Lights,
    /// Pixels, row 0 first.
    Frame,
}

impl MemoryKind {
    /// All kinds in the order of their addresses.
    pub const ALL: [MemoryKind; 7] = [
        MemoryKind::Header,
        MemoryKind::Nodes,
        MemoryKind::References,
        MemoryKind::Triangles,
        MemoryKind::Materials,
        MemoryKind::Lights,
        MemoryKind::Frame,
    ];

    /// Name in listings and traces.
    pub const fn name(self) -> &'static str {
        match self {
            MemoryKind::Header => "header",
            MemoryKind::Nodes => "nodes",
            MemoryKind::References => "references",
            MemoryKind::Triangles => "triangles",
            MemoryKind::Materials => "materials",
            MemoryKind::Lights => "lights",
            MemoryKind::Frame => "frame",
        }
    }
}

/// Addresses of each kind, in the order of [`MemoryKind::ALL`].
pub type Regions = [(MemoryKind, Range<u32>); 7];

/// A memory image and the raw integers that go with it.
#[derive(Clone, Debug)]
pub struct MemoryImage {
    /// Global memory from address 0; the frame at its end is zero.
    pub bytes: Vec<u8>,
    /// The layout of triangles and tree.
    pub layout: Layout,
    /// The structures, with the widths of their fields.
    pub structures: StructureSet,
    /// Addresses of each kind, in the order of [`MemoryKind::ALL`]; they start at multiples of 8, and may be empty.
    pub regions: Regions,
    /// Address of the tree's root, in the layout `packed` its name.
    pub root: u32,
    /// Box of the tree's root, raw: the scene's, one stored unit larger on every side.
    pub bounds: Bounds,
    /// Width and height of the frame in pixels.
    pub size: (u32, u32),
    /// Fraction bits of all quantities.
    pub formats: Formats,
    /// The grid, which says where the scene lies on the integers.
    pub grid: Grid,
    /// The camera, which says where the rays of the pixels start and go.
    pub camera: RawCamera,
    /// Ambient intensity in the colour format.
    pub ambient: i32,
    /// Colour where a ray hits nothing, in the colour format.
    pub background: [i32; 3],
    /// Numbers of triangles, materials and lights.
    pub counts: StructureCounts,
    /// Size and shape of the tree that is stored; the tree itself is in the octets alone ([`MemoryImage::decode`] reads it back).
    pub tree: Statistics,
}

/// Numbers of structures in an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StructureCounts {
    /// Triangles.
    pub triangles: u32,
    /// Materials.
    pub materials: u32,
    /// Lights.
    pub lights: u32,
}

impl MemoryImage {
    /// The addresses of one kind.
    pub fn region(&self, kind: MemoryKind) -> Range<u32> {
        self.regions.iter().find(|(k, _)| *k == kind).map_or(0..0, |(_, range)| range.clone())
    }

    /// True where lights have steps of their own.
    pub fn has_far_lights(&self) -> bool {
        self.structures.light.fields.len() == FAR_LIGHT.fields.len()
    }

    /// The contents of an address, `None` beyond the end and in the gaps between the regions.
    pub fn kind(&self, address: u32) -> Option<MemoryKind> {
        self.regions.iter().find(|(_, range)| range.contains(&address)).map(|(kind, _)| *kind)
    }
}

/// Puts a scene into memory.
///
/// Vertices are rounded to the grid and, in the report's layout, further to the 16 bits that it stores; the tree is built on the vertices as
/// they are stored, so planes and triangles agree.
///
/// # Errors
/// What [`Grid::new`], [`Formats::new`], [`Rays::new`], [`RawCamera::new`] and [`kdtree::build`] refuse, more materials than a triangle can
/// name, coefficients that do not fit their format, leaves with more triangles than a node can count, and an image beyond 32-bit addresses.
pub fn build(scene: &Scene, view: &View, options: &MemoryOptions) -> Result<MemoryImage, Report> {
    let layout = options.layout;
    let shift = layout.coordinate_shift(options.word);
    let grid = if shift == 0 { Grid::new } else { Grid::of_powers };
    let grid = grid(scene, view, options.word, options.formats.position)?;
    // Leave out first what the layout does not store, so that tree, boxes and kernels all see the same corners
    let vertices: Vec<[i32; 3]> = scene.vertices.iter().map(|&vertex| stored_place(&grid, layout, vertex)).collect();
    let mesh = GridMesh { vertices: &vertices, triangles: &scene.triangles };
    let unit = 1 << shift;
    let boxes = (0..mesh.count()).map(|index| Bounds::of_triangle(&mesh.vertices(index)));
    // Without triangles the grid's own box remains, since the camera still needs one.
    let inner = boxes.reduce(|a, b| a.union(&b)).unwrap_or_else(|| {
        let Bounds { low, high } = grid.bounds();
        Bounds { low: low.map(|x| stored(x, shift) << shift), high: high.map(|x| stored(x, shift) << shift) }
    });
    let bounds = inner.enlarged(unit);
    let formats = Formats::new(scene, view, &grid, 2 * unit as u32 + 2, &options.formats)?;
    // The camera comes to the grid with the scene, so that a scene moved by whole steps has the same rays.
    let local = View { camera: camera::mapped(&view.camera, |p| grid.local(p)), ..view.clone() };
    let rays = Rays::new(grid.local_corners(), &local)?;
    let camera = RawCamera::new(&rays, view.size, &formats, &bounds)?;
    let colour = |name: &str, value: f64| {
        cadrage::raw(value, formats.colour, formats.word)
            .ok_or_else(|| out_of_range(name, value, "colour", formats.colour, formats.word))
    };
    let ambient = colour("the ambient intensity", view.ambient)?;
    let background = three(view.background, |x| colour("the background", x))?;
    let tree = kdtree::build_in_order(&mesh, bounds, options.kd_depth, options.kd_method, options.kd_visit)?;
    let tables = encode::Tables::new(scene, &grid, &formats, layout)?;
    let parts =
        arrange::ImageParts { tree: &tree, scene, triangles: &mesh, tables: &tables, layout, shift, size: view.size };
    let encode::EncodedMemory { bytes, regions, structures, root } = encode::memory(&parts)?;
    let counts = StructureCounts {
        triangles: scene.triangles.len() as u32,
        materials: scene.materials.len() as u32,
        lights: scene.lights.len() as u32,
    };
    Ok(MemoryImage {
        bytes,
        layout,
        structures,
        regions,
        root,
        bounds,
        size: view.size,
        formats,
        grid,
        camera,
        ambient,
        background,
        counts,
        tree: tree.statistics(),
    })
}

/// The triangles of a scene with their vertices on the grid.
struct GridMesh<'a> {
    vertices: &'a [[i32; 3]],
    triangles: &'a [Triangle],
}

impl Triangles for GridMesh<'_> {
    fn count(&self) -> usize {
        self.triangles.len()
    }

    fn vertices(&self, index: usize) -> [[i32; 3]; 3] {
        self.triangles[index].vertices.map(|vertex| self.vertices[vertex as usize])
    }
}

/// A vertex as triangles are stored with: on the grid, and without what the layout does not store.
pub fn stored_place(grid: &Grid, layout: Layout, vertex: Vec3) -> [i32; 3] {
    let shift = layout.coordinate_shift(grid.word);
    grid.raw(vertex).map(|x| stored(x, shift) << shift)
}

/// A raw coordinate as it is stored: shifted right, nearest, ties up, within 16 bits when it is shifted at all.
fn stored(raw: i32, shift: u32) -> i32 {
    if shift == 0 {
        return raw;
    }
    let rounded = (i64::from(raw) + (1i64 << (shift - 1))) >> shift;
    rounded.clamp(i64::from(i16::MIN), i64::from(i16::MAX)) as i32
}

/// `f` of each component, or its first error.
fn three<T, E>(values: Vec3, f: impl Fn(f64) -> Result<T, E>) -> Result<[T; 3], E> {
    let [a, b, c] = values;
    Ok([f(a)?, f(b)?, f(c)?])
}

fn out_of_range(name: &str, value: f64, format: &str, fraction: u32, word: u32) -> Report {
    let most = crate::vector::shifted(1.0, word as i32 - 1 - fraction as i32);
    Diagnostic::error(format!("{name} is {value}, which does not fit the {format} format"))
        .hint(format!("{fraction} fraction bits in a word of {word} hold values below {most}"))
        .into()
}
