//! The rays of the pixels, as the main processor makes them.

use std::array::from_fn;

use scenes::camera::RawCamera;

use super::ray::TwinRay;
use super::unit::sqrt;
use super::vector_arithmetic::{VectorArithmetic, WideVector};

/// The ray of a pixel, row 0 on top. In perspective each component is the quotient of the way to the pixel, in twice the word, and its
/// length, in a word.
pub fn camera(
    arithmetic: &impl VectorArithmetic,
    direction_bits: u32,
    camera: &RawCamera,
    column: u32,
    row: u32,
) -> TwinRay {
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
        RawCamera::Perspective { eye, extra, base, column, row } => {
            let way: WideVector = from_fn(|k| down(right(base[k], column[k]), row[k]));
            let rounded = way.map(|component| arithmetic.narrow64(component, extra));
            let length = sqrt(arithmetic, arithmetic.wide_dot(rounded, rounded));
            let length = arithmetic.widen(i128::from(length) << extra, 0);
            let direction =
                way.map(|component| arithmetic.quotient(i128::from(component) << direction_bits, length.into()));
            TwinRay::new(arithmetic, eye, direction)
        }
    }
}
