//! The arithmetic that kernels are written in: sums, products and determinants of raw integers, each exact and then quantized once to a
//! word or to twice the word. [`Arithmetic`] says how that is done, formats are the caller's business.

use std::array::from_fn;

use isa::number::{Arithmetic, Vector, normalizing_shift, split_shift};

/// Three wide components.
pub type WideVector = [i64; 3];

fn product(a: i32, b: i32) -> i64 {
    i64::from(a) * i64::from(b)
}

fn dot(a: Vector, b: Vector) -> i128 {
    i128::from(product(a[0], b[0]) + product(a[1], b[1])) + i128::from(product(a[2], b[2]))
}

/// Exact cross product; a component fits 64 bits: the largest product is 2^62, the least -(2^62 - 2^31).
fn cross(a: Vector, b: Vector) -> WideVector {
    let minor = |j: usize, k: usize| product(a[j], b[k]) - product(a[k], b[j]);
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// Operations that round once. A `shift` goes to the right.
pub trait VectorArithmetic: Arithmetic {
    /// Sum.
    fn plus(&self, a: i32, b: i32) -> i32 {
        self.narrow64(i64::from(a) + i64::from(b), 0)
    }

    /// Difference.
    fn minus(&self, a: i32, b: i32) -> i32 {
        self.narrow64(i64::from(a) - i64::from(b), 0)
    }

    /// Negation.
    fn negative(&self, a: i32) -> i32 {
        self.narrow64(-i64::from(a), 0)
    }

    /// Product.
    fn times(&self, a: i32, b: i32, shift: u32) -> i32 {
        self.narrow64(product(a, b), shift)
    }

    /// Sum, component by component.
    fn sum(&self, a: Vector, b: Vector) -> Vector {
        from_fn(|k| self.plus(a[k], b[k]))
    }

    /// Difference, component by component.
    fn difference(&self, a: Vector, b: Vector) -> Vector {
        from_fn(|k| self.minus(a[k], b[k]))
    }

    /// Absolute value, component by component.
    fn magnitude(&self, a: Vector) -> Vector {
        a.map(|component| self.narrow64(i64::from(component).abs(), 0))
    }

    /// Product with a scalar, component by component.
    fn scaled(&self, a: Vector, b: i32, shift: u32) -> Vector {
        a.map(|component| self.times(component, b, shift))
    }

    /// Product, component by component.
    fn products(&self, a: Vector, b: Vector, shift: u32) -> Vector {
        from_fn(|k| self.times(a[k], b[k], shift))
    }

    /// Dot product.
    fn dot(&self, a: Vector, b: Vector, shift: u32) -> i32 {
        self.narrow(dot(a, b), shift)
    }

    /// Product as a wide number.
    fn wide_product(&self, a: i32, b: i32) -> i64 {
        self.widen(product(a, b).into(), 0)
    }

    /// Difference of wide numbers.
    fn wide_difference(&self, a: i64, b: i64) -> i64 {
        self.widen(i128::from(a) - i128::from(b), 0)
    }

    /// Dot product as a wide number.
    fn wide_dot(&self, a: Vector, b: Vector) -> i64 {
        self.widen(dot(a, b), 0)
    }

    /// Cross product in wide components.
    fn wide_cross(&self, a: Vector, b: Vector) -> WideVector {
        cross(a, b).map(|component| self.widen(component.into(), 0))
    }

    /// Dot product of wide components and a vector: with [`VectorArithmetic::wide_cross`], a determinant.
    fn wide_mixed(&self, a: WideVector, b: Vector, shift: u32) -> i64 {
        self.widen((0..3).map(|k| i128::from(a[k]) * i128::from(b[k])).sum(), shift)
    }

    /// The vector times the power of two that brings its largest component into [2^(word-3), 2^(word-2)]; zero stays zero.
    fn normalized(&self, a: WideVector) -> Vector {
        let components = a.map(i128::from);
        let shift = normalizing_shift(components, self.word());
        components.map(|component| {
            let (value, right) = split_shift(component, shift);
            self.narrow(value, right)
        })
    }

    /// The direction of the cross product, scaled as in [`VectorArithmetic::normalized`].
    fn normalized_cross(&self, a: Vector, b: Vector) -> Vector {
        self.normalized(cross(a, b))
    }
}

impl<A: Arithmetic> VectorArithmetic for A {}
