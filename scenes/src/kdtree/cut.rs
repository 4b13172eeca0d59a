//! Both halves of a triangle that a plane cuts, as boxes. It looks at one plane only, so it takes a fifth of the time of [`super::clip`], and its boxes are
//! hardly larger.

use super::Bounds;
use super::split::Division;

/// Units by which a point on an edge is moved outwards before it is rounded. Coordinates have 32 bits and double precision has 53, so such a point
/// is off by less than 2^-16.
const MARGIN: f64 = 1.0 / 1024.0;

/// Boxes of what lies left and right of a plane, of the part `part` of a triangle that has points strictly on both sides; `None` where the triangle
/// leaves `part` before it.
///
/// A half is the box of the vertices on its side and of the points in which edges cross the plane, cut down to `part`. It errs on the large side:
/// where an edge is crossed by up to one unit. For example, the triangle (0,0) (10,0) (0,10) at x = 4 has the halves 0..4 x 0..10 and 4..10 x 0..7 in
/// the plane of z: its third side is crossed at (4,6), which becomes 6 + 1/1024 and is rounded up.
pub(super) fn halves(vertices: &[[i32; 3]; 3], part: &Bounds, division: &Division) -> [Option<Bounds>; 2] {
    let (axis, at) = (division.axis, f64::from(division.at));
    let corners = vertices.map(|[x, y, z]| [x, y, z, 0].map(f64::from));
    let [mut left, mut right] = [RealBox::EMPTY; 2];
    let mut from = &corners[2];
    for to in &corners {
        if to[axis] <= at {
            left.grow(to, 0.0);
        }
        if to[axis] >= at {
            right.grow(to, 0.0);
        }
        // Strictly on different sides: never with a vertex in the plane, and whatever is 0 divides nothing.
        let (before, after) = (at - from[axis], to[axis] - at);
        if before * after > 0.0 {
            let share = before / (to[axis] - from[axis]);
            let point = [0, 1, 2, 3].map(|k| from[k] + share * (to[k] - from[k]));
            left.grow(&point, MARGIN);
            right.grow(&point, MARGIN);
        }
        from = to;
    }
    let [mut left, mut right] = [left, right].map(|half| half.on_grid());
    left.high[axis] = division.at;
    right.low[axis] = division.at;
    [left, right].map(|half| {
        let low = [0, 1, 2].map(|k| half.low[k].max(part.low[k]));
        let high = [0, 1, 2].map(|k| half.high[k].min(part.high[k]));
        (0..3).all(|k| low[k] <= high[k]).then_some(Bounds { low, high })
    })
}

/// A box of real numbers, with a fourth coordinate that is 0: four are computed as fast as three.
#[derive(Clone, Copy)]
struct RealBox {
    low: [f64; 4],
    high: [f64; 4],
}

impl RealBox {
    const EMPTY: RealBox = RealBox { low: [f64::INFINITY; 4], high: [f64::NEG_INFINITY; 4] };

    /// Grows to a point and `margin` around it.
    fn grow(&mut self, point: &[f64; 4], margin: f64) {
        for ((least, most), &at) in self.low.iter_mut().zip(&mut self.high).zip(point) {
            let (low, high) = (at - margin, at + margin);
            *least = if low < *least { low } else { *least };
            *most = if high > *most { high } else { *most };
        }
    }

    /// The smallest box on the grid around it, within 32 bits.
    fn on_grid(self) -> Bounds {
        let (low, high) = (self.low.map(floor), self.high.map(|x| -floor(-x)));
        let whole = |[x, y, z, _]: [f64; 4]| [x as i32, y as i32, z as i32];
        Bounds { low: whole(low), high: whole(high) }
    }
}

/// The next whole number below, of one of at most 33 bits; `f64::floor` is a call where the host is not known to round.
fn floor(x: f64) -> f64 {
    // A number so large has no fraction bits, so adding it rounds to the nearest whole number.
    const LARGE: f64 = 6_755_399_441_055_744.0;
    let nearest = (x + LARGE) - LARGE;
    if nearest > x { nearest - 1.0 } else { nearest }
}
