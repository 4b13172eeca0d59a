//! Decimal literals as exact numbers, and their conversion to fixed point with one rounding; no floating point.

use fixed::types::U0F128;

use crate::limits::FRACTION_DIGITS;

/// A decimal number: `(integer + fraction / 10^places)`, negated when asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Decimal {
    pub is_negative: bool,
    integer: u64,
    fraction: u128,
    places: u32,
}

impl Decimal {
    /// Reads digits with an optional point and exponent; `Err` says what is too long.
    pub fn parse(text: &str) -> Result<Decimal, String> {
        let text: String = text.chars().filter(|&c| c != '_').collect();
        let (mantissa, exponent) = match text.find(['e', 'E']) {
            None => (&text[..], 0),
            Some(at) => (&text[..at], text[at + 1..].parse::<i32>().map_err(|_| "the exponent is too large")?),
        };
        let (before, after) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let all = format!("{before}{after}");
        let digits = all.trim_start_matches('0');
        let point = before.len() as i64 - (all.len() - digits.len()) as i64 + i64::from(exponent);
        let digits = digits.trim_end_matches('0');
        if digits.is_empty() {
            return Ok(Decimal { is_negative: false, integer: 0, fraction: 0, places: 0 });
        }
        let places = (digits.len() as i64 - point).max(0);
        if places > FRACTION_DIGITS as i64 {
            return Err(format!("more than {FRACTION_DIGITS} digits after the point"));
        }
        if point > 20 {
            return Err("the number is too large".into());
        }
        let split = point.clamp(0, digits.len() as i64) as usize;
        let zeros = "0".repeat((point - digits.len() as i64).max(0) as usize);
        let integer = format!("0{}{zeros}", &digits[..split]).parse().map_err(|_| "the number is too large")?;
        let fraction = format!("0{}", &digits[split..]).parse().map_err(|_| "the fraction is too long")?;
        Ok(Decimal { is_negative: false, integer, fraction, places: places as u32 })
    }

    /// Number of the same magnitude, negated where it is to be negative.
    pub fn signed(self, is_negative: bool) -> Decimal {
        Decimal { is_negative, ..self }
    }

    /// The nearest multiple of 2^-`bits` (at most 63), as a count of them; ties go up. `None` beyond 64 bits.
    ///
    /// -1.3 with 2 bits: 0.3 is 1 quarter and 0.2 of one, so the number is -5 quarters; -1.375 lies half-way between -6 and -5 and becomes -5,
    /// 1.375 becomes 6.
    pub fn to_fixed(self, bits: u32) -> Option<i64> {
        // The part behind the point, cut off after 128 bits. Nothing is lost of a number that lies half-way between two multiples, since
        // it has at most one bit more than they; any other is on the same side of the middle as before, or on it and not exact.
        let one = 10u128.checked_pow(self.places)?;
        let fraction = U0F128::from_bits(self.fraction) / U0F128::from_bits(one);
        let is_exact = fraction.to_bits().wrapping_mul(one) == 0;
        // The multiple at or below the number, and what is left of it in multiples.
        let high = fraction.to_bits().checked_shr(128 - bits).unwrap_or(0);
        let whole = i128::from(self.integer).checked_mul(1 << bits)?.checked_add_unsigned(high)?;
        let rest = fraction << bits;
        let half = U0F128::from_bits(1 << 127);
        let is_rounded_away = rest > half || rest == half && !(self.is_negative && is_exact);
        let raw = whole + i128::from(is_rounded_away);
        i64::try_from(if self.is_negative { -raw } else { raw }).ok()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use testing::check;

    use super::*;

    fn fixed(text: &str, bits: u32) -> Option<i64> {
        let (is_negative, digits) = text.strip_prefix('-').map_or((false, text), |rest| (true, rest));
        Decimal { is_negative, ..Decimal::parse(digits).unwrap() }.to_fixed(bits)
    }

    #[test]
    fn nearest_with_ties_up() {
        for (text, bits, raw) in [
            ("0.5", 30, 1 << 29),
            ("-1.25", 16, -81920),
            ("1", 30, 1 << 30),
            ("0.5", 0, 1),
            ("-0.5", 0, 0),
            ("-1.5", 0, -1),
            ("1.5", 0, 2),
            ("0.1", 4, 2),
            ("-0.1", 4, -2),
            ("1e3", 1, 2000),
            ("1.5e-1", 10, 154),
            ("0.00000000000000000000000000000000000001", 63, 0),
            ("00012.500", 1, 25),
            ("9223372036854775807", 0, i64::MAX),
            ("-9223372036854775808", 0, i64::MIN),
            ("-1.3", 2, -5),
            ("-1.375", 2, -5),
            ("1.375", 2, 6),
            ("0.49999999999999999999999999999999999999", 0, 0),
            ("0.50000000000000000000000000000000000001", 0, 1),
            ("-0.50000000000000000000000000000000000001", 0, -1),
        ] {
            assert_eq!(fixed(text, bits), Some(raw), "{text} with {bits} bits");
        }
    }

    /// A second way to [`Decimal::to_fixed`], bit by bit: twice the rest, and a one where that reaches the denominator.
    fn bit_by_bit(number: Decimal, bits: u32) -> Option<i64> {
        let one = 10u128.pow(number.places);
        let (mut raw, mut rest) = (i128::from(number.integer), number.fraction);
        for _ in 0..bits {
            rest *= 2;
            raw = raw * 2 + i128::from(rest >= one);
            rest %= one;
        }
        let rounds = if number.is_negative { rest * 2 > one } else { rest * 2 >= one };
        let raw = raw + i128::from(rounds);
        i64::try_from(if number.is_negative { -raw } else { raw }).ok()
    }

    #[test]
    fn all_bits_are_those_of_long_division() {
        let digits = proptest::string::string_regex("[0-9]{1,20}(\\.[0-9]{0,38})?").unwrap();
        let ties = (0..1u64 << 20, 0..20u32).prop_map(|(odd, bits)| {
            // Odd multiples of half a unit: 25^n / 100^n has n bits.
            let places = bits as usize + 1;
            let fraction = u128::from(2 * (odd >> (20 - bits)) + 1) * 5u128.pow(bits + 1);
            format!("3.{fraction:0places$}")
        });
        check(2000, &(prop_oneof![digits, ties], 0..64u32, any::<bool>()), |(text, bits, is_negative)| {
            if let Ok(number) = Decimal::parse(&text) {
                let number = Decimal { is_negative, ..number };
                prop_assert_eq!(number.to_fixed(bits), bit_by_bit(number, bits), "{} with {} bits", text, bits);
            }
            Ok(())
        });
    }

    #[test]
    fn what_is_too_long_is_refused() {
        assert!(Decimal::parse("0.000000000000000000000000000000000000001").is_err());
        assert!(Decimal::parse("1e99").is_err());
        assert!(Decimal::parse("1e99999999999").is_err());
        assert!(Decimal::parse("1e-99").is_err());
        assert_eq!(fixed("9223372036854775808", 0), None);
        assert_eq!(fixed("1", 63), None);
        assert_eq!(fixed("-1", 63), Some(i64::MIN));
    }
}
