//! Products of vectors in scalar operations, each rounded to a word.

use std::array::from_fn;

use isa::number::Vector;

use crate::twin::vector_arithmetic::VectorArithmetic;

/// a x b, two products and their difference a component.
pub fn cross(arithmetic: &impl VectorArithmetic, a: Vector, b: Vector, shift: u32) -> Vector {
    from_fn(|k| {
        let (next, last) = ((k + 1) % 3, (k + 2) % 3);
        arithmetic.minus(arithmetic.times(a[next], b[last], shift), arithmetic.times(a[last], b[next], shift))
    })
}

/// a . b, three products and two sums.
pub fn dot(arithmetic: &impl VectorArithmetic, a: Vector, b: Vector, shift: u32) -> i32 {
    let [x, y, z] = from_fn(|k| arithmetic.times(a[k], b[k], shift));
    arithmetic.plus(arithmetic.plus(x, y), z)
}
