//! Rays against triangles, boxes and the planes of a kd tree, decided exactly on raw integers of any 32 bits. What is rounded at the end is
//! said in [`ratio`]; which format an integer has is the caller's business.
//!
//! Nothing here is ever undecided: a ray that meets an edge, a vertex or two planes at once is decided as if its direction were moved by
//! (e, e^2, e^3) with e > 0 infinitely small. Triangles and planes use the same movement, so a closed mesh is crossed as often from the
//! outside to the inside as back, by a walk through a kd tree as well. `docs/exactness.md` has the argument and the numbers of bits.

mod filter;
mod packet;
#[cfg(test)]
mod packet_tests;
mod plane;
mod ratio;
#[cfg(test)]
mod tests;
mod triangle;
mod walk;

use super::Vector;
pub use filter::triangle;
pub use packet::{PACKET_WORDS, PacketHit, PacketWords};
pub use plane::{BoxEnd, Plane, SplitEnd, across_box, exit_face, is_surely_before, step};
pub use ratio::ratio;
pub use triangle::{Meeting, TriangleEnd, exact_triangle};
pub use walk::{Children, Descent};

/// A ray P(t) = origin + t direction, t > 0, on raw integers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ray {
    /// The origin of the ray.
    pub origin: Vector,
    /// The direction, of any length.
    pub direction: Vector,
}

impl From<[Vector; 2]> for Ray {
    #[inline]
    fn from([origin, direction]: [Vector; 2]) -> Ray {
        Ray { origin, direction }
    }
}

/// Differences of coordinates: 33 bits with their sign.
pub(crate) type Difference = [i64; 3];

fn difference(a: Vector, b: Vector) -> Difference {
    std::array::from_fn(|k| i64::from(a[k]) - i64::from(b[k]))
}
