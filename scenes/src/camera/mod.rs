//! The two cameras: which ray belongs to a pixel, in double precision and as the raw integers that the dispatch kernel starts from.
//! Rays are made here; where they go is not known here.

mod entry;

use messages::{Diagnostic, Report};

use crate::cadrage::Formats;
use crate::kdtree::Bounds;
use crate::model::{Camera, Vec3, View};
use crate::vector::{AXES, add, cross, exponent, largest, nearest, scale, shifted, sub, unit};

pub use entry::{Across, EntryFace, PixelFunction, RayStart};

/// Corners of a box, smallest and largest.
pub type Corners = (Vec3, Vec3);

/// The rays of a picture in double precision, in the units of the box that they were made for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rays {
    /// Parallel rays along -z. Pixel (c, r) starts at (first.x + c pitch, first.y - r pitch, z).
    Orthographic {
        /// x of column 0 and y of row 0, at the sample.
        first: [f64; 2],
        /// Distance of neighbouring samples.
        pitch: f64,
        /// The point at which all rays start, in front of the box.
        z: f64,
    },
    /// Rays from one point. Pixel (c, r) looks along base + c column - r row, which has no particular length.
    Perspective {
        /// The eye.
        eye: Vec3,
        /// Direction of pixel (0, 0).
        base: Vec3,
        /// The difference of a step to the right.
        column: Vec3,
        /// The difference of a step up.
        row: Vec3,
    },
}

impl Rays {
    /// The rays of `view` at a scene whose box is `(low, high)`; the camera's points are in the units of the box.
    ///
    /// A box without width and height is looked at as if its depth were its width, and a single point as if it were 1 wide.
    /// Where the camera looks straight up or down, the top of the picture is towards -z. Coordinates are to be below 2^1000.
    ///
    /// # Errors
    /// A field of view outside 0 to 180 degrees, an eye that is the point looked at, or points that are not finite.
    pub fn new((low, high): Corners, view: &View) -> Result<Rays, Report> {
        let size = [f64::from(view.size.0), f64::from(view.size.1)];
        let middle = centre((low, high));
        // Samples are at pixel centres; the offsets of column 0 and row 0 from the middle of the picture, in pitches, x right and y up.
        let start = [0.5 + view.shift[0] - size[0] / 2.0, size[1] / 2.0 - 0.5 + view.shift[1]];
        match view.camera {
            Camera::Orthographic => {
                let side = sub(high, low);
                // Square pixels: the side that is longer for the picture's shape fills it, the other has a margin.
                let pitch = (side[0] / size[0]).max(side[1] / size[1]);
                let pitch = if pitch > 0.0 { pitch } else { extent((low, high)) / size[0].max(size[1]) };
                let first = [middle[0] + start[0] * pitch, middle[1] + start[1] * pitch];
                let z = high[2] + extent((low, high)) / 16.0;
                Ok(Rays::Orthographic { first, pitch, z })
            }
            Camera::Perspective { look, field, .. } => {
                if !(field > 0.0 && field < 180.0) {
                    return Err(Diagnostic::error(format!("a field of view of {field} degrees cannot be drawn"))
                        .hint("--fov takes the vertical angle, above 0 and below 180 degrees")
                        .into());
                }
                let eye = eye((low, high), &view.camera).unwrap_or(middle);
                let Some(forward) = unit(sub(look.unwrap_or(middle), eye)) else {
                    return Err(Diagnostic::error(
                        "the camera has no direction: the eye is at the point that it looks at",
                    )
                    .hint("move one of them with --eye or --look")
                    .into());
                };
                // Looking straight up or down, y says nothing of what is up in the picture; -z does.
                let up = if forward[0].hypot(forward[2]) < 1e-9 { [0.0, 0.0, -1.0] } else { [0.0, 1.0, 0.0] };
                let right = unit(cross(forward, up)).expect("up was chosen away from the direction");
                let up = cross(right, forward);
                // The field is that from the upper edge to the lower one, at distance 1 from the eye.
                let step = 2.0 * (field.to_radians() / 2.0).tan() / size[1];
                let (column, row) = (scale(right, step), scale(up, step));
                let base = add(forward, add(scale(column, start[0]), scale(row, start[1])));
                Ok(Rays::Perspective { eye, base, column, row })
            }
        }
    }

