//! Fixed-point numbers as decimal text and back, exactly: what is printed of a raw number reads back as the same raw number.

use crate::decimal::Decimal;
use crate::limits::FRACTION_BITS;

/// Raw number of a decimal text such as `-1.25` or `1e-3` in a format of `bits` fraction bits (0 to 63): the nearest one, ties up.
///
/// # Errors
/// Anything but a decimal number, one with too many digits, and one beyond 64 bits.
pub fn parse(text: &str, bits: u32) -> Result<i64, String> {
    let refusal = || format!("`{text}` is no decimal number, such as -1.25");
    let (is_negative, digits) = match text.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, text.strip_prefix('+').unwrap_or(text)),
    };
    let is_plain = digits.starts_with(|c: char| c.is_ascii_digit())
        && digits.bytes().all(|c| c.is_ascii_digit() || b"._eE+-".contains(&c))
        && digits.matches('.').count() < 2;
    if !is_plain {
        return Err(refusal());
    }
    let decimal = Decimal::parse(digits).map_err(|why| format!("`{text}`: {why}"))?;
    let raw = decimal.signed(is_negative).to_fixed(bits.min(FRACTION_BITS as u32));
    raw.ok_or_else(|| format!("{text} does not fit 64 bits with {bits} fraction bits"))
}

/// Shortest decimal text that [`parse`] reads as this raw number in a format of `bits` fraction bits (0 to 63), without an exponent.
///
/// 329,314 with 16 bits is 5.024932...; 5.02493 is the text, since 5.0249 would be 329,312.
pub fn text(raw: i64, bits: u32) -> String {
    let bits = bits.min(FRACTION_BITS as u32);
    let magnitude = u128::from(raw.unsigned_abs());
    // Try one digit more behind the point until what is printed lies within half a unit. All products stay below 2^127: a number has
    // 64 bits, and 10^19, which is always enough for 63 fraction bits, another 64.
    let mut scale = 1u128;
    let mut places = 0;
    loop {
        let exact = magnitude * scale;
        let printed = (exact + (1u128 << bits >> 1)) >> bits;
        let difference = (printed << bits).abs_diff(exact);
        if difference * 2 < scale || places == 19 {
            let sign = if raw < 0 { "-" } else { "" };
            let (whole, fraction) = (printed / scale, printed % scale);
            return match places {
                0 => format!("{sign}{whole}"),
                _ => format!("{sign}{whole}.{fraction:0places$}"),
            };
        }
        places += 1;
        scale *= 10;
    }
}

/// Real value of a raw number, as near as double precision comes.
pub fn value(raw: i64, bits: u32) -> f64 {
    raw as f64 * (-f64::from(bits)).exp2()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use testing::check;

    use super::*;

    #[test]
    fn numbers_are_as_short_as_they_can_be() {
        for (raw, bits, expected) in [
            (329_314, 16, "5.02493"),
            (98_304, 16, "1.5"),
            (-98_304, 16, "-1.5"),
            (7, 0, "7"),
            (0, 63, "0"),
            (1, 1, "0.5"),
            (1, 30, "0.000000001"),
            (i64::MIN, 63, "-1"),
            (i64::MIN, 0, "-9223372036854775808"),
            (i64::MAX, 0, "9223372036854775807"),
        ] {
            assert_eq!(text(raw, bits), expected);
        }
    }

    #[test]
    fn what_is_printed_reads_back() {
        let raws = prop_oneof![any::<i64>(), any::<i32>().prop_map(i64::from), -1000i64..1000];
        check(4000, &(raws, 0..64u32), |(raw, bits)| {
            let text = text(raw, bits);
            prop_assert_eq!(parse(&text, bits), Ok(raw), "{} with {} bits", text, bits);
            Ok(())
        });
    }

    #[test]
    fn what_is_no_number_is_refused() {
        for text in ["", "-", "x", "1.2.3", "0x10", ".5", "1,000", "--1", "\u{e9}"] {
            assert!(parse(text, 16).unwrap_err().contains("no decimal number"), "{text}");
        }
        assert!(parse("1e30", 0).unwrap_err().contains("too large"));
        assert!(parse("140737488355328", 16).unwrap_err().contains("does not fit"));
    }
}
