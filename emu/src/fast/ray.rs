//! The rows of the ray unit over all lanes, in doubles of which the host computes several at once. Products of two operands are kept as a
//! rounded product and its exact rest, so that planes are compared exactly; triangles are decided where no rounding error can have turned a
//! sign or a quotient, and the other lanes are left to [`isa::number::ray`], as is everything on hosts without fused multiply-add.
//!
//! Each step is a loop of its own over all lanes, without a branch: that is what the compiler turns into vector instructions.

use std::sync::atomic::{AtomicUsize, Ordering};

use isa::Fields;

use super::lanes::{LANES, Lanes, Longs, Mask, Words};

/// [`LANES`], which the compiler is not to know: it would unroll the short loops here before it could make vector instructions of them.
static COUNT: AtomicUsize = AtomicUsize::new(LANES);

#[inline(always)]
fn count() -> usize {
    COUNT.load(Ordering::Relaxed).min(LANES)
}

/// What an expression gives for each lane. Closures would be compiled apart, without the host's vector instructions.
macro_rules! all {
    ($lane:ident: $value:expr) => {{
        let mut all = [Default::default(); LANES];
        for $lane in 0..count() {
            all[$lane] = $value;
        }
        all
    }};
}

/// The lanes for which a claim holds.
macro_rules! which {
    ($lane:ident: $claim:expr) => {{
        let mut mask: Mask = 0;
        for $lane in 0..count() {
            mask |= Mask::from($claim) << $lane;
        }
        mask
    }};
}

/// Keeps what an expression gives in the lanes of a mask.
macro_rules! keep {
    ($place:expr, $mask:expr, $lane:ident: $value:expr) => {{
        let (place, mask) = ($place, $mask);
        for $lane in 0..count() {
            place[$lane] = if mask & 1 << $lane != 0 { $value } else { place[$lane] };
        }
    }};
}

/// One double a lane.
type Doubles = [f64; LANES];

/// Lanes by the exit that they take.
pub type Ways = [Mask; 8];

/// Words as doubles, exactly.
#[inline(always)]
fn doubles(words: &Words) -> Doubles {
    all!(lane: f64::from(words[lane]))
}

/// A vector as doubles.
#[inline(always)]
fn vector(lanes: &Lanes, number: u8) -> [Doubles; 3] {
    let [x, y, z] = lanes.vector(number);
    [doubles(x), doubles(y), doubles(z)]
}

/// Origin and direction, or the corners of a box.
#[inline(always)]
fn pair(lanes: &Lanes, number: u8) -> [[Doubles; 3]; 2] {
    [vector(lanes, number), vector(lanes, number.wrapping_add(1))]
}

/// One plane a lane, as the lane's ray meets it: at t = run / slope.
#[derive(Clone, Copy)]
struct Meetings {
    /// Axis above the coordinate, as in the patterns, without other bits.
    pattern: Longs,
    run: Doubles,
    slope: Doubles,
}

/// Patterns have their axis here.
const AXIS: i64 = 3 << 32;

/// The start of a ray.
const START: i64 = AXIS;

/// `value` where the claim holds, else 0: an and, where a choice could become a jump.
#[inline(always)]
fn if_true(claim: bool, value: f64) -> u64 {
    value.to_bits() & 0u64.wrapping_sub(claim.into())
}

/// What belongs to an axis, or to time.
#[inline(always)]
fn pick(axis: i64, values: &[Doubles; 3], time: f64, lane: usize) -> f64 {
    let (x, y) = (if_true(axis == 0, values[0][lane]), if_true(axis == 1, values[1][lane]));
    f64::from_bits(x | y | if_true(axis == 2, values[2][lane]) | if_true(axis == 3, time))
}

