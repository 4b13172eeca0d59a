//! Octets as text.

use std::fmt::Write;

/// Octets as lower-case hexadecimal digits, two each.
pub fn hexadecimal(octets: &[u8]) -> String {
    octets.iter().fold(String::with_capacity(2 * octets.len()), |mut text, octet| {
        let _ = write!(text, "{octet:02x}");
        text
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_digits_an_octet() {
        assert_eq!(hexadecimal(&[0, 10, 255]), "000aff");
    }
}
