//! Rays of real numbers against planes and triangles: the decisions that the machine takes on its own numbers, taken on shadows.

use std::cmp::Ordering;

use isa::number::ray::Plane;

use super::{RealFormulas, ShadowInput};
use crate::shadow::long_real::LongReal;

/// Number of the axis that stands for time.
const TIME: usize = 3;

/// A ray of real numbers.
pub(super) struct RealRay {
    pub(super) origin: [LongReal; 3],
    pub(super) direction: [LongReal; 3],
}

/// A plane as a ray of real numbers meets it, at t = run / slope.
#[derive(Clone, Copy)]
pub(super) struct RealCrossing {
    axis: usize,
    run: LongReal,
    slope: LongReal,
}

/// The real numbers of a vector.
pub(super) fn reals(vector: &[ShadowInput; 3]) -> [LongReal; 3] {
    std::array::from_fn(|k| *vector[k].term().real())
}

/// The raw numbers of a vector.
pub(super) fn raws(vector: &[ShadowInput; 3]) -> [i32; 3] {
    vector.map(|component| component.raw as i32)
}

impl RealRay {
    pub(super) fn new(ray: &[[ShadowInput; 3]; 2]) -> RealRay {
        RealRay { origin: reals(&ray[0]), direction: reals(&ray[1]) }
    }

    /// The ray goes towards smaller coordinates.
    pub(super) fn is_backwards(&self, axis: usize) -> bool {
        axis != TIME && self.direction[axis].is_negative()
    }

    pub(super) fn crossing(&self, plane: Plane) -> RealCrossing {
        let at = LongReal::whole(plane.at.into());
        match plane.axis {
            TIME => RealCrossing { axis: TIME, run: at, slope: LongReal::whole(1) },
            axis => RealCrossing { axis, run: at.minus(&self.origin[axis]), slope: self.direction[axis] },
        }
    }
}

impl RealCrossing {
    /// The plane lies ahead of the origin.
    pub(super) fn is_ahead(&self) -> bool {
        !self.run.is_zero() && self.run.is_negative() == self.slope.is_negative()
    }

    /// The plane is met before another one, ties as the machine decides them.
    pub(super) fn is_before(&self, other: &RealCrossing) -> bool {
        let (here, there) = (self.run.times(&other.slope), other.run.times(&self.slope));
        match here.partial_cmp(&there) {
            Some(Ordering::Equal) | None => match self.axis.cmp(&other.axis) {
                Ordering::Less => !self.slope.is_negative(),
                Ordering::Equal => false,
                Ordering::Greater => other.slope.is_negative(),
            },
            order => (order == Some(Ordering::Less)) == (self.slope.is_negative() == other.slope.is_negative()),
        }
    }

    /// The point at `t`, in units of 2^-shift, lies before the plane even one unit further on.
    pub(super) fn is_surely_behind(&self, t: &LongReal, shift: i32) -> bool {
        let magnitude = |number: LongReal| if self.slope.is_negative() { number.negated() } else { number };
        let way = t.plus(&LongReal::whole(1)).times(&magnitude(self.slope));
        way.partial_cmp(&magnitude(self.run).scaled(shift)) == Some(Ordering::Less)
    }
}

