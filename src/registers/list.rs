//! A list of registers with values, such as `s1=100,000,v2=1:2:3`, split where a comma separates and not where it groups digits.

use std::str::FromStr;

use super::RegisterSetting;

/// Registers and what they are set to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RegisterList(pub Vec<RegisterSetting>);

impl FromStr for RegisterList {
    type Err = String;

    fn from_str(text: &str) -> Result<RegisterList, String> {
        split(text)?.iter().map(|item| item.parse()).collect::<Result<_, _>>().map(RegisterList)
    }
}

/// The items of a list. A comma that is followed by exactly three digits and no `=` continues the number before it; any other separates.
///
/// # Errors
/// What could be read in two ways, with the form that can not.
fn split(text: &str) -> Result<Vec<String>, String> {
    let mut items: Vec<String> = Vec::new();
    for piece in text.split(',') {
        let piece = piece.trim();
        let digits = piece.bytes().take_while(u8::is_ascii_digit).count();
        let begins_with_group = digits == 3 && piece[3..].chars().next().is_none_or(|c| ":.".contains(c));
        let Some(item) = items.last_mut() else {
            items.push(piece.to_owned());
            continue;
        };
        if piece.contains('=') {
            items.push(piece.to_owned());
            continue;
        }
        // The number before the comma: its digits behind the last sign that is none.
        let before = item.rsplit(|c: char| !(c.is_ascii_alphanumeric() || "_.".contains(c))).next().unwrap_or_default();
        let plain = before.rsplit('_').next().unwrap_or(before);
        let is_grouped = (1..=3).contains(&plain.len())
            && plain.bytes().all(|digit| digit.is_ascii_digit())
            && (before.contains('_') || !plain.starts_with('0'));
        // Digits behind a format are neither a register nor a group of the number, which is over.
        let is_number = before.starts_with(|c: char| c.is_ascii_digit());
        match (begins_with_group, is_grouped) {
            _ if digits > 0 && !is_number => {
                return Err(format!(
                    "`{piece}` behind a comma names no register: write s1={piece} for one more; groups of digits stand before the format, as in s1=1_000:pos"
                ));
            }
            (true, true) => *item = format!("{item}_{piece}"),
            (true, false) => {
                return Err(format!("`{before},{piece}` could be read in two ways; write {before}_{piece}"));
            }
            (false, _) if digits > 0 => {
                return Err(format!(
                    "`{piece}` behind a comma is no register and no group of three digits; write {before}_{piece} for one number"
                ));
            }
            (false, _) => items.push(piece.to_owned()),
        }
    }
    Ok(items)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commas_separate_or_group() {
        for (text, items) in [
            ("s1=5,v2=1:2:3", &["s1=5", "v2=1:2:3"][..]),
            ("s1=100,000", &["s1=100_000"]),
            ("s1=1,000,000,s2=-2,000", &["s1=1_000_000", "s2=-2_000"]),
            ("v1=1,000:2,000:3,v2=4:5:6", &["v1=1_000:2_000:3", "v2=4:5:6"]),
            ("s5=1.5:pos, w0=0xffff_ffff_ffff_fff9", &["s5=1.5:pos", "w0=0xffff_ffff_ffff_fff9"]),
            ("s5=1,234.5:pos", &["s5=1_234.5:pos"]),
        ] {
            assert_eq!(split(text).unwrap(), items, "{text}");
        }
        for (text, form) in [
            ("s1=1234,567", "write 1234_567"),
            ("s1=0x10,000", "write 0x10_000"),
            ("s1=1.5,000", "write 1.5_000"),
            ("s1=0,123", "write 0_123"),
            ("s1=1,0000", "write 1_0000"),
            ("s1=1,00", "write 1_00"),
            ("s5=1.5:pos,100", "`100` behind a comma names no register: write s1=100"),
            ("s5=one\u{e9}, 655 x", "`655 x` behind a comma names no register"),
        ] {
            assert!(split(text).unwrap_err().contains(form), "{text}: {:?}", split(text));
        }
    }
}
