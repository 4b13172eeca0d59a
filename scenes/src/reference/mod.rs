//! The picture in double precision: an independent Whitted renderer that the coprocessor's pictures are measured against. It shares the
//! scene and the cameras' rays with the rest, but neither the kd tree nor its traversal, nor any intersection, shading or rounding.

mod hierarchy;
#[cfg(test)]
mod log_tests;
mod ray_log;
mod search;
mod short;
#[cfg(test)]
mod short_tests;
#[cfg(test)]
mod tests;
mod tie;
mod triangle;
mod whitted;

use messages::{Diagnostic, Report};
use rayon::prelude::*;
use serde::Serialize;

use crate::camera::{self, Corners, Rays};
use crate::model::{Picture, Scene, Vec3, View};
use crate::vector::{exponent, largest, shifted, sub};
use hierarchy::Hierarchy;
use ray_log::{LocalFrame, RayLog, RayWitness};
pub use ray_log::{RayKind, ReferenceHit, ReferenceLight, ReferenceRay};
use search::{Exhaustive, Search};
use tie::Sample;
pub use tie::Ties;
use triangle::Shapes;

/// Pixels of the largest picture that is rendered.
pub const MOST_PIXELS: u64 = 1 << 27;

/// Number of rays that were sent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RayCounts {
    /// From the camera, one a pixel.
    pub camera: u64,
    /// Mirrored ones, totally reflected ones included.
    pub reflected: u64,
    /// Refracted ones, which passed a surface.
    pub refracted: u64,
    /// Towards lights.
    pub shadow: u64,
}

impl RayCounts {
    /// The sum of both.
    pub fn plus(self, other: RayCounts) -> RayCounts {
        RayCounts {
            camera: self.camera + other.camera,
            reflected: self.reflected + other.reflected,
            refracted: self.refracted + other.refracted,
            shadow: self.shadow + other.shadow,
        }
    }
}

/// A picture and what it took.
#[derive(Clone, Debug, PartialEq)]
pub struct Rendering {
    /// The picture; linear, not clamped.
    pub picture: Picture,
    /// The rays that were sent.
    pub rays: RayCounts,
}

/// The way in which the triangle that a ray meets is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SearchMethod {
    /// By a hierarchy of boxes.
    #[default]
    Hierarchy,
    /// By trying all triangles: slow, and simple enough to be believed.
    Exhaustive,
}

/// A scene made ready for rays.
pub struct Reference<'a> {
    search: Box<dyn Search + 'a>,
    world: whitted::World<'a>,
    rays: Rays,
    frame: LocalFrame,
    size: (u32, u32),
}

