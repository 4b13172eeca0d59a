//! Both halves of a triangle that a plane cuts, as boxes. It looks at one plane only, so it computes far less than [`super::clip`], and its boxes are
//! hardly larger.

use wide::f64x4;

use super::Bounds;
use super::split::Division;

/// Units by which a point on an edge is moved outwards before it is rounded. Coordinates have 32 bits and double precision has 53, so such a point
/// is off by less than 2^-16.
const MARGIN: f64 = 1.0 / 1024.0;

/// Boxes of what lies left and right of a plane, of the part `part` of a triangle that has points strictly on both sides; an empty box, `low` beyond
/// `high`, where the triangle leaves `part` before it.
///
/// A half is the box of the vertices on its side and of the points in which edges cross the plane, cut down to `part`. It errs on the large side:
/// where an edge is crossed by up to one unit. For example, the triangle (0,0) (10,0) (0,10) at x = 4 has the halves 0..4 x 0..10 and 4..10 x 0..7 in
/// the plane of z: its third side is crossed at (4,6), which becomes 6 + 1/1024 and is rounded up.
pub(super) fn halves(vertices: &[[i32; 3]; 3], part: &Bounds, division: &Division) -> [Bounds; 2] {
    let Division { axis, at, .. } = *division;
    // One vertex is alone on its side: the other two are beyond the plane or in it, and both of its edges reach the plane.
    let is_below = vertices.map(|vertex| vertex[axis] < at);
    let is_above = vertices.map(|vertex| vertex[axis] > at);
    let is_left = is_below.map(usize::from).iter().sum::<usize>() == 1;
    let [_, second, third] = if is_left { is_below } else { is_above };
    let [before, alone, after] = THREE_FROM[usize::from(second) + 2 * usize::from(third)].map(|k| vertices[k]);

    // Where the edges cross it. An edge that ends in the plane is not cut there: its end is a vertex of both halves, and as exact as all of them.
    let plane = f64::from(at);
    let [from, middle, to] = [f64::from(before[axis]), f64::from(alone[axis]), f64::from(after[axis])];
    let shares = [(plane - from) / (middle - from), (plane - middle) / (to - middle)].map(f64x4::splat);
    let margins = [before[axis], after[axis]].map(|end| f64x4::splat(if end == at { 0.0 } else { MARGIN }));
    let (before, alone, after) = (real(&before), real(&alone), real(&after));
    let first = before + shares[0] * (alone - before);
    let second = alone + shares[1] * (after - alone);
    let low = (first - margins[0]).fast_min(second - margins[1]);
    let high = (first + margins[0]).fast_max(second + margins[1]);

    let one = on_grid(low.fast_min(alone), high.fast_max(alone), part);
    let other = on_grid(low.fast_min(before).fast_min(after), high.fast_max(before).fast_max(after), part);
    let [mut left, mut right] = if is_left { [one, other] } else { [other, one] };
    left.high[axis] = at;
    right.low[axis] = at;
    [left, right]
}

/// Numbers of the vertices before, at and after the one that is alone: the second if 1, the third if 2, else the first.
const THREE_FROM: [[usize; 3]; 4] = [[2, 0, 1], [0, 1, 2], [1, 2, 0], [2, 0, 1]];

/// A vertex as real numbers, with a fourth coordinate that is 0: four are computed as fast as three.
#[inline]
fn real(&[x, y, z]: &[i32; 3]) -> f64x4 {
    f64x4::new([f64::from(x), f64::from(y), f64::from(z), 0.0])
}

/// The smallest box on the grid around a box of real numbers, cut down to `part`.
#[inline]
fn on_grid(low: f64x4, high: f64x4, part: &Bounds) -> Bounds {
    let low = floor(low).fast_max(real(&part.low));
    let high = (-floor(-high)).fast_min(real(&part.high));
    Bounds { low: whole(low), high: whole(high) }
}

/// A number so large that it has no fraction bits, so adding it rounds to the nearest whole number, which its lowest bits then are.
const LARGE: f64 = 1.5 * (1u64 << 52) as f64;

