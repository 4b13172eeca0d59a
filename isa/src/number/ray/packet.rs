//! A ray against a packet: triangles whose words of the same kind stand together, four of which are tried at once in double precision.
//! [`super::filter`] has the bounds, and integers decide where those are met; so the results are those of one triangle after the other.

use super::filter::{DETERMINANT, DIFFERENCE};
use super::triangle::{TriangleEnd, exact_triangle};
use super::{Ray, ratio};
use crate::number::{Arithmetic, Vector};

/// Triangles that are tried at once.
const LANES: usize = 4;

/// Words of a triangle of a packet: its name and three vertices.
pub const PACKET_WORDS: usize = 10;

/// Largest quotient that double precision rounds; beyond it a word may saturate.
const LARGEST: f64 = 2147483000.0;

/// A number for each lane.
type LaneNumbers = [f64; LANES];

/// Triangles in octets: as many names of 32 bits, then as many x, y and z of first vertices, of second and of third ones, little-endian.
#[derive(Clone, Copy, Debug)]
pub struct PacketWords<'a> {
    octets: &'a [u8],
    count: usize,
}

/// A hit of a packet, or a distance that hits have to stay below.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PacketHit {
    /// The rounded distance, scaled as the search says.
    pub t: i32,
    /// Name of the triangle; of those at the same distance, the least name counts as the nearest.
    pub name: u32,
}

impl PacketHit {
    /// The hit comes before another one: its distance is less, or its name where the distances are the same.
    fn is_before(self, other: PacketHit) -> bool {
        (self.t, self.name) < (other.t, other.name)
    }
}

