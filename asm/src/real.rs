//! Fixed-point numbers as decimal text and back, exactly: what is printed of a raw number reads back as the same raw number.

use crate::decimal::Decimal;
use crate::limits::FRACTION_BITS;

/// Raw number of a decimal text such as `-1.25` or `1e-3` in a format of `bits` fraction bits: the nearest one, ties up. Formats of fewer than 0 or
/// more than 63 bits, which only the loader of a scene makes, are read by way of double precision.
///
/// # Errors
/// Anything but a decimal number, one with too many digits, and one beyond 64 bits.
pub fn parse(text: &str, bits: i32) -> Result<i64, String> {
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
    let beyond = || format!("{text} does not fit 64 bits with {bits} fraction bits");
    let Some(bits) = written(bits) else {
        let value: f64 = digits.replace('_', "").parse().map_err(|_| refusal())?;
        let raw = (scaled(if is_negative { -value } else { value }, bits) + 0.5).floor();
        return if raw.abs() < TWO_TO_63 { Ok(raw as i64) } else { Err(beyond()) };
    };
    let decimal = Decimal::parse(digits).map_err(|why| format!("`{text}`: {why}"))?;
    decimal.signed(is_negative).to_fixed(bits).ok_or_else(beyond)
}

/// First magnitude that 64 bits do not hold.
const TWO_TO_63: f64 = (1u64 << 63) as f64;

/// Fraction bits that assembly text can write; `None` for others.
fn written(bits: i32) -> Option<u32> {
    u32::try_from(bits).ok().filter(|&bits| i64::from(bits) <= FRACTION_BITS)
}

/// `x * 2^power`, in two steps since one power may lie beyond double precision.
fn scaled(x: f64, power: i32) -> f64 {
    let half = power / 2;
    x * f64::from(half).exp2() * f64::from(power - half).exp2()
}

/// Shortest decimal text that [`parse`] reads as this raw number in a format of `bits` fraction bits. It has no exponent for 0 to 63 bits; for others,
/// of which raw numbers beyond 2^53 lose their last bits, it has one.
///
/// 329,314 with 16 bits is 5.024932...; 5.02493 is the text, since 5.0249 would be 329,312.
pub fn text(raw: i64, bits: i32) -> String {
    let Some(bits) = written(bits) else {
        let value = scaled(raw as f64, -bits);
        let mut texts = (0..18).map(|digits| format!("{value:.digits$e}"));
        let last = format!("{value:e}");
        return texts.find(|text| parse(text, bits) == Ok(raw)).unwrap_or(last);
    };
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
pub fn value(raw: i64, bits: i32) -> f64 {
    scaled(raw as f64, -bits)
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
            (3, -2, "1e1"),
            (-5, -270, "-9e81"),
            (7, 300, "3.4e-90"),
            (0, 64, "0e0"),
        ] {
            assert_eq!(text(raw, bits), expected);
        }
    }

    #[test]
    fn what_is_printed_reads_back() {
        let raws = prop_oneof![any::<i64>(), any::<i32>().prop_map(i64::from), -1000i64..1000];
        check(4000, &(raws, 0..64i32), |(raw, bits)| {
            let text = text(raw, bits);
            prop_assert_eq!(parse(&text, bits), Ok(raw), "{} with {} bits", text, bits);
            Ok(())
        });
    }

    #[test]
    fn words_of_very_large_and_small_scenes_read_back() {
        let bits = prop_oneof![-990..0i32, 64..1040i32];
        check(4000, &(any::<i32>(), bits), |(raw, bits)| {
            let text = text(raw.into(), bits);
            prop_assert_eq!(parse(&text, bits), Ok(raw.into()), "{} with {} bits", text, bits);
            Ok(())
        });
        assert_eq!(parse("8.452712498170644e270", -900), Ok(1));
        assert!(parse("1e300", 100).unwrap_err().contains("does not fit"));
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
