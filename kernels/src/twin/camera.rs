//! The rays of the pixels, as the main processor makes them.

use std::array::from_fn;

use scenes::camera::{Across, PixelFunction, RawCamera, RayStart};
use scenes::kdtree::Bounds;

use super::ray::TwinRay;
use super::unit::sqrt;
use super::vector_arithmetic::{VectorArithmetic, WideVector};

/// The ray of a pixel, row 0 on top. In perspective each component of the direction is the quotient of the way to the pixel, in twice the word, and its
/// length, in a word; the ray starts one unit before it enters the box `root`, and one that misses it behind it on every axis.
pub fn camera(
    arithmetic: &impl VectorArithmetic,
    direction_bits: u32,
    camera: &RawCamera,
    root: &Bounds,
    column: u32,
    row: u32,
) -> TwinRay {
    // Compute as the kernel does: what is widened stands in twice the word, and what is narrowed is rounded there
    let [column, row] = [column, row].map(|number| arithmetic.widen((number as i32).into(), 0));
    let step = |step: i64, number: i64| i128::from(arithmetic.widen(i128::from(step) * i128::from(number), 0));
    let right = |from: i64, by: i64| arithmetic.widen(i128::from(from) + step(by, column), 0);
    let down = |from: i64, by: i64| arithmetic.widen(i128::from(from) - step(by, row), 0);
    match *camera {
        RawCamera::Orthographic { direction, extra, first, pitch, z } => {
            let x = arithmetic.narrow64(right(first[0], pitch), extra);
            let y = arithmetic.narrow64(down(first[1], pitch), extra);
            TwinRay::new(arithmetic, [x, y, z], direction)
        }
        RawCamera::Perspective { start, extra, base, column, row } => {
            let of_pixel = |function: PixelFunction| down(right(function.first, function.column), function.row);
            let way: WideVector = from_fn(|k| down(right(base[k], column[k]), row[k]));
            // Only the length is that of the rounded way, so that each component of the direction is rounded once, by its quotient.
            let rounded = way.map(|component| arithmetic.narrow64(component, extra));
            let length = sqrt(arithmetic, arithmetic.wide_dot(rounded, rounded));
            let length = arithmetic.widen(i128::from(length) << extra, 0);
            let direction =
                way.map(|component| arithmetic.quotient(i128::from(component) << direction_bits, length.into()));
            let origin = match start {
                RayStart::Eye(eye) => eye,
                RayStart::Faces { shift, .. } => {
                    // Find the face by which the ray enters: it goes towards it, and lies within both ends on either axis along it
                    let entry = start.faces().find_map(|face| {
                        let slope = Some(of_pixel(face.slope)).filter(|&slope| slope > 0)?;
                        let mut point = [face.at; 3];
                        for &Across { axis, low, from_low, from_high } in &face.across {
                            let from_low = of_pixel(from_low);
                            if from_low < 0 || of_pixel(from_high) < 0 {
                                return None;
                            }
                            let inside = arithmetic.quotient(i128::from(from_low) << shift, slope.into());
                            point[axis] = arithmetic.plus(inside, low);
                        }
                        Some(point)
                    });
                    // A ray that misses the box starts beyond it on every axis, going away, so that it meets nothing.
                    let behind = |k: usize| if direction[k] < 0 { root.low[k] - 2 } else { root.high[k] + 2 };
                    entry.unwrap_or_else(|| from_fn(behind))
                }
            };
            TwinRay::new(arithmetic, origin, direction)
        }
    }
}
