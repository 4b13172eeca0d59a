//! Steps that fit a scene in short words: as short as the box allows, and, of parallel rays, a whole part of the way from sample to sample.
//!
//! A power of two leaves up to half of a word's numbers unused: a box 8 wide has 262,144 steps in words of 20 bits, where 524,280 fit. With
//! steps of another length, scene coordinates are multiplied by a *stretch* once, before they are rounded, and nothing else knows of it.
//!
//! Of parallel rays the samples stand a *pitch* apart. If that is a whole number of steps, samples are on the grid as they are: nothing of them is
//! rounded, and an edge is only as far off as its corners are. And all samples have the same place between two numbers, which can be chosen. It
//! decides about edges that run along a column or a row of samples. Rounding keeps order, so such an edge stays on its side of a sample or falls
//! on it, and then the sample counts as beyond the edge (docs/exactness.md, where all rays move by the same infinitely small amount). That is
//! wrong for an edge at v, less than half a step beyond the sample at n: v is rounded to n. With the origin moved so that samples are at n + p and
//! are rounded to n, only edges less than 1/2 - p beyond the sample are wrong; in turn all samples are p off. For example, an edge 0.44 steps
//! beyond the samples of a column of 170 pixels is wrong at p = 0 and right at p = 1/16.

use super::{Grid, box_limit};
use crate::camera::Rays;
use crate::kdtree::Bounds;
use crate::model::{Camera, Scene, Vec3, View};
use crate::vector::{AXES, largest, nearest, scale, shifted, sub};

/// Words from this length on have steps of a power of two: they have more bits than a picture asks for, and their coordinates can be read.
pub(super) const LONGEST: u32 = 32;

/// Bound below the stretch of positions that are given. A box of 8 has corners at 2^8 steps of 2^-6, where the box of a word of 10 bits ends at 2^8 - 4: with
/// steps longer by a fiftieth it takes 10 bits, and without it would take 11.
pub(super) const LEAST_GIVEN: f64 = 31.0 / 32.0;

/// Fewest steps of a pitch: with fewer, a whole number of them would lose too much of a step's length.
const FEWEST_STEPS: f64 = 8.0;

/// Part of the box up to which a sample is on an edge; the reference leaves it to the kernels ([`crate::reference`]).
const ON_EDGE: i32 = -42;

/// Places of samples between two numbers that are tried, in 1/64 steps; from 32 on a sample would be rounded up.
const PLACES: std::ops::Range<u32> = 0..32;

/// The grid of a scene with the shortest steps that fit a box of `width` bits, from one with steps of a power of two; `None` where the powers of two hold
/// all corners as they are, or where the stretch would not be more than `least`.
pub(super) fn fitted(powers: &Grid, (width, least): (u32, f64), scene: &Scene, view: &View) -> Option<Grid> {
    let corners = || scene.triangles.iter().flat_map(|triangle| triangle.vertices);
    let is_exact = |vertex: u32| {
        let place = powers.local(scene.vertices[vertex as usize]);
        place == place.map(nearest)
    };
    if corners().all(is_exact) {
        return None;
    }
    // Sides are differences, so they do not change when a scene is moved by whole steps.
    let limit = box_limit(width) as f64;
    let down = |p: Vec3| p.map(|x| shifted(x, -powers.unit));
    let base = down(powers.corners.0);
    let power = powers.position + powers.unit;
    let side = sub(down(powers.corners.1), base).map(|x| shifted(x, power));
    // A step is left on each side for the middle and for rounding.
    let most = 2.0 * (limit - 1.0) / largest(side);
    let parallel = match view.camera {
        Camera::Orthographic => Rays::new(([0.0; 3], side), view).ok(),
        Camera::Perspective { .. } => None,
    };
    let samples = parallel.and_then(|rays| SampleLattice::new(rays, (least, most)));
    let stretch = samples.as_ref().map_or(most, |samples| samples.stretch);
    if !(stretch > least && stretch.is_finite()) {
        return None;
    }
    // The middle of the box becomes 0, or as near to it as the samples let it.
    let mut offset = scale(side, -stretch / 2.0);
    if let Some(samples) = samples {
        let along = |vertex: u32| {
            let from_base = sub(down(scene.vertices[vertex as usize]), base);
            from_base.map(|x| shifted(x, power) * stretch)
        };
        let edges = scene.triangles.iter().flat_map(|triangle| {
            let [a, b, c] = triangle.vertices.map(along);
            [(a, b), (b, c), (c, a)]
        });
        let places = samples.places(edges, largest(side) * stretch);
        for axis in [0, 1] {
            let first = samples.first[axis] - places[axis];
            offset[axis] = nearest(first + offset[axis]) - first;
        }
    }
    let raw = |from_base: Vec3| AXES.map(|k| nearest(from_base[k] * stretch + offset[k]) as i32);
    let reach = Bounds { low: raw([0.0; 3]), high: raw(side) };
    let span = AXES.map(|axis| reach.side(axis));
    Some(Grid { stretch, reach, span, base, offset, ..*powers })
}

