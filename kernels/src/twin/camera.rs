//! The rays of the pixels, as the main processor makes them.

use std::array::from_fn;

use isa::number::Vector;
use scenes::camera::RawCamera;

use super::lanes::Lanes;
use super::ray::Ray;

/// The ray of a pixel, row 0 on top. `unit` makes a unit vector of one that is scaled into [2^(word-3), 2^(word-2)].
pub fn camera(
    arithmetic: &impl Lanes,
    unit: impl Fn(Vector) -> Vector,
    camera: &RawCamera,
    column: u32,
    row: u32,
) -> Ray {
    let [column, row] = [column, row].map(|number| arithmetic.widen((number as i32).into(), 0));
    let step = |step: i64, number: i64| i128::from(arithmetic.widen(i128::from(step) * i128::from(number), 0));
    let right = |from: i64, by: i64| arithmetic.widen(i128::from(from) + step(by, column), 0);
    let down = |from: i64, by: i64| arithmetic.widen(i128::from(from) - step(by, row), 0);
    match *camera {
        RawCamera::Orthographic { direction, extra, first, pitch, z } => {
            let x = arithmetic.narrow64(right(first[0], pitch), extra);
            let y = arithmetic.narrow64(down(first[1], pitch), extra);
            Ray::new(arithmetic, [x, y, z], direction)
        }
        RawCamera::Perspective { eye, extra, base, column, row } => {
            let towards = from_fn(|k| arithmetic.narrow64(down(right(base[k], column[k]), row[k]), extra));
            let direction = unit(arithmetic.normalized(towards.map(i64::from)));
            Ray::new(arithmetic, eye, direction)
        }
    }
}
