//! Entry of a perspective ray into the scene's box: where the rays of pixels start, however far away the eye is. Directions are made elsewhere.
//!
//! A ray from the eye E along W meets the plane of a face, x_k = p, in x_j = E_j + (p - E_k) W_j / W_k. With S = |W_k|, the distances from both faces
//! of axis j are quotients by S whose numerators, as W itself, are linear in column and row:
//!
//! ```text
//! x_j - low_j = ((E_j - low_j) S + |p - E_k| W_j) / S,    high_j - x_j = ((high_j - E_j) S - |p - E_k| W_j) / S
//! ```
//!
//! So numerators are evaluated exactly, their signs say whether the ray enters by that face, and one division rounds the point once.

use super::Rays;
use crate::kdtree::Bounds;
use crate::model::Vec3;
use crate::vector::{AXES, exponent, nearest, shifted};

/// Most bits by which the assembler lets a numerator be shifted.
const MOST_SHIFT: i32 = 63;

/// A number for each pixel: `first + c column - r row`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelFunction {
    /// Value of pixel (0, 0).
    pub first: i64,
    /// The difference of a step to the right.
    pub column: i64,
    /// The difference of a step up.
    pub row: i64,
}

/// A face by which rays can enter the box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EntryFace {
    /// Axis across which the face lies.
    pub axis: usize,
    /// Coordinate at which rays start, one raw unit in front of the face.
    pub at: i32,
    /// Growth of the ray towards the face, positive when it comes from the eye's side.
    pub slope: PixelFunction,
    /// The other two axes.
    pub across: [Across; 2],
}

/// An axis along a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Across {
    /// Number of the axis.
    pub axis: usize,
    /// The lower end of the face, raw.
    pub low: i32,
    /// Slope times the distance from the lower end, not negative where the ray enters by the face.
    pub from_low: PixelFunction,
    /// Slope times the distance from the upper end, not negative where the ray enters by the face.
    pub from_high: PixelFunction,
}

/// Start of perspective rays.
#[expect(clippy::large_enum_variant, reason = "an image has one camera")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayStart {
    /// The eye, which is inside the box, raw.
    Eye([i32; 3]),
    /// The face by which a ray enters: the point is `low + (from_low 2^shift) / slope` on the axes across it. A ray that enters by none starts
    /// beyond the box's last corner, two raw units from it.
    Faces {
        /// Bits by which numerators are shifted left.
        shift: u32,
        /// The faces that the eye sees.
        faces: [Option<EntryFace>; 3],
    },
}

/// A number for each pixel in double precision: of pixel (0, 0), of a step to the right and of one up.
type Slopes = [f64; 3];

fn raw(slopes: Slopes, power: i32) -> PixelFunction {
    let [first, column, row] = slopes.map(|x| nearest(shifted(x, power)) as i64);
    PixelFunction { first, column, row }
}

impl RayStart {
    /// The start of the rays of a perspective camera, in (unrounded) raw units, at the box `root`, for numbers of at most `bits` bits and a sign.
    pub(super) fn new(rays: &Rays, size: (u32, u32), bits: i32, root: &Bounds) -> RayStart {
        let Rays::Perspective { eye, base, column, row } = *rays else { return RayStart::Eye([0; 3]) };
        let way = AXES.map(|k| [base[k], column[k], row[k]]);
        let far = |k: usize| EyeSide::new(eye, root, k);
        let sides = AXES.map(far);
        if sides.iter().all(Option::is_none) {
            return RayStart::Eye(eye.map(|x| nearest(x) as i32));
        }
        let slope = |side: &EyeSide, k: usize| way[k].map(|x| x * side.sign);
        let numerators = |side: &EyeSide, k: usize, j: usize| {
            let slope = slope(side, k);
            let of = |distance: f64, sign: f64| AXES.map(|n| distance * slope[n] + sign * side.distance * way[j][n]);
            let (low, high) = (f64::from(root.low[j]), f64::from(root.high[j]));
            [of(eye[j] - low, 1.0), of(high - eye[j], -1.0)]
        };
        let across = |k: usize| [(k + 1) % 3, (k + 2) % 3];
        // One scale for the slopes of all faces and one for all numerators, as large as twice the word holds whatever the pixel.
        let seen = || AXES.into_iter().filter_map(|k| Some((k, sides[k].as_ref()?)));
        let widest = |slopes: Slopes| {
            slopes[0].abs().max(slopes[1].abs() * f64::from(size.0)).max(slopes[2].abs() * f64::from(size.1))
        };
        let most_slope = seen().map(|(k, side)| widest(slope(side, k))).fold(0.0, f64::max);
        let most_numerator = seen()
            .flat_map(|(k, side)| across(k).into_iter().flat_map(move |j| numerators(side, k, j)))
            .map(widest)
            .fold(0.0, f64::max);
        let scale = bits - exponent(4.0 * most_numerator);
        let slope_scale = (bits - exponent(4.0 * most_slope)).min(scale + MOST_SHIFT);
        let scale = scale.min(slope_scale);
        let face = |(k, side): (usize, &EyeSide)| EntryFace {
            axis: k,
            at: side.at,
            slope: raw(slope(side, k), slope_scale),
            across: across(k).map(|j| {
                let [from_low, from_high] = numerators(side, k, j).map(|slopes| raw(slopes, scale));
                Across { axis: j, low: root.low[j], from_low, from_high }
            }),
        };
        let mut faces = [None; 3];
        for (place, seen) in faces.iter_mut().zip(seen()) {
            *place = Some(face(seen));
        }
        RayStart::Faces { shift: (slope_scale - scale) as u32, faces }
    }

    /// The faces, those that the eye sees.
    pub fn faces(&self) -> impl Iterator<Item = &EntryFace> {
        let faces: &[Option<EntryFace>] = match self {
            RayStart::Eye(_) => &[],
            RayStart::Faces { faces, .. } => faces,
        };
        faces.iter().flatten()
    }
}

/// A plane in front of a face of the box, with the eye in front of it.
struct EyeSide {
    at: i32,
    /// Distance from the eye to the plane.
    distance: f64,
    /// 1 for rays towards larger coordinates, else -1.
    sign: f64,
}

impl EyeSide {
    /// The plane across an axis, `None` for an eye between both.
    fn new(eye: Vec3, root: &Bounds, axis: usize) -> Option<EyeSide> {
        let (below, above) = (root.low[axis] - 1, root.high[axis] + 1);
        let side = |at: i32, sign: f64| EyeSide { at, distance: (f64::from(at) - eye[axis]) * sign, sign };
        [side(below, 1.0), side(above, -1.0)].into_iter().find(|side| side.distance > 0.0)
    }
}
