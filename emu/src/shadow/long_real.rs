//! Real numbers of 256 significant bits, each with a bound on its error: the numbers that shadows are computed in. Which of them belongs to
//! which register is not said here.

use std::cmp::Ordering;

/// Digits of 64 bits that a number has.
const DIGITS: usize = 4;

/// Significant bits.
const BITS: i32 = 64 * DIGITS as i32;

/// A real number `± digits 2^(exponent - 256)`, truncated by each operation that cannot be exact.
///
/// The exact result of the same operations lies within `slack` units in the last place of it; a number whose slack is 0 is exact. So sums,
/// differences and products of integers stay exact up to 256 bits, and one truncation is an error below 2^-255 of the number.
#[derive(Clone, Copy, Debug)]
pub struct LongReal {
    is_negative: bool,
    /// The number lies in [2^(exponent - 1), 2^exponent) but for its sign.
    exponent: i32,
    /// Least digit first; the highest bit is set, but in 0.
    digits: [u64; DIGITS],
    /// Bound on the error in units of 2^(exponent - 256).
    slack: f64,
}

/// 2^by, within the range of doubles.
pub(super) fn power(by: i32) -> f64 {
    match by {
        1024.. => f64::INFINITY,
        ..-1022 => f64::MIN_POSITIVE,
        _ => f64::from_bits(((by + 1023) as u64) << 52),
    }
}

/// A bound in units that become 2^-by times as large.
fn rescaled(slack: f64, by: i32) -> f64 {
    if slack == 0.0 { 0.0 } else { slack * power(by) }
}

/// Digits shifted right, and whether a bit other than 0 was lost.
fn shifted_right(digits: [u64; DIGITS], by: i32) -> ([u64; DIGITS], bool) {
    if by >= BITS {
        return ([0; DIGITS], digits != [0; DIGITS]);
    }
    let (whole, bits) = ((by / 64) as usize, (by % 64) as u32);
    let digit = |at: usize| digits.get(at).copied().unwrap_or(0);
    let joined = |at: usize| match bits {
        0 => digit(at),
        _ => digit(at) >> bits | digit(at + 1) << (64 - bits),
    };
    let lost = digits[..whole].iter().any(|digit| *digit != 0) || bits != 0 && digits[whole] << (64 - bits) != 0;
    (std::array::from_fn(|at| joined(at + whole)), lost)
}

/// Digits shifted left by fewer bits than there are zeros at the top.
fn shifted_left(digits: [u64; DIGITS], by: u32) -> [u64; DIGITS] {
    let (whole, bits) = ((by / 64) as usize, by % 64);
    let digit = |at: usize| at.checked_sub(whole).map_or(0, |at| digits[at]);
    std::array::from_fn(|at| match bits {
        0 => digit(at),
        _ => digit(at) << bits | if at == 0 { 0 } else { digit(at - 1) >> (64 - bits) },
    })
}

/// Zero bits above the highest one.
fn leading_zeros(digits: [u64; DIGITS]) -> u32 {
    let mut zeros = 0;
    for digit in digits.into_iter().rev() {
        zeros += digit.leading_zeros();
        if digit != 0 {
            break;
        }
    }
    zeros
}

fn is_less(a: [u64; DIGITS], b: [u64; DIGITS]) -> bool {
    a.iter().rev().lt(b.iter().rev())
}