impl<'a> Reference<'a> {
    /// Prepares a scene. All coordinates are taken relative to the middle of the scene's box and multiplied by a power of two that makes the
    /// box at most 2 long, so that scenes of any size and place keep the same relative precision.
    ///
    /// # Errors
    /// What [`Scene::check`], [`View::check`] and [`Rays::new`] refuse, and pictures of more than [`MOST_PIXELS`].
    pub fn new(scene: &'a Scene, view: &View, method: SearchMethod) -> Result<Reference<'a>, Report> {
        Reference::framed(scene, scene.bounds(), view, method)
    }

    /// A reference with a camera that looks at another box than the scene's own, as where its vertices were rounded; `None` is that from -1 to 1.
    ///
    /// # Errors
    /// As [`Reference::new`].
    pub fn framed(
        scene: &'a Scene,
        corners: Option<Corners>,
        view: &View,
        method: SearchMethod,
    ) -> Result<Reference<'a>, Report> {
        let mut report = scene.check();
        report.0.extend(view.check().0);
        let pixels = u64::from(view.size.0) * u64::from(view.size.1);
        if pixels > MOST_PIXELS {
            report.0.push(Diagnostic::error(format!(
                "a picture of {} x {} pixels is more than the reference renders ({MOST_PIXELS})",
                view.size.0, view.size.1
            )));
        }
        if report.has_errors() {
            return Err(report);
        }
        let corners = corners.unwrap_or(([-1.0; 3], [1.0; 3]));
        let middle = camera::centre(corners);
        let halves = |p: Vec3| p.map(|x| x / 2.0);
        // Halves, because the distance of two representable points need not be representable.
        let power = exponent(largest(sub(halves(corners.1), halves(corners.0))));
        let local = |p: Vec3| [0, 1, 2].map(|k| shifted(p[k] / 2.0 - middle[k] / 2.0, 1 - power));
        let shapes =
            Shapes { vertices: scene.vertices.iter().map(|&p| local(p)).collect(), triangles: &scene.triangles };
        let indices = shapes.visible();
        let local_view = View { camera: camera::mapped(&view.camera, local), ..view.clone() };
        let rays = Rays::new((local(corners.0), local(corners.1)), &local_view)?;
        let search: Box<dyn Search + 'a> = match method {
            SearchMethod::Hierarchy => Box::new(Hierarchy::new(shapes, indices)),
            SearchMethod::Exhaustive => Box::new(Exhaustive { shapes, indices }),
        };
        let frame = LocalFrame { middle, power };
        Ok(Reference { search, world: whitted::World::new(scene, view, local), rays, frame, size: view.size })
    }

    /// True where the camera ray of column `c` and row `r`, row 0 on top, meets a triangle.
    pub fn is_met(&self, c: u32, r: u32) -> bool {
        let (origin, direction) = self.rays.ray(c, r);
        self.search.nearest(&triangle::ShearedRay::new(origin, direction)).is_some()
    }

    /// The colour of the pixel in column `c` and row `r`, row 0 on top, and the rays that it took. A camera ray on an edge is decided by
    /// `ties`; without them, as one whose direction is moved by an infinitely small amount, which all other rays are.
    pub fn pixel(&self, c: u32, r: u32, ties: Option<&dyn Ties>) -> (Vec3, RayCounts) {
        let mut counts = RayCounts::default();
        let colour = self.colour(c, r, ties, &mut counts);
        (colour, counts)
    }

    /// The colour of a pixel, and the rays of its tree in the order in which they are followed: depth first, the reflected child before the
    /// refracted one. The colour is the sum of what they bring back, each by its weight. `ties` as in [`Reference::pixel`].
    pub fn explain(&self, c: u32, r: u32, ties: Option<&dyn Ties>) -> (Vec3, Vec<ReferenceRay>) {
        let mut log = RayLog { frame: self.frame, rays: Vec::new() };
        let colour = self.colour(c, r, ties, &mut log);
        (colour, log.rays)
    }

    fn colour(&self, c: u32, r: u32, ties: Option<&dyn Ties>, witness: &mut impl RayWitness) -> Vec3 {
        let (origin, direction) = self.rays.ray(c, r);
        let sample = ties.map(|ties| Sample { pixel: [c, r], ties });
        let ray = triangle::ShearedRay::new(origin, direction);
        self.world.colour(self.search.as_ref(), ray.of(sample), witness)
    }

    /// The whole picture, rows in parallel; the same bits for any number of threads. `ties` as in [`Reference::pixel`].
    pub fn picture(&self, ties: Option<&dyn Ties>) -> Rendering {
        let (width, height) = self.size;
        let row = |r: u32| {
            let pixels = (0..width).map(|c| self.pixel(c, r, ties));
            let mut rays = RayCounts::default();
            let colours: Vec<Vec3> = pixels
                .map(|(colour, counts)| {
                    rays = rays.plus(counts);
                    colour
                })
                .collect();
            (colours, rays)
        };
        let rows: Vec<_> = (0..height).into_par_iter().map(row).collect();
        let rays = rows.iter().fold(RayCounts::default(), |sum, (_, counts)| sum.plus(*counts));
        let pixels = rows.into_iter().flat_map(|(colours, _)| colours).collect();
        Rendering { picture: Picture { size: self.size, pixels }, rays }
    }
}

/// The picture of a scene in double precision.
///
/// # Errors
/// See [`Reference::new`].
pub fn render(scene: &Scene, view: &View) -> Result<Rendering, Report> {
    Ok(Reference::new(scene, view, SearchMethod::Hierarchy)?.picture(None))
}

/// The picture of a scene, each ray tried against all triangles.
///
/// # Errors
/// See [`Reference::new`].
pub fn render_exhaustively(scene: &Scene, view: &View) -> Result<Rendering, Report> {
    Ok(Reference::new(scene, view, SearchMethod::Exhaustive)?.picture(None))
}
