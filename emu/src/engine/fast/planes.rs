//! A step down a kd tree as the host does it quickest: it leaves as soon as the way is known, so that what follows can be foreseen.

use isa::Fields;
use isa::table::outcome::rstep::Outcome;

use crate::code::registers::Registers;

/// The number that stands for time among the axes.
const TIME: usize = 3;

/// A plane as the ray meets it, at t = run / slope.
#[derive(Clone, Copy)]
struct Meeting {
    axis: usize,
    run: i64,
    slope: i64,
}

impl Meeting {
    #[inline(always)]
    fn of(pattern: i64, origin: &[i32; 4], direction: &[i32; 4]) -> Meeting {
        let axis = (pattern >> 32 & 3) as usize;
        // Along time, the fourth lane, the origin is 0 and the direction 1.
        let slope = i64::from(direction[axis]) | i64::from(axis == TIME);
        Meeting { axis, run: i64::from(pattern as i32) - i64::from(origin[axis]), slope }
    }

    /// True where the ray, its direction moved, meets this plane before the other one; see [`isa::number::ray`]. A run has 33 bits with its sign and is
    /// never the least of them, so a product fits.
    #[inline(always)]
    fn is_before(self, other: Meeting) -> bool {
        let (here, there) = (self.run * other.slope, other.run * self.slope);
        if here == there {
            return (self.axis < other.axis) & (self.slope >= 0) | (self.axis > other.axis) & (other.slope < 0);
        }
        (here < there) == ((self.slope ^ other.slope) >= 0)
    }
}

/// A step down a kd tree; see the row.
#[inline(always)]
pub(super) fn rstep(registers: &Registers, fields: &Fields) -> (i32, i32, Outcome) {
    let (origin, direction) = (registers.padded(fields.a), registers.padded(fields.a.wrapping_add(1)));
    let [node, entry, exit]: [i64; 3] = registers.wides(fields.b);
    let split = Meeting::of(node, origin, direction);
    let left = (node >> 32) as i32 & !3;
    if split.axis == TIME {
        return (left, -1, Outcome::Leaf);
    }
    let right = left.wrapping_add(fields.i);
    let (near, far) = if split.slope < 0 { (right, left) } else { (left, right) };
    if if split.slope < 0 { split.run >= 0 } else { split.run <= 0 } {
        (far, 0, Outcome::Behind)
    } else if !Meeting::of(entry, origin, direction).is_before(split) {
        (far, 0, Outcome::Passed)
    } else if !split.is_before(Meeting::of(exit, origin, direction)) {
        (near, 0, Outcome::Near)
    } else {
        (near, far, Outcome::Both)
    }
}
