//! Single precision where it is sure: rays and blocks of four triangles with which the quick search refuses triangles that a ray misses by far. What is
//! not refused is decided in double precision by [`super::triangle`], so nothing here can change a picture.
//!
//! Everything lies in the scene's box, whose coordinates are at most 1, and a ray starts in it or next to it. Let u = 2^-24 be the rounding of single
//! precision, E the sum of the absolute components of a triangle's two edges. Möller and Trumbore's products (1997), `u = from . (d x second)`,
//! `v = d . (from x first)` and the determinant, have components of `from` of little more than 2, each off by 4 u, and components of `d x second` off by 4 u E;
//! the three sums are then off by less than 66 u E, 66 u E and 42 u E, and the third edge's function, the determinant less both, by less than 150 u E. So
//! [`MARGIN`], 256 u, times E bounds all of them. An edge function below the margin and another one above it have opposite signs, whichever
//! sign the determinant has: a miss.
//!
//! Far origins make both margins larger. With T for the size of an origin's terms in sheared space ([`ShearedRay::origin_terms`]), the test in double precision
//! calls an edge function a tie up to some multiple of [`TIE`] times E times T, and the start is off by 2^-51 T across the ray, so the margins grow by
//! multiples of [`TIE`] times T. Along the ray the start is off by as much as double precision rounds the distance, by which distances alone are made longer.

use wide::f32x4;

use super::hierarchy::Box3;
use super::tie::TIE;
use super::triangle::{PreparedTriangle, ShearedRay};
use crate::model::Vec3;
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
    /// Distance of the start from the ray's own origin, as the sum of two numbers of which the second one is small.
    start: [f64; 2],
    /// Bound of the error of distances from that origin.
    blur: f64,
}

/// Coordinates up to which a start counts as one next to the box.
const NEXT: f64 = 2.0;

impl ShortRay {
    /// The ray from where it enters a box whose coordinates are at most 1; `None` when it misses it before `end`.
    pub fn entering(all: Box3, ray: &ShearedRay, end: f64) -> Option<ShortRay> {
        // A component 0 gives an infinite reciprocal, and with it the comparisons that are right for such a ray.
        let reciprocal = ray.direction.map(|d| 1.0 / d);
        let first = enters(all, ray.origin, reciprocal, end)?;
        let along = |from: Vec3, way: f64| AXES.map(|k| from[k] + way * ray.direction[k]);
        let mut start = along(ray.origin, first);
        // A step from afar ends where rounding lets it, each further one as much nearer. Of an eye at 10^20: at 10^8, at 0.0001.
        let mut rest = 0.0;
        for _ in 0..32 {
            if largest(start) <= NEXT {
                break;
            }
            let Some(step) = enters(all, start, reciprocal, f64::INFINITY) else { break };
            start = along(start, step);
            rest += step;
        }
        let blur = if first > 0.0 { 4.0 * TIE * largest(ray.origin) } else { 0.0 };
        let far = if largest(start) <= NEXT { TIE * (1.0 + ray.origin_terms()) } else { f64::INFINITY };
        // Beyond the numbers of single precision nothing is refused: the margin is larger than any edge function, the place than any box.
        let far = far.min(1e30) as f32;
        let (place, margin) = (PLACE + 4.0 * far, MARGIN + 32.0 * far);
        let origin = start.map(|x| x.clamp(-NEXT, NEXT) as f32);
        let direction = ray.direction.map(|d| d as f32);
        let reciprocal = direction.map(|d| if d.abs() > 1.0 / ALONG { 1.0 / d } else { ALONG.copysign(d) });
        Some(ShortRay {
            origin: origin.map(f32x4::splat),
            direction: direction.map(f32x4::splat),
            reciprocal: reciprocal.map(f32x4::splat),
            beyond: [place, -place].map(|place| origin.map(|x| f32x4::splat(x + place))),
            margin: f32x4::splat(margin),
            start: [first, rest],
            blur,
        })
    }

    /// Distance in the box up to which boxes are opened for a distance from the ray's own origin.
    pub fn end(&self, t: f64) -> f32 {
        // Finite, also for a distance that is not, so that nothing is infinity less infinity.
        let way = (t - self.start[0]) - self.start[1] + self.blur;
        (way.clamp(-1e30, 1e30) as f32) * LONGER + PLACE
    }
}

/// Distance at which the ray enters the box, `None` when it misses it before `end`. The box is taken a little larger, by more than all roundings here and
/// what the test of a triangle calls its border, so that no hit is lost.
fn enters((low, high): Box3, origin: Vec3, reciprocal: Vec3, end: f64) -> Option<f64> {
    const SLACK: f64 = 4.0 * TIE;
    let (mut near, mut far) = (0.0f64, end);
    for k in AXES {
        // An origin on the face of a box that it runs along gives 0 * infinity; min and max skip it.
        let a = (f64::from(low[k]) - origin[k] - SLACK * (1.0 + origin[k].abs())) * reciprocal[k];
        let b = (f64::from(high[k]) - origin[k] + SLACK * (1.0 + origin[k].abs())) * reciprocal[k];
        near = near.max(a.min(b));
        far = far.min(a.max(b));
    }
    (near <= far * (1.0 + SLACK)).then_some(near * (1.0 - SLACK))
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