    /// Origin and direction of length 1 of the ray of column `c` and row `r`, row 0 on top.
    pub fn ray(&self, c: u32, r: u32) -> (Vec3, Vec3) {
        let (c, r) = (f64::from(c), f64::from(r));
        match *self {
            Rays::Orthographic { first, pitch, z } => {
                ([first[0] + c * pitch, first[1] - r * pitch, z], [0.0, 0.0, -1.0])
            }
            Rays::Perspective { eye, base, column, row } => {
                let towards = add(base, sub(scale(column, c), scale(row, r)));
                (eye, unit(towards).expect("every pixel lies in front of the eye"))
            }
        }
    }
}

/// The position of the eye, `None` for parallel rays: as given, or at (cx, cy, zmax + 1.2 max(box width, box height)).
pub fn eye((low, high): Corners, camera: &Camera) -> Option<Vec3> {
    let Camera::Perspective { eye, .. } = camera else { return None };
    Some(eye.unwrap_or_else(|| {
        let middle = centre((low, high));
        let side = sub(high, low);
        let width = side[0].max(side[1]);
        let width = if width > 0.0 { width } else { extent((low, high)) };
        [middle[0], middle[1], high[2] + 1.2 * width]
    }))
}

/// The camera with its points moved into other units.
pub fn mapped(camera: &Camera, map: impl Fn(Vec3) -> Vec3) -> Camera {
    match *camera {
        Camera::Orthographic => Camera::Orthographic,
        Camera::Perspective { eye, look, field } => {
            Camera::Perspective { eye: eye.map(&map), look: look.map(&map), field }
        }
    }
}

/// Middle of a box; halved first, so that no sum overflows.
pub fn centre((low, high): Corners) -> Vec3 {
    AXES.map(|k| low[k] / 2.0 + high[k] / 2.0)
}

/// Longest side of a box, 1 for a single point.
fn extent((low, high): Corners) -> f64 {
    let most = largest(sub(high, low));
    if most > 0.0 { most } else { 1.0 }
}

/// The camera as raw integers. What is 64 bits wide fits a register of twice the word, in every value that a pixel's ray passes through.
#[expect(clippy::large_enum_variant, reason = "an image has one camera")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RawCamera {
    /// Parallel rays. The origin of pixel (c, r) is `(first.x + c pitch) >> extra`, `(first.y - r pitch) >> extra` (nearest, ties up,
    /// saturated to the word) and `z`, positions in raw units.
    Orthographic {
        /// Direction (0, 0, -1) in the direction format.
        direction: [i32; 3],
        /// Fraction bits of `first` and `pitch` beyond those of a position.
        extra: u32,
        /// x of column 0 and y of row 0.
        first: [i64; 2],
        /// Distance of neighbouring samples.
        pitch: i64,
        /// One raw unit in front of the root's box.
        z: i32,
    },
    /// Rays from one point that start where they enter the scene's box. The direction of pixel (c, r) is `(base + c column - r row) >> extra` (nearest, ties up) in the direction format.
    /// It is not of length 1: its components are less than 1, and over the whole picture the largest of them is 1/2 or more.
    Perspective {
        /// Start of the rays.
        start: RayStart,
        /// Fraction bits of the three vectors beyond those of a direction.
        extra: u32,
        /// Direction of pixel (0, 0).
        base: [i64; 3],
        /// The difference of a step to the right.
        column: [i64; 3],
        /// The difference of a step up.
        row: [i64; 3],
    },
}

