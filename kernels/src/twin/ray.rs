//! Values that functions hand to each other: rays, the places where they leave packets, packets, and the search for a hit.

use std::ops::Range;

use isa::number::Vector;
use scenes::kdtree::Bounds;

use super::vector_arithmetic::VectorArithmetic;

/// A ray P(t) = origin + t direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TwinRay {
    /// The origin: a position.
    pub origin: Vector,
    /// The direction, of unit length.
    pub direction: Vector,
    /// Absolute value of the direction, component by component.
    pub steep: Vector,
}

impl TwinRay {
    /// A ray from its origin and direction.
    pub fn new(arithmetic: &impl VectorArithmetic, origin: Vector, direction: Vector) -> TwinRay {
        TwinRay { origin, direction, steep: arithmetic.magnitude(direction) }
    }

    /// The ray goes towards smaller coordinates of an axis; 0 counts as positive.
    pub fn is_backwards(&self, axis: usize) -> bool {
        self.direction[axis] < 0
    }
}

/// A plane through which a ray leaves a packet (or enters the scene): met at t = run / slope.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExitPlane {
    /// Axis of the plane; 3 for the start of a ray, which is no plane.
    pub axis: usize,
    /// Coordinate of the plane, raw.
    pub plane: i32,
    /// Distance from the origin to the plane along the axis, raw, counted in the ray's direction.
    pub run: i32,
    /// Absolute value of the direction along the axis.
    pub slope: i32,
}

impl ExitPlane {
    /// The start of a ray: t = 0.
    pub const START: ExitPlane = ExitPlane { axis: 3, plane: 0, run: 0, slope: 1 };
}

/// A leaf of the kd tree.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Packet {
    /// The packet's part of space.
    pub bounds: Bounds,
    /// The packet's references to triangles, by number.
    pub references: Range<u32>,
}

/// A search for the nearest hit, or for any hit nearer than a distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TwinSearch {
    /// Distance of the nearest hit so far; before the first one, the distance that it has to stay below.
    pub t: i32,
    /// The triangle of the nearest hit so far, by index.
    pub triangle: Option<u32>,
    /// The search ends with any hit.
    pub takes_any: bool,
}

/// A ray has visited more packets than there are: a trap of the machine, which exact arithmetic never meets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stuck;
