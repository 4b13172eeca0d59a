//! Single precision where it is sure: rays and blocks of four triangles with which the quick search refuses triangles that a ray misses by far. What is
//! not refused is decided in double precision by [`super::triangle`], so nothing here can change a picture.
//!
//! Everything lies in the scene's box, whose coordinates are at most 1, and a ray starts where it enters it. Let u = 2^-24 be the rounding of single
//! precision, E the sum of the absolute components of a triangle's two edges. Möller and Trumbore's products (1997), `u = from . (d x second)`,
//! `v = d . (from x first)` and the determinant, have components of `from` of at most 2, each off by 4 u, and components of `d x second` off by 4 u E; the
//! three sums are then off by less than 66 u E, 66 u E and 42 u E, and the third edge's function, the determinant less both, by less than 144 u E. So
//! [`MARGIN`], 256 u, times E bounds all of them. The test in double precision calls an edge function a tie up to some [`TIE`] times E and the size of the
//! ray's origin, for which a second term stands. An edge function below the margin and another one above it have opposite signs, whichever sign the
//! determinant has: a miss.

use wide::f32x4;

use super::hierarchy::Box3;
use super::tie::TIE;
use super::triangle::{PreparedTriangle, ShearedRay};
use crate::vector::{AXES, largest};

/// Triangles of a block, or boxes of a node.
pub const LANES: usize = 4;

/// Bound of the error of an edge function, as part of the sum of the edges' components.
const MARGIN: f32 = 1.0 / (1u32 << 16) as f32;

/// Bound of the error of places in the box: 16 roundings.
const PLACE: f32 = 1.0 / (1u32 << 20) as f32;

/// One more than the relative error of a distance, 8 roundings and some.
const LONGER: f32 = 1.0 + PLACE;

/// Reciprocal of a direction's component that is 0 or next to it: large enough for all that lies aside, and finite, so that 0 times it is a number.
const ALONG: f32 = 1e30;

/// A ray in single precision, its numbers in all lanes. It starts where it enters the scene's box.
#[derive(Clone, Copy, Debug)]
pub struct ShortRay {
    origin: [f32x4; 3],
    direction: [f32x4; 3],
    reciprocal: [f32x4; 3],
    /// The origin, moved by the error of places towards larger coordinates and towards smaller ones.
    beyond: [[f32x4; 3]; 2],
    /// Margin of edge functions, as part of the sum of the edges' components.
    margin: f32x4,
    /// Distance of the start from the ray's own origin.
    start: f64,
}

impl ShortRay {
    /// The ray from `start` on, where it enters a box whose coordinates are at most 1.
    pub fn new(ray: &ShearedRay, start: f64) -> ShortRay {
        let origin = AXES.map(|k| (ray.origin[k] + start * ray.direction[k]) as f32);
        let direction = ray.direction.map(|d| d as f32);
        let reciprocal = direction.map(|d| if d.abs() > 1.0 / ALONG { 1.0 / d } else { ALONG.copysign(d) });
        // What double precision does with far origins is as rough as they are far.
        let far = (TIE * (1.0 + largest(ray.origin))) as f32;
        let place = PLACE + 4.0 * far;
        ShortRay {
            origin: origin.map(f32x4::splat),
            direction: direction.map(f32x4::splat),
            reciprocal: reciprocal.map(f32x4::splat),
            beyond: [place, -place].map(|place| origin.map(|x| f32x4::splat(x + place))),
            margin: f32x4::splat(MARGIN + 32.0 * far),
            start,
        }
    }

    /// Distance in the box up to which boxes are opened for a distance from the ray's own origin.
    pub fn end(&self, t: f64) -> f32 {
        ((t - self.start) as f32) * LONGER + PLACE
    }
}

/// Boxes of a node's children.
#[derive(Clone, Copy, Debug)]
pub struct Boxes {
    low: [f32x4; 3],
    high: [f32x4; 3],
}

impl Boxes {
    /// The boxes of at most four children.
    pub fn new(boxes: &[Box3]) -> Boxes {
        let lanes = |number: &dyn Fn(&Box3) -> f32| {
            let mut lanes = [0.0; LANES];
            lanes.iter_mut().zip(boxes).for_each(|(lane, of)| *lane = number(of));
            f32x4::new(lanes)
        };
        Boxes { low: AXES.map(|k| lanes(&|of| of.0[k])), high: AXES.map(|k| lanes(&|of| of.1[k])) }
    }

    /// Distances at which a ray enters the boxes, and a bit for each one that it meets before `end` (the slab test, Kay and Kajiya 1986); of lanes without a
    /// box they mean nothing.
    #[inline]
    pub fn enter(&self, ray: &ShortRay, end: f32) -> ([f32; LANES], u32) {
        let (mut near, mut far) = (f32x4::ZERO, f32x4::splat(end));
        for k in AXES {
            let low = (self.low[k] - ray.beyond[0][k]) * ray.reciprocal[k];
            let high = (self.high[k] - ray.beyond[1][k]) * ray.reciprocal[k];
            near = near.fast_max(low.fast_min(high));
            far = far.fast_min(low.fast_max(high));
        }
        (near.to_array(), near.simd_le(far * f32x4::splat(LONGER)).to_bitmask())
    }
}

/// Up to four triangles.
#[derive(Clone, Copy, Debug)]
pub struct TriangleBlock {
    corner: [f32x4; 3],
    first: [f32x4; 3],
    second: [f32x4; 3],
    /// Sum of the absolute components of both edges; of a lane without a triangle less than 0, by which it is always refused.
    edges: f32x4,
    indices: [u32; LANES],
}

impl TriangleBlock {
    /// The block of at most four triangles, by their numbers in the scene.
    pub fn new(numbers: &[u32], triangle: impl Fn(u32) -> PreparedTriangle) -> TriangleBlock {
        let [mut corner, mut first, mut second] = [[[0.0; LANES]; 3]; 3];
        let (mut edges, mut indices) = ([-1.0; LANES], [0; LANES]);
        for (lane, &index) in numbers.iter().enumerate() {
            let [a, b, c] = triangle(index).vertices;
            let mut sum = 0.0;
            for k in AXES {
                corner[k][lane] = a[k] as f32;
                first[k][lane] = (b[k] - a[k]) as f32;
                second[k][lane] = (c[k] - a[k]) as f32;
                sum += (b[k] - a[k]).abs() + (c[k] - a[k]).abs();
            }
            edges[lane] = (sum as f32).next_up();
            indices[lane] = index;
        }
        let [corner, first, second] = [corner, first, second].map(|vectors| vectors.map(f32x4::new));
        TriangleBlock { corner, first, second, edges: f32x4::new(edges), indices }
    }

    /// Number of a lane's triangle in the scene.
    pub fn index(&self, lane: usize) -> u32 {
        self.indices[lane]
    }

    /// A bit for each lane whose triangle the ray may meet.
    #[inline]
    pub fn candidates(&self, ray: &ShortRay) -> u32 {
        let dot = |a: &[f32x4; 3], b: &[f32x4; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let cross = |a: &[f32x4; 3], b: &[f32x4; 3]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let from = AXES.map(|k| ray.origin[k] - self.corner[k]);
        let p = cross(&ray.direction, &self.second);
        let determinant = dot(&self.first, &p);
        let u = dot(&from, &p);
        let v = dot(&ray.direction, &cross(&from, &self.first));
        let w = determinant - u - v;
        let margin = self.edges * ray.margin;
        let is_missed = u.fast_min(v).fast_min(w).simd_lt(-margin) & u.fast_max(v).fast_max(w).simd_gt(margin);
        !is_missed.to_bitmask() & 0xf
    }
}
