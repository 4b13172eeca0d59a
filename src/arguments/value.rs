//! Values as people type them: `320x240`, `0.5,-1,2`, `name=value`. An error says what was read and what was expected.

use std::str::FromStr;

use kernels::build::Crop;

use crate::settings::LONGEST;

/// Width and height in pixels.
pub type Size = (u32, u32);

/// A part of a picture, as four numbers.
pub type Rectangle = Crop;

/// `N` finite numbers between commas.
///
/// # Errors
/// Another number of parts, or a part that is no finite number.
pub fn point<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    let example = ["0.25", "0.25,-0.5", "0.25,-0.5,1"][N - 1];
    if parts.len() != N {
        return Err(format!("{N} numbers between commas are expected, such as {example}"));
    }
    let mut numbers = [0.0f64; N];
    for (number, part) in numbers.iter_mut().zip(parts) {
        *number = part.parse().map_err(|_| format!("`{part}` is no number"))?;
        if !number.is_finite() {
            return Err(format!("`{part}` is not finite"));
        }
    }
    Ok(numbers)
}

/// `N` whole numbers between commas.
///
/// # Errors
/// Another number of parts, or a part that is no whole number of 32 bits.
pub fn whole<const N: usize>(text: &str) -> Result<[u32; N], String> {
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    if parts.len() != N {
        return Err(format!("{N} whole numbers between commas are expected"));
    }
    let mut numbers = [0; N];
    for (number, part) in numbers.iter_mut().zip(parts) {
        *number = part.parse().map_err(|_| match part.strip_prefix('-') {
            Some(rest) if rest.starts_with(|c: char| c.is_ascii_digit()) => {
                format!("`{part}` is negative: columns and rows count from 0, at the top left")
            }
            _ => format!("`{part}` is no whole number"),
        })?;
    }
    Ok(numbers)
}

/// A picture's size such as `320x240`.
///
/// # Errors
/// Anything else, and a width or height of 0 or more than 16,384.
pub fn size(text: &str) -> Result<Size, String> {
    let refusal = || "a width and a height are expected, such as 320x240".to_owned();
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(refusal)?;
    let side = |text: &str| text.trim().parse::<u32>().map_err(|_| refusal());
    let (width, height) = (side(width)?, side(height)?);
    match [width, height].iter().all(|side| (1..=LONGEST).contains(side)) {
        true => Ok((width, height)),
        false => Err(format!("width and height lie in 1 to {LONGEST}")),
    }
}

/// A part of a picture: first column, first row, width, height.
///
/// # Errors
/// Anything but four whole numbers, and a part without pixels.
pub fn rectangle(text: &str) -> Result<Rectangle, String> {
    let [column, row, width, height] = whole(text)?;
    match width.min(height) {
        0 => Err("a width or a height of 0 leaves no pixel".into()),
        _ => Ok(Crop { column, row, width, height }),
    }
}

/// `name=value`.
///
/// # Errors
/// A text without `=`, an empty name, or what the value's own reader says.
pub fn setting<T: FromStr<Err: std::fmt::Display>>(text: &str) -> Result<(String, T), String> {
    let (name, value) = text.split_once('=').ok_or("a name, `=` and a value are expected")?;
    let (name, value) = (name.trim(), value.trim());
    if name.is_empty() {
        return Err("there is no name before `=`".into());
    }
    Ok((name.to_owned(), value.parse().map_err(|error| format!("`{value}`: {error}"))?))
}

/// Digits without what groups them: `_` between digits, and commas as results print them, such as `100,000,000`.
pub fn ungrouped(text: &str) -> String {
    let plain = text.trim().replace('_', "");
    let mut groups = plain.split(',');
    let is_digits = |group: &str| group.bytes().all(|digit| digit.is_ascii_digit());
    let first = groups.next().unwrap_or_default().trim_start_matches(['-', '+']);
    let is_grouped = (1..=3).contains(&first.len()) && is_digits(first);
    match is_grouped && groups.all(|group| group.len() == 3 && is_digits(group)) {
        true => plain.replace(',', ""),
        false => plain,
    }
}