/// Digits of `numerator / divisor`, where the quotient has as many as the divisor, whose highest bit is set; and whether something is left.
/// This is long division by digits of 64 bits: each is guessed from the two highest digits and lowered while it is too large.
fn divided(mut rest: [u64; 2 * DIGITS], divisor: [u64; DIGITS]) -> ([u64; DIGITS], bool) {
    let mut quotient = [0; DIGITS];
    let highest = u128::from(divisor[DIGITS - 1]);
    for at in (0..DIGITS).rev() {
        let high = u128::from(rest[at + DIGITS]) << 64 | u128::from(rest[at + DIGITS - 1]);
        // The guess is at most two too large, since the divisor's highest bit is set.
        let mut guess = (high / highest).min(u128::from(u64::MAX)) as u64;
        loop {
            let (mut next, mut carry, mut borrow) = (rest, 0u128, 0i128);
            for k in 0..=DIGITS {
                carry += divisor.get(k).map_or(0, |&digit| u128::from(digit) * u128::from(guess));
                borrow += i128::from(next[at + k]) - i128::from(carry as u64);
                next[at + k] = borrow as u64;
                (carry, borrow) = (carry >> 64, borrow >> 64);
            }
            if borrow >= 0 {
                rest = next;
                break;
            }
            guess -= 1;
        }
        quotient[at] = guess;
    }
    (quotient, rest != [0; 2 * DIGITS])
}

impl LongReal {
    /// Zero, exactly.
    pub const ZERO: LongReal = LongReal { is_negative: false, exponent: 0, digits: [0; DIGITS], slack: 0.0 };

    /// A whole number, exactly.
    pub fn whole(value: i128) -> LongReal {
        let magnitude = value.unsigned_abs();
        if magnitude == 0 {
            return LongReal::ZERO;
        }
        let zeros = magnitude.leading_zeros();
        let top = magnitude << zeros;
        let digits = [0, 0, top as u64, (top >> 64) as u64];
        LongReal { is_negative: value < 0, exponent: 128 - zeros as i32, digits, slack: 0.0 }
    }

    /// The number is 0.
    pub fn is_zero(&self) -> bool {
        self.digits == [0; DIGITS]
    }

    /// The number is less than 0.
    pub fn is_negative(&self) -> bool {
        self.is_negative
    }

    /// Nothing was truncated on the way to the number.
    pub fn is_exact(&self) -> bool {
        self.slack == 0.0
    }

    /// The number lies in a range in which its error is known: 2^(-2^20) to 2^(2^20).
    pub fn is_in_range(&self) -> bool {
        self.exponent.abs() < 1 << 20 && self.slack.is_finite()
    }

    /// Exponent of the power of two above the magnitude; meaningless for 0.
    pub fn exponent(&self) -> i32 {
        self.exponent
    }

    /// The number as a double, rounded; infinite beyond their range.
    pub fn to_f64(&self) -> f64 {
        if self.is_zero() {
            return 0.0;
        }
        // Two factors, since 2^exponent alone may leave the range of doubles.
        let magnitude = self.digits[DIGITS - 1] as f64 * power(-64) * power(self.exponent);
        if self.is_negative { -magnitude } else { magnitude }
    }

    /// Bits of the number that are surely right: all of them, or fewer than 256 where truncations and cancellation took some.
    pub fn good_bits(&self) -> f64 {
        match self.slack {
            0.0 => f64::INFINITY,
            _ if self.is_zero() => 0.0,
            slack => (f64::from(BITS) - slack.log2()).max(0.0),
        }
    }

    /// Sign (true below 0), digits (least first) and exponent: the number is `± digits 2^(exponent - 256)` exactly.
    pub fn binary(&self) -> (bool, [u64; DIGITS], i32) {
        (self.is_negative, self.digits, self.exponent)
    }

    /// Bound on the distance from what exact operations would have given, as a double.
    pub fn bound(&self) -> f64 {
        rescaled(self.slack, self.exponent - BITS)
    }

    /// The number with the other sign.
    pub fn negated(self) -> LongReal {
        LongReal { is_negative: !self.is_negative && !self.is_zero(), ..self }
    }

    /// The number times 2^by, exactly.
    pub fn scaled(self, by: i32) -> LongReal {
        if self.is_zero() && self.slack == 0.0 { self } else { LongReal { exponent: self.exponent + by, ..self } }
    }

