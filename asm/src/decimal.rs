//! Decimal literals as exact numbers, and their conversion to fixed point with one rounding; no floating point.

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

    /// The nearest multiple of 2^-`bits`, as a count of them; ties go up. `None` beyond 64 bits.
    pub fn to_fixed(self, bits: u32) -> Option<i64> {
        let one = 10u128.checked_pow(self.places)?;
        let mut raw = i128::from(self.integer);
        let mut rest = self.fraction;
        for _ in 0..bits {
            rest *= 2;
            raw = raw * 2 + i128::from(rest >= one);
            rest %= one;
            if raw > 1 << 64 {
                return None;
            }
        }
        let is_rounded_away = if self.is_negative { rest * 2 > one } else { rest * 2 >= one };
        raw += i128::from(is_rounded_away);
        i64::try_from(if self.is_negative { -raw } else { raw }).ok()
    }
}

#[cfg(test)]
mod tests {
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
        ] {
            assert_eq!(fixed(text, bits), Some(raw), "{text} with {bits} bits");
        }
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
