//! Square roots and vectors of unit length.

use isa::number::Vector;

use super::vector_arithmetic::VectorArithmetic;

/// The square root of a wide number >= 0, correctly rounded to a word.
pub fn sqrt(arithmetic: &impl VectorArithmetic, square: i64) -> i32 {
    arithmetic.root(square.max(0) as u128)
}

/// The unit vector, with `fraction` bits, in the direction of one that is scaled into [2^(word-3), 2^(word-2)].
pub fn unit(arithmetic: &impl VectorArithmetic, fraction: u32, vector: Vector) -> Vector {
    let length = sqrt(arithmetic, arithmetic.wide_dot(vector, vector));
    vector.map(|component| arithmetic.quotient(i128::from(component) << fraction, length.into()))
}