    /// The sum.
    pub fn plus(&self, other: &LongReal) -> LongReal {
        // Zero adds only what it may be off by.
        let beside = |number: &LongReal, zero: &LongReal| {
            let more = rescaled(zero.slack, zero.exponent.saturating_sub(number.exponent));
            LongReal { slack: number.slack + more, ..*number }
        };
        match (self.is_zero(), other.is_zero()) {
            (_, true) => return beside(self, other),
            (true, _) => return beside(other, self),
            _ => {}
        }
        // Bring the smaller number under the larger one
        let is_swapped = match self.exponent.cmp(&other.exponent) {
            Ordering::Equal => is_less(self.digits, other.digits),
            order => order == Ordering::Less,
        };
        let (large, small) = if is_swapped { (other, self) } else { (self, other) };
        let apart = large.exponent.saturating_sub(small.exponent);
        let (low, lost) = shifted_right(small.digits, apart);
        let slack = large.slack + rescaled(small.slack, -apart) + f64::from(u8::from(lost));
        let mut digits = [0; DIGITS];
        if large.is_negative == small.is_negative {
            let mut carry = false;
            for at in 0..DIGITS {
                (digits[at], carry) = large.digits[at].carrying_add(low[at], carry);
            }
            let mut sum = LongReal { is_negative: large.is_negative, exponent: large.exponent, digits, slack };
            if carry {
                let (shifted, lost) = shifted_right(digits, 1);
                sum.digits = shifted;
                sum.digits[DIGITS - 1] |= 1 << 63;
                sum.exponent += 1;
                sum.slack = slack / 2.0 + f64::from(u8::from(lost));
            }
            return sum;
        }
        let mut borrow = false;
        for at in 0..DIGITS {
            (digits[at], borrow) = large.digits[at].borrowing_sub(low[at], borrow);
        }
        let difference = LongReal { is_negative: large.is_negative, exponent: large.exponent, digits, slack };
        difference.normalized()
    }

    /// The number with its highest bit in place: cancellation makes the units smaller, and the slack counts more of them.
    fn normalized(self) -> LongReal {
        if self.is_zero() {
            return LongReal { is_negative: false, ..self };
        }
        let zeros = leading_zeros(self.digits);
        LongReal {
            digits: shifted_left(self.digits, zeros),
            exponent: self.exponent - zeros as i32,
            slack: rescaled(self.slack, zeros as i32),
            ..self
        }
    }

    /// The difference.
    pub fn minus(&self, other: &LongReal) -> LongReal {
        self.plus(&other.negated())
    }

    /// The digits as a fraction in [1/2, 1).
    fn fraction(&self) -> f64 {
        self.digits[DIGITS - 1] as f64 * power(-64)
    }

    /// The product.
    pub fn times(&self, other: &LongReal) -> LongReal {
        let mut wide = [0u64; 2 * DIGITS];
        for (at, &a) in self.digits.iter().enumerate().filter(|(_, digit)| **digit != 0) {
            let mut carry = 0u128;
            for (k, &b) in other.digits.iter().enumerate() {
                carry += u128::from(a) * u128::from(b) + u128::from(wide[at + k]);
                wide[at + k] = carry as u64;
                carry >>= 64;
            }
            wide[at + DIGITS] = carry as u64;
        }
        // The product of two fractions in [1/2, 1) lies in [1/4, 1): one shift brings its highest bit up.
        let shift = u32::from(wide[2 * DIGITS - 1] >> 63 == 0);
        let digit = |at: usize| if shift == 0 { wide[at] } else { wide[at] << 1 | wide[at - 1] >> 63 };
        let digits: [u64; DIGITS] = std::array::from_fn(|at| digit(at + DIGITS));
        let lost = wide[..DIGITS - 1].iter().any(|digit| *digit != 0) || wide[DIGITS - 1] << shift != 0;
        let mut slack = f64::from(u8::from(lost));
        if self.slack != 0.0 || other.slack != 0.0 {
            let inherited = self.fraction() * other.slack + other.fraction() * self.slack;
            slack += (inherited + self.slack * other.slack * power(-BITS)) * f64::from(1u32 << shift);
        }
        let is_zero = digits == [0; DIGITS];
        LongReal {
            is_negative: self.is_negative != other.is_negative && !is_zero,
            exponent: self.exponent.saturating_add(other.exponent) - shift as i32,
            digits,
            slack,
        }
    }