impl Meetings {
    /// The planes in patterns.
    #[inline(always)]
    fn of(patterns: &Longs, origin: &[Doubles; 3], direction: &[Doubles; 3]) -> Meetings {
        let pattern = all!(lane: patterns[lane] & (AXIS | 0xffff_ffff));
        let slope = all!(lane: pick(pattern[lane] >> 32, direction, 1.0, lane));
        // 33 bits, exactly.
        let run = all!(lane: f64::from(pattern[lane] as i32) - pick(pattern[lane] >> 32, origin, 0.0, lane));
        Meetings { pattern, run, slope }
    }

    /// The faces of boxes on an axis.
    #[inline(always)]
    fn on(axis: usize, at: &Doubles, origin: &[Doubles; 3], direction: &[Doubles; 3]) -> Meetings {
        Meetings {
            pattern: all!(lane: (axis as i64) << 32 | i64::from(at[lane] as i32 as u32)),
            run: all!(lane: at[lane] - origin[axis][lane]),
            slope: direction[axis],
        }
    }

    /// Lanes whose ray meets the plane after its start.
    #[inline(always)]
    fn ahead(&self) -> Mask {
        let backwards = self.backwards();
        backwards & which!(lane: self.run[lane] < 0.0) | !backwards & which!(lane: self.run[lane] > 0.0)
    }

    /// Lanes whose ray goes towards smaller coordinates.
    #[inline(always)]
    fn backwards(&self) -> Mask {
        which!(lane: self.slope[lane] < 0.0)
    }

    /// Lanes whose ray, its direction moved, meets this plane first. A rounded product is never on the wrong side of another one: where both
    /// are equal, their rests decide.
    #[inline(always)]
    fn before(&self, other: &Meetings) -> Mask {
        let here: Doubles = all!(lane: self.run[lane] * other.slope[lane]);
        let there: Doubles = all!(lane: other.run[lane] * self.slope[lane]);
        let here_rest: Doubles = all!(lane: self.run[lane].mul_add(other.slope[lane], -here[lane]));
        let there_rest: Doubles = all!(lane: other.run[lane].mul_add(self.slope[lane], -there[lane]));
        let alike = which!(lane: here[lane] == there[lane]);
        let less = which!(lane: here[lane] < there[lane]) | alike & which!(lane: here_rest[lane] < there_rest[lane]);
        let equal = alike & which!(lane: here_rest[lane] == there_rest[lane]);
        let same_way = !(self.backwards() ^ other.backwards());
        let lower = which!(lane: self.pattern[lane] >> 32 < other.pattern[lane] >> 32);
        let higher = which!(lane: self.pattern[lane] >> 32 > other.pattern[lane] >> 32);
        let first_of_equals = lower & !self.backwards() | higher & other.backwards();
        same_way & less | !same_way & !less & !equal | equal & first_of_equals
    }

    /// This plane in the lanes of the mask, else the other one.
    #[inline(always)]
    fn or(&self, other: &Meetings, mask: Mask) -> Meetings {
        Meetings {
            pattern: all!(lane: if mask & 1 << lane != 0 { self.pattern[lane] } else { other.pattern[lane] }),
            run: all!(lane: if mask & 1 << lane != 0 { self.run[lane] } else { other.run[lane] }),
            slope: all!(lane: if mask & 1 << lane != 0 { self.slope[lane] } else { other.slope[lane] }),
        }
    }
}

/// A step down a kd tree; see the row.
#[inline(always)]
pub fn rstep(fields: &Fields, lanes: &mut Lanes, mask: Mask, ways: &mut Ways) -> Mask {
    let [origin, direction] = pair(lanes, fields.a);
    let nodes = *lanes.wide(fields.b);
    let split = Meetings::of(&nodes, &origin, &direction);
    let entry = Meetings::of(lanes.wide(fields.b.wrapping_add(1)), &origin, &direction);
    let exit = Meetings::of(lanes.wide(fields.b.wrapping_add(2)), &origin, &direction);
    let leaf = which!(lane: split.pattern[lane] >> 32 == 3);
    let behind = !leaf & !split.ahead();
    let passed = !leaf & !behind & !entry.before(&split);
    let inner = !leaf & !behind & !passed;
    let both = inner & split.before(&exit);
    let right_first = !leaf & (split.backwards() ^ (behind | passed));
    let left: Words = all!(lane: (nodes[lane] >> 32) as i32 & !3);
    let right: Words = all!(lane: left[lane].wrapping_add(fields.i));
    keep!(lanes.scalar_mut(fields.d), mask, lane: if right_first & 1 << lane != 0 { right[lane] } else { left[lane] });
    keep!(lanes.scalar_mut(fields.e), mask, lane: {
        let second = if right_first & 1 << lane != 0 { left[lane] } else { right[lane] };
        let second = if both & 1 << lane != 0 { second } else { 0 };
        if leaf & 1 << lane != 0 { -1 } else { second }
    });
    ways[..5].copy_from_slice(&[leaf, behind, passed, inner & !both, both]);
    mask
}