impl<'a> PacketWords<'a> {
    /// The packet of as many triangles as the octets hold.
    #[inline(always)]
    pub fn new(octets: &'a [u8]) -> PacketWords<'a> {
        PacketWords { octets, count: octets.len() / (4 * PACKET_WORDS) }
    }

    /// The packet of so many triangles at the beginning of octets that go on behind it: four lanes are read at once wherever they do. `None` where
    /// the octets do not hold it.
    #[inline(always)]
    pub fn at_start(octets: &'a [u8], count: usize) -> Option<PacketWords<'a>> {
        let needed = count.checked_mul(4 * PACKET_WORDS)?;
        (needed <= octets.len()).then_some(PacketWords { octets, count })
    }

    /// A word of a triangle: 0 for its name, then the components of its vertices.
    #[inline(always)]
    fn word(&self, kind: usize, triangle: usize) -> i32 {
        let at = 4 * (kind * self.count + triangle);
        self.octets[at..].first_chunk().map_or(0, |&octets| i32::from_le_bytes(octets))
    }

    fn name(&self, triangle: usize) -> u32 {
        self.word(0, triangle) as u32
    }

    fn vertices(&self, triangle: usize) -> [Vector; 3] {
        [1, 4, 7].map(|kind| [0, 1, 2].map(|axis| self.word(kind + axis, triangle)))
    }

    /// The words of one kind of the lanes from a triangle on; lanes without a triangle have any.
    #[inline(always)]
    fn lanes(&self, kind: usize, first: usize) -> LaneNumbers {
        let start = 4 * (kind * self.count + first);
        // What follows in memory stands in lanes that nobody looks at. At the end of it the last octets are moved to where they belong.
        let octets = match self.octets[start..].first_chunk::<{ 4 * LANES }>() {
            Some(octets) => *octets,
            None => {
                let last = self.octets.last_chunk().map_or(0, |&last| u128::from_le_bytes(last));
                let left = self.octets.len() - start;
                (last >> (8 * (4 * LANES - left))).to_le_bytes()
            }
        };
        let (words, _) = octets.as_chunks::<4>();
        let mut lanes = [0.0; LANES];
        for (lane, &word) in lanes.iter_mut().zip(words) {
            *lane = f64::from(i32::from_le_bytes(word));
        }
        lanes
    }

    /// The components of a vertex of the lanes from a triangle on; `kind` is that of x.
    #[inline(always)]
    fn vertex_lanes(&self, kind: usize, first: usize) -> [LaneNumbers; 3] {
        [self.lanes(kind, first), self.lanes(kind + 1, first), self.lanes(kind + 2, first)]
    }

    /// The nearest of a hit and those of the packet: the least rounded t, then the least name. t is scaled by 2^shift.
    #[inline(always)]
    pub fn nearest(&self, arithmetic: &impl Arithmetic, ray: &Ray, shift: u32, found: PacketHit) -> PacketHit {
        let mut best = found;
        self.search(arithmetic, ray, shift, found.t, |hit| {
            if hit.is_before(best) {
                best = hit;
            }
            (best.t, false)
        });
        best
    }

    /// The first hit, in the order of the packet, whose t is below `limit`, and the number of triangles before it.
    #[inline(always)]
    pub fn any(&self, arithmetic: &impl Arithmetic, ray: &Ray, shift: u32, limit: i32) -> Option<(usize, PacketHit)> {
        let mut found = None;
        let last = self.search(arithmetic, ray, shift, limit, |hit| {
            let is_below = hit.t < limit;
            if is_below {
                found = Some(hit);
            }
            (limit, is_below)
        });
        found.map(|hit| (last, hit))
    }

    /// Offers the hits to a function, in the order of the packet, but for those that are surely rounded beyond a distance. The function says
    /// which distance that is from then on, and whether the search is over; the number of the triangle at which it ended is returned.
    #[inline(always)]
    fn search(
        &self,
        arithmetic: &impl Arithmetic,
        ray: &Ray,
        shift: u32,
        mut most: i32,
        mut offer: impl FnMut(PacketHit) -> (i32, bool),
    ) -> usize {
        let beam = Beam::new(ray);
        // A distance beyond the word becomes the largest word, which is nearer than what is farther than that.
        let word_end = i32::MAX >> (32 - arithmetic.word());
        let end_of = |most: i32| if most < word_end { f64::from(most) + 1.0 } else { f64::INFINITY };
        let mut first = 0;
        while first < self.count {
            let judged = beam.judge(self, first);
            // Most triangles are surely missed; the others come in their order.
            let mut left = judged.candidates() & !(u32::MAX << LANES.min(self.count - first));
            while left != 0 {
                let lane = left.trailing_zeros() as usize;
                left &= left - 1;
                let triangle = first + lane;
                let t = match judged.distance(lane, shift) {
                    Distance::Between(low, _) if low >= end_of(most) => continue,
                    Distance::Between(low, high) => rounded(arithmetic, low, high),
                    Distance::Unsure => None,
                };
                let exactly = || {
                    let met = exact_triangle(ray, &self.vertices(triangle));
                    (met.end == TriangleEnd::Hit).then(|| ratio(arithmetic, met.t, met.determinant, shift))
                };
                let Some(t) = t.or_else(exactly) else { continue };
                let is_over;
                (most, is_over) = offer(PacketHit { t, name: self.name(triangle) });
                if is_over {
                    return triangle;
                }
            }
            first += LANES;
        }
        self.count
    }
}

/// Knowledge of the t of a lane, scaled.
enum Distance {
    /// The lane is surely hit, and t lies strictly between these.
    Between(f64, f64),
    /// Integers have to say.
    Unsure,
}

/// A number that lies strictly between two, rounded to a word, where both ends say the same: no quarter lies between them.
#[inline(always)]
fn rounded(arithmetic: &impl Arithmetic, low: f64, high: f64) -> Option<i32> {
    let (quarter, other) = ((4.0 * low).floor(), (4.0 * high).ceil());
    // 5.3 to 5.4 lies between quarters 21 and 22, so it is above 5 by less than a half: quarters 4 x 5 + 1 are rounded as it is.
    if other - quarter != 1.0 || high > LARGEST {
        return None;
    }
    let quarter = quarter as i64;
    let above = if quarter & 3 < 2 { 1 } else { 3 };
    let t = (quarter & !3) | above;
    let largest = i64::from(i32::MAX >> (32 - arithmetic.word()));
    // A distance saturates in every mode, as `ratio` says.
    Some(if t >> 2 >= largest { largest as i32 } else { arithmetic.narrow64(t, 2) })
}

/// A ray as the lanes take it.
struct Beam {
    origin: [LaneNumbers; 3],
    direction: [LaneNumbers; 3],
    /// The largest component of the direction.
    size: f64,
}

/// Bounds of the tests of some lanes. With the sign of the determinant turned away, each test is a number that has to be positive.
struct Judged {
    /// The determinant's magnitude above its error.
    sure: LaneNumbers,
    /// The least of the tests, with all errors taken for it: a negative one is surely missed.
    most: LaneNumbers,
    /// The least of the tests, with all errors taken against it: a positive one is surely hit.
    least: LaneNumbers,
    /// u, or v, surely above the determinant's magnitude: missed, whatever the sign of that is.
    beyond: LaneNumbers,
    determinant: LaneNumbers,
    t: LaneNumbers,
    /// Errors of the determinant and of t.
    determinant_error: LaneNumbers,
    t_error: LaneNumbers,
}

impl Judged {
    /// The lanes that are not surely missed, a bit each.
    #[inline(always)]
    fn candidates(&self) -> u32 {
        let mut candidates = 0;
        for lane in 0..LANES {
            let is_missed = (self.most[lane] < 0.0) & (self.sure[lane] > 0.0) | (self.beyond[lane] > 0.0);
            candidates |= u32::from(!is_missed) << lane;
        }
        candidates
    }

    /// The quotient of t and the determinant, scaled by 2^shift, where both have sure signs.
    ///
    /// Both are off by their errors at most, so the quotient q by (error of t + q error of the determinant) / (magnitude - error) at most,
    /// and by a few units in the last place from computing all this, for which the bound is doubled and 2^-50 of q added.
    #[inline(always)]
    fn distance(&self, lane: usize, shift: u32) -> Distance {
        if !(self.least[lane] > 0.0 && self.sure[lane] > 0.0) {
            return Distance::Unsure;
        }
        let scale = f64::from_bits(u64::from(1023 + shift) << 52);
        let (magnitude, t) = (self.determinant[lane].abs(), self.t[lane].abs());
        let quotient = t / magnitude;
        let error = 2.0 * (self.t_error[lane] + quotient * self.determinant_error[lane]) / self.sure[lane]
            + quotient * (1.0 / (1u64 << 50) as f64);
        Distance::Between(scale * (quotient - error), scale * (quotient + error))
    }
}

/// A function of two numbers, lane by lane. A loop by hand: what `array::map` calls is compiled apart, without the host's features.
#[inline(always)]
fn each(a: LaneNumbers, b: LaneNumbers, of: impl Fn(f64, f64) -> f64) -> LaneNumbers {
    let mut result = [0.0; LANES];
    for lane in 0..LANES {
        result[lane] = of(a[lane], b[lane]);
    }
    result
}

#[inline(always)]
fn add(a: LaneNumbers, b: LaneNumbers) -> LaneNumbers {
    each(a, b, |a, b| a + b)
}

#[inline(always)]
fn subtract(a: LaneNumbers, b: LaneNumbers) -> LaneNumbers {
    each(a, b, |a, b| a - b)
}

#[inline(always)]
fn multiply(a: LaneNumbers, b: LaneNumbers) -> LaneNumbers {
    each(a, b, |a, b| a * b)
}

#[inline(always)]
fn scaled(a: LaneNumbers, factor: f64) -> LaneNumbers {
    each(a, [factor; LANES], |a, factor| a * factor)
}

#[inline(always)]
fn magnitude(a: LaneNumbers) -> LaneNumbers {
    each(a, a, |a, _| a.abs())
}

/// The smaller number, lane by lane; none of them is NaN.
#[inline(always)]
fn least(a: LaneNumbers, b: LaneNumbers) -> LaneNumbers {
    each(a, b, |a, b| if a < b { a } else { b })
}

/// The larger number, lane by lane; none of them is NaN.
#[inline(always)]
fn largest(a: LaneNumbers, b: LaneNumbers) -> LaneNumbers {
    each(a, b, |a, b| if a > b { a } else { b })
}

/// The number with its sign turned where that of another one is set.
#[inline(always)]
fn turned(a: LaneNumbers, sign: LaneNumbers) -> LaneNumbers {
    each(a, sign, |a, sign| a * 1f64.copysign(sign))
}

#[inline(always)]
fn minor(a: &[LaneNumbers; 3], b: &[LaneNumbers; 3], j: usize, k: usize) -> LaneNumbers {
    subtract(multiply(a[j], b[k]), multiply(a[k], b[j]))
}

#[inline(always)]
fn cross(a: &[LaneNumbers; 3], b: &[LaneNumbers; 3]) -> [LaneNumbers; 3] {
    [minor(a, b, 1, 2), minor(a, b, 2, 0), minor(a, b, 0, 1)]
}

#[inline(always)]
fn dot(a: &[LaneNumbers; 3], b: &[LaneNumbers; 3]) -> LaneNumbers {
    add(add(multiply(a[0], b[0]), multiply(a[1], b[1])), multiply(a[2], b[2]))
}

#[inline(always)]
fn size(a: &[LaneNumbers; 3]) -> LaneNumbers {
    largest(largest(magnitude(a[0]), magnitude(a[1])), magnitude(a[2]))
}

#[inline(always)]
fn difference(a: &[LaneNumbers; 3], b: &[LaneNumbers; 3]) -> [LaneNumbers; 3] {
    [subtract(a[0], b[0]), subtract(a[1], b[1]), subtract(a[2], b[2])]
}

/// A vector for all lanes.
#[inline(always)]
fn beside([x, y, z]: Vector) -> [LaneNumbers; 3] {
    [[f64::from(x); LANES], [f64::from(y); LANES], [f64::from(z); LANES]]
}

impl Beam {
    #[inline(always)]
    fn new(ray: &Ray) -> Beam {
        let direction = beside(ray.direction);
        let size = size(&direction)[0];
        Beam { origin: beside(ray.origin), direction, size }
    }

    /// Tries the triangles from a number on, by the formulas and the bounds of [`super::filter`].
    #[inline(always)]
    fn judge(&self, packet: &PacketWords, first: usize) -> Judged {
        // Find edges and start, which doubles hold exactly.
        let corner = packet.vertex_lanes(1, first);
        let edge1 = difference(&packet.vertex_lanes(4, first), &corner);
        let edge2 = difference(&packet.vertex_lanes(7, first), &corner);
        let start = difference(&self.origin, &corner);

        // Compute the determinants, and how far each may be off.
        let p = cross(&self.direction, &edge2);
        let q = cross(&start, &edge1);
        let determinant = dot(&p, &edge1);
        let (u, v, t) = (dot(&p, &start), dot(&q, &self.direction), dot(&q, &edge2));
        let w = subtract(subtract(determinant, u), v);
        let (a, b, s) = (size(&edge1), size(&edge2), size(&start));
        let (ab, bs, as_) = (multiply(a, b), multiply(b, s), multiply(a, s));
        let margin = DETERMINANT * self.size;
        let (determinant_error, u_error, v_error) = (scaled(ab, margin), scaled(bs, margin), scaled(as_, margin));
        let w_error = scaled(add(add(ab, bs), as_), DIFFERENCE * self.size);
        let t_error = scaled(multiply(ab, s), DETERMINANT);

        // Turn the tests so that a hit passes them with positive numbers.
        let (inside_u, inside_v) = (turned(u, determinant), turned(v, determinant));
        let (inside_w, ahead) = (turned(w, determinant), turned(t, determinant));
        let absolute = magnitude(determinant);
        let above = largest(subtract(magnitude(u), u_error), subtract(magnitude(v), v_error));
        Judged {
            sure: subtract(absolute, determinant_error),
            most: least(
                least(add(inside_u, u_error), add(inside_v, v_error)),
                least(add(inside_w, w_error), add(ahead, t_error)),
            ),
            least: least(
                least(subtract(inside_u, u_error), subtract(inside_v, v_error)),
                least(subtract(inside_w, w_error), subtract(ahead, t_error)),
            ),
            beyond: subtract(above, add(absolute, determinant_error)),
            determinant,
            t,
            determinant_error,
            t_error,
        }
    }
}
