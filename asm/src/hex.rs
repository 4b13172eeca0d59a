//! Memory contents as Verilog's `$readmemh` reads them.

use std::fmt::Write;

/// Instruction words, one of eight digits a line, from address 0.
pub fn words(words: &[u32]) -> String {
    let mut text = String::with_capacity(words.len() * 9 + 32);
    let _ = writeln!(text, "// {} words of 32 bits", words.len());
    for word in words {
        let _ = writeln!(text, "{word:08x}");
    }
    text
}

/// Octets, sixteen a line, from address 0.
pub fn octets(octets: &[u8]) -> String {
    let mut text = String::with_capacity(octets.len() * 3 + 32);
    let _ = writeln!(text, "// {} octets", octets.len());
    for row in octets.chunks(16) {
        let digits: Vec<String> = row.iter().map(|octet| format!("{octet:02x}")).collect();
        let _ = writeln!(text, "{}", digits.join(" "));
    }
    text
}

#[cfg(test)]
mod tests {
    #[test]
    fn one_word_a_line_and_sixteen_octets_a_line() {
        assert_eq!(super::words(&[1, 0xdeadbeef]), "// 2 words of 32 bits\n00000001\ndeadbeef\n");
        let octets: Vec<u8> = (0..17).collect();
        assert_eq!(super::octets(&octets), "// 17 octets\n00 01 02 03 04 05 06 07 08 09 0a 0b 0c 0d 0e 0f\n10\n");
    }
}
