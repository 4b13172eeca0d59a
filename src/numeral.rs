//! Numbers as people read them.

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

/// A number as it is below 10,000, else with three digits and a unit: 9876, 12.3M.
pub fn short(number: u64) -> String {
    if number < 10_000 {
        return number.to_string();
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

/// A part of a whole in per cent with one decimal; of nothing it is 0.
pub fn percent(part: u64, whole: u64) -> String {
    format!("{:.1} %", if whole == 0 { 0.0 } else { 100.0 * part as f64 / whole as f64 })
}

/// A number with its noun: `1 light`, `2 lights`, `1,000 lights`.
pub fn count(number: u64, singular: &str, plural: &str) -> String {
    format!("{} {}", grouped(number), if number == 1 { singular } else { plural })
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
        assert_eq!(shorter, ["0", "9999", "10.0k", "99.9k", "100k", "999k", "1.00M", "12.3M", "18.4E"]);
        assert_eq!((percent(1, 8), percent(0, 0)), ("12.5 %".into(), "0.0 %".into()));
        assert_eq!((count(1, "light", "lights"), count(0, "light", "lights")), ("1 light".into(), "0 lights".into()));
    }
}
