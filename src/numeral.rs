//! Numbers as people read and write them.

/// A number with commas between its thousands.
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::with_capacity(digits.len() * 4 / 3);
    for (at, digit) in digits.chars().enumerate() {
        if at != 0 && (digits.len() - at).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// A number as it is below 10,000, else with three digits and a unit: 9,876, 12.3M.
pub fn short(number: u64) -> String {
    if number < 10_000 {
        return grouped(number);
    }
    let mut scaled = number as f64 / 1000.0;
    for unit in ["k", "M", "G", "T", "P"] {
        // 999.5 would be shown with four digits.
        if scaled < 999.5 {
            let decimals = if scaled < 9.995 { 2 } else { usize::from(scaled < 99.95) };
            return format!("{scaled:.decimals$}{unit}");
        }
        scaled /= 1000.0;
    }
    format!("{scaled:.1}E")
}

/// A part of a whole as a number from 0 to 1, or more where it is no part; of nothing it is 0.
pub fn share(part: u64, whole: u64) -> f64 {
    if whole == 0 { 0.0 } else { part as f64 / whole as f64 }
}

/// A part of a whole in per cent with one decimal; of nothing it is 0.
pub fn percent(part: u64, whole: u64) -> String {
    format!("{:.1} %", 100.0 * share(part, whole))
}

/// A number with its noun: `1 light`, `2 lights`, `1,000 lights`.
pub fn count(number: u64, singular: &str, plural: &str) -> String {
    format!("{} {}", grouped(number), if number == 1 { singular } else { plural })
}

/// Most numbers of a list.
const MOST_NUMBERS: usize = 10_000_000;

/// Whole numbers from `least` to `most`: single ones and ranges, between commas: `1,4-8`, `1..4`, `1..=4`, ranges with both ends.
///
/// # Errors
/// Anything else, ranges that go down, and more than ten million numbers.
pub fn numbers(text: &str, least: u32, most: u32, what: &str) -> Result<Vec<u32>, String> {
    let number = |text: &str| match text.trim().parse::<u32>() {
        Ok(number) if (least..=most).contains(&number) => Ok(number),
        _ => Err(format!("`{}` is no {what} from {least} to {most}", text.trim())),
    };
    let mut numbers = Vec::new();
    for part in text.split(',') {
        let range = part.split_once("..").map(|(first, last)| (first, last.trim_start_matches('=')));
        match range.or_else(|| part.split_once('-').filter(|(first, _)| !first.trim().is_empty())) {
            None => numbers.push(number(part)?),
            Some((first, last)) => {
                let (first, last) = (number(first)?, number(last)?);
                if first > last {
                    return Err(format!("`{part}` goes down"));
                }
                if (last - first) as usize >= MOST_NUMBERS - numbers.len().min(MOST_NUMBERS) {
                    return Err(format!("`{text}` is more than {} numbers", grouped(MOST_NUMBERS as u64)));
                }
                numbers.extend(first..=last);
            }
        }
    }
    Ok(numbers)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_or_exact() {
        let exact: Vec<String> = [0, 12, 999, 1000, 1_234_567].map(grouped).to_vec();
        assert_eq!(exact, ["0", "12", "999", "1,000", "1,234,567"]);
        let numbers = [0, 9_999, 10_000, 99_949, 99_951, 999_499, 999_501, 12_345_678, u64::MAX];
        let shorter: Vec<String> = numbers.map(short).to_vec();
        assert_eq!(shorter, ["0", "9,999", "10.0k", "99.9k", "100k", "999k", "1.00M", "12.3M", "18.4E"]);
        assert_eq!((percent(1, 8), percent(0, 0)), ("12.5 %".into(), "0.0 %".into()));
        assert_eq!((count(1, "light", "lights"), count(0, "light", "lights")), ("1 light".into(), "0 lights".into()));
    }

    #[test]
    fn lists_have_numbers_and_ranges() {
        let cores = |text: &str| numbers(text, 1, 256, "number of cores");
        assert_eq!(cores("1..4,8, 2"), Ok(vec![1, 2, 3, 4, 8, 2]));
        assert_eq!((cores("1-3"), cores("1..=3"), cores("16")), (Ok(vec![1, 2, 3]), Ok(vec![1, 2, 3]), Ok(vec![16])));
        for text in ["", "0", "257", "4..2", "4-2", "1..", "1-", "-1", "a", "1,,2", "1..999", "1-2-3"] {
            assert!(cores(text).is_err(), "{text}");
        }
        let any = |text: &str| numbers(text, 0, u32::MAX, "number").map(|numbers| numbers.len());
        assert_eq!(any("1-10000000"), Ok(MOST_NUMBERS));
        assert!(["0-10000000", "0-4294967295", "1-9999999,0-1"].iter().all(|text| any(text).is_err()));
    }
}