/// Whether a hit is surely nearer than a plane; see the row.
#[inline(always)]
pub fn rbefore(fields: &Fields, lanes: &mut Lanes, mask: Mask, _: &mut Ways) -> Mask {
    let [origin, direction] = pair(lanes, fields.a);
    let plane = Meetings::of(lanes.wide(fields.b), &origin, &direction);
    let hits = lanes.scalar(fields.c);
    let scale = (1u64 << (fields.i & 63)) as f64;
    let after: Doubles = all!(lane: f64::from(hits[lane]) + 1.0);
    let slope: Doubles = all!(lane: plane.slope[lane].abs());
    let end: Doubles = all!(lane: if plane.slope[lane] < 0.0 { -plane.run[lane] } else { plane.run[lane] } * scale);
    let reached: Doubles = all!(lane: after[lane] * slope[lane]);
    let rest: Doubles = all!(lane: after[lane].mul_add(slope[lane], -reached[lane]));
    let before = which!(lane: reached[lane] < end[lane])
        | which!(lane: reached[lane] == end[lane]) & which!(lane: rest[lane] < 0.0);
    keep!(lanes.scalar_mut(fields.d), mask, lane: (before >> lane & 1) as i32);
    mask
}

/// The face of an axis by which rays enter boxes, or by which they leave them.
#[inline(always)]
fn face(
    axis: usize,
    is_entry: bool,
    [low, high]: &[[Doubles; 3]; 2],
    origin: &[Doubles; 3],
    direction: &[Doubles; 3],
) -> Meetings {
    let at = all!(lane: if (direction[axis][lane] < 0.0) == is_entry { high[axis][lane] } else { low[axis][lane] });
    Meetings::on(axis, &at, origin, direction)
}

#[inline(always)]
fn first_to_leave(x: &Meetings, y: &Meetings, z: &Meetings) -> Meetings {
    let first = x.or(y, x.before(y));
    first.or(z, first.before(z))
}

/// The plane by which a ray leaves a box; see the row.
#[inline(always)]
pub fn rexit(fields: &Fields, lanes: &mut Lanes, mask: Mask, _: &mut Ways) -> Mask {
    let [origin, direction] = pair(lanes, fields.a);
    let corners = pair(lanes, fields.b);
    let x = face(0, false, &corners, &origin, &direction);
    let y = face(1, false, &corners, &origin, &direction);
    let z = face(2, false, &corners, &origin, &direction);
    let found = first_to_leave(&x, &y, &z);
    keep!(lanes.wide_mut(fields.d), mask, lane: found.pattern[lane]);
    mask
}