    /// The quotient; `None` for a division by 0.
    pub fn over(&self, other: &LongReal) -> Option<LongReal> {
        if other.is_zero() {
            return None;
        }
        // The dividend is halved where its digits are not below the divisor's, so that the quotient has its highest bit in place.
        let is_halved = !is_less(self.digits, other.digits);
        let mut wide = [0; 2 * DIGITS];
        wide[DIGITS..].copy_from_slice(&self.digits);
        if is_halved {
            wide[DIGITS..].copy_from_slice(&shifted_right(self.digits, 1).0);
            wide[DIGITS - 1] = self.digits[0] << 63;
        }
        let (digits, lost) = divided(wide, other.digits);
        let mut quotient = LongReal {
            is_negative: self.is_negative != other.is_negative && !self.is_zero(),
            exponent: self.exponent.saturating_sub(other.exponent) + i32::from(is_halved),
            digits,
            slack: f64::from(u8::from(lost)),
        };
        if self.slack != 0.0 || other.slack != 0.0 {
            // (a + da) / (b - db) - a / b = (da + q db) / (b - db)
            let least = other.fraction() - other.slack * power(-BITS);
            let numerator = self.slack * power(self.exponent - other.exponent - quotient.exponent)
                + quotient.fraction() * other.slack;
            quotient.slack += if least > 0.0 { numerator / least } else { f64::INFINITY };
        }
        Some(quotient)
    }

    /// The square root; `None` of a negative number.
    pub fn root(&self) -> Option<LongReal> {
        // A number that may be 0 has a root that may be 0.
        let may_be_zero = self.is_zero() || self.good_bits() < 1.0;
        if may_be_zero {
            let bound = (self.fraction() + self.slack * power(-BITS)).sqrt() * power(self.exponent / 2 + 1);
            let root = LongReal { slack: bound * power(BITS), exponent: 0, ..LongReal::ZERO };
            return Some(if bound == 0.0 { LongReal::ZERO } else { root });
        }
        if self.is_negative {
            return None;
        }
        // The root of a fraction in [1/4, 1), by Newton's method from the 53 bits of a double: 106, 212, more than 256 bits.
        let half = self.exponent.div_euclid(2) + self.exponent.rem_euclid(2);
        let fraction = LongReal { slack: 0.0, ..self.scaled(-2 * half) };
        let seed = fraction.to_f64().sqrt();
        let mut root = LongReal::whole((seed * power(62)) as i128).scaled(-62);
        for _ in 0..3 {
            root = root.plus(&fraction.over(&root)?).scaled(-1);
        }
        // The root of a square is exact: of such a number half of the digits are enough.
        let mut short = LongReal { slack: 0.0, ..root };
        let is_up = short.digits[DIGITS / 2 - 1] >> 63 == 1;
        short.digits[..DIGITS / 2].fill(0);
        if is_up {
            short = short.plus(&LongReal::whole(1).scaled(short.exponent - BITS / 2));
        }
        let square = short.times(&short).minus(&fraction);
        root = if square.is_zero() && square.is_exact() { short } else { LongReal { slack: 4.0, ..root } };
        if self.slack != 0.0 {
            // The root's error is that of the number over twice the root.
            root.slack += self.slack * power(self.exponent - 2 * half - root.exponent) / root.fraction();
        }
        Some(root.scaled(half))
    }
}

impl PartialEq for LongReal {
    fn eq(&self, other: &LongReal) -> bool {
        self.partial_cmp(other) == Some(Ordering::Equal)
    }
}

impl PartialOrd for LongReal {
    fn partial_cmp(&self, other: &LongReal) -> Option<Ordering> {
        let difference = self.minus(other);
        // A difference of which no bit is sure may be 0, and a difference of equal numbers is 0.
        Some(match (difference.is_zero() || difference.good_bits() < 1.0, difference.is_negative) {
            (true, _) => Ordering::Equal,
            (_, true) => Ordering::Less,
            _ => Ordering::Greater,
        })
    }
}
