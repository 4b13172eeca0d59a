//! Octets as text that a page can hold (RFC 4648).

const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// The text of octets: four letters for three of them, `=` where the last ones are fewer.
pub fn text(octets: &[u8]) -> String {
    let mut text = String::with_capacity(octets.len().div_ceil(3) * 4);
    for part in octets.chunks(3) {
        // Three octets are four groups of six bits, the first one on top.
        let bits = part.iter().fold(0u32, |bits, &octet| bits << 8 | u32::from(octet)) << (8 * (3 - part.len()));
        for group in 0..4 {
            let letter = LETTERS[(bits >> (18 - 6 * group) & 63) as usize];
            text.push(if group <= part.len() { char::from(letter) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_standards_examples() {
        let of = |word: &str| text(word.as_bytes());
        assert_eq!(
            ["", "f", "fo", "foo", "foob", "fooba", "foobar"].map(of),
            ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"]
        );
        assert_eq!(text(&[0xFF, 0xEF, 0xBE]), "/+++");
    }
}