/// The next whole numbers below, of some with at most 33 bits; `f64::floor` is a call where the host is not known to round.
#[inline]
fn floor(x: f64x4) -> f64x4 {
    let large = f64x4::splat(LARGE);
    let nearest = (x + large) - large;
    nearest - (nearest.simd_gt(x) & f64x4::ONE)
}

/// Whole numbers of 32 bits.
#[inline]
fn whole(x: f64x4) -> [i32; 3] {
    let [x, y, z, _] = (x + f64x4::splat(LARGE)).to_array();
    [x.to_bits() as i32, y.to_bits() as i32, z.to_bits() as i32]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    use super::super::split::Side;
    use super::*;

    /// The halves word by word: every vertex is asked for its side, every edge for a crossing.
    fn model(vertices: &[[i32; 3]; 3], part: &Bounds, axis: usize, at: i32) -> [Option<Bounds>; 2] {
        let corners = vertices.map(|vertex| vertex.map(f64::from));
        let plane = f64::from(at);
        let mut points: [Vec<[[f64; 3]; 2]>; 2] = [Vec::new(), Vec::new()];
        for (number, to) in corners.iter().enumerate() {
            let from = corners[(number + 2) % 3];
            // A vertex is a point of the half on its side, and of both where it lies in the plane.
            if to[axis] <= plane {
                points[0].push([*to; 2]);
            }
            if to[axis] >= plane {
                points[1].push([*to; 2]);
            }
            // An edge that ends in the plane is not cut: its vertex is in both halves already.
            if (from[axis] < plane && to[axis] > plane) || (from[axis] > plane && to[axis] < plane) {
                let share = (plane - from[axis]) / (to[axis] - from[axis]);
                let crossing = [0, 1, 2].map(|k| from[k] + share * (to[k] - from[k]));
                let around = [crossing.map(|x| x - MARGIN), crossing.map(|x| x + MARGIN)];
                points.iter_mut().for_each(|half| half.push(around));
            }
        }
        // Round outwards and cut down to the part; the plane itself is exact
        let boxes = points.map(|half| {
            let least = |k: usize| half.iter().map(|[low, _]| low[k]).fold(f64::INFINITY, f64::min);
            let most = |k: usize| half.iter().map(|[_, high]| high[k]).fold(f64::NEG_INFINITY, f64::max);
            Bounds {
                low: [0, 1, 2].map(|k| (least(k).floor() as i32).max(part.low[k])),
                high: [0, 1, 2].map(|k| (most(k).ceil() as i32).min(part.high[k])),
            }
        });
        let [mut left, mut right] = boxes;
        left.high[axis] = at;
        right.low[axis] = at;
        [left, right].map(|half| (0..3).all(|k| half.low[k] <= half.high[k]).then_some(half))
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 2000, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

        #[test]
        fn halves_are_those_of_the_plain_rule(
            small in prop::array::uniform3(prop::array::uniform3(-9..=9)),
            large in prop::array::uniform3(prop::array::uniform3(-((1 << 30) - 2)..(1 << 30) - 2)),
            sides in prop::array::uniform3(0u32..=100),
            ends in prop::array::uniform3(0u32..=100),
            share in 1u32..100,
            axis in 0usize..3,
            is_small: bool,
        ) {
            let vertices = if is_small { small } else { large };
            let whole = Bounds::of_triangle(&vertices);
            // A part: some of the box along each axis. A plane strictly inside of it, if there is one; vertices of small triangles often lie in it.
            let along = |k: usize, percent: u32| {
                (i64::from(whole.low[k]) + i64::from(whole.side(k)) * i64::from(percent) / 100) as i32
            };
            let part = Bounds {
                low: [0, 1, 2].map(|k| along(k, sides[k].min(ends[k]))),
                high: [0, 1, 2].map(|k| along(k, sides[k].max(ends[k]))),
            };
            let at = part.low[axis] + (i64::from(part.side(axis)) * i64::from(share) / 100) as i32;
            if part.low[axis] < at && at < part.high[axis] {
                let found = halves(&vertices, &part, &Division { axis, at, flat: Side::Left });
                prop_assert_eq!(found.map(|half| (!half.is_empty()).then_some(half)), model(&vertices, &part, axis, at));
            }
        }
    }
}