/// A whole number of at least 1, as [`numbered`] reads it.
///
/// # Errors
/// Anything else.
pub fn positive(text: &str) -> Result<u64, String> {
    match ungrouped(text).parse::<u64>() {
        Ok(number) if number > 0 => Ok(number),
        Ok(_) => Err("0 is not in 1..".to_owned()),
        Err(_) => match numbered(text)? {
            number if number > 0 => Ok(number as u64),
            number => Err(format!("{number} is not in 1..")),
        },
    }
}

/// A whole number, decimal or with `0x`, `0o`, `0b`, with a sign, `_` between digits or commas between thousands.
///
/// # Errors
/// Anything else, and numbers beyond 64 bits.
pub fn numbered(text: &str) -> Result<i64, String> {
    let plain = ungrouped(text);
    let (sign, digits) = match plain.strip_prefix('-') {
        Some(digits) => ("-", digits),
        None => ("", plain.strip_prefix('+').unwrap_or(&plain)),
    };
    let lower = digits.to_ascii_lowercase();
    let (radix, digits) = [("0x", 16), ("0o", 8), ("0b", 2)]
        .into_iter()
        .find_map(|(prefix, radix)| Some((radix, lower.strip_prefix(prefix)?)))
        .unwrap_or((10, &lower));
    let is_plain = !digits.is_empty() && digits.chars().all(|digit| digit.is_digit(radix));
    is_plain
        .then(|| i64::from_str_radix(&format!("{sign}{digits}"), radix).ok())
        .flatten()
        .ok_or_else(|| format!("`{}` is no whole number", text.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_have_as_many_finite_numbers_as_asked_for() {
        assert_eq!(point::<2>("-0.1,0.2"), Ok([-0.1, 0.2]));
        assert_eq!(point::<3>(" 0 , -1 ,3e2"), Ok([0.0, -1.0, 300.0]));
        for (text, message) in [("1,2", "3 numbers"), ("1,,2", "`` is no number"), ("1,2,inf", "`inf` is not finite")] {
            assert!(point::<3>(text).unwrap_err().contains(message), "{text}");
        }
    }

    #[test]
    fn sizes_have_pixels_and_an_end() {
        assert_eq!((size("320x240"), size("1X16384")), (Ok((320, 240)), Ok((1, 16_384))));
        for text in ["320", "0x4", "4x", "x", "-1x4", "16385x1", "3 20x4", "1x1x1"] {
            assert!(size(text).is_err(), "{text}");
        }
    }

    #[test]
    fn rectangles_have_pixels() {
        assert_eq!(rectangle("1,2,3,4"), Ok(Crop { column: 1, row: 2, width: 3, height: 4 }));
        for text in ["1,2,3", "1,2,0,4", "1,2,3,0", "-1,2,3,4", "1,2,3,4294967296"] {
            assert!(rectangle(text).is_err(), "{text}");
        }
    }

    #[test]
    fn whole_numbers_in_every_base() {
        for (text, value) in [("12", 12), ("-0x10", -16), ("0b101", 5), ("0o17", 15), ("1_000", 1000), ("+3", 3)] {
            assert_eq!(numbered(text), Ok(value), "{text}");
        }
        assert_eq!((numbered("100,000,000"), numbered("-1,000"), numbered("7")), (Ok(100_000_000), Ok(-1000), Ok(7)));
        assert_eq!((positive("1,000"), positive("1_000"), positive("0x10")), (Ok(1000), Ok(1000), Ok(16)));
        assert!(
            ["0", "-1", "1,00", "1000,000", ",100", "1,,000", "1.5", ""].iter().all(|text| positive(text).is_err())
        );
        assert_eq!((numbered("-9223372036854775808"), numbered("9223372036854775807")), (Ok(i64::MIN), Ok(i64::MAX)));
        for text in ["", "-", "0x", "0x-1", "1.5", "9223372036854775808", "abc", "--1"] {
            assert!(numbered(text).is_err(), "{text}");
        }
    }

    #[test]
    fn settings_are_a_name_and_a_value() {
        assert_eq!(setting::<i64>("dir = 24"), Ok(("dir".into(), 24)));
        for text in ["dir", "=3", "dir=many"] {
            assert!(setting::<i64>(text).is_err(), "{text}");
        }
    }
}