/// The t of a ray's hit in a triangle, in raw coordinates over raw directions; `None` where the ray misses it. Edges count as inside.
pub(super) fn meeting(ray: &RealRay, vertices: &[[LongReal; 3]; 3]) -> Option<LongReal> {
    let difference =
        |a: &[LongReal; 3], b: &[LongReal; 3]| -> [LongReal; 3] { std::array::from_fn(|k| a[k].minus(&b[k])) };
    let cross = |a: &[LongReal; 3], b: &[LongReal; 3]| -> [LongReal; 3] {
        std::array::from_fn(|k| {
            let (next, last) = ((k + 1) % 3, (k + 2) % 3);
            a[next].times(&b[last]).minus(&a[last].times(&b[next]))
        })
    };
    let dot =
        |a: &[LongReal; 3], b: &[LongReal; 3]| a[0].times(&b[0]).plus(&a[1].times(&b[1])).plus(&a[2].times(&b[2]));
    // Möller and Trumbore's test before its division: u, v and w are barycentric coordinates times the determinant
    let [edge1, edge2, start] = [
        difference(&vertices[1], &vertices[0]),
        difference(&vertices[2], &vertices[0]),
        difference(&ray.origin, &vertices[0]),
    ];
    let p = cross(&ray.direction, &edge2);
    let determinant = dot(&p, &edge1);
    if determinant.is_zero() {
        return None;
    }
    // Inside of the triangle each of them is 0 or has the determinant's sign.
    let is_outside = |number: &LongReal| !number.is_zero() && number.is_negative() != determinant.is_negative();
    let u = dot(&p, &start);
    let q = cross(&start, &edge1);
    let v = dot(&q, &ray.direction);
    let w = determinant.minus(&u).minus(&v);
    if [u, v, w].iter().any(is_outside) {
        return None;
    }
    // Divide, now that there is a hit of the plane within the triangle, and see whether it lies ahead
    let t = dot(&q, &edge2).over(&determinant)?;
    (!t.is_zero() && !t.is_negative()).then_some(t)
}

/// Bound on the error of a determinant of doubles, in units of the product of the largest components. Each operand is off by 2^-53 of itself and
/// each of the seven operations in a row by as much, so 18 products of 10 errors of 2^-53 are below 2^-45.
const MARGIN: f64 = 1.0 / (1u64 << 45) as f64;

/// The ray surely misses a triangle: of most triangles doubles can say so.
pub(super) fn surely_misses(ray: &[[f64; 3]; 2], vertices: &[[f64; 3]; 3]) -> bool {
    let difference = |a: &[f64; 3], b: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|k| a[k] - b[k]) };
    let cross =
        |a: &[f64; 3], b: &[f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let size = |a: &[f64; 3]| a.iter().fold(0.0f64, |largest, component| largest.max(component.abs()));
    let (edge1, edge2) = (difference(&vertices[1], &vertices[0]), difference(&vertices[2], &vertices[0]));
    let start = difference(&ray[0], &vertices[0]);
    // The start is a difference of rounded numbers: its error is that of the larger ones.
    let from = size(&ray[0]).max(size(&vertices[0]));
    let (d, a, b, s) = (size(&ray[1]), size(&edge1), size(&edge2), size(&start).max(from));
    let p = cross(&ray[1], &edge2);
    let determinant = dot(&p, &edge1);
    if determinant.abs() <= MARGIN * d * a * b {
        return false;
    }
    let sign = determinant.signum();
    let q = cross(&start, &edge1);
    let (u, v, t) = (dot(&p, &start) * sign, dot(&q, &ray[1]) * sign, dot(&q, &edge2) * sign);
    let w = determinant.abs() - u - v;
    u < -MARGIN * d * b * s
        || v < -MARGIN * d * a * s
        || w < -2.0 * MARGIN * d * (a * b + b * s + a * s)
        || t < -MARGIN * a * b * s
}

impl RealFormulas<'_> {
    /// Notes the choice of the largest component.
    pub(super) fn decide_major(&mut self, a: &[ShadowInput; 3]) {
        let largest = |magnitudes: [LongReal; 3]| {
            let is_not_above =
                |j: usize, k: usize| magnitudes[j].partial_cmp(&magnitudes[k]) != Some(Ordering::Greater);
            (0..3).find(|&k| (0..3).all(|j| is_not_above(j, k)))
        };
        let magnitude = |number: LongReal| if number.is_negative() { number.negated() } else { number };
        self.decide_on(a.iter(), || {
            let machine = a.map(|component| LongReal::whole(component.raw.into()));
            largest(reals(a).map(magnitude)) == largest(machine.map(magnitude))
        });
    }
}
