//! Long reals against exact rationals of unbounded integers: every number lies within its own bound.

use num_bigint::{BigInt, Sign};
use proptest::prelude::*;
use testing::check;

use super::long_real::LongReal;

/// A rational number with a positive denominator.
#[derive(Clone, Debug)]
struct Rational(BigInt, BigInt);

/// The exact value of a long real.
fn exact(number: &LongReal) -> Rational {
    let (is_negative, digits, exponent) = number.binary();
    let words: Vec<u32> = digits.iter().flat_map(|digit| [*digit as u32, (*digit >> 32) as u32]).collect();
    let sign = if is_negative { Sign::Minus } else { Sign::Plus };
    let digits = BigInt::from_slice(sign, &words);
    match exponent - 256 {
        up @ 0.. => Rational(digits << up as usize, 1.into()),
        down => Rational(digits, BigInt::from(1) << -down as usize),
    }
}

/// |a - b| <= 2^bits times a bound.
fn is_near(a: &Rational, b: &Rational, bound: f64) -> bool {
    let difference = (&a.0 * &b.1 - &b.0 * &a.1).magnitude().clone();
    let scale = (&a.1 * &b.1).magnitude().clone();
    // The bound as a fraction of two whole numbers, a little larger.
    let (mantissa, exponent) =
        ((bound.to_bits() & ((1 << 52) - 1) | 1 << 52) + 1, (bound.to_bits() >> 52) as i64 - 1075);
    let bound = num_bigint::BigUint::from(mantissa) * scale;
    if exponent >= 0 { difference <= bound << exponent as usize } else { difference << -exponent as usize <= bound }
}

/// An operation and where its operands come from.
type TriedStep = (u8, usize, usize, i32);

#[test]
fn every_number_lies_within_its_bound_of_the_exact_one() {
    let starts = prop::collection::vec(any::<i64>().prop_flat_map(|n| (0u32..63).prop_map(move |by| n >> by)), 3);
    let steps = prop::collection::vec((0u8..6, 0usize..16, 0usize..16, -40i32..40), 1..12);
    check(1500, &(starts, steps), |(starts, steps): (Vec<i64>, Vec<TriedStep>)| {
        let mut numbers: Vec<LongReal> = starts.iter().map(|&n| LongReal::whole(n.into())).collect();
        let mut rationals: Vec<Rational> = starts.iter().map(|&n| Rational(n.into(), 1.into())).collect();
        for (operation, a, b, by) in steps {
            let (a, b) = (a % numbers.len(), b % numbers.len());
            let (x, y) = (numbers[a], numbers[b]);
            let (Rational(xn, xd), Rational(yn, yd)) = (rationals[a].clone(), rationals[b].clone());
            let (number, rational) = match operation {
                0 => (x.plus(&y), Rational(&xn * &yd + &yn * &xd, &xd * &yd)),
                1 => (x.minus(&y), Rational(&xn * &yd - &yn * &xd, &xd * &yd)),
                2 => (x.times(&y), Rational(&xn * &yn, &xd * &yd)),
                3 if yn.sign() != Sign::NoSign => {
                    let Some(quotient) = x.over(&y) else { continue };
                    let sign = if yn.sign() == Sign::Minus { BigInt::from(-1) } else { BigInt::from(1) };
                    (quotient, Rational(&sign * &xn * &yd, &sign * &xd * &yn))
                }
                4 if by >= 0 => (x.scaled(by), Rational(xn << by as usize, xd)),
                4 => (x.scaled(by), Rational(xn, xd << -by as usize)),
                // The root to 2^-400, which is far below every bound.
                5 if xn.sign() != Sign::Minus => {
                    let Some(root) = x.root() else { continue };
                    let square: BigInt = (xn << 800usize) / xd;
                    (root, Rational(square.sqrt(), BigInt::from(1) << 400usize))
                }
                _ => continue,
            };
            if !number.is_in_range() || number.bound() == f64::INFINITY {
                continue;
            }
            let bound = number.bound() + if operation == 5 { 1e-120 } else { 0.0 };
            if number.is_exact() && operation != 5 {
                let Rational(n, d) = exact(&number);
                prop_assert_eq!(&n * &rational.1, &rational.0 * &d, "{:?}", number);
            } else {
                prop_assert!(is_near(&exact(&number), &rational, bound), "{:?} by {}", number, operation);
            }
            numbers.push(number);
            rationals.push(rational);
        }
        Ok(())
    });
}

#[test]
fn small_numbers_come_out_as_they_should() {
    let whole = |n: i128| LongReal::whole(n);
    assert_eq!(whole(7).over(&whole(2)).unwrap().to_f64(), 3.5);
    assert_eq!(whole(-7).times(&whole(3)).to_f64(), -21.0);
    assert_eq!(whole(1 << 100).plus(&whole(-1)).minus(&whole(1 << 100)).to_f64(), -1.0);
    assert!(whole(49).root().unwrap() == whole(7) && whole(49).root().unwrap().is_exact());
    assert_eq!(whole(2).root().unwrap().to_f64(), 2f64.sqrt());
    assert!(whole(-1).root().is_none() && whole(1).over(&LongReal::ZERO).is_none());
    let third = whole(1).over(&whole(3)).unwrap();
    assert!(!third.is_exact() && third.good_bits() > 254.0);
    let nothing = third.times(&whole(3)).minus(&whole(1));
    assert!(nothing.good_bits() < 2.0, "{nothing:?}: nothing is left of a third of three");
    assert!(third < whole(1) && third.scaled(2) > whole(1) && whole(-3) < whole(-2));
}
