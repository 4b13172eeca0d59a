//! Semantics of the numeric instructions on vectors of three components. Copies move raw bits, everything else quantizes each component.

use std::array::from_fn;

use isa::number::{Arithmetic, Vector, normalizing_shift};
use isa::table::Done;

use super::VectorRoom;

/// Lane `k` of the exact cross product. It fits 64 bits: the largest product is 2^62, the least -(2^62 - 2^31).
fn cross_component(a: Vector, b: Vector, k: usize) -> i64 {
    let (next, last) = ((k + 1) % 3, (k + 2) % 3);
    i64::from(a[next]) * i64::from(b[last]) - i64::from(a[last]) * i64::from(b[next])
}

/// The components shifted right by what brings the largest to the top of the word, and that shift.
fn normalize(arithmetic: &impl Arithmetic, components: [i64; 3]) -> (Vector, i32) {
    let [x, y, z] = components.map(i64::unsigned_abs);
    let shift = normalizing_shift([x.max(y).max(z).into(), 0, 0], arithmetic.word());
    // A component that goes left ends within the word, so 64 bits hold it.
    let component = |component: i64| match u32::try_from(shift) {
        Ok(right) => arithmetic.narrow64(component, right),
        Err(_) => arithmetic.narrow64(component << -shift, 0),
    };
    (components.map(component), shift)
}

impl<T: Arithmetic> VectorRoom for T {
    #[inline]
    fn vadd(&self, a: Vector, b: Vector) -> (Vector, Done) {
        (from_fn(|k| self.narrow64(i64::from(a[k]) + i64::from(b[k]), 0)), Done)
    }

    #[inline]
    fn vsub(&self, a: Vector, b: Vector) -> (Vector, Done) {
        (from_fn(|k| self.narrow64(i64::from(a[k]) - i64::from(b[k]), 0)), Done)
    }

    #[inline]
    fn vneg(&self, a: Vector) -> (Vector, Done) {
        (a.map(|component| self.narrow64(-i64::from(component), 0)), Done)
    }

    #[inline]
    fn vabs(&self, a: Vector) -> (Vector, Done) {
        (a.map(|component| self.narrow64(i64::from(component).abs(), 0)), Done)
    }

    #[inline]
    fn vmin(&self, a: Vector, b: Vector) -> (Vector, Done) {
        (from_fn(|k| self.narrow64(a[k].min(b[k]).into(), 0)), Done)
    }

    #[inline]
    fn vmax(&self, a: Vector, b: Vector) -> (Vector, Done) {
        (from_fn(|k| self.narrow64(a[k].max(b[k]).into(), 0)), Done)
    }

    #[inline]
    fn vmul(&self, a: Vector, b: Vector, i: i32) -> (Vector, Done) {
        (from_fn(|k| self.narrow64(i64::from(a[k]) * i64::from(b[k]), i as u32)), Done)
    }

    #[inline]
    fn vscale(&self, a: Vector, b: i32, i: i32) -> (Vector, Done) {
        (a.map(|component| self.narrow64(i64::from(component) * i64::from(b), i as u32)), Done)
    }

    #[inline]
    fn vdiv(&self, a: Vector, b: i32, i: i32) -> (Vector, Done) {
        (a.map(|component| self.quotient(i128::from(component) << i, b.into())), Done)
    }

    #[inline]
    fn vdot(&self, a: Vector, b: Vector, i: i32) -> (i32, Done) {
        let dot = self.narrow_products(from_fn(|k| i64::from(a[k]) * i64::from(b[k])), i as u32);
        (dot, Done)
    }

    #[inline]
    fn vcross(&self, a: Vector, b: Vector, i: i32) -> (Vector, Done) {
        (from_fn(|k| self.narrow64(cross_component(a, b, k), i as u32)), Done)
    }

    #[inline]
    fn vcrossn(&self, a: Vector, b: Vector) -> (Vector, Done) {
        (normalize(self, from_fn(|k| cross_component(a, b, k))).0, Done)
    }

    #[inline]
    fn vnorm(&self, a: Vector) -> (Vector, i32, Done) {
        let (vector, shift) = normalize(self, a.map(i64::from));
        (vector, shift, Done)
    }

    #[inline]
    fn vmov(&self, a: Vector) -> (Vector, Done) {
        (a, Done)
    }

    #[inline]
    fn vsplat(&self, a: i32) -> (Vector, Done) {
        ([a; 3], Done)
    }

    #[inline]
    fn vget(&self, a: Vector, i: i32) -> (i32, Done) {
        self.vgetr(a, i)
    }

    #[inline]
    fn vgetr(&self, a: Vector, b: i32) -> (i32, Done) {
        // Component by component: engines that compute many at once have no use for an index.
        let component = |k: usize| if b & 3 == k as i32 { a[k] } else { 0 };
        (component(0) | component(1) | component(2), Done)
    }

    #[inline]
    fn vput(&self, x: Vector, a: i32, i: i32) -> (Vector, Done) {
        self.vputr(x, a, i)
    }

    #[inline]
    fn vputr(&self, x: Vector, a: i32, b: i32) -> (Vector, Done) {
        (from_fn(|k| if b & 3 == k as i32 { a } else { x[k] }), Done)
    }

    #[inline]
    fn vmajor(&self, a: Vector) -> (i32, Done) {
        let [x, y, z] = a.map(i32::unsigned_abs);
        let major = if x >= y && x >= z {
            0
        } else if y >= z {
            1
        } else {
            2
        };
        (major, Done)
    }

    #[inline]
    fn vlt(&self, a: Vector, b: Vector) -> (i32, Done) {
        ((0..3).map(|k| i32::from(a[k] < b[k]) << k).sum(), Done)
    }

    #[inline]
    fn vselect(&self, x: Vector, a: Vector, b: i32) -> (Vector, Done) {
        (from_fn(|k| if b >> k & 1 == 1 { a[k] } else { x[k] }), Done)
    }
}