/// Samples of parallel rays, in steps from the box's lowest corner.
struct SampleLattice {
    stretch: f64,
    /// Steps from sample to sample, a whole number.
    pitch: f64,
    /// x and y of the first sample.
    first: [f64; 2],
}

impl SampleLattice {
    /// The samples with the most steps of a pitch that `most` allows as stretch; `None` where there are too few, or the stretch is not more than `least`.
    fn new(rays: Rays, (least, most): (f64, f64)) -> Option<SampleLattice> {
        let Rays::Orthographic { first, pitch, .. } = rays else { return None };
        let steps = (pitch * most).floor();
        let stretch = steps / pitch;
        let samples = SampleLattice { stretch, pitch: steps, first: first.map(|x| x * stretch) };
        (steps >= FEWEST_STEPS && stretch > least).then_some(samples)
    }

    /// Places of samples beyond whole numbers along x and y, 0 up to 1/2, for which the fewest samples are expected on wrong sides of edges.
    ///
    /// An edge along a column that is d steps beyond its samples puts as many of them on the wrong side as it passes, if d < 1/2 - p. A
    /// displacement of p steps puts p of `pitch` on the wrong side of any edge. For example, of 150 edges of 200 samples with pitch 1,332,
    /// p = 1/16 costs 1.4 samples, and one edge at d = 0.44 costs 200 without it.
    fn places(&self, edges: impl Iterator<Item = (Vec3, Vec3)>, extent: f64) -> [f64; 2] {
        let on_edge = shifted(extent, ON_EDGE);
        let count = PLACES.len();
        // Samples passed by edges whose distance asks for this place or a later one, and by all edges.
        let mut passed = [vec![0.0; count + 1], vec![0.0; count + 1]];
        let mut all = [0.0; 2];
        for (a, b) in edges {
            for axis in [0, 1] {
                let samples = (a[1 - axis] - b[1 - axis]).abs() / self.pitch;
                all[axis] += samples;
                let beyond = (a[axis] - self.first[axis]).rem_euclid(self.pitch);
                if (a[axis] - b[axis]).abs() <= on_edge && beyond > on_edge && beyond < 0.5 {
                    // The first place, in 64ths, at which 1/2 - p <= d.
                    let needed = ((0.5 - beyond) * 64.0).ceil() as usize;
                    passed[axis][needed.min(count)] += samples;
                }
            }
        }
        [0, 1].map(|axis| {
            let wrong = |place: u32| {
                let late: f64 = passed[axis][place as usize + 1..].iter().sum();
                late + f64::from(place) / 64.0 * all[axis] / self.pitch
            };
            let best = PLACES.min_by(|&a, &b| wrong(a).total_cmp(&wrong(b))).unwrap_or(0);
            f64::from(best) / 64.0
        })
    }
}
