//! A ray against a triangle in doubles of which the host computes four at once: decided where no rounding error can have turned a sign or the
//! rounding of a quotient, by the bounds of the filter of [`isa::number::ray::triangle`]; the rest is left to exact integers.

use std::arch::x86_64::*;

use isa::Fields;
use isa::number::{Nearest32, Vector};
use isa::table::outcome::rtri::{Outcome, Way};

use super::operands::set_vector;
use crate::code::registers::Registers;
use crate::semantics::RayRoom;

/// Bound on the error of a determinant, in units of the product of the largest lanes of its three vectors.
const DETERMINANT: f64 = 1.0 / (1u64 << 48) as f64;

/// Largest quotient that is decided here: beyond it, the word may saturate.
const LARGEST: f64 = 2147483000.0;

/// Lane 0 of the next three for y, z, x, as [`_mm256_permute4x64_pd`] takes it.
const NEXT: i32 = 0b11_00_10_01;

#[target_feature(enable = "avx2,fma")]
#[inline]
fn vector(registers: &Registers, number: u8) -> __m256d {
    let [x, y, z, w] = *registers.padded(number);
    _mm256_cvtepi32_pd(_mm_setr_epi32(x, y, z, w))
}

/// Cross product; the fourth lane is 0. A lane is off by less than the filter's bound allows: one of the two products is not rounded.
#[target_feature(enable = "avx2,fma")]
#[inline]
fn cross(a: __m256d, b: __m256d) -> __m256d {
    let (next_a, next_b) = (_mm256_permute4x64_pd::<NEXT>(a), _mm256_permute4x64_pd::<NEXT>(b));
    _mm256_permute4x64_pd::<NEXT>(_mm256_fmsub_pd(a, next_b, _mm256_mul_pd(next_a, b)))
}

/// The sums of the lanes of four vectors.
#[target_feature(enable = "avx2,fma")]
#[inline]
fn sums(a: __m256d, b: __m256d, c: __m256d, d: __m256d) -> __m256d {
    let (first, second) = (_mm256_hadd_pd(a, b), _mm256_hadd_pd(c, d));
    _mm256_add_pd(_mm256_permute2f128_pd::<0x20>(first, second), _mm256_permute2f128_pd::<0x31>(first, second))
}

/// The largest magnitudes of the lanes of four vectors.
#[target_feature(enable = "avx2,fma")]
#[inline]
fn largest(vectors: [__m256d; 4]) -> __m256d {
    let sign = _mm256_set1_pd(-0.0);
    let [a, b, c, d] = vectors;
    let [a, b, c, d] =
        [_mm256_andnot_pd(sign, a), _mm256_andnot_pd(sign, b), _mm256_andnot_pd(sign, c), _mm256_andnot_pd(sign, d)];
    let first = _mm256_max_pd(_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
    let second = _mm256_max_pd(_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
    _mm256_max_pd(_mm256_permute2f128_pd::<0x20>(first, second), _mm256_permute2f128_pd::<0x31>(first, second))
}

/// Bits in the order of the tests (determinant, u, v, w, t) from those of the lanes (determinant, u, v, t).
#[inline(always)]
fn in_order(lanes: i32, w: bool) -> u32 {
    let lanes = lanes as u32;
    lanes & 7 | u32::from(w) << 3 | (lanes & 8) << 1
}

/// A ray and a triangle: the four vectors, and four times the volumes that decide.
#[derive(Clone, Copy)]
struct Met {
    direction: __m256d,
    edge1: __m256d,
    edge2: __m256d,
    start: __m256d,
    /// The determinant, u, v and t.
    found: __m256d,
}

#[target_feature(enable = "avx2,fma")]
#[inline]
fn meet(registers: &Registers, fields: &Fields) -> Met {
    let (origin, direction) = (vector(registers, fields.a), vector(registers, fields.a.wrapping_add(1)));
    let corner = vector(registers, fields.b);
    let edge1 = _mm256_sub_pd(vector(registers, fields.b.wrapping_add(1)), corner);
    let edge2 = _mm256_sub_pd(vector(registers, fields.b.wrapping_add(2)), corner);
    let start = _mm256_sub_pd(origin, corner);
    let (p, q) = (cross(direction, edge2), cross(start, edge1));
    let found =
        sums(_mm256_mul_pd(p, edge1), _mm256_mul_pd(p, start), _mm256_mul_pd(q, direction), _mm256_mul_pd(q, edge2));
    Met { direction, edge1, edge2, start, found }
}

/// Number of tests that a ray surely passes, and whether it surely fails the next one, where the determinants are off by at most the margins
/// and w = determinant - u - v by at most its own.
#[target_feature(enable = "avx2,fma")]
#[inline]
fn judge(found: __m256d, margins: __m256d, w_margin: f64) -> (u32, bool) {
    let high = _mm256_extractf128_pd::<1>(found);
    let w = _mm_sub_sd(
        _mm_sub_sd(_mm256_castpd256_pd128(found), _mm256_castpd256_pd128(_mm256_permute_pd::<1>(found))),
        high,
    );
    let w = _mm_cvtsd_f64(w);
    let above = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_GT_OQ>(found, margins));
    let below = _mm256_xor_pd(margins, _mm256_set1_pd(-0.0));
    let below = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(found, below));
    let (above, below) = (in_order(above, w > w_margin), in_order(below, w < -w_margin));
    // All tests are turned where the determinant is negative.
    let (inside, outside) = if below & 1 == 0 { (above, below) } else { (below, above) };
    // The first test that is not passed decides, if it is decided.
    let passed = inside.trailing_ones();
    (passed, outside >> passed & 1 == 1)
}