impl RawCamera {
    /// The raw camera of `rays`, which are in (unrounded) raw units of the grid, in front of the root's box.
    ///
    /// # Errors
    /// When a picture is so many pixels wide or high that its positions do not fit twice the word.
    pub fn new(rays: &Rays, size: (u32, u32), formats: &Formats, root: &Bounds) -> Result<RawCamera, Report> {
        let (width, height) = (f64::from(size.0), f64::from(size.1));
        let bits = (2 * formats.word - 2) as i32;
        let fixed = |x: f64, power: u32| nearest(shifted(x, power as i32)) as i64;
        match *rays {
            Rays::Orthographic { first, pitch, .. } => {
                // As many extra bits as the largest number leaves room for in twice a word, but not more than a word.
                let most = [first[0], first[1], width * pitch, height * pitch]
                    .into_iter()
                    .fold(0.0, |a: f64, b| a.max(b.abs()));
                let extra = bits - exponent(2.0 * most);
                if extra < 0 {
                    return Err(Diagnostic::error(format!(
                        "a picture of {} x {} pixels is too long for positions of {} bits",
                        size.0, size.1, formats.word
                    ))
                    .hint("make it shorter, or use a longer word with --word")
                    .into());
                }
                let extra = extra.min(formats.word as i32) as u32;
                Ok(RawCamera::Orthographic {
                    direction: [0, 0, -1i32 << formats.direction],
                    extra,
                    first: first.map(|x| fixed(x, extra)),
                    pitch: fixed(pitch, extra),
                    z: root.high[2] + 1,
                })
            }
            Rays::Perspective { base, column, row, .. } => {
                // Directions are linear in column and row, so the longest component is found at a corner of the picture.
                let corner = |c: f64, r: f64| largest(add(base, sub(scale(column, c), scale(row, r))));
                let (right, bottom) = (width - 1.0, height - 1.0);
                let most = corner(0.0, 0.0).max(corner(right, 0.0)).max(corner(0.0, bottom)).max(corner(right, bottom));
                // A power of two, so that the rounded directions differ from the exact ones by one rounding only.
                let unit = formats.direction as i32 - exponent(most);
                let widest = largest(base).max(largest(column) * width).max(largest(row) * height);
                let extra = (bits - unit - exponent(2.0 * widest)).clamp(0, formats.word as i32) as u32;
                let wide = |v: Vec3| v.map(|x| nearest(shifted(x, unit + extra as i32)) as i64);
                Ok(RawCamera::Perspective {
                    start: RayStart::new(rays, size, bits, root),
                    extra,
                    base: wide(base),
                    column: wide(column),
                    row: wide(row),
                })
            }
        }
    }

    /// Origin of parallel rays, or `None`, and direction of the ray of column `c` and row `r`, as the formulas of the variants give them.
    pub fn ray(&self, c: u32, r: u32, word: u32) -> (Option<[i32; 3]>, [i32; 3]) {
        let (c, r) = (i128::from(c), i128::from(r));
        let rounded = |x: i128, extra: u32| {
            let most = (1i128 << (word - 1)) - 1;
            let half = if extra == 0 { 0 } else { 1i128 << (extra - 1) };
            ((x + half) >> extra).clamp(-most - 1, most) as i32
        };
        match *self {
            RawCamera::Orthographic { direction, extra, first, pitch, z } => {
                let (x, y) =
                    (i128::from(first[0]) + c * i128::from(pitch), i128::from(first[1]) - r * i128::from(pitch));
                (Some([rounded(x, extra), rounded(y, extra), z]), direction)
            }
            RawCamera::Perspective { extra, base, column, row, .. } => {
                let towards = |k: usize| i128::from(base[k]) + c * i128::from(column[k]) - r * i128::from(row[k]);
                (None, AXES.map(|k| rounded(towards(k), extra)))
            }
        }
    }
}

#[cfg(test)]
mod tests;
