//! Meanings against an independent model: exact integers, one rounding to nearest with ties up, saturation.

use emu::semantics::{IntegerRoom, ScalarRoom, VectorRoom, WideRoom};
use isa::number::{Modes, Nearest32, Overflow, Quantization, Vector};
use isa::table::Done;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// `value / 2^shift` to nearest, ties up, by division.
fn nearest(value: i128, shift: i32) -> i128 {
    let unit = 1i128 << shift;
    (2 * value + unit).div_euclid(2 * unit)
}

fn word(value: i128) -> i32 {
    value.clamp(-(1 << 31), (1 << 31) - 1) as i32
}

fn double_word(value: i128) -> i64 {
    value.clamp(-(1 << 63), (1 << 63) - 1) as i64
}

fn exact(vector: Vector) -> [i128; 3] {
    vector.map(i128::from)
}

fn cross(a: Vector, b: Vector) -> [i128; 3] {
    let ([ax, ay, az], [bx, by, bz]) = (exact(a), exact(b));
    [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx]
}

fn dot(a: Vector, b: Vector) -> i128 {
    exact(a).into_iter().zip(exact(b)).map(|(a, b)| a * b).sum()
}

fn quotient(dividend: i128, divisor: i128) -> i32 {
    match divisor {
        0 => word(dividend.signum() << 40),
        _ if divisor < 0 => quotient(-dividend, -divisor),
        _ => word((2 * dividend + divisor).div_euclid(2 * divisor)),
    }
}

/// Numbers of every size.
fn scalar() -> impl Strategy<Value = i32> {
    prop_oneof![(any::<i32>(), 0u32..32).prop_map(|(number, shift)| number >> shift), Just(i32::MIN), Just(i32::MAX)]
}

fn wide() -> impl Strategy<Value = i64> {
    prop_oneof![(any::<i64>(), 0u32..64).prop_map(|(number, shift)| number >> shift), Just(i64::MIN), Just(i64::MAX)]
}