/// Where a ray crosses a box; see the row.
#[inline(always)]
pub fn rbox(fields: &Fields, lanes: &mut Lanes, mask: Mask, ways: &mut Ways) -> Mask {
    let [origin, direction] = pair(lanes, fields.a);
    let corners = pair(lanes, fields.b);
    let x = face(0, false, &corners, &origin, &direction);
    let y = face(1, false, &corners, &origin, &direction);
    let z = face(2, false, &corners, &origin, &direction);
    let beside = !(x.ahead() & y.ahead() & z.ahead());
    let exit = first_to_leave(&x, &y, &z);
    let mut entry = Meetings { pattern: [START; LANES], run: [0.0; LANES], slope: [1.0; LANES] };
    for axis in 0..3 {
        let next = face(axis, true, &corners, &origin, &direction);
        entry = next.or(&entry, next.ahead() & entry.before(&next));
    }
    let inside = !beside & which!(lane: entry.pattern[lane] == START);
    let entered = !beside & !inside & entry.before(&exit);
    let met = inside | entered;
    keep!(lanes.wide_mut(fields.d), mask, lane: if met & 1 << lane != 0 { entry.pattern[lane] } else { -1 });
    keep!(lanes.wide_mut(fields.e), mask, lane: if met & 1 << lane != 0 { exit.pattern[lane] } else { -1 });
    ways[..4].copy_from_slice(&[beside, inside, !beside & !met, entered]);
    mask
}

/// Bound on the error of a determinant, in units of the product of the largest lanes of its three vectors; see the filter of
/// [`isa::number::ray::triangle`].
const DETERMINANT: f64 = 1.0 / (1u64 << 48) as f64;

/// Largest quotient that is decided here: beyond it, the word may saturate.
const LARGEST: f64 = 2147483000.0;

#[inline(always)]
fn minus(a: &Doubles, b: &Doubles) -> Doubles {
    all!(lane: a[lane] - b[lane])
}

#[inline(always)]
fn difference(a: &[Doubles; 3], b: &[Doubles; 3]) -> [Doubles; 3] {
    [minus(&a[0], &b[0]), minus(&a[1], &b[1]), minus(&a[2], &b[2])]
}

/// The larger number; there is none that is no number, about which `max` would ask.
#[inline(always)]
fn more(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[inline(always)]
fn largest(a: &[Doubles; 3]) -> Doubles {
    all!(lane: more(more(a[0][lane].abs(), a[1][lane].abs()), a[2][lane].abs()))
}

#[inline(always)]
fn minor(a: &[Doubles; 3], b: &[Doubles; 3], j: usize, k: usize) -> Doubles {
    all!(lane: a[j][lane] * b[k][lane] - a[k][lane] * b[j][lane])
}

#[inline(always)]
fn cross(a: &[Doubles; 3], b: &[Doubles; 3]) -> [Doubles; 3] {
    [minor(a, b, 1, 2), minor(a, b, 2, 0), minor(a, b, 0, 1)]
}

/// The bound on the error of a determinant of vectors with these largest lanes.
#[inline(always)]
fn bound(a: &Doubles, b: &Doubles, c: &Doubles) -> Doubles {
    all!(lane: DETERMINANT * a[lane] * (b[lane] * c[lane]))
}

/// The dot product, its sign turned where that of `sign` is set.
#[inline(always)]
fn signed_dot(a: &[Doubles; 3], b: &[Doubles; 3], sign: &Doubles) -> Doubles {
    all!(lane: {
        let dot = a[0][lane] * b[0][lane] + a[1][lane] * b[1][lane] + a[2][lane] * b[2][lane];
        f64::from_bits(dot.to_bits() ^ sign[lane].to_bits() & 1 << 63)
    })
}

/// One determinant a lane, divided by another one.
struct Quotients<'a> {
    inverse: &'a Doubles,
    doubt: &'a Doubles,
}

impl Quotients<'_> {
    /// Determinants over the divisor, times a power of two, to nearest, ties up, and the lanes in which that is sure.
    ///
    /// `part` is off by at most `margin`, the divisor by `doubt` of itself, at most one half; then the quotient is off by at most
    /// 2 (margin + quotient doubt) / divisor, and by 2^-50 of itself from the operations here. Sure is what lies further than twice that from
    /// where rounding turns.
    #[inline(always)]
    fn rounded(&self, part: &Doubles, margin: &Doubles, scale: f64) -> (Doubles, Mask) {
        let quotient: Doubles = all!(lane: part[lane] * self.inverse[lane] * scale);
        let floor: Doubles = all!(lane: (quotient[lane] + 0.5).floor());
        let error: Doubles = all!(lane: {
            4.0 * (margin[lane] * self.inverse[lane] * scale + quotient[lane] * self.doubt[lane])
                + (quotient[lane] + 0.5) * DETERMINANT
        });
        let above: Doubles = all!(lane: quotient[lane] + 0.5 - floor[lane]);
        let sure = which!(lane: above[lane] > error[lane])
            & which!(lane: above[lane] < 1.0 - error[lane])
            & which!(lane: quotient[lane] < LARGEST);
        (floor, sure)
    }
}