/// A margin for all determinants: from the largest lane of the direction, and the largest one of the other vectors.
#[target_feature(enable = "avx2,fma")]
#[inline]
fn wide_margin(met: &Met) -> __m128d {
    let sign = _mm256_set1_pd(-0.0);
    let [direction, edge1, edge2, start] =
        [met.direction, met.edge1, met.edge2, met.start].map(|vector| _mm256_andnot_pd(sign, vector));
    let others = _mm256_max_pd(_mm256_max_pd(edge1, edge2), start);
    let pairs = _mm256_max_pd(_mm256_unpacklo_pd(direction, others), _mm256_unpackhi_pd(direction, others));
    let both = _mm_max_pd(_mm256_castpd256_pd128(pairs), _mm256_extractf128_pd::<1>(pairs));
    let other = _mm_unpackhi_pd(both, both);
    _mm_mul_sd(_mm_mul_sd(_mm_max_sd(both, other), _mm_set_sd(DETERMINANT)), _mm_mul_sd(other, other))
}

/// The margin of each.
#[target_feature(enable = "avx2,fma")]
#[inline]
fn close_margins(met: &Met) -> __m256d {
    let large = largest([met.direction, met.edge1, met.edge2, met.start]);
    // Direction, direction, direction, start; edge1, edge2, edge1, edge1; edge2, start, start, edge2.
    _mm256_mul_pd(
        _mm256_mul_pd(_mm256_set1_pd(DETERMINANT), _mm256_permute4x64_pd::<0b11_00_00_00>(large)),
        _mm256_mul_pd(_mm256_permute4x64_pd::<0b01_01_10_01>(large), _mm256_permute4x64_pd::<0b10_11_11_10>(large)),
    )
}

/// A ray against a triangle; see the row.
#[target_feature(enable = "avx2,fma")]
#[inline]
pub(super) fn rtri(registers: &mut Registers, fields: &Fields) -> Outcome {
    let met = meet(registers, fields);
    let margin = wide_margin(&met);
    let (passed, is_missed) = judge(met.found, _mm256_broadcastsd_pd(margin), 6.0 * _mm_cvtsd_f64(margin));
    if is_missed {
        return miss(registers, fields, passed);
    }
    closely(registers, fields)
}

/// The test that comes after those passed is failed.
#[inline(always)]
fn miss(registers: &mut Registers, fields: &Fields, passed: u32) -> Outcome {
    const WAYS: [Way; 8] =
        [Way::Parallel, Way::OutsideU, Way::OutsideV, Way::OutsideW, Way::Behind, Way::Hit, Way::Hit, Way::Hit];
    registers.set_other_scalar(fields.d, i32::MAX);
    set_vector(registers, fields.e, [0; 3]);
    Outcome { way: WAYS[passed as usize & 7], units: 0 }
}

/// Decision with closer bounds.
#[target_feature(enable = "avx2,fma")]
#[inline(never)]
fn closely(registers: &mut Registers, fields: &Fields) -> Outcome {
    let met = meet(registers, fields);
    let margins = close_margins(&met);
    let [whole_margin, u_margin, v_margin, _] = lanes(margins);
    let (passed, is_missed) = judge(met.found, margins, 2.0 * (whole_margin + u_margin + v_margin));
    if is_missed {
        return miss(registers, fields, passed);
    }
    let turn = _mm256_and_pd(_mm256_permute4x64_pd::<0>(met.found), _mm256_set1_pd(-0.0));
    let turned = _mm256_xor_pd(met.found, turn);
    if passed == 5
        && let Some((t, weights)) = hit(turned, margins, _mm256_cvtsd_f64(turned), whole_margin, fields.i)
    {
        registers.set_other_scalar(fields.d, t);
        set_vector(registers, fields.e, weights);
        return Outcome { way: Way::Hit, units: 0 };
    }
    exactly(registers, fields)
}

#[target_feature(enable = "avx2,fma")]
#[inline]
fn lanes(vector: __m256d) -> [f64; 4] {
    let (low, high) = (_mm256_castpd256_pd128(vector), _mm256_extractf128_pd::<1>(vector));
    [low, high]
        .map(|half| [_mm_cvtsd_f64(half), _mm_cvtsd_f64(_mm_unpackhi_pd(half, half))])
        .as_flattened()
        .try_into()
        .expect("two halves of two")
}