fn vector() -> impl Strategy<Value = Vector> {
    prop::array::uniform3(scalar())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn scalars(a in scalar(), b in scalar(), i in 0i32..64) {
        let (x, y) = (i128::from(a), i128::from(b));
        prop_assert_eq!(Nearest32.add(a, b), (word(x + y), Done));
        prop_assert_eq!(Nearest32.sub(a, b), (word(x - y), Done));
        prop_assert_eq!(ScalarRoom::neg(&Nearest32, a), (word(-x), Done));
        prop_assert_eq!(Nearest32.abs(a), (word(x.abs()), Done));
        prop_assert_eq!(Nearest32.mul(a, b, i), (word(nearest(x * y, i)), Done));
        prop_assert_eq!(Nearest32.div(a, b, i), (quotient(x << i, y), Done));
        prop_assert_eq!(Nearest32.rshift(a, i), (word(nearest(x, i)), Done));
        prop_assert_eq!(Nearest32.lshift(a, i), (word(x << i), Done));
        prop_assert_eq!(Nearest32.scale(a, i), (word(nearest(x, i)), Done));
        prop_assert_eq!(Nearest32.scale(a, -i), (word(x << i), Done));
        prop_assert_eq!(Nearest32.scale(a, i32::MIN), (word(x << 63), Done));
        prop_assert_eq!(Nearest32.scale(a, i32::MAX), (word(nearest(x, 63)), Done));
    }

    #[test]
    fn vectors(a in vector(), b in vector(), s in scalar(), i in 0i32..64) {
        let (x, y) = (exact(a), exact(b));
        let components = |component: &dyn Fn(usize) -> i128| (std::array::from_fn(|k| word(component(k))), Done);
        prop_assert_eq!(Nearest32.vadd(a, b), components(&|k| x[k] + y[k]));
        prop_assert_eq!(Nearest32.vsub(a, b), components(&|k| x[k] - y[k]));
        prop_assert_eq!(Nearest32.vneg(a), components(&|k| -x[k]));
        prop_assert_eq!(Nearest32.vabs(a), components(&|k| x[k].abs()));
        prop_assert_eq!(Nearest32.vmul(a, b, i), components(&|k| nearest(x[k] * y[k], i)));
        prop_assert_eq!(Nearest32.vscale(a, s, i), components(&|k| nearest(x[k] * i128::from(s), i)));
        prop_assert_eq!(Nearest32.vdiv(a, s, i), components(&|k| quotient(x[k] << i, s.into()).into()));
        prop_assert_eq!(Nearest32.vdot(a, b, i), (word(nearest(dot(a, b), i)), Done));
        prop_assert_eq!(Nearest32.vcross(a, b, i), components(&|k| nearest(cross(a, b)[k], i)));
        let major = (0..3).max_by_key(|&k| (x[k].abs(), -(k as i32))).expect("three components");
        prop_assert_eq!(Nearest32.vmajor(a), (major as i32, Done));
        let bits = (0..3).filter(|&k| a[k] < b[k]).map(|k| 1 << k).sum();
        prop_assert_eq!(Nearest32.vlt(a, b), (bits, Done));
        prop_assert_eq!(Nearest32.vselect(a, b, s), components(&|k| if s & 1 << k == 0 { x[k] } else { y[k] }));
    }

    #[test]
    fn normalized_vectors_fill_the_word(a in vector(), b in vector(), bits in 8u32..=32) {
        let modes = Modes { word: bits, ..Modes::default() };
        for (components, found) in [(exact(a), modes.vnorm(a).0), (cross(a, b), modes.vcrossn(a, b).0)] {
            let largest = components.map(i128::abs).into_iter().max().expect("three components");
            if largest == 0 {
                prop_assert_eq!(found, [0; 3]);
                continue;
            }
            let top = found.map(i32::unsigned_abs).into_iter().max().expect("three components");
            prop_assert!((1 << (bits - 3)..=1 << (bits - 2)).contains(&top), "{:?}", found);
            // Some one power of two explains all components.
            let scaled = |shift: i32| components.map(|component| if shift < 0 { component << -shift } else { nearest(component, shift) });
            prop_assert!((-32..64).any(|shift| scaled(shift) == exact(found)), "{:?} is not {:?}", found, components);
        }
        let (found, shift, _) = modes.vnorm(a);
        let expected = exact(a).map(|component| if shift < 0 { component << -shift } else { nearest(component, shift) });
        prop_assert_eq!(exact(found), expected);
    }

    #[test]
    fn wide_numbers(a in wide(), b in wide(), s in scalar(), t in scalar(), i in 0i32..64) {
        let (x, y, p) = (i128::from(a), i128::from(b), i128::from(s) * i128::from(t));
        prop_assert_eq!(Nearest32.wmul(s, t), (p as i64, Done));
        prop_assert_eq!(Nearest32.wmac(a, s, t), (double_word(x + p), Done));
        prop_assert_eq!(Nearest32.wmsub(a, s, t), (double_word(x - p), Done));
        prop_assert_eq!(Nearest32.wadd(a, b), (double_word(x + y), Done));
        prop_assert_eq!(Nearest32.wsub(a, b), (double_word(x - y), Done));
        prop_assert_eq!(Nearest32.wmulw(a, b), (double_word(x * y), Done));
        prop_assert_eq!(Nearest32.wneg(a), (double_word(-x), Done));
        prop_assert_eq!(Nearest32.wextend(s, i), (double_word(i128::from(s) << i), Done));
        prop_assert_eq!(Nearest32.wround(a, i), (word(nearest(x, i)), Done));
        prop_assert_eq!(Nearest32.wscale(a, i), (word(nearest(x, i)), Done));
        prop_assert_eq!(Nearest32.wscale(a, -i), (word((x << i).clamp(-(1 << 40), 1 << 40)), Done));
        // The quotient of numbers up to 2^126 needs no more than 127 bits, twice that would not fit.
        let narrow = a >> 1;
        prop_assert_eq!(Nearest32.wdiv(narrow, b >> 1, i), (quotient(i128::from(narrow) << i, (b >> 1).into()), Done));
        prop_assert_eq!(Nearest32.wjoin((a >> 32) as i32, a as i32), (a, Done));
        prop_assert_eq!(Nearest32.whigh(a), ((a >> 32) as i32, Done));
        prop_assert_eq!(Nearest32.wlow(a), (a as i32, Done));
        prop_assert_eq!(Nearest32.wclz(a).0 as u32, (0..64).rev().take_while(|bit| a >> bit & 1 == 0).count() as u32);
        prop_assert_eq!(Nearest32.wltz(a), (if a < 0 { -1 } else { 0 }, Done));
    }

    #[test]
    fn products_of_three_vectors(a in vector(), b in vector(), c in vector(), i in 0i32..64) {
        prop_assert_eq!(Nearest32.wdot(a, b), (double_word(dot(a, b)), Done));
        let components = cross(a, b).map(|component| component as i64);
        prop_assert_eq!(Nearest32.wcross(a, b), (components, Done), "64 bits hold a cross product exactly");
        let determinant: i128 = cross(a, b).into_iter().zip(exact(c)).map(|(component, c)| component * c).sum();
        prop_assert_eq!(Nearest32.wmixed(components, c, i), (double_word(nearest(determinant, i)), Done));
    }

    #[test]
    fn roots(a in wide(), i in 0i32..64) {
        let (root, _) = Nearest32.wsqrt(a, i);
        let radicand = (a.max(0) as u128) << i;
        if radicand >= 1 << 64 {
            prop_assert_eq!(root, i32::MAX);
        } else {
            // (root - 1/2)^2 < radicand < (root + 1/2)^2, times 4; the largest word stands for everything above.
            let twice = 2 * i128::from(root);
            prop_assert!(root == 0 || (twice - 1).pow(2) < 4 * radicand as i128, "{}", root);
            prop_assert!(root == i32::MAX || 4 * (radicand as i128) < (twice + 1).pow(2), "{}", root);
        }
    }

    #[test]
    fn integers(a: i32, b: i32, i in 0i32..32, offset: i16) {
        let modulo = |value: i128| value.rem_euclid(1 << 32) as u32 as i32;
        let (x, y) = (i128::from(a), i128::from(b));
        prop_assert_eq!(Nearest32.iadd(a, b), (modulo(x + y), Done));
        prop_assert_eq!(Nearest32.isub(a, b), (modulo(x - y), Done));
        prop_assert_eq!(Nearest32.imul(a, b), (modulo(x * y), Done));
        prop_assert_eq!(Nearest32.slli(a, i), (modulo(x << i), Done));
        prop_assert_eq!(Nearest32.srli(a, i), ((a as u32 >> i) as i32, Done));
        prop_assert_eq!(Nearest32.srai(a, i), (x.div_euclid(1 << i) as i32, Done));
        prop_assert_eq!(Nearest32.sll(a, b), Nearest32.slli(a, b & 31));
        prop_assert_eq!(Nearest32.srl(a, b), Nearest32.srli(a, b & 31));
        prop_assert_eq!(Nearest32.sra(a, b), Nearest32.srai(a, b & 31));
        prop_assert_eq!(Nearest32.lea(a as u32, offset.into()), (modulo(x + i128::from(offset)), Done));
        prop_assert_eq!(Nearest32.element(a as u32, b, i), (modulo(x + y * i128::from(i)), Done));
        prop_assert_eq!(Nearest32.movhi(a, i), (modulo(x.rem_euclid(1 << 16) + (i128::from(i) << 16)), Done));
    }
}