/// A ray against a triangle; see the row.
#[inline(always)]
pub fn rtri(fields: &Fields, lanes: &mut Lanes, mask: Mask, ways: &mut Ways) -> Mask {
    let [origin, d] = pair(lanes, fields.a);
    let corner = vector(lanes, fields.b);
    let edge1 = difference(&vector(lanes, fields.b.wrapping_add(1)), &corner);
    let edge2 = difference(&vector(lanes, fields.b.wrapping_add(2)), &corner);
    let start = difference(&origin, &corner);
    let (large_d, large_a, large_b, large_s) = (largest(&d), largest(&edge1), largest(&edge2), largest(&start));

    let (p, q) = (cross(&d, &edge2), cross(&start, &edge1));
    let signed = signed_dot(&p, &edge1, &[0.0; LANES]);
    let whole: Doubles = all!(lane: signed[lane].abs());
    let u = signed_dot(&p, &start, &signed);
    let v = signed_dot(&q, &d, &signed);
    let w: Doubles = all!(lane: whole[lane] - u[lane] - v[lane]);
    let t = signed_dot(&q, &edge2, &signed);
    let margin = bound(&large_d, &large_a, &large_b);
    let (margin_u, margin_v) = (bound(&large_d, &large_b, &large_s), bound(&large_d, &large_a, &large_s));
    let margin_w: Doubles = all!(lane: 2.0 * (margin[lane] + margin_u[lane] + margin_v[lane]));
    let margin_t = bound(&large_s, &large_a, &large_b);

    // Lanes that are still inside, as they are tested one after the other.
    let mut inside = mask & which!(lane: whole[lane] > margin[lane]);
    let mut decided = 0;
    for (way, value, margin) in [(1, &u, &margin_u), (2, &v, &margin_v), (3, &w, &margin_w), (4, &t, &margin_t)] {
        let outside = inside & which!(lane: value[lane] < -margin[lane]);
        ways[way] = outside;
        decided |= outside;
        inside &= which!(lane: value[lane] > margin[lane]);
    }
    keep!(lanes.scalar_mut(fields.d), decided, lane: i32::MAX);
    for k in 0..3 {
        keep!(&mut lanes.vector_mut(fields.e)[k], decided, lane: 0);
    }
    if inside == 0 {
        return decided;
    }
    let inverse: Doubles = all!(lane: 1.0 / whole[lane]);
    let doubt: Doubles = all!(lane: margin[lane] * inverse[lane]);
    let quotients = Quotients { inverse: &inverse, doubt: &doubt };
    let (time, sure_time) = quotients.rounded(&t, &margin_t, (1u64 << (fields.i & 63)) as f64);
    let (weight_u, sure_u) = quotients.rounded(&u, &margin_u, (1u64 << 30) as f64);
    let (weight_v, sure_v) = quotients.rounded(&v, &margin_v, (1u64 << 30) as f64);
    let hit = inside & sure_time & sure_u & sure_v & which!(lane: doubt[lane] < 0.5);
    keep!(lanes.scalar_mut(fields.d), hit, lane: time[lane] as i32);
    let weights = lanes.vector_mut(fields.e);
    keep!(&mut weights[0], hit, lane: weight_u[lane] as i32);
    keep!(&mut weights[1], hit, lane: weight_v[lane] as i32);
    keep!(&mut weights[2], hit, lane: 0);
    ways[5] = hit;
    decided | hit
}
