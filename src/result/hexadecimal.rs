//! Octets as text.

use std::fmt::Write;

/// Octets as lower-case hexadecimal digits, two each.
pub fn hexadecimal(octets: &[u8]) -> String {
    octets.iter().fold(String::with_capacity(2 * octets.len()), |mut text, octet| {
        let _ = write!(text, "{octet:02x}");
        text
    })
}

/// Octets in hexadecimal, sixteen a line, with their addresses from `address` on.
pub fn octet_rows(octets: &[u8], address: u32) -> String {
    let mut text = String::new();
    for (number, row) in octets.chunks(16).enumerate() {
        let digits: Vec<String> = row.chunks(4).map(hexadecimal).collect();
        let _ = writeln!(text, " {:08x}  {}", u64::from(address) + 16 * number as u64, digits.join(" "));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_digits_an_octet() {
        assert_eq!(hexadecimal(&[0, 10, 255]), "000aff");
    }
}