/// The quotients by the determinant, to nearest, ties up, where they are sure.
///
/// A determinant is off by at most its margin, the divisor by `doubt` of itself, at most one half; then a quotient is off by at most
/// 2 (margin + quotient doubt) / divisor, and by 2^-50 of itself from the operations here. Sure is what lies further than twice that from
/// where rounding turns.
#[target_feature(enable = "avx2,fma")]
#[inline]
fn hit(found: __m256d, margin: __m256d, whole: f64, whole_margin: f64, shift: i32) -> Option<(i32, Vector)> {
    let weight = (1u64 << 30) as f64;
    let scale = _mm256_setr_pd(0.0, weight, weight, (1u64 << (shift & 63)) as f64);
    let inverse = 1.0 / whole;
    let doubt = whole_margin * inverse;
    let factor = _mm256_mul_pd(_mm256_set1_pd(inverse), scale);
    let quotient = _mm256_mul_pd(found, factor);
    let half_up = _mm256_add_pd(quotient, _mm256_set1_pd(0.5));
    let floor = _mm256_floor_pd(half_up);
    let above = _mm256_sub_pd(half_up, floor);
    let spread = _mm256_fmadd_pd(margin, factor, _mm256_mul_pd(quotient, _mm256_set1_pd(doubt)));
    let error = _mm256_fmadd_pd(_mm256_set1_pd(4.0), spread, _mm256_mul_pd(half_up, _mm256_set1_pd(DETERMINANT)));
    let sure = _mm256_and_pd(
        _mm256_and_pd(
            _mm256_cmp_pd::<_CMP_GT_OQ>(above, error),
            _mm256_cmp_pd::<_CMP_LT_OQ>(above, _mm256_sub_pd(_mm256_set1_pd(1.0), error)),
        ),
        _mm256_cmp_pd::<_CMP_LT_OQ>(quotient, _mm256_set1_pd(LARGEST)),
    );
    if _mm256_movemask_pd(sure) & 0b1110 != 0b1110 || doubt >= 0.5 {
        return None;
    }
    let words = _mm256_cvttpd_epi32(floor);
    let (u, v, t) = (_mm_extract_epi32::<1>(words), _mm_extract_epi32::<2>(words), _mm_extract_epi32::<3>(words));
    Some((t, [u, v, 0]))
}

#[cold]
#[inline(never)]
fn exactly(registers: &mut Registers, fields: &Fields) -> Outcome {
    let (t, weights, exit) =
        RayRoom::rtri(&Nearest32, registers.vectors(fields.a), registers.vectors(fields.b), fields.i);
    registers.set_other_scalar(fields.d, t);
    set_vector(registers, fields.e, weights);
    exit
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    use super::*;

    /// Vectors with lanes of at most so many bits.
    fn vector(bits: u32) -> impl Strategy<Value = Vector> {
        let most = i32::MAX >> (31 - bits);
        prop::array::uniform3(-most..=most)
    }

    /// A ray that goes close to a point of a triangle's edge, begins close to its plane or runs along it, and the triangle.
    fn close() -> impl Strategy<Value = [Vector; 5]> {
        let parts = (1u32..32, 1u32..32).prop_flat_map(|(far, near)| {
            (vector(far), vector(near), vector(near), vector(far), -2i64..=66, vector(1), 0u32..5, -4i64..5)
        });
        parts.prop_map(|(corner, edge1, edge2, origin, part, offset, target, scale)| {
            let lanes =
                |lane: &dyn Fn(usize) -> i64| [0, 1, 2].map(|k| lane(k).clamp(i32::MIN.into(), i32::MAX.into()) as i32);
            let moved = |edge: Vector, part: i64| lanes(&|k| i64::from(corner[k]) + ((i64::from(edge[k]) * part) >> 6));
            let (b, c, inside) = (moved(edge1, 64), moved(edge2, 64), [0, 1, 2].map(|k| edge1[k] / 2 + edge2[k] / 2));
            let aim = match target {
                0 => moved(edge1, part),
                1 => moved(edge2, 64 - part),
                _ => moved(inside, part),
            };
            let off = |k: usize| i64::from(offset[k]);
            let towards = lanes(&|k| (i64::from(aim[k]) - i64::from(origin[k])) * scale + off(k));
            let (origin, direction) = match target {
                3 => (lanes(&|k| i64::from(aim[k]) - scale * i64::from(towards[k]) / 1024 + off(k)), towards),
                4 => (origin, lanes(&|k| scale * i64::from(edge1[k]) + part * i64::from(edge2[k]) / 16 + off(k))),
                _ => (origin, towards),
            };
            [origin, direction, corner, b, c]
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 20_000, rng_seed: RngSeed::Fixed(11), ..ProptestConfig::default() })]

        #[test]
        fn it_decides_as_integers_do([origin, direction, a, b, c] in close(), shift in 0i32..32) {
            if !crate::engine::HostSimd::Avx2.is_present() {
                return Ok(());
            }
            let mut found = Registers::default();
            found.set_vectors(1, [origin, direction, a, b, c]);
            let mut exact = found.clone();
            let fields = Fields { d: 4, e: 9, a: 1, b: 3, i: shift, ..Fields::default() };
            // SAFETY: the host has the features.
            let exit = unsafe { rtri(&mut found, &fields) };
            prop_assert_eq!(exit, exactly(&mut exact, &fields));
            prop_assert_eq!(found, exact);
        }
    }
}