#[test]
fn results_saturate_or_wrap_as_the_machine_says() {
    let modes = |overflow| Modes { word: 16, quantization: Quantization::Rnd, overflow };
    assert_eq!(modes(Overflow::Sat).add(32000, 1000), (32767, Done));
    assert_eq!(modes(Overflow::SatZero).add(32000, 1000), (0, Done));
    assert_eq!(modes(Overflow::SatSym).sub(-32000, 1000), (-32767, Done));
    assert_eq!(modes(Overflow::Wrap(0)).add(32000, 1000), (33000 - 65536, Done));
    assert_eq!(modes(Overflow::Wrap(0)).wmul(32000, -32000), (-1_024_000_000, Done), "32 bits hold it");
    assert_eq!(modes(Overflow::Sat).wmac(2_000_000_000, 32000, 32000), (i64::from(i32::MAX), Done));
    assert_eq!(modes(Overflow::Wrap(0)).iadd(32000, 1000), (33000, Done), "integer rows do not know the word");
    assert_eq!(modes(Overflow::Wrap(0)).div(5, 0, 3), (32767, Done), "a division by zero saturates in every mode");
    assert_eq!(modes(Overflow::Wrap(0)).div(0, 0, 3), (0, Done));
}

#[test]
fn lane_three_is_nowhere() {
    assert_eq!(Nearest32.vgetr([7, 8, 9], 2), (9, Done));
    assert_eq!(Nearest32.vgetr([7, 8, 9], 3), (0, Done));
    assert_eq!(Nearest32.vgetr([7, 8, 9], -4), (7, Done));
    assert_eq!(Nearest32.vputr([7, 8, 9], 1, 3), ([7, 8, 9], Done));
    assert_eq!(Nearest32.vput([7, 8, 9], 1, 1), ([7, 1, 9], Done));
    assert_eq!(Nearest32.vmajor([-5, 5, 5]), (0, Done), "of equal components the first");
}
